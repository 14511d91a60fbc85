// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "engine/scene/scene.h"

namespace limn::test {

/// The meshes on which the laws of subdivided forms are checked: closed, open, all boundary fans,
/// valence 2 to 12, n-gons, creases of any sharpness, several components, genus 0 to 2; each with
/// its name.
std::vector<std::pair<std::string, engine::Scene>> MakeFormMeshes();

/// A boundary fan: vertex 0 with `count` triangles (Loop) or quads, not closed.
engine::Scene MakeOpenFan(int count, Sdc::SchemeType scheme);

/// The tetrahedron of the reference rows.
engine::Scene MakeTetrahedron();

/// A flat n x m grid of triangles (Loop) or quads whose diagonals all run the same way, with
/// integer coordinates.
engine::Scene MakeLattice(int n, int m, Sdc::SchemeType scheme);

/// A dodecahedron of pentagons.
engine::Scene MakeDodecahedron();

/// d0 of a coordinate: from the lower to the higher end of each edge.
std::vector<double> MakeCoordinateForm(Far::TopologyLevel const& level,
                                       std::vector<double> const& positions, size_t axis);

}  // namespace limn::test
