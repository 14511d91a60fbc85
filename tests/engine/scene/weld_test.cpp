// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/weld.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "engine/scene/mesh_info.h"
#include "engine/scene/refine.h"
#include "support/errors.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::Scene;
using test::AtCorners;

/// The scene with a vertex for each value of `keys`, which belong to corners: what an exporter
/// writes that has one index for positions and texture coordinates, or none that is shared.
Scene Split(Scene const& scene, std::vector<Index> const& keys) {
    Scene split = scene;
    std::map<std::pair<Index, Index>, Index> vertexOf;
    split.positions.clear();
    for (auto& primvar : split.primvars) primvar.values.clear();
    std::vector<std::vector<Index>> copies(static_cast<size_t>(scene.cage.numVertices));
    for (size_t corner = 0; corner < scene.cage.faceVertices.size(); ++corner) {
        Index const old = scene.cage.faceVertices[corner];
        auto const [found, isNew] = vertexOf.try_emplace(
            std::pair(old, keys[corner]), static_cast<Index>(split.positions.size() / 3));
        split.cage.faceVertices[corner] = found->second;
        if (!isNew) continue;
        copies[old].push_back(found->second);
        for (size_t c = 0; c < 3; ++c) split.positions.push_back(scene.positions[3 * old + c]);
        for (size_t p = 0; p < split.primvars.size(); ++p) {
            size_t const n = static_cast<size_t>(scene.primvars[p].numChannels);
            for (size_t c = 0; c < n; ++c)
                split.primvars[p].values.push_back(scene.primvars[p].values[old * n + c]);
        }
    }
    split.cage.numVertices = static_cast<Index>(split.positions.size() / 3);
    auto& cage = split.cage;
    cage.creaseVertexPairs.clear();
    cage.creaseSharpness.clear();
    for (size_t i = 0; i < scene.cage.creaseSharpness.size(); ++i) {
        for (Index a : copies[scene.cage.creaseVertexPairs[2 * i]]) {
            for (Index b : copies[scene.cage.creaseVertexPairs[2 * i + 1]]) {
                cage.creaseVertexPairs.insert(cage.creaseVertexPairs.end(), {a, b});
                cage.creaseSharpness.push_back(scene.cage.creaseSharpness[i]);
            }
        }
    }
    cage.cornerVertices.clear();
    cage.cornerSharpness.clear();
    for (size_t i = 0; i < scene.cage.cornerSharpness.size(); ++i) {
        for (Index copy : copies[scene.cage.cornerVertices[i]]) {
            cage.cornerVertices.push_back(copy);
            cage.cornerSharpness.push_back(scene.cage.cornerSharpness[i]);
        }
    }
    return split;
}

/// Every face by itself, with texture coordinates of its own.
Scene SplitFaces(Scene const& scene) {
    std::vector<Index> faceOfCorner;
    for (Index face = 0; face < scene.cage.GetNumFaces(); ++face)
        faceOfCorner.insert(faceOfCorner.end(), static_cast<size_t>(scene.cage.faceSizes[face]),
                            face);
    Scene split = Split(scene, faceOfCorner);
    if (!scene.HasUVs()) return split;
    far_ext::FVarChannel& channel = split.cage.fvarChannels[0];
    std::vector<double> uvs;
    for (Index& value : channel.valueIndices) {
        uvs.insert(uvs.end(), {scene.uvs[2 * value], scene.uvs[2 * value + 1]});
        value = static_cast<Index>(uvs.size() / 2) - 1;
    }
    channel.numValues = static_cast<Index>(channel.valueIndices.size());
    split.uvs = std::move(uvs);
    return split;
}

/// A vertex for each texture coordinate, as in a PLY with s and t.
Scene SplitAtSeams(Scene const& scene) {
    return Split(scene, scene.cage.fvarChannels.at(0).valueIndices);
}

