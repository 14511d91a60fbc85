// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/job.h"

#include <utility>

#include "far_ext/error.h"

namespace limn::engine {

namespace {

constexpr std::chrono::milliseconds kPause(50);

}  // namespace

void Job::Start(std::string phase, size_t total) {
    std::lock_guard const lock(_hostMutex);
    if (_host.onPhase) _host.onPhase(phase);
    _phase = std::move(phase);
    _total = total;
    _done = 0;
    _nextTold = (Clock::now() + kPause).time_since_epoch().count();
    Tell(0, false);
}

void Job::Start(std::string const& phase) {
    std::lock_guard const lock(_hostMutex);
    if (_host.onPhase) _host.onPhase(phase);
}

void Job::Advance(size_t steps) {
    _done += steps;
    if (!_host.onProgress) return;
    auto const now = Clock::now();
    auto due = _nextTold.load();
    if (now.time_since_epoch().count() < due) return;
    // Of the threads that see it is time, the one that moves the clock tells.
    if (!_nextTold.compare_exchange_strong(due, (now + kPause).time_since_epoch().count())) return;
    std::lock_guard const lock(_hostMutex);
    Tell(_done, false);
}

void Job::Finish() {
    std::lock_guard const lock(_hostMutex);
    Tell(_total, true);
}

void Job::Tell(size_t done, bool isFinished) {
    if (_host.onProgress) _host.onProgress({_phase, done, _total, isFinished});
}

void Job::Note(std::string const& message) {
    std::lock_guard const lock(_hostMutex);
    if (_host.onNote) _host.onNote(message);
}

void Job::Warn(std::string const& text) {
    std::string const message = MakeOneLine(text);
    std::lock_guard const hearing(_hostMutex);  // first, so that it hears in the report's order
    {
        std::lock_guard const lock(_warningsMutex);
        _warnings.push_back(message);
    }
    if (_host.onWarning) _host.onWarning(message);
}

std::vector<std::string> Job::GetWarnings() const {
    std::lock_guard const lock(_warningsMutex);
    return _warnings;
}

}  // namespace limn::engine
