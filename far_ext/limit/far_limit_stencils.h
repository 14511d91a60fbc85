// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "far_ext/enum_words.h"
#include "far_ext/stencils/stencil_rows.h"
#include "far_ext/topology/control_mesh.h"

namespace limn::far_ext {

/// What OpenSubdiv puts where isolation ends round an extraordinary vertex.
enum class EndCap { Gregory, BSpline };

inline constexpr auto kEndCapWords =
    MakeEnumWords<EndCap>("endCap", {{EndCap::Gregory, "gregory"}, {EndCap::BSpline, "bspline"}});

/// How OpenSubdiv approximates the limit; the defaults are its own but for the level.
struct FarLimitOptions {
    static constexpr int kMaxLevel = 10;

    int level = 6;  ///< of isolation, 1 to kMaxLevel
    EndCap endCap = EndCap::Gregory;
    bool hasInfSharpPatches = false;  ///< exact patches along infinitely sharp creases
};

/// (s,t) on a face of OpenSubdiv's numbering, in which a polygon has as many as it has corners
/// (Far::PtexIndices).
struct PtexPlace {
    Index face = 0;
    double s = 0.0, t = 0.0;
};

/// OpenSubdiv's limit stencils: what its users get, an approximation near extraordinary vertices.
struct FarLimitStencils {
    StencilRows rows;             ///< positions, first and second derivatives by s and t, in float
    std::vector<int> rowOfPlace;  ///< -1 where OpenSubdiv has no patch, as in a hole
};

/// Makes them by Far::LimitStencilTableFactory over a patch table that isolates up to the level.
///
/// \throws Error  BadOption: the level; BadMesh where OpenSubdiv refuses the topology
FarLimitStencils BuildFarLimitStencils(ControlMesh const& cage, std::span<PtexPlace const> places,
                                       FarLimitOptions const& options);

}  // namespace limn::far_ext
