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
#include "engine/cli/terminal/progress_bar.h"
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

namespace {

double GetSeconds(std::chrono::steady_clock::duration duration) {
    return std::chrono::duration<double>(duration).count();
}

Console::Style ChooseStyle(std::optional<Console::Style> wanted) {
    if (wanted.value_or(Console::Style::Bar) != Console::Style::Bar) return *wanted;
    return FindColumns().value_or(0) < kLeastColumns ? Console::Style::Lines : Console::Style::Bar;
}

}  // namespace

Console::Console(std::optional<Style> style, Detail detail)
    : _style(detail == Detail::Quiet ? Style::None : ChooseStyle(style)), _detail(detail) {}

Console::~Console() {
    if (_detail != Detail::Verbose) return;
    EndPhase();
    PrintLine(fmt::format("limn: {:.3f} s in all", GetSeconds(Clock::now() - _runStart)));
}

engine::JobHost Console::MakeHost(std::function<bool()> isStopped) {
    engine::JobHost host{.isStopped = std::move(isStopped)};
    if (_style != Style::None) {
        host.onProgress = [this](Progress const& progress) { OnProgress(progress); };
    }
    if (_detail != Detail::Quiet) {
        host.onWarning = [this](std::string const& message) {
            PrintLine(fmt::format("limn: warning: {}", NameFlags(message)));
        };
    }
    if (_detail == Detail::Verbose) {
        host.onPhase = [this](std::string const& phase) { OnPhase(phase); };
        host.onNote = [this](std::string const& message) {
            PrintLine(fmt::format("limn: {}", message));
        };
    }
    return host;
}

void Console::OnProgress(Progress const& progress) {
    auto const now = Clock::now();
    if (progress.isFinished) {
        if (_detail == Detail::Verbose) return;  // the end of the phase is told
        bool const isShort = now - _start < std::chrono::milliseconds(500);
        if (_barColumns > 0 || !isShort) Show(progress);
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
    double const elapsed = GetSeconds(Clock::now() - _start);
    std::string const time = progress.isFinished ? FormatSeconds(elapsed)
                             : share > 0.0 ? FormatSeconds(elapsed * (1 - share) / share) + " left"
                                           : std::string("starting");
    if (_style == Style::Bar)
        ShowBar(progress, share, time);
    else
        PrintLine(fmt::format("limn: {}: {:.0f} %, {}", progress.phase, 100 * share, time));
}

void Console::ShowBar(Progress const& progress, double share, std::string const& time) {
    int const columns = FindColumns().value_or(_barColumns);  // a terminal may change its size
    std::string const bar = FormatBar(progress.phase, share, time, columns);
    Say(fmt::format("\r{: <{}}{}", bar, columns - 1, progress.isFinished ? "\n" : ""));
    _barColumns = progress.isFinished ? 0 : columns;
}

void Console::OnPhase(std::string const& phase) {
    EndPhase();
    _phase = phase;
    _phaseStart = Clock::now();
}

void Console::EndPhase() {
    if (_phase.empty()) return;
    PrintLine(fmt::format("limn: {}: {:.3f} s", std::exchange(_phase, {}),
                          GetSeconds(Clock::now() - _phaseStart)));
}

/// In the place of a bar, which comes again below it.
void Console::PrintLine(std::string const& text) {
    if (_barColumns > 0) Say(fmt::format("\r{: <{}}\r", "", _barColumns - 1));
    _barColumns = 0;
    Say(text + "\n");
}

}  // namespace limn::cli
