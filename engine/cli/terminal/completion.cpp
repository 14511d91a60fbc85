// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/terminal/completion.h"

namespace limn::cli {

std::string WriteCompletion(CLI::App const& app, Shell shell) {
    switch (shell) {
        case Shell::Bash:
            return WriteBashCompletion(app);
        case Shell::Zsh:
            return WriteZshCompletion(app);
        case Shell::Fish:
            return WriteFishCompletion(app);
    }
    return {};
}

}  // namespace limn::cli
