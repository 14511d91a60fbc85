// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "far_ext/enum_words.h"
#include "far_ext/topology/control_mesh.h"

namespace limn::engine {

inline constexpr auto kSchemeWords =
    MakeEnumWords<Sdc::SchemeType>("scheme", {{Sdc::SCHEME_CATMARK, "catmark"},
                                              {Sdc::SCHEME_LOOP, "loop"},
                                              {Sdc::SCHEME_BILINEAR, "bilinear"}});

inline constexpr auto kBoundaryWords = MakeEnumWords<Sdc::Options::VtxBoundaryInterpolation>(
    "boundary", {{Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER, "edge-and-corner"},
                 {Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, "edge-only"},
                 {Sdc::Options::VTX_BOUNDARY_NONE, "none"}});

inline constexpr auto kFVarWords = MakeEnumWords<Sdc::Options::FVarLinearInterpolation>(
    "fvar", {{Sdc::Options::FVAR_LINEAR_NONE, "none"},
             {Sdc::Options::FVAR_LINEAR_CORNERS_ONLY, "corners-only"},
             {Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1, "corners-plus1"},
             {Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2, "corners-plus2"},
             {Sdc::Options::FVAR_LINEAR_BOUNDARIES, "boundaries"},
             {Sdc::Options::FVAR_LINEAR_ALL, "all"}});

inline constexpr auto kCreaseWords = MakeEnumWords<Sdc::Options::CreasingMethod>(
    "creases",
    {{Sdc::Options::CREASE_UNIFORM, "uniform"}, {Sdc::Options::CREASE_CHAIKIN, "chaikin"}});

inline constexpr auto kTriangleWords = MakeEnumWords<Sdc::Options::TriangleSubdivision>(
    "triangles",
    {{Sdc::Options::TRI_SUB_CATMARK, "catmark"}, {Sdc::Options::TRI_SUB_SMOOTH, "smooth"}});

inline constexpr auto kOrientationWords = MakeEnumWords<Orientation>(
    "orientation", {{Orientation::Right, "right"}, {Orientation::Left, "left"}});

/// "scheme=catmark boundary=edge-and-corner fvar=corners-plus1 creases=uniform triangles=catmark"
std::string DescribeSubdivision(far_ext::ControlMesh const& cage);

}  // namespace limn::engine
