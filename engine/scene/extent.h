// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

namespace limn::engine {

// How far from the origin points lie, and what floats keep of them there: a float's step grows with
// the distance, a mesh does not.

/// The bounding box of points.
struct Extent {
    std::array<double, 3> low{}, high{};

    double GetDiagonal() const;
    /// The largest coordinate, in value or below zero.
    double GetFarthest() const;
};

/// \param positions  3 per point; of none, the box is the origin
Extent FindExtent(std::span<double const> positions);

/// How much farther than a box a mesh made from its own reaches, seen from the box's middle: 1
/// where it fills it. Of a box without size 1.
double FindGrowth(Extent const& before, Extent const& after);

/// What a result may outgrow its input by without a word.
inline constexpr double kMostGrown = 10.0;

/// The distance from a number to the next one, as a float or of half precision.
double GetFloatStep(double value);
double GetHalfStep(double value);

/// What coordinates may lose without a word, over the diagonal of the bounding box.
inline constexpr double kMostRounded = 1e-6;

/// How far floats are off at most: 2^-24 of the largest coordinate, or all of it where that is
/// beyond their range.
double FindFloatError(Extent const& extent);

/// Whether floats keep all coordinates to within `share` of the diagonal.
bool AreFloatsEnough(Extent const& extent, double share = kMostRounded);

/// The middle of the box, each coordinate rounded to a multiple of the largest power of two that
/// the diagonal reaches: a short number, without which positions are small, and which is subtracted
/// from far ones without loss.
std::array<double, 3> FindOrigin(Extent const& extent);

/// What positions are best taken relative to before they become floats: FindOrigin, or 0 where
/// floats are enough as they are.
std::array<double, 3> FindFloatOrigin(Extent const& extent);

/// Positions relative to an origin.
std::vector<double> Subtract(std::span<double const> positions,
                             std::array<double, 3> const& origin);

}  // namespace limn::engine
