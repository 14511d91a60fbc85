// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "eval/cascade/cascade.h"

namespace limn::eval {

/// Mean distance of a component's vertices from their mean, per component.
std::vector<double> FindMeanRadii(std::span<double const> positions,
                                  std::span<int const> componentOfVertex, int numComponents);

/// Below this share of its start radius a closed component has no fixed point any more: a sphere's
/// smallest is a half.
inline constexpr double kLeastRadiusRatio = 0.5;

/// Filter widths of a cascade.
struct CascadeWidths {
    double constant = -1.0;          ///< of all vertices; negative: one of the following
    std::vector<double> atVertices;  ///< of the start mesh
    std::vector<std::vector<double>>
        atLevels;  ///< per level and vertex, used as they are; empty: interpolated and filtered
};

/// The largest factor on all widths, up to 1, with which the wanted components keep a fixed point:
/// on the last of the levels, the filter is repeated with new metrics until radii settle, or one
/// falls below kLeastRadiusRatio of its start. Found by halving, to 0.5 %.
///
/// \param componentOfVertex  per vertex of the last level
/// \param isWanted           per component
/// \param filter             order and features of the filter
/// \param check              called between steps; may throw
/// Source  [Diewald02] Sec. 6; [Cascade 7]
double FindCriticalFactor(std::span<far_ext::CascadeLevel const> levels,
                          std::span<double const> positions, CascadeWidths const& widths,
                          std::span<int const> componentOfVertex, std::span<char const> isWanted,
                          CascadeOptions const& filter, std::function<void()> const& check);

}  // namespace limn::eval
