// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/texture_tiles.h"

#include <gtest/gtest.h>

#include "engine/bake/bake.h"
#include "engine/scene/mesh_info.h"
#include "support/errors.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::Model;
using engine::TextureTiles;
using Numbers = std::vector<int>;

/// A quad with these corners in texture space, or a triangle under Loop.
Model MakeFace(std::vector<double> uvs, Sdc::SchemeType scheme = Sdc::SCHEME_CATMARK) {
    bool const isQuad = uvs.size() == 8;
    engine::Scene scene =
        isQuad ? test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {{0, 1, 2, 3}}, scheme)
               : test::MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 2}}, scheme);
    scene.uvs = std::move(uvs);
    scene.cage.options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_ALL);
    scene.cage.fvarChannels.push_back(
        {static_cast<Index>(scene.uvs.size() / 2), scene.cage.faceVertices});
    return Model::Build(std::move(scene));
}

std::vector<double> MakeSquare(double minU, double minV, double maxU, double maxV) {
    return {minU, minV, maxU, minV, maxU, maxV, minU, maxV};
}

Numbers TilesOf(Model const& model, int size = 2048) {
    eval::LimitSurface const surface(model.GetRefiner(), 0);
    TextureTiles tiles(surface, model.GetUVs(), size, size);
    for (Index face = 0; face < surface.GetNumFaces(); ++face) tiles.Add(face);
    EXPECT_EQ(tiles.GetCount(), tiles.ListNumbers().size());
    return tiles.ListNumbers();
}

TEST(TextureTiles, AFaceThatFillsATileLiesInThatOne) {
    EXPECT_EQ(TilesOf(MakeFace(MakeSquare(0, 0, 1, 1))), (Numbers{1001}));
    EXPECT_EQ(TilesOf(MakeFace(MakeSquare(2, 1, 3, 2))), (Numbers{1013}));
}

TEST(TextureTiles, AFaceOverSeveralTilesLiesInAllOfThem) {
    EXPECT_EQ(TilesOf(MakeFace(MakeSquare(0, 0, 3, 1))), (Numbers{1001, 1002, 1003}));
    EXPECT_EQ(TilesOf(MakeFace(MakeSquare(0.5, 0.5, 1.5, 2.5))),
              (Numbers{1001, 1002, 1011, 1012, 1021, 1022}));
}

TEST(TextureTiles, WhereCoordinatesOverflowThereAreNoTiles) {
    Model const model = MakeFace(MakeSquare(0, 0, 1, 1));
    eval::LimitSurface const surface(model.GetRefiner(), 0);
    for (double const far : {1e308, -1e308}) {
        auto uvs = model.GetUVs();
        uvs[4] = far;
        TextureTiles tiles(surface, uvs, 2048, 2048);
        tiles.Add(0);
        EXPECT_EQ(tiles.IsLeftBy(0), false);
    }
}

// The corner (2, 2) of the box is no part of the triangle.
TEST(TextureTiles, OnlyWhatTheFaceReachesCounts) {
    for (auto scheme : {Sdc::SCHEME_LOOP, Sdc::SCHEME_CATMARK}) {
        EXPECT_EQ(TilesOf(MakeFace({0, 0, 1.98, 0, 0, 1.98}, scheme)), (Numbers{1001, 1002, 1011}));
        EXPECT_EQ(TilesOf(MakeFace({0, 0, 2.02, 0, 0, 2.02}, scheme)),
                  (Numbers{1001, 1002, 1003, 1011, 1012, 1021}));
    }
}

// Samples begin half a texel inside of a border.
TEST(TextureTiles, WhatReachesNoSampleDoesNotCount) {
    for (int size : {64, 2048}) {
        double const half = 0.5 / size;
        EXPECT_EQ(TilesOf(MakeFace(MakeSquare(0.5, 0, 1 + 0.9 * half, 1)), size), (Numbers{1001}));
        EXPECT_EQ(TilesOf(MakeFace(MakeSquare(0.5, 0, 1 + 1.1 * half, 1)), size),
                  (Numbers{1001, 1002}));
        EXPECT_EQ(TilesOf(MakeFace(MakeSquare(1 - 0.9 * half, 0, 1.5, 1)), size), (Numbers{1002}));
    }
}

TEST(TextureTiles, SmallFacesCountAsLargeOnesDo) {
    EXPECT_EQ(TilesOf(MakeFace(MakeSquare(4.5, 0.5, 4.5 + 1e-7, 0.5 + 1e-7))), (Numbers{1005}));
}