/// The scene with its vertices numbered otherwise.
Scene Renumber(Scene const& scene, unsigned seed) {
    std::vector<Index> newOf(static_cast<size_t>(scene.cage.numVertices));
    for (size_t i = 0; i < newOf.size(); ++i) newOf[i] = static_cast<Index>(i);
    std::mt19937 random(seed);
    std::shuffle(newOf.begin(), newOf.end(), random);
    Scene other = scene;
    for (size_t old = 0; old < newOf.size(); ++old) {
        for (size_t c = 0; c < 3; ++c)
            other.positions[3 * newOf[old] + c] = scene.positions[3 * old + c];
        for (size_t p = 0; p < scene.primvars.size(); ++p) {
            size_t const n = static_cast<size_t>(scene.primvars[p].numChannels);
            for (size_t c = 0; c < n; ++c)
                other.primvars[p].values[newOf[old] * n + c] =
                    scene.primvars[p].values[old * n + c];
        }
    }
    for (auto* vertices :
         {&other.cage.faceVertices, &other.cage.creaseVertexPairs, &other.cage.cornerVertices}) {
        for (Index& vertex : *vertices) vertex = newOf[vertex];
    }
    return other;
}

/// The corners' numbers are those of the other list by another name.
void ExpectSameUpToNames(std::vector<Index> const& a, std::vector<Index> const& b) {
    ASSERT_EQ(a.size(), b.size());
    std::map<Index, Index> toB, toA;
    for (size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(toB.try_emplace(a[i], b[i]).first->second, b[i]) << "corner " << i;
        ASSERT_EQ(toA.try_emplace(b[i], a[i]).first->second, a[i]) << "corner " << i;
    }
}

/// Creases by where their ends are, with their sharpness.
std::multiset<std::vector<double>> ListCreases(Scene const& scene) {
    std::multiset<std::vector<double>> creases;
    for (size_t i = 0; i < scene.cage.creaseSharpness.size(); ++i) {
        std::vector<std::vector<double>> ends;
        for (size_t k = 0; k < 2; ++k) {
            auto const at = scene.positions.begin() + 3 * scene.cage.creaseVertexPairs[2 * i + k];
            ends.push_back({at, at + 3});
        }
        std::sort(ends.begin(), ends.end());
        std::vector<double> crease{scene.cage.creaseSharpness[i]};
        for (auto const& end : ends) crease.insert(crease.end(), end.begin(), end.end());
        creases.insert(crease);
    }
    return creases;
}

/// All of two scenes but how their vertices and values are numbered.
void ExpectSameScene(Scene const& a, Scene const& b) {
    EXPECT_EQ(a.cage.numVertices, b.cage.numVertices);
    EXPECT_EQ(a.cage.faceSizes, b.cage.faceSizes);
    ExpectSameUpToNames(a.cage.faceVertices, b.cage.faceVertices);
    EXPECT_EQ(AtCorners(a, a.positions, 3), AtCorners(b, b.positions, 3));
    EXPECT_EQ(ListCreases(a), ListCreases(b));
    EXPECT_EQ(a.cage.cornerSharpness.size(), b.cage.cornerSharpness.size());
    EXPECT_EQ(a.cage.holes, b.cage.holes);
    ASSERT_EQ(a.cage.fvarChannels.size(), b.cage.fvarChannels.size());
    for (size_t i = 0; i < a.cage.fvarChannels.size(); ++i) {
        EXPECT_EQ(a.cage.fvarChannels[i].numValues, b.cage.fvarChannels[i].numValues);
        ExpectSameUpToNames(a.cage.fvarChannels[i].valueIndices,
                            b.cage.fvarChannels[i].valueIndices);
    }
    ASSERT_EQ(a.primvars.size(), b.primvars.size());
    for (size_t i = 0; i < a.primvars.size(); ++i) {
        size_t const n = static_cast<size_t>(a.primvars[i].numChannels);
        EXPECT_EQ(AtCorners(a, a.primvars[i].values, n), AtCorners(b, b.primvars[i].values, n));
    }
    for (size_t kind = 0; kind < 3; ++kind) {
        EXPECT_EQ(a.groups[kind].names, b.groups[kind].names);
        EXPECT_EQ(a.groups[kind].faceGroup, b.groups[kind].faceGroup);
    }
}

