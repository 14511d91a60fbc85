// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "eval/streamlines/stream_tracer.h"

namespace limn::eval {

/// A line along a field. A closed one ends at its first point, which is not repeated.
struct Streamline {
    std::vector<StreamPoint> points;  ///< in the field's direction; lengths from the first on
    double length = 0.0;              ///< of a closed line: all round
    bool isClosed = false;
    std::vector<StreamEnd> ends;  ///< of the line's last point and, if it has run both ways, first
};

/// How lines run.
struct StreamlineOptions {
    double step = 0.0;  ///< of the walk, in units of length
    double maxLength = std::numeric_limits<double>::infinity();  ///< of a line
    bool isForwardOnly = false;       ///< from its seed with the field; else to both sides of it
    double leastSpeed = 0.0;          ///< a field that is not faster counts as none
    std::function<void()> onSteps{};  ///< called now and then; may throw to end the work
};

/// What a line keeps away from.
struct Apartness {
    double separation = 0.0;  ///< 0: from nothing
    /// It ends nearer than this to itself, but for its last 2 `separation`s.
    double nearest = 0.0;
    /// Whether a point is too near to other lines, which ends this one.
    std::function<bool(Eigen::Vector3d const& point)> isNear{};
};

/// The line through a place, both halves up to half of the longest length, or forward only.
///
/// Closed   within 3/4 of a step of its start again, after 4 steps at least, and running the same
///          way there.
Streamline TraceStreamline(StreamTracer& tracer, SurfacePlace const& seed,
                           StreamlineOptions const& options, Apartness const& apartness = {});

/// A line through each seed, on many threads. Nothing keeps them apart.
///
/// \param onLine   called after each; may throw to end the work
std::vector<Streamline> TraceStreamlines(FlowSurface const& flow,
                                         std::span<SurfacePlace const> seeds,
                                         StreamlineOptions const& options,
                                         std::function<void()> const& onLine = {});

}  // namespace limn::eval
