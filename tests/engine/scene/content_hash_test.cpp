// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/content_hash.h"

#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "support/meshes.h"

namespace limn {
namespace {

using engine::Scene;

/// A mesh with something in every array.
Scene MakeFullTorus() {
    Scene scene = test::MakeTorus(6, 4);
    auto const numVertices = static_cast<size_t>(scene.cage.numVertices);
    auto const numFaces = scene.cage.faceSizes.size();
    scene.cage.creaseVertexPairs = {0, 1};
    scene.cage.creaseSharpness = {2.0f};
    scene.cage.cornerVertices = {3};
    scene.cage.cornerSharpness = {1.0f};
    scene.cage.holes = {5};
    scene.lacksUVs.assign(numFaces, 0);
    scene.groups[0] = {{"skin"}, std::vector<Index>(numFaces, 0)};
    scene.primvars = {{"mass", 1, std::vector<float>(numVertices, 2.0f)}};
    return scene;
}

std::string Hash(Scene const& scene) {
    return engine::HashContent(scene, scene.positions);
}

TEST(ContentHash, ChangesWithAllThatAMapMayDependOn) {
    std::vector<std::function<void(Scene&)>> const changes{
        [](Scene&) {},
        [](Scene& s) { s.positions[7] += 1e-12; },
        [](Scene& s) { s.uvs[3] += 1e-12; },
        [](Scene& s) { std::swap(s.cage.faceVertices[0], s.cage.faceVertices[1]); },
        [](Scene& s) { s.cage.creaseVertexPairs = {1, 2}; },
        [](Scene& s) { s.cage.creaseSharpness = {3.0f}; },
        [](Scene& s) { s.cage.cornerVertices = {4}; },
        [](Scene& s) { s.cage.cornerSharpness = {3.0f}; },
        [](Scene& s) { s.cage.holes = {6}; },
        [](Scene& s) { s.cage.fvarChannels[0].valueIndices[0] = 1; },
        [](Scene& s) { s.cage.scheme = Sdc::SCHEME_BILINEAR; },
        [](Scene& s) { s.cage.options.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN); },
        [](Scene& s) { s.lacksUVs[0] = 1; },
        [](Scene& s) { s.groups[0].names = {"cloth"}; },
        [](Scene& s) { s.groups[0].faceGroup[0] = -1; },
        [](Scene& s) { std::swap(s.groups[0], s.groups[1]); },
        [](Scene& s) { s.primvars[0].name = "weight"; },
        [](Scene& s) { s.primvars[0].values[0] = 3.0f; },
        [](Scene& s) { s.primvars.clear(); }};
    std::set<std::string> hashes;
    for (auto const& change : changes) {
        Scene scene = MakeFullTorus();
        change(scene);
        hashes.insert(Hash(scene));
    }
    EXPECT_EQ(hashes.size(), changes.size());
}

TEST(ContentHash, DoesNotChangeWithNamesAndPlaces) {
    Scene other = MakeFullTorus();
    other.name = "other";
    other.path = "other.obj";
    other.faceLines.assign(other.cage.faceSizes.size(), 7);
    EXPECT_EQ(Hash(other), Hash(MakeFullTorus()));
}

TEST(ContentHash, OfNumbersIsOfTheirValues) {
    EXPECT_EQ(engine::HashNumbers({1.0, 2.0}), engine::HashNumbers({1.0, 2.0}));
    EXPECT_NE(engine::HashNumbers({1.0, 2.0}), engine::HashNumbers({2.0, 1.0}));
}

}  // namespace
}  // namespace limn
