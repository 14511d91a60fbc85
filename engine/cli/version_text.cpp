// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/version_text.h"

#include "engine/version.h"

namespace limn::cli {

extern char const* const kCommit;  ///< cmake/WriteCommit.cmake writes it

std::string GetVersionText() {
    std::string const commit = kCommit;
    return commit.empty() ? kVersionAndBuild : kVersionAndBuild + (", commit " + commit);
}

}  // namespace limn::cli
