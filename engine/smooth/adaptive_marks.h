// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "engine/smooth/widths.h"
#include "far_ext/cascade/cascade_level.h"

namespace limn::engine {

/// Which triangles lie too far from the surface they stand for.
struct AdaptiveMarks {
    std::vector<char> isMarked;  ///< per triangle
    double largest = 0.0;        ///< sagitta

    bool IsAny() const;
};

/// Marks the triangles whose sagitta is above a bound. Where the filter has no width, or next to
/// none, the mesh is exact.
///
/// \param positions  3 per vertex
/// \param sigmas     filter width per vertex
/// \param widths     that these are from: what is sampled anew on every level may lie between
///                   vertices without one
/// \param bound      of the sagitta, in the positions' unit
/// Source  [Cascade 13]
AdaptiveMarks MarkBentTriangles(far_ext::CascadeMesh const& mesh, std::span<double const> positions,
                                std::span<double const> sigmas, ScaledWidths const& widths,
                                double bound);

/// Vertices of a mesh of triangles after so many uniform quarterings.
double CountAfterQuarterings(far_ext::CascadeMesh const& mesh, int levels);

/// The shortest edge of a mesh of triangles; 0 without any.
double FindShortestEdge(far_ext::CascadeMesh const& mesh, std::span<double const> positions);

}  // namespace limn::engine
