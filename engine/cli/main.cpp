// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "engine/cli/run_command.h"
#include "engine/cli/signals.h"

/// The work runs on a thread of its own, because some of it (a factorisation by a library, a pipe
/// that nobody writes to) cannot stop where it is. Such work is given up with the process.
int main(int argc, char** argv) {
    using namespace limn::cli;
    OpenStandardStreams();
    WatchForSignals();
    limn::engine::MeshFiles files;
    Command command({argv + 1, argv + argc}, files, GetStopStatus);
    int status = 0;
    if (RunInterruptibly([&] { status = command.Run(); })) return status;
    command.GiveUp(GetStopStatus());
    std::_Exit(GetStopStatus());
}
