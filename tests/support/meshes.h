// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/scene/scene.h"

namespace limn::test {

/// A mesh file of tests/data, by its path there.
engine::Scene LoadData(std::string const& path);

/// The points of a golden result, whose files have no faces.
Eigen::MatrixXd LoadGoldenPoints(std::string const& path);

/// A mesh file of the larger assets; the caller skips its test where HasAsset is false.
bool HasAsset(std::string const& path);
engine::Scene LoadAsset(std::string const& path);

/// Path of a file in tests/data or among the assets.
std::string DataPath(std::string const& path);
std::string AssetPath(std::string const& path);

/// A scene from arrays: `faces` lists each face's vertices.
engine::Scene MakeScene(std::vector<double> positions, std::vector<std::vector<Index>> const& faces,
                        Sdc::SchemeType scheme = Sdc::SCHEME_CATMARK);

/// A vertex of the given valence among quads (Loop: triangles), three rings wide, at height
/// a (x^2 + y^2) + b (x^2 - y^2): a smooth cup or saddle with one extraordinary vertex (vertex 0).
engine::Scene MakeFan(int valence, Sdc::SchemeType scheme, double a, double b);

/// A quad torus with wavy tube, n x m faces, with its natural UVs.
engine::Scene MakeTorus(int n, int m);

/// A torus of triangles.
engine::Scene MakeTriangleTorus(int n, int m);

engine::Scene MakeCube();

/// Names of all OBJ files of a folder of tests/data, sorted.
std::vector<std::string> ListData(std::string const& folder);

}  // namespace limn::test
