// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "engine/io/mesh_source.h"

namespace limn::cli {

class Context;
class Parser;
struct RunEnd;

/// Exit statuses that a caller may want to tell apart.
inline constexpr int kDone = 0, kInternal = 1, kUsage = 2, kNotReached = 4;

/// One command: `limn ARGUMENTS`. Data goes to stdout, all else to stderr. Nothing of it outlasts
/// Run or is shared with another command, unless it is given up.
class Command {
public:
    /// \param getStopStatus  asked often and from many threads at once: 0 to go on, else the exit
    ///                       status to stop with; may be empty
    Command(std::vector<std::string> arguments, engine::MeshSource& meshes,
            std::function<int()> getStopStatus = {});
    Command(Command const&) = delete;
    Command& operator=(Command const&) = delete;

    /// Threads  the caller's and as many of TBB's as the options ask for.
    /// \return  the exit status; nothing half-written is left
    int Run();

    /// From another thread, while Run is at something that cannot stop by itself: removes what is
    /// half-written, writes the report and says that the run was interrupted. Run may then never
    /// come back: the process has to end (std::_Exit).
    void GiveUp(int status);

private:
    RunEnd ParseAndRun();
    RunEnd RunVerb(Parser const& parser);
    void SetContext(Context* context);

    std::vector<std::string> const _arguments;
    engine::MeshSource& _meshes;
    std::function<int()> const _getStopStatus;
    std::mutex _contextMutex;
    Context* _context = nullptr;  ///< while the verb runs
    std::atomic_flag _isTold;     ///< that the run ended in an error
};

/// Runs one command and returns its exit status.
inline int RunCommand(std::vector<std::string> arguments, engine::MeshSource& meshes,
                      std::function<int()> getStopStatus = {}) {
    return Command(std::move(arguments), meshes, std::move(getStopStatus)).Run();
}

}  // namespace limn::cli
