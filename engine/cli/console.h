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

/// The terminal as a job's host: progress, warnings and, where wanted, phases with their seconds on
/// stderr, as they come.
class Console {
public:
    enum class Style { None, Lines, Bar };
    enum class Detail { Quiet, Usual, Verbose };

    /// \param style  nothing for what suits stderr; a bar where there is no terminal, or one of
    ///               less than kLeastColumns, is told in lines
    Console(std::optional<Style> style, Detail detail);
    ~Console();
    Console(Console const&) = delete;
    Console& operator=(Console const&) = delete;

    /// Hears for one job, which must not outlive it.
    engine::JobHost MakeHost(std::function<bool()> isStopped);

private:
    using Clock = std::chrono::steady_clock;

    void OnProgress(engine::Progress const& progress);
    void OnPhase(std::string const& phase);
    void EndPhase();
    void Show(engine::Progress const& progress);
    void ShowBar(engine::Progress const& progress, double share, std::string const& time);
    void PrintLine(std::string const& text);

    Style _style;
    Detail _detail;
    Clock::time_point const _runStart = Clock::now();
    Clock::time_point _start, _lastShown;
    std::string _phase;  ///< the present one, in detail
    Clock::time_point _phaseStart;
    int _barColumns = 0;  ///< of the line that a bar is on; 0 where it is on none
};

/// Nothing is the style that suits what stderr is.
inline constexpr auto kProgressWords =
    MakeEnumWords<std::optional<Console::Style>>("progress", {{std::nullopt, "auto"},
                                                              {Console::Style::Bar, "bar"},
                                                              {Console::Style::Lines, "lines"},
                                                              {Console::Style::None, "none"}});

}  // namespace limn::cli
