// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "eval/streamlines/streamline.h"

namespace limn::eval {

/// Lines that keep apart.
struct EvenLines {
    std::vector<Streamline> lines;
    /// How far from the lines the surface reaches, up to twice the separation; none without lines.
    std::optional<double> farthest;
};

struct EvenOptions {
    StreamlineOptions line;
    double separation = 0.0;    ///< D; positive
    double stopDistance = 0.5;  ///< of D: a line ends nearer to another one
};

/// Fills a surface with lines about D apart: the first through the vertex of the fastest field,
/// then from places D to the left and right of lines already there, every D along them, that are
/// farther than 0.95 D from all; where no such place is left, from the place that is farthest from
/// all lines, if that is more than D. Lines shorter than D are left out.
///
/// Far     places that are looked at lie D/2 apart and less, vertices among them. Distances are
///         those of space, to points of lines.
/// Threads one line after the other: the result is one and the same
/// \throws Error  TooLarge: D so small that there would be more than 2^24 places
/// Source  [Jobard97]; [Forms 12]
EvenLines FillEvenly(FlowSurface const& flow, EvenOptions const& options);

/// Lines through these seeds only, one after the other, that end near those before; a seed that is
/// too near already has none.
EvenLines TraceApart(FlowSurface const& flow, std::span<SurfacePlace const> seeds,
                     EvenOptions const& options);

}  // namespace limn::eval
