// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/images/exr_writer.h"
#include "far_ext/topology/control_mesh.h"

namespace limn::engine {

/// Names of options as the command line spells them; Parse... throw Error BadOption and list what
/// there is.
char const* GetName(Sdc::SchemeType scheme);
char const* GetName(Sdc::Options::VtxBoundaryInterpolation rule);
char const* GetName(Sdc::Options::FVarLinearInterpolation rule);
char const* GetName(Sdc::Options::CreasingMethod method);
char const* GetName(Sdc::Options::TriangleSubdivision rule);
char const* GetName(ExrCompression compression);

Sdc::SchemeType ParseScheme(std::string const& name);
Sdc::Options::VtxBoundaryInterpolation ParseBoundary(std::string const& name);
Sdc::Options::FVarLinearInterpolation ParseFVar(std::string const& name);
Sdc::Options::CreasingMethod ParseCreases(std::string const& name);
Sdc::Options::TriangleSubdivision ParseTriangles(std::string const& name);
ExrCompression ParseCompression(std::string const& name);

/// "scheme=catmark boundary=edge-and-corner fvar=corners-plus1 creases=uniform triangles=catmark"
std::string DescribeSubdivision(far_ext::ControlMesh const& cage);

}  // namespace limn::engine
