// SPDX-License-Identifier: Apache-2.0
//
// What a bake that chose something says.

#include "engine/bake/bake_warnings.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/bake/bake.h"
#include "engine/scene/uv_info.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/threads.h"

namespace limn {
namespace {

using engine::BakeOptions;
using engine::Scene;
using Words = std::vector<std::string>;

BakeOptions MakeMapOptions(Words maps, int size = 64) {
    BakeOptions options;
    options.maps = std::move(maps);
    options.width = options.height = size;
    return options;
}

Words WarningsOf(Scene scene, BakeOptions const& options) {
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    engine::BakeToMemory(engine::Model::Build(std::move(scene)), options, job);
    return listener.warnings;
}

bool Contains(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

/// The one warning there must be.
std::string WarningOf(Scene scene, BakeOptions const& options) {
    Words const warnings = WarningsOf(std::move(scene), options);
    EXPECT_EQ(warnings.size(), 1u);
    return warnings.empty() ? "" : warnings[0];
}

TEST(BakeWarnings, NothingIsSaidOfASoundMesh) {
    auto options = MakeMapOptions({"position", "normal", "mean", "overlap"});
    for (char const* mesh : {"udim/grid_with_udims.obj", "udim/plane_3_udims.obj"})
        EXPECT_EQ(WarningsOf(test::LoadAsset(mesh), options), Words{}) << mesh;
    for (int size : {64, 300, 1024}) {
        options.width = options.height = size;
        EXPECT_EQ(WarningsOf(test::LoadSpot(), options), Words{}) << size;
    }
}

// -------- faces that are lost

TEST(BakeWarnings, ABakeThatMayBeEmptySaysThatItIs) {
    Scene scene = test::MakeTorus(6, 4);
    std::ranges::fill(scene.uvs, 0.5);
    auto options = MakeMapOptions({"mean"});
    options.mayBeEmpty = true;
    EXPECT_EQ(WarningsOf(scene, options).back(), "made: no texel is covered by any face");
    options.tiles = {1002};
    EXPECT_EQ(WarningsOf(scene, options).back(),
              "made: no texel is covered by any face in the tiles asked for");
}

TEST(BakeWarnings, FacesWithoutTextureAreaAreCountedAsInfoCountsThem) {
    Scene scene = test::MakeTorus(6, 4);
    EXPECT_EQ(WarningsOf(scene, MakeMapOptions({"position"})), Words{});
    auto& values = scene.cage.fvarChannels.at(0).valueIndices;
    for (size_t face : {5u, 9u, 20u})
        std::fill_n(values.begin() + static_cast<long>(4 * face), 4, values[4 * face]);
    EXPECT_EQ(engine::DescribeUVs(engine::Model::Build(scene)).zeroAreaFaces, 3u);
    std::string const warning = WarningOf(scene, MakeMapOptions({"position"}));
    EXPECT_TRUE(Contains(warning, "3 of 24 faces have no area in the texture")) << warning;
    EXPECT_TRUE(Contains(warning, "first face 5")) << warning;
}

// -------- overlaps

/// A torus of n x m quads with its natural layout, and the same one once more, some way off.
Scene MakeTwoTori() {
    Scene two = test::MakeTorus(6, 4);
    Scene const other = test::MakeTorus(6, 4);
    Index const first = two.cage.numVertices;
    auto& channel = two.cage.fvarChannels.at(0);
    Index const firstValue = channel.numValues;
    for (double x : other.positions) two.positions.push_back(x + 10.0);
    for (Index size : other.cage.faceSizes) two.cage.faceSizes.push_back(size);
    for (Index vertex : other.cage.faceVertices) two.cage.faceVertices.push_back(vertex + first);
    for (Index value : other.cage.fvarChannels[0].valueIndices)
        channel.valueIndices.push_back(value + firstValue);
    two.uvs.insert(two.uvs.end(), other.uvs.begin(), other.uvs.end());
    two.cage.numVertices *= 2;
    channel.numValues *= 2;
    return two;
}

void SplitIntoGroups(Scene& scene, engine::GroupKind kind, Words names, Index firstOfSecond) {
    auto& groups = scene.groups[static_cast<size_t>(kind)];
    groups.names = std::move(names);
    for (Index face = 0; face < scene.cage.GetNumFaces(); ++face)
        groups.faceGroup.push_back(face >= firstOfSecond);
}

TEST(BakeWarnings, AnOverlapIsSaidWithItsShareAndItsFirstFaces) {
    std::string const warning = WarningOf(MakeTwoTori(), MakeMapOptions({"position"}));
    EXPECT_TRUE(Contains(warning, "4096 of 4096 covered texels (100 %)")) << warning;
    EXPECT_TRUE(Contains(warning, "first face 0 and face 24;")) << warning;
    EXPECT_FALSE(Contains(warning, "different")) << warning;
    EXPECT_TRUE(Contains(warning, "`maps` overlap")) << warning;
}

TEST(BakeWarnings, WhereGroupsOverlapTheyAreTheWayOut) {
    for (auto const& [kind, word] : {std::pair{engine::GroupKind::Material, "materials"},
                                     {engine::GroupKind::Group, "groups"},
                                     {engine::GroupKind::Object, "objects"}}) {
        Scene scene = MakeTwoTori();
        SplitIntoGroups(scene, kind, {"red", "blue"}, 24);
        std::string const warning = WarningOf(std::move(scene), MakeMapOptions({"position"}));
        EXPECT_TRUE(Contains(warning, std::string("all of them under faces of different ") + word +
                                          ", such as red and blue"))
            << warning;
        EXPECT_TRUE(Contains(warning, "`groups` or with {group}")) << warning;
    }
}

TEST(BakeWarnings, GroupsThatDoNotOverlapAreNoWayOut) {
    Scene scene = MakeTwoTori();
    for (auto kind : {engine::GroupKind::Material, engine::GroupKind::Object}) {
        auto& groups = scene.groups[static_cast<size_t>(kind)];
        groups.names = {"left", "right"};
        for (int face = 0; face < 48; ++face) groups.faceGroup.push_back(face % 24 >= 12);
    }
    std::string const warning = WarningOf(scene, MakeMapOptions({"position"}));
    EXPECT_FALSE(Contains(warning, "different")) << warning;
    // Of one group alone each texel of its half lies under two faces all the same.
    auto options = MakeMapOptions({"position"});
    options.groups = {"left"};
    EXPECT_TRUE(Contains(WarningOf(scene, options), "(100 %)"));
}

TEST(BakeWarnings, ABakeOfOneGroupOfTwoHasNoOverlap) {
    Scene scene = MakeTwoTori();
    SplitIntoGroups(scene, engine::GroupKind::Material, {"red", "blue"}, 24);
    auto options = MakeMapOptions({"position"});
    options.groups = {"blue"};
    EXPECT_EQ(WarningsOf(std::move(scene), options), Words{});
}

TEST(BakeWarnings, AreTheSameForAnyNumberOfThreadsAndSamples) {
    Scene const scene = test::LoadAsset("control/pyramid_corners.obj");
    Words warnings;
    for (int threads : {1, 4}) {
        test::WithThreads(threads, [&] {
            warnings.push_back(WarningOf(scene, MakeMapOptions({"position"}, 1000)));
        });
    }
    EXPECT_EQ(warnings[0], warnings[1]);
    auto options = MakeMapOptions({"position"});
    options.samplesPerSide = 2;
    EXPECT_TRUE(Contains(WarningOf(MakeTwoTori(), options), "(100 %)"));
}

// -------- displacement

Scene Move(Scene scene, double dx, double dy, double dz) {
    for (size_t i = 0; i < scene.positions.size(); i += 3) {
        scene.positions[i] += dx;
        scene.positions[i + 1] += dy;
        scene.positions[i + 2] += dz;
    }
    return scene;
}

/// A flat sheet whose normal is z.
Scene MakeSheet() {
    Scene sheet = test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {{0, 1, 2, 3}});
    sheet.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
    sheet.cage.fvarChannels.push_back({4, sheet.cage.faceVertices});
    return sheet;
}

TEST(BakeWarnings, WhatScalarDisplacementLeavesOutIsSaid) {
    auto options = MakeMapOptions({"displacement"});
    options.against = engine::Model::Build(Move(MakeSheet(), 0.3, -0.4, 1.2));
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    auto const report =
        engine::BakeToMemory(engine::Model::Build(MakeSheet()), options, job).report;
    auto const& leftOut = report.outputs.at(0).leftOut;
    EXPECT_EQ(leftOut.count, 64u * 64u);
    EXPECT_NEAR(leftOut.max, 0.5, 1e-6);
    EXPECT_NEAR(leftOut.GetRms(), 0.5, 1e-6);
    EXPECT_NEAR(leftOut.longest, 1.3, 1e-6);
    ASSERT_EQ(listener.warnings.size(), 1u);
    EXPECT_TRUE(Contains(listener.warnings[0], "up to 0.5 long (0.5 rms)")) << listener.warnings[0];
    EXPECT_TRUE(Contains(listener.warnings[0], "`isVector`")) << listener.warnings[0];
}

TEST(BakeWarnings, WholeVectorsLeaveNothingOut) {
    auto options = MakeMapOptions({"displacement"});
    options.against = engine::Model::Build(Move(MakeSheet(), 0.3, -0.4, 1.2));
    options.isVector = true;
    EXPECT_EQ(WarningsOf(MakeSheet(), options), Words{});
}

TEST(BakeWarnings, AFewPartsOfAHundredMayBeLeftOut) {
    for (auto const& [aside, numWarnings] : {std::pair{0.04, 0u}, {0.06, 1u}}) {
        auto options = MakeMapOptions({"displacement"});
        options.against = engine::Model::Build(Move(MakeSheet(), aside, 0.0, 1.0));
        EXPECT_EQ(WarningsOf(MakeSheet(), options).size(), numWarnings) << aside;
    }
}

// -------- positions far from the origin

Scene MakeTorusAt(double distance) {
    Scene scene = test::MakeTorus(6, 4);
    for (double& x : scene.positions) x += distance;
    return scene;
}

TEST(BakeWarnings, PositionsFarFromTheOriginAreTooCoarse) {
    auto options = MakeMapOptions({"position", "normal"});
    EXPECT_EQ(WarningsOf(MakeTorusAt(10.0), options), Words{});
    std::string const warning = WarningOf(MakeTorusAt(1000.0), options);
    EXPECT_TRUE(Contains(warning, "positions of single precision are 6.10352e-05 apart"))
        << warning;
    EXPECT_FALSE(Contains(warning, "halfMaps")) << warning;
    options.origin = engine::AutomaticOrigin{};
    EXPECT_EQ(WarningsOf(MakeTorusAt(1000.0), options), Words{});
    EXPECT_EQ(WarningsOf(MakeTorusAt(1000.0), MakeMapOptions({"normal"})), Words{});
}

TEST(BakeWarnings, PositionsInHalfAreTooCoarseEarlier) {
    auto options = MakeMapOptions({"position", "normal"});
    options.isHalf = true;
    EXPECT_EQ(WarningsOf(MakeTorusAt(0.0), options), Words{});
    std::string const warning = WarningOf(MakeTorusAt(100.0), options);
    EXPECT_TRUE(Contains(warning, "positions of half precision are 0.0625 apart")) << warning;
    EXPECT_TRUE(Contains(warning, "name the other maps by `halfMaps`")) << warning;
    options.origin = engine::AutomaticOrigin{};
    EXPECT_EQ(WarningsOf(MakeTorusAt(100.0), options), Words{});
    options.origin.reset();
    options.halfMaps = {"normal"};
    EXPECT_EQ(WarningsOf(MakeTorusAt(10.0), options), Words{});
}

// -------- faces without texture coordinates

TEST(BakeWarnings, FacesWithoutTextureCoordinatesAreCountedAndTheFirstIsNamed) {
    Scene scene = test::MakeTorus(6, 4);
    auto values = scene.cage.fvarChannels.at(0).valueIndices;
    scene.cage.fvarChannels.clear();
    std::vector<char> lacks(24, 0);
    for (Index face : {3, 8, 9}) {
        lacks[face] = 1;
        std::fill_n(values.begin() + 4 * face, 4, -1);
    }
    scene.AddUVChannel(std::move(values), std::move(lacks));
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    auto const report =
        engine::BakeToMemory(engine::Model::Build(scene), MakeMapOptions({"mean"}), job).report;
    ASSERT_EQ(listener.warnings.size(), 1u);
    EXPECT_TRUE(Contains(listener.warnings[0], "3 of 24 faces have no texture coordinates"));
    EXPECT_TRUE(Contains(listener.warnings[0], "first face 3"));
    EXPECT_NEAR(static_cast<double>(report.texelsCovered), 64.0 * 64.0 * 21 / 24, 200.0);
}

}  // namespace
}  // namespace limn
