// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/run_command.h"
#include "engine/cli/signals.h"

int main(int argc, char** argv) {
    limn::cli::InstallSignalHandlers();
    limn::engine::MeshFiles files;
    int const status = limn::cli::RunCommand({argv + 1, argv + argc}, files,
                                             [] { return limn::cli::GetSignal() != 0; });
    return status == limn::cli::kStopped ? 128 + limn::cli::GetSignal() : status;
}