/// Meshes of which no vertices coincide.
std::vector<Scene> MakeWholeMeshes() {
    Scene cube = test::MakeCube();
    cube.groups[0] = {{"red", "blue"}, {0, 0, 0, 1, 1, -1}};
    cube.cage.holes = {2};
    cube.cage.cornerVertices = {0, 7};
    cube.cage.cornerSharpness = {3, 10};
    cube.primvars = {{"color", 3, {}}};
    for (int i = 0; i < 24; ++i) cube.primvars[0].values.push_back(static_cast<float>(i) / 7);
    return {cube,
            test::MakeTorus(9, 6),
            test::MakeTriangleTorus(8, 5),
            test::LoadSpot(),
            test::LoadShape("catmark_cube_creases0"),
            test::LoadShape("catmark_pyramid"),
            test::LoadShape("loop_icosahedron"),
            test::LoadAsset("control/pyramid_edge_creases.obj"),
            test::LoadAsset("tri/mechpart_loop_control.obj"),
            test::LoadAsset("tri/cat_head.obj"),
            test::LoadAsset("tri/hourglass_ico.obj")};
}

TEST(Weld, AMeshCutIntoFacesIsWholeAgain) {
    for (Scene const& scene : MakeWholeMeshes()) {
        SCOPED_TRACE(scene.path);
        Scene const split = SplitFaces(scene);
        ASSERT_EQ(static_cast<size_t>(split.cage.numVertices), scene.cage.faceVertices.size());
        Scene const welded = engine::Weld(split, 0.0);
        ExpectSameScene(welded, scene);
        EXPECT_TRUE(welded.warnings.empty());
        EXPECT_EQ(welded.weld->numJoined, split.cage.numVertices - scene.cage.numVertices);
        EXPECT_EQ(welded.weld->numLeftApart, 0);
    }
}

TEST(Weld, AMeshCutAtItsTextureSeamsIsWholeAgainAndKeepsItsSeams) {
    for (Scene const& scene :
         {test::MakeTorus(9, 6), test::LoadSpot(), test::LoadShape("catmark_cube"),
          test::LoadAsset("control/pyramid_corners.obj")}) {
        SCOPED_TRACE(scene.path);
        Scene const split = SplitAtSeams(scene);
        ASSERT_GT(split.cage.numVertices, scene.cage.numVertices);
        Scene const welded = engine::Weld(split, 0.0);
        ExpectSameScene(welded, scene);
        EXPECT_EQ(welded.uvs, scene.uvs);
    }
}

/// Limits at all corners of the faces, refined once.
std::vector<double> FindLimits(Scene const& scene) {
    engine::Job job;
    Scene const fine =
        engine::RefineUniformly(engine::Model::Build(scene), {.levels = 1, .toLimit = true}, job);
    auto limits = AtCorners(fine, fine.positions, 3);
    auto const& values =
        fine.HasUVs() ? fine.cage.fvarChannels[0].valueIndices : std::vector<Index>{};
    for (Index value : values) {
        limits.push_back(fine.uvs[2 * value]);
        limits.push_back(fine.uvs[2 * value + 1]);
    }
    return limits;
}

TEST(Weld, AMeshThatWasCutHasItsLimitAgain) {
    for (Scene const& scene :
         {test::MakeTorus(9, 6), test::LoadSpot(), test::LoadShape("catmark_cube_creases0"),
          test::LoadAsset("tri/cat_head.obj")}) {
        SCOPED_TRACE(scene.path);
        auto const expected = FindLimits(scene),
                   found = FindLimits(engine::Weld(SplitFaces(scene), 0.0));
        ASSERT_EQ(found.size(), expected.size());
        for (size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], expected[i], 1e-12) << i;
    }
}

TEST(Weld, WeldingAgainChangesNothing) {
    for (Scene const& scene : MakeWholeMeshes()) {
        SCOPED_TRACE(scene.path);
        for (double tolerance : {0.0, 1e-9}) {
            Scene const once = engine::Weld(SplitFaces(scene), tolerance),
                        twice = engine::Weld(once, tolerance);
            EXPECT_EQ(twice.cage.faceVertices, once.cage.faceVertices);
            EXPECT_EQ(twice.positions, once.positions);
            EXPECT_EQ(twice.uvs, once.uvs);
            EXPECT_EQ(twice.cage.creaseVertexPairs, once.cage.creaseVertexPairs);
            EXPECT_EQ(twice.weld->numJoined, 0);
        }
    }
}