TEST(TextureTiles, FacesFarBeyondTheRangeFillIt) {
    for (double far : {1e3, 1e9, 1e12})
        EXPECT_EQ(TilesOf(MakeFace(MakeSquare(-far, -far, far, far))).size(), 9000u) << far;
    EXPECT_EQ(TilesOf(MakeFace(MakeSquare(0, 0, 1e12, 1e12))).size(), 9000u);
    EXPECT_TRUE(TilesOf(MakeFace(MakeSquare(11, 0, 1e9, 1))).empty());
    EXPECT_TRUE(TilesOf(MakeFace(MakeSquare(-5, -5, -1, 1))).empty());
}

// Nor does a bake find a texel there: doubles of that size are whole tiles apart.
TEST(TextureTiles, FacesWhoseNumbersCannotTellTilesApartLieInNone) {
    for (double far : {1e15, 1e30}) {
        for (auto const& uvs : {MakeSquare(-far, -far, far, far), MakeSquare(0, 0, far, far),
                                MakeSquare(0, 0, far, 1), MakeSquare(0, 0, 1, far)}) {
            Model const model = MakeFace(uvs);
            EXPECT_TRUE(TilesOf(model).empty()) << far;
            engine::Job job;
            engine::BakeOptions options;
            options.maps = {"position"};
            options.width = options.height = 16;
            options.tiles = {1001};
            EXPECT_TRUE(test::CatchError([&] { engine::BakeToMemory(model, options, job); }));
        }
    }
}

TEST(TextureTiles, TellsWhichFacesLeaveTheTilesThatAreThere) {
    auto const isLeft = [](Model const& model) {
        eval::LimitSurface const surface(model.GetRefiner(), 0);
        TextureTiles tiles(surface, model.GetUVs(), 64, 64);
        tiles.AddTile({0, 0});
        return tiles.IsLeftBy(0);
    };
    EXPECT_FALSE(isLeft(MakeFace(MakeSquare(0, 0, 1, 1))));
    EXPECT_FALSE(isLeft(MakeFace(MakeSquare(-3, 0, 1, 1)))) << "there are no tiles";
    EXPECT_TRUE(isLeft(MakeFace(MakeSquare(0, 0, 1.1, 1))));
    EXPECT_TRUE(isLeft(MakeFace(MakeSquare(5, 5, 5.5, 5.5))));
}

TEST(TextureTiles, TellsWhichFacesLeaveTheRange) {
    auto const isLeft = [](Model const& model) {
        eval::LimitSurface const surface(model.GetRefiner(), 0);
        return TextureTiles(surface, model.GetUVs(), 64, 64).IsRangeLeftBy(0);
    };
    EXPECT_FALSE(isLeft(MakeFace(MakeSquare(0, 0, 10, 900))));
    EXPECT_FALSE(isLeft(MakeFace(MakeSquare(-5e-5, 0, 1, 1)))) << "that is rounding";
    EXPECT_TRUE(isLeft(MakeFace(MakeSquare(-1e-3, 0, 1, 1))));
    EXPECT_TRUE(isLeft(MakeFace(MakeSquare(0, 0, 10.01, 1))));
    EXPECT_TRUE(isLeft(MakeFace(MakeSquare(0, 0, 1, 900.1))));
    EXPECT_TRUE(isLeft(MakeFace({0, 0, 1, 0, 1, 1e30, 0, 1})));
}

class TilesOfMesh : public testing::TestWithParam<char const*> {};
INSTANTIATE_TEST_SUITE_P(Meshes, TilesOfMesh,
                         testing::Values("udim/grid_with_udims.obj", "udim/plane_3_udims.obj",
                                         "control/pyramid_corners.obj"),
                         [](auto const& mesh) { return test::NameInstance(mesh.param); });

// Info says what a bake will find.
TEST_P(TilesOfMesh, InfoAndBakeCountAlike) {
    for (auto const& [scale, offset] : {std::pair{1.0, 0.0}, {1.7, 0.4}, {0.3, 2.9}}) {
        engine::Scene scene = test::LoadAsset(GetParam());
        for (double& uv : scene.uvs) uv = scale * uv + offset;
        Model const model = Model::Build(std::move(scene));
        engine::BakeOptions options;
        options.maps = {"position"};
        options.width = options.height = 512;
        engine::Job job;
        auto const baked = engine::BakeToMemory(model, options, job).report.tiles;
        EXPECT_EQ(engine::DescribeMesh(model).uv.tiles, baked) << scale;
    }
}

}  // namespace
}  // namespace limn
