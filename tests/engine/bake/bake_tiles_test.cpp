// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/bake_tiles.h"

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/meshes.h"

namespace limn {
namespace {

using Numbers = std::vector<int>;

/// Quads of size 1 whose lower left corners in texture space are these.
engine::Model MakeQuads(std::vector<std::pair<double, double>> const& corners) {
    std::vector<double> positions, uvs;
    std::vector<std::vector<Index>> faces;
    for (auto const& [u, v] : corners) {
        Index const first = static_cast<Index>(positions.size() / 3);
        for (auto const& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            positions.insert(positions.end(), {u + x, v + y, 3.0 * first});
            uvs.insert(uvs.end(), {u + x, v + y});
        }
        faces.push_back({first, first + 1, first + 2, first + 3});
    }
    engine::Scene scene = test::MakeScene(std::move(positions), faces);
    scene.cage.fvarChannels.push_back({scene.cage.numVertices, scene.cage.faceVertices});
    scene.uvs = std::move(uvs);
    return engine::Model::Build(std::move(scene));
}

Numbers FindTiles(engine::Model const& model, Numbers asked, bool hasToken) {
    engine::BakeOptions options;
    options.width = options.height = 64;
    options.tiles = std::move(asked);
    engine::Job job;
    engine::TexturedFaces const faces(model, {}, job);
    return engine::FindBakedTiles(faces, model, options, hasToken, job);
}

TEST(BakeTiles, AreThoseThatFacesReachOfThoseAskedFor) {
    auto const model = MakeQuads({{0, 0}, {1.5, 0.5}});
    EXPECT_EQ(FindTiles(model, {}, true), (Numbers{1001, 1002, 1003, 1012, 1013}));
    EXPECT_EQ(FindTiles(model, {1012, 1003, 1050}, true), (Numbers{1003, 1012}));
}

TEST(BakeTiles, WhereNoneOfThoseAskedForIsThereTheOnesThatAreAreListed) {
    auto const model = MakeQuads({{0, 0}, {1.5, 0.5}});
    for (bool hasToken : {true, false}) {
        EXPECT_EQ(test::CodeOf([&] { FindTiles(model, {1050}, hasToken); }), ErrorCode::BadMesh);
        std::string const refusal = test::RefusalOf([&] { FindTiles(model, {1050}, hasToken); });
        EXPECT_TRUE(refusal.ends_with("there are: 1001, 1002, 1003, 1012, 1013")) << refusal;
    }
}

TEST(BakeTiles, WithoutATokenOneTileIsBakedThatLosesNoFace) {
    EXPECT_EQ(FindTiles(MakeQuads({{0, 0}}), {}, false), (Numbers{1001}));
    EXPECT_EQ(FindTiles(MakeQuads({{-3, 0}, {0, 0}}), {}, false), (Numbers{1001}));
    auto const model = MakeQuads({{0, 0}, {1, 0}, {4.5, 0}});
    std::string const refusal = test::RefusalOf([&] { FindTiles(model, {}, false); });
    EXPECT_NE(refusal.find("2 of the faces to bake lie in other tiles than 1001: face 1, face 2"),
              std::string::npos)
        << refusal;
    EXPECT_NE(refusal.find("<UDIM>"), std::string::npos) << refusal;
    EXPECT_EQ(test::CodeOf([&] { FindTiles(model, {1001, 1002}, false); }), ErrorCode::BadOption);
}

TEST(BakeTiles, WithoutATokenTheOneTileAskedForIsBaked) {
    auto const model = MakeQuads({{0, 0}, {1, 0}, {4.5, 0}});
    for (int tile : {1001, 1002, 1005})
        EXPECT_EQ(FindTiles(model, {tile}, false), (Numbers{tile})) << tile;
}

TEST(BakeTiles, MoreThanAHundredNeedToBeAskedFor) {
    std::vector<std::pair<double, double>> corners;
    for (int tile = 0; tile < 100; ++tile) corners.emplace_back(tile % 10, tile / 10);
    EXPECT_EQ(FindTiles(MakeQuads(corners), {}, true).size(), 100u);
    corners.emplace_back(0, 10);
    auto const model = MakeQuads(corners);
    std::string const refusal = test::RefusalOf([&] { FindTiles(model, {}, true); });
    EXPECT_NE(refusal.find("more than 100 tiles would be baked; with face 100"), std::string::npos)
        << refusal;
    EXPECT_EQ(test::CodeOf([&] { FindTiles(model, {}, true); }), ErrorCode::BadOption);
    Numbers all;
    for (int tile = 1001; tile <= 1200; ++tile) all.push_back(tile);
    EXPECT_EQ(FindTiles(model, all, true).size(), 101u);
}

}  // namespace
}  // namespace limn
