// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/job.h"

#include <algorithm>
#include <csignal>
#include <cstdio>

#include <fmt/format.h>

namespace limn::engine {

namespace {

std::atomic<int> signalCaught{0};

void OnSignal(int signal) {
    if (signalCaught.exchange(signal) != 0) std::_Exit(128 + signal);
}

}  // namespace

void InstallSignalHandlers() {
    std::signal(SIGINT, OnSignal);
    std::signal(SIGTERM, OnSignal);
    std::signal(SIGPIPE, SIG_IGN);
}

void CheckInterrupted() {
    int const signal = signalCaught.load(std::memory_order_relaxed);
    if (signal != 0) throw Interrupted{signal};
}

void Job::Start(std::string what, size_t total) {
    std::lock_guard const lock(_mutex);
    _what = std::move(what);
    _total = total;
    _done = 0;
    _start = _lastShown = std::chrono::steady_clock::now();
}

void Job::Advance(size_t steps) {
    size_t const done = _done += steps;
    if (_progress == Progress::None) return;
    std::lock_guard const lock(_mutex);
    auto const now = std::chrono::steady_clock::now();
    auto const pause = _progress == Progress::Bar ? std::chrono::milliseconds(100)
                                                  : std::chrono::milliseconds(5000);
    if (now - _lastShown < pause) return;
    _lastShown = now;
    Show(done, false);
}

void Job::Finish() {
    if (_progress == Progress::None) return;
    std::lock_guard const lock(_mutex);
    bool const isShort = std::chrono::steady_clock::now() - _start < std::chrono::milliseconds(500);
    if (_isLineOpen || !isShort) Show(_total, true);
}

void Job::Show(size_t done, bool isLast) {
    double const share =
        _total ? std::min(1.0, static_cast<double>(done) / static_cast<double>(_total)) : 1.0;
    std::chrono::duration<double> const elapsed = std::chrono::steady_clock::now() - _start;
    std::string const time =
        isLast        ? fmt::format("{:.1f} s", elapsed.count())
        : share > 0.0 ? fmt::format("{:.0f} s left", elapsed.count() * (1 - share) / share)
                      : std::string("starting");
    if (_progress == Progress::Lines) {
        fmt::print(stderr, "limn: {}: {:.0f} %, {}\n", _what, 100 * share, time);
        return;
    }
    int const filled = static_cast<int>(share * 30);
    fmt::print(stderr, "\r{} [{:=<{}}{: <{}}] {:3.0f} %  {}   ", _what, "", filled, "", 30 - filled,
               100 * share, time);
    _isLineOpen = !isLast;
    if (isLast) fmt::print(stderr, "\n");
    std::fflush(stderr);
}

void Job::Warn(std::string const& message) {
    std::lock_guard const lock(_mutex);
    _warnings.push_back(message);
    if (_isQuiet) return;
    if (_isLineOpen) fmt::print(stderr, "\n");
    _isLineOpen = false;
    fmt::print(stderr, "limn: warning: {}\n", message);
}

std::vector<std::string> Job::GetWarnings() const {
    std::lock_guard const lock(_mutex);
    return _warnings;
}

}  // namespace limn::engine