/// The scene with vertices moved by up to `size`, and other values of its primvars.
Scene Shake(Scene scene, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-size, size);
    for (double& coordinate : scene.positions) coordinate += shift(random);
    for (auto& primvar : scene.primvars) {
        for (float& value : primvar.values) value += static_cast<float>(shift(random));
    }
    return scene;
}

TEST(Weld, NumbersOfVerticesMakeNoOtherMesh) {
    for (Scene const& scene : MakeWholeMeshes()) {
        SCOPED_TRACE(scene.path);
        Scene const split = Shake(SplitFaces(scene), 1e-6, 5);
        for (double tolerance : {0.0, 1e-5}) {
            Scene const welded = engine::Weld(split, tolerance);
            Scene const& expected = tolerance > 0.0 ? scene : split;
            EXPECT_EQ(welded.cage.numVertices, expected.cage.numVertices);
            for (unsigned seed = 1; seed < 4; ++seed)
                ExpectSameScene(engine::Weld(Renumber(split, seed), tolerance), welded);
        }
    }
}

TEST(Weld, PointsThatStayAreAmongThoseThatWere) {
    Scene const split = Shake(SplitFaces(test::MakeCube()), 1e-6, 7);
    Scene const welded = engine::Weld(split, 1e-5);
    for (size_t i = 0; i < welded.positions.size(); i += 3) {
        bool isThere = false;
        for (size_t k = 0; k < split.positions.size(); k += 3) {
            isThere |= std::equal(welded.positions.begin() + i, welded.positions.begin() + i + 3,
                                  split.positions.begin() + k);
        }
        EXPECT_TRUE(isThere) << i / 3;
    }
}

TEST(Weld, WhatIsFartherThanTheToleranceStays) {
    Scene const scene = test::MakeCube();  // edges of length 2
    Scene const split = Shake(SplitFaces(scene), 1e-3, 3);
    EXPECT_EQ(engine::Weld(split, 1e-5).cage.numVertices, 24);
    EXPECT_EQ(engine::Weld(split, 1e-2).cage.numVertices, 8);
}

TEST(Weld, VerticesWithinASurfaceStayAsTheyAre) {
    // A closed cube twice: nothing is on a boundary.
    Scene twice = test::MakeCube();
    auto const vertices = twice.cage.faceVertices;
    auto const positions = twice.positions;
    for (Index vertex : vertices) twice.cage.faceVertices.push_back(vertex + 8);
    twice.positions.insert(twice.positions.end(), positions.begin(), positions.end());
    twice.cage.faceSizes.resize(12, 4);
    twice.cage.numVertices = 16;
    EXPECT_EQ(engine::Weld(twice, 0.0).cage.faceVertices, twice.cage.faceVertices);
}

TEST(Weld, OfSharpnessesThatMeetTheLargestCounts) {
    // Two quads that touch along an edge, each with a crease there, and corners at its end.
    Scene scene =
        test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0},
                        {{0, 1, 2, 3}, {4, 5, 6, 7}});
    scene.cage.creaseVertexPairs = {1, 2, 7, 4, 0, 1};
    scene.cage.creaseSharpness = {1, 3, 2};
    scene.cage.cornerVertices = {4, 1, 0};
    scene.cage.cornerSharpness = {2, 5, 1};
    Scene const welded = engine::Weld(scene, 0.0);
    EXPECT_EQ(welded.cage.faceVertices, (std::vector<Index>{0, 1, 2, 3, 1, 4, 5, 2}));
    EXPECT_EQ(welded.cage.creaseVertexPairs, (std::vector<Index>{1, 2, 0, 1}));
    EXPECT_EQ(welded.cage.creaseSharpness, (std::vector<float>{3, 2}));
    EXPECT_EQ(welded.cage.cornerVertices, (std::vector<Index>{1, 0}));
    EXPECT_EQ(welded.cage.cornerSharpness, (std::vector<float>{5, 1}));
}

