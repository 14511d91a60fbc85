// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace limn::cli {

/// Below this a bar says too little: progress is told in lines.
inline constexpr int kLeastColumns = 20;

/// Columns of the terminal that stderr is: those it has and, where the user says so by COLUMNS, no
/// more than that. Nothing where stderr is no terminal, or one that cannot go back in a line.
std::optional<int> FindColumns();

/// "1.2 s", "90 s", "25 min", "3.0 h"
std::string FormatSeconds(double seconds);

/// A line of progress that is narrower than the terminal, so that it never wraps: phase, bar,
/// percentage and time, of which the bar goes first where there is no room, then the phase's end.
///
/// \param phase  anything: what a terminal would obey is shown as `?`
/// \param share  0 to 1
std::string FormatBar(std::string_view phase, double share, std::string_view time, int columns);

}  // namespace limn::cli
