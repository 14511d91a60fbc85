// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace limn::test {

/// A mesh file of tests/data, by its path there.
engine::Scene LoadData(std::string const& path);

/// The points of a reference of tests/data, whose files have no faces.
std::vector<double> LoadPoints(std::string const& path);

/// A cage of tests/data/opensubdiv_shapes, under the scheme that its name begins with.
engine::Scene LoadShape(std::string const& name);

/// A mesh of tests/data/assets, by its path there; with LIMN_ASSETS, one of the larger ones, too.
engine::Scene LoadAsset(std::string const& path);
std::string AssetPath(std::string const& path);
bool HasAsset(std::string const& path);

/// The Catmull-Clark cage of a cow, from the scenes.
engine::Scene LoadSpot();

/// Path of a file in tests/data, and in scenes.
std::string DataPath(std::string const& path);
std::string ScenePath(std::string const& path);

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

/// What each corner has of a list with `length` numbers per vertex.
template <class T>
std::vector<T> AtCorners(engine::Scene const& scene, std::vector<T> const& values, size_t length) {
    std::vector<T> atCorners;
    for (Index vertex : scene.cage.faceVertices) {
        for (size_t c = 0; c < length; ++c) atCorners.push_back(values[vertex * length + c]);
    }
    return atCorners;
}

/// Names of all OBJ files of a folder of tests/data, sorted.
std::vector<std::string> ListData(std::string const& folder);

/// The names of all cages that LoadShape takes, sorted.
std::vector<std::string> ListShapes();

/// A file's name as the name of a test's instance: letters, digits and _, without the ending.
std::string NameInstance(std::string const& path);

}  // namespace limn::test
