// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace limn::engine {

/// Thrown where work stops because its host asked for it. Not an Error: nothing was wrong.
struct Stopped {};

/// How far the present phase of a job is.
struct Progress {
    std::string phase;           ///< what is done, e.g. "baking spot"
    size_t done = 0, total = 0;  ///< steps
    bool isFinished = false;     ///< told once, as the last of a phase, with done == total
};

/// What the host of a job hears and says; each may be empty. Hearing happens on whichever thread
/// of the work has something to tell, one call at a time; it must not call the job. What a callback
/// throws ends the work and comes unchanged out of the function that was given the job.
struct JobHost {
    /// Of each phase whose steps are counted the start (done == 0) and the end, and at most 20
    /// times a second between.
    std::function<void(Progress const&)> onProgress{};
    std::function<void(std::string const&)> onWarning{};
    /// Each phase as it starts, with counted steps or without, e.g. "factorising"; the one before
    /// has ended then.
    std::function<void(std::string const&)> onPhase{};
    /// What only those want to know who watch closely: tiles, files.
    std::function<void(std::string const&)> onNote{};
    /// Asked often and from many threads at once: a look at an atomic flag.
    std::function<bool()> isStopped{};
};

/// One piece of work and its host: progress, warnings, and the wish to stop. Nothing is shared
/// between jobs. One without a host is silent and never stops. Safe to use from many threads. Of
/// one that is used for one call after the other, warnings add up.
class Job {
public:
    Job() = default;
    explicit Job(JobHost host) : _host(std::move(host)) {}

    /// Starts a phase of `total` steps. One phase at a time.
    void Start(std::string phase, size_t total);
    /// Starts a phase whose steps nobody counts; it ends where the next one starts.
    void Start(std::string const& phase);
    void Advance(size_t steps = 1);
    void Finish();

    void Note(std::string const& message);

    /// Told to the host at once and kept for the report, as one line.
    void Warn(std::string const& text);
    std::vector<std::string> GetWarnings() const;

    /// \throws Stopped  once the host has asked for it
    void CheckStopped() const {
        if (_host.isStopped && _host.isStopped()) throw Stopped{};
    }

private:
    using Clock = std::chrono::steady_clock;

    void Tell(size_t done, bool isFinished);

    JobHost const _host;

    /// Held while the host hears, so that it hears one thing at a time.
    std::mutex _hostMutex;
    std::string _phase;
    size_t _total = 0;
    std::atomic<size_t> _done{0};
    std::atomic<Clock::rep> _nextTold{0};  ///< when Advance tells again

    /// Apart from the host's: GetWarnings never waits for a host that is hearing something.
    mutable std::mutex _warningsMutex;
    std::vector<std::string> _warnings;
};

}  // namespace limn::engine