TEST(Weld, PrimvarsThatDifferHaveTheirMeanAndOneWarning) {
    Scene scene =
        test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0},
                        {{0, 1, 2, 3}, {4, 5, 6, 7}});
    scene.path = "two.ply";
    scene.primvars = {{"heat", 1, {0, 1, 2, 3, 5, 6, 7, 2}},
                      {"same", 1, {0, 1, 2, 3, 1, 6, 7, 2}},
                      {"flow", 2, {0, 0, 1, 1, 2, 2, 3, 3, 3, 1, 6, 6, 7, 7, 2, 4}}};
    Scene const welded = engine::Weld(scene, 0.0);
    EXPECT_EQ(welded.primvars[0].values, (std::vector<float>{0, 3, 2, 3, 6, 7}));
    EXPECT_EQ(welded.primvars[1].values, (std::vector<float>{0, 1, 2, 3, 6, 7}));
    EXPECT_EQ(welded.primvars[2].values, (std::vector<float>{0, 0, 2, 1, 2, 3, 3, 3, 6, 6, 7, 7}));
    EXPECT_EQ(welded.warnings, std::vector<std::string>{
                                   "two.ply: of the joined vertices up to 2 had different values "
                                   "of 'heat', 'flow'; they have the mean"});
}

/// Three quads that touch along the edge from (0,0,0) to (0,0,1), each with vertices of its own.
Scene MakeThreeSheets() {
    std::vector<double> positions;
    std::vector<std::vector<Index>> faces;
    for (Index i = 0; i < 3; ++i) {
        double const x = std::cos(2.0 * i), y = std::sin(2.0 * i);
        positions.insert(positions.end(), {0, 0, 0, x, y, 0, x, y, 1, 0, 0, 1});
        faces.push_back({4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3});
    }
    return test::MakeScene(positions, faces);
}

TEST(Weld, AnEdgeThatWouldHaveThreeFacesStaysApart) {
    Scene scene = MakeThreeSheets();
    scene.path = "three.obj";
    Scene const welded = engine::Weld(scene, 0.0);
    EXPECT_EQ(welded.cage.faceVertices, scene.cage.faceVertices);
    EXPECT_EQ(welded.weld->numLeftApart, 6);
    EXPECT_EQ(welded.warnings, std::vector<std::string>{
                                   "three.obj: 6 boundary vertices coincide with others and stay "
                                   "apart, first vertex 0: joined, an edge would have more than "
                                   "two faces"});
}

TEST(Weld, OnlyTheEdgeThatWouldHaveThreeFacesStaysApart) {
    // A fourth sheet continues the first one beyond its far edge.
    Scene scene = MakeThreeSheets();
    double const x = std::cos(0.0), y = std::sin(0.0);
    scene.positions.insert(scene.positions.end(),
                           {x, y, 0, 2 * x, 2 * y, 0, 2 * x, 2 * y, 1, x, y, 1});
    scene.cage.faceVertices.insert(scene.cage.faceVertices.end(), {12, 13, 14, 15});
    scene.cage.faceSizes.push_back(4);
    scene.cage.numVertices = 16;
    Scene const welded = engine::Weld(scene, 0.0);
    EXPECT_EQ(welded.weld->numJoined, 2);
    EXPECT_EQ(welded.weld->numLeftApart, 6);
    EXPECT_EQ(engine::DescribeMesh(engine::Model::Build(welded)).components, 3);
}

