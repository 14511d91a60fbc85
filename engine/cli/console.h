// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/job.h"
#include "far_ext/enum_words.h"

namespace limn::cli {

/// Writes to stderr, as far as it takes anything: that nobody hears is no error.
void Say(std::string_view text);

/// As Say, but says nothing where stderr is a full pipe, which another thread may be waiting for.
void SayWithoutWaiting(std::string_view text);

/// Writes data to stdout. \throws Error Io, e.g. on a full disk
void PrintData(std::string const& text);

/// The terminal as a job's host: progress and warnings on stderr, as they come.
class Console {
public:
    enum class Style { None, Lines, Bar };

    Console(Style style, bool isQuiet) : _style(style), _isQuiet(isQuiet) {}
    Console(Console const&) = delete;
    Console& operator=(Console const&) = delete;

    /// Hears for one job, which must not outlive it.
    engine::JobHost MakeHost(std::function<bool()> isStopped);

private:
    using Clock = std::chrono::steady_clock;

    void OnProgress(engine::Progress const& progress);
    void OnWarning(std::string const& message);
    void Show(engine::Progress const& progress);

    Style _style;
    bool _isQuiet;
    Clock::time_point _start, _lastShown;
    bool _isLineOpen = false;
};

/// Nothing is the style that suits what stderr is.
inline constexpr auto kProgressWords =
    MakeEnumWords<std::optional<Console::Style>>("progress", {{std::nullopt, "auto"},
                                                              {Console::Style::Bar, "bar"},
                                                              {Console::Style::Lines, "lines"},
                                                              {Console::Style::None, "none"}});

}  // namespace limn::cli
