// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/smooth/smooth.h"
#include "far_ext/cascade/cascade_level.h"

namespace limn::engine {

// Between a scene and a cascade of it, which counts lengths in another unit and from another
// origin, and has values on every level.

std::vector<double> Times(double factor, std::vector<double> values);

/// A length of the scene's size, so that the fourth powers of all others fit a float; a power of
/// two, which costs no digit.
double FindUnit(std::span<double const> positions);

/// Positions as the cascade takes them, which may be in float.
std::vector<double> ToCascade(std::vector<double> const& positions,
                              std::array<double, 3> const& origin, double unit);

/// Values of the coarser mesh' vertices, each finer one taking its first parent's.
std::vector<int> Inherit(far_ext::CascadeMesh const& mesh, std::vector<int> const& coarse);

/// Positions of the coarser mesh, interpolated linearly as the cascade does.
std::vector<double> Interpolate(far_ext::CascadeMesh const& mesh,
                                std::vector<double> const& coarse);

/// What a filter that keeps features is given, in a cascade's unit; none for others.
std::optional<eval::KeptFeatures> ScaleFeatures(Model const& model, SmoothOptions const& options,
                                                double unit);

/// The longest way that a point goes from one place to the other.
double FindLargestMove(std::span<double const> from, std::span<double const> to);

}  // namespace limn::engine