TEST(Weld, AnEdgeThatHasThreeFacesMayHaveMore) {
    // The three sheets share their edge already, and a fourth touches it.
    Scene scene = MakeThreeSheets();
    scene.cage.faceVertices = {0, 1, 2, 3, 0, 5, 6, 3, 0, 9, 10, 3, 4, 7, 8, 11};
    scene.cage.faceSizes = {4, 4, 4, 4};
    auto const at = [&](Index vertex) { return scene.positions.begin() + 3 * vertex; };
    std::copy_n(std::vector<double>{-1, -1, 1}.begin(), 3, at(7));
    std::copy_n(std::vector<double>{-1, -1, 0}.begin(), 3, at(8));
    std::copy_n(std::vector<double>{0, 0, 1}.begin(), 3, at(11));
    scene.cage.faceVertices = {0, 1, 2, 3, 0, 5, 6, 3, 0, 9, 10, 3, 4, 8, 7, 11};
    Scene const welded = engine::Weld(scene, 0.0);
    EXPECT_EQ(welded.weld->numJoined, 2);
    EXPECT_EQ(welded.weld->numLeftApart, 0);
    auto const info = engine::DescribeMesh(engine::Model::Build(welded));
    EXPECT_EQ(info.components, 1);
}

TEST(Weld, AFaceThatWouldHaveACornerTwiceStaysAsItIs) {
    // A quad whose upper corners lie in one place, beside one that touches it.
    Scene scene = test::MakeScene(
        {0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 1, -1, 0, 0, -1, 0},
        {{0, 1, 2, 3}, {4, 7, 6, 5}});
    scene.path = "pole.obj";
    Scene const welded = engine::Weld(scene, 0.0);
    EXPECT_EQ(welded.cage.faceVertices, (std::vector<Index>{0, 1, 2, 3, 0, 5, 4, 1}));
    EXPECT_EQ(welded.warnings, std::vector<std::string>{
                                   "pole.obj: 2 boundary vertices coincide with others and stay "
                                   "apart, first vertex 2: joined, a face would have a corner "
                                   "twice"});
}

TEST(Weld, TextureCoordinatesThatDifferStayApart) {
    Scene scene =
        test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0},
                        {{0, 1, 2, 3}, {4, 5, 6, 7}});
    scene.uvs = {0, 0, .5, 0, .5, 1, 0, 1, .5, 0, 1, 0, 1, 1, .5, .9, 7, 7};  // the last is unused
    scene.cage.fvarChannels = {{9, {0, 1, 2, 3, 4, 5, 6, 7}}};
    Scene const welded = engine::Weld(scene, 0.0);
    // Corners 1 and 4 share (.5, 0); 2 and 7 have (.5, 1) and (.5, .9). The unused value stays.
    EXPECT_EQ(welded.cage.fvarChannels[0].valueIndices,
              (std::vector<Index>{0, 1, 2, 3, 1, 4, 5, 6}));
    EXPECT_EQ(welded.uvs,
              (std::vector<double>{0, 0, .5, 0, .5, 1, 0, 1, 1, 0, 1, 1, .5, .9, 7, 7}));
    EXPECT_EQ(welded.cage.fvarChannels[0].numValues, 8);
}

TEST(Weld, WhatCannotBeWeldedIsRefused) {
    auto const code = [](Scene const& scene, double tolerance) {
        auto const error = test::CatchError([&] { engine::Weld(scene, tolerance); });
        return error ? error->GetCode() : ErrorCode::Io;
    };
    double const nan = std::numeric_limits<double>::quiet_NaN();
    Scene const cube = test::MakeCube();
    for (double tolerance : {-1.0, nan, std::numeric_limits<double>::infinity()})
        EXPECT_EQ(code(cube, tolerance), ErrorCode::BadOption) << tolerance;
    Scene broken = cube;
    broken.positions[4] = nan;
    EXPECT_EQ(code(broken, 0.0), ErrorCode::BadMesh);
    broken = cube;
    broken.cage.faceVertices[3] = 8;
    EXPECT_EQ(code(broken, 0.0), ErrorCode::BadMesh);
    broken = cube;
    broken.positions.pop_back();
    EXPECT_EQ(code(broken, 0.0), ErrorCode::BadMesh);
}

TEST(Weld, ManySheetsTakeLittleTime) {
    Scene const torus = test::MakeTorus(300, 200);
    Scene const welded = engine::Weld(SplitFaces(torus), 1e-9);
    EXPECT_EQ(welded.cage.numVertices, torus.cage.numVertices);
    EXPECT_TRUE(test::AreFinite(welded.positions));
}

}  // namespace
}  // namespace limn
