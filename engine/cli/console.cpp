// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/console.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "engine/cli/option_names.h"
#include "engine/io/file.h"

namespace limn::cli {

using engine::Progress;

void Say(std::string_view text) {
    // Not by stdio, whose lock a thread that waits for a full pipe would hold.
    while (!text.empty()) {
        ssize_t const count = ::write(STDERR_FILENO, text.data(), text.size());
        if (count < 0 && errno != EINTR) return;
        text.remove_prefix(static_cast<size_t>(std::max<ssize_t>(count, 0)));
    }
}

void SayWithoutWaiting(std::string_view text) {
    pollfd stream{STDERR_FILENO, POLLOUT, 0};
    if (::poll(&stream, 1, 0) == 1) Say(text);
}

void PrintData(std::string const& text) {
    bool const isWritten =
        std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!isWritten) engine::ThrowIoError("stdout", "cannot be written");
}

engine::JobHost Console::MakeHost(std::function<bool()> isStopped) {
    engine::JobHost host{.isStopped = std::move(isStopped)};
    if (_style != Style::None) {
        host.onProgress = [this](Progress const& progress) { OnProgress(progress); };
    }
    if (!_isQuiet) host.onWarning = [this](std::string const& message) { OnWarning(message); };
    return host;
}

void Console::OnProgress(Progress const& progress) {
    auto const now = Clock::now();
    if (progress.isFinished) {
        bool const isShort = now - _start < std::chrono::milliseconds(500);
        if (_isLineOpen || !isShort) Show(progress);
        return;
    }
    if (progress.done == 0) {
        _start = _lastShown = now;
        return;
    }
    auto const pause =
        _style == Style::Bar ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
    if (now - _lastShown < pause) return;
    _lastShown = now;
    Show(progress);
}

void Console::Show(Progress const& progress) {
    double const share = progress.total ? std::min(1.0, static_cast<double>(progress.done) /
                                                            static_cast<double>(progress.total))
                                        : 1.0;
    std::chrono::duration<double> const elapsed = Clock::now() - _start;
    std::string const time =
        progress.isFinished ? fmt::format("{:.1f} s", elapsed.count())
        : share > 0.0       ? fmt::format("{:.0f} s left", elapsed.count() * (1 - share) / share)
                            : std::string("starting");
    if (_style == Style::Lines) {
        Say(fmt::format("limn: {}: {:.0f} %, {}\n", progress.phase, 100 * share, time));
        return;
    }
    int const filled = static_cast<int>(share * 30);
    Say(fmt::format("\r{} [{:=<{}}{: <{}}] {:3.0f} %  {}   {}", progress.phase, "", filled, "",
                    30 - filled, 100 * share, time, progress.isFinished ? "\n" : ""));
    _isLineOpen = !progress.isFinished;
}

void Console::OnWarning(std::string const& message) {
    Say(fmt::format("{}limn: warning: {}\n", _isLineOpen ? "\n" : "", NameFlags(message)));
    _isLineOpen = false;
}

}  // namespace limn::cli
