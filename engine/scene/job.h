// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace limn::engine {

/// Thrown where work stops because a signal asked for it. Not an Error: nothing was wrong.
struct Interrupted {
    int signal;
};

/// Makes SIGINT and SIGTERM stop the work at its next CheckInterrupted. A second signal ends the
/// process at once.
void InstallSignalHandlers();

/// \throws Interrupted  once a signal has come
void CheckInterrupted();

/// What a running job tells its user: progress and warnings. Safe to use from many threads.
class Job {
public:
    enum class Progress { None, Lines, Bar };

    Job() = default;
    Job(Progress progress, bool isQuiet) : _progress(progress), _isQuiet(isQuiet) {}

    /// Starts a phase of `total` steps; the line on the terminal shows `what`, its share and the
    /// time left.
    void Start(std::string what, size_t total);
    void Advance(size_t steps = 1);
    void Finish();

    /// Shown at once on stderr (unless quiet) and kept for the report.
    void Warn(std::string const& message);
    std::vector<std::string> GetWarnings() const;

private:
    void Show(size_t done, bool isLast);

    Progress _progress = Progress::None;
    bool _isQuiet = true;
    std::string _what;
    size_t _total = 0;
    std::atomic<size_t> _done{0};
    std::chrono::steady_clock::time_point _start, _lastShown;
    mutable std::mutex _mutex;
    std::vector<std::string> _warnings;
    bool _isLineOpen = false;
};

}  // namespace limn::engine
