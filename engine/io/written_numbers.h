// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "engine/scene/extent.h"
#include "engine/scene/job.h"
#include "far_ext/types.h"

namespace limn::engine {

// What is said of a mesh that is written holds for its file, not for the doubles it came from:
// choose the precision, round the coordinates, measure those, and write them.

/// A mesh file to be.
struct MeshTarget {
    std::string path;  ///< .obj or .ply
    /// None: float, or double where floats would lose more than is right.
    std::optional<Precision> precision{};
};

/// The precision of a file whose coordinates may lose `share` of the diagonal.
Precision FindPrecision(MeshTarget const& target, Extent const& extent,
                        double share = kMostRounded);

/// Warns where that is double without having been asked for, or float and loses more.
void WarnOfPrecision(MeshTarget const& target, Extent const& extent, Job& job,
                     double share = kMostRounded);

/// Both.
Precision ChoosePrecision(MeshTarget const& target, Extent const& extent, Job& job,
                          double share = kMostRounded);

/// Rounds coordinates to the numbers that a reader of the file finds: in text, the decimal ones.
void RoundAsWritten(std::string const& path, Precision precision, std::span<double> positions);

}  // namespace limn::engine
