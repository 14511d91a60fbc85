// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/pictures/map_picture.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "engine/images/png.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/threads.h"

namespace limn {
namespace {

using Colour = test::Picture::Colour;

Colour const kBackground{38, 38, 38};
engine::PictureView const kFromFront{{0.0, 0.0, 1.0}, 100};

bool IsGrey(Colour const& colour) {
    return colour[0] == colour[1] && colour[1] == colour[2];
}

/// A flat sheet of two squares side by side, 2 x 1, each in a tile of its own.
engine::Scene MakeSheet() {
    engine::Scene sheet = test::MakeScene({0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0},
                                          {{0, 1, 4, 3}, {1, 2, 5, 4}});
    sheet.uvs = {0.1, 0.1, 0.9, 0.1, 0.9, 0.9, 0.1, 0.9, 1.1, 0.1, 1.9, 0.1, 1.9, 0.9, 1.1, 0.9};
    sheet.AddUVChannel({0, 1, 2, 3, 4, 5, 6, 7}, {});
    sheet.cage.scheme = Sdc::SCHEME_BILINEAR;
    sheet.primvars = {{"x", 1, {0, 1, 2, 0, 1, 2}}};
    return sheet;
}

class MapPictures : public testing::Test {
protected:
    engine::BakeReport Bake(engine::Scene scene) {
        model = engine::Model::Build(std::move(scene));
        return engine::Bake(*model, options, job);
    }
    std::vector<std::string> Draw(engine::Scene scene) {
        auto const report = Bake(std::move(scene));
        return engine::WriteMapPictures(*model, options, report, kFromFront, job);
    }

    test::TemporaryFolder folder;
    engine::Job job;
    std::optional<engine::Model> model;
    engine::BakeOptions options = [&] {
        engine::BakeOptions made;
        made.pattern = folder / "{map}.<UDIM>.exr";
        made.maps = {"primvar:x"};
        made.width = made.height = 64;
        return made;
    }();
};

// The sheet lies from x = 3 to 97 and y = 26.5 to 73.5; its value is the distance from the left.
TEST_F(MapPictures, ShowTheMapWhereTheSurfaceIs) {
    auto const paths = Draw(MakeSheet());
    ASSERT_EQ(paths, std::vector{folder / "primvar_x.picture.png"});
    auto const picture = test::ReadPng(paths[0]);
    EXPECT_GT(picture.height, 100) << "a legend below";
    EXPECT_EQ(picture.At(50, 20), kBackground);
    EXPECT_EQ(picture.At(1, 50), kBackground);
    for (int x : {10, 40, 60, 90}) EXPECT_EQ(picture.At(x, 35), picture.At(x, 65)) << x;
    // From dark violet to yellow green rises, across the border of the tiles, too.
    for (int x = 6; x < 94; x += 4)
        EXPECT_LT(picture.At(x, 50)[1], picture.At(x + 4, 50)[1] + 1) << x;
    EXPECT_LT(picture.At(6, 50)[1] + 50, picture.At(94, 50)[1]);
}

TEST_F(MapPictures, WhatIsInNoTileIsGrey) {
    options.tiles = {1001};
    auto const picture = test::ReadPng(Draw(MakeSheet())[0]);
    EXPECT_FALSE(IsGrey(picture.At(25, 50)));
    EXPECT_TRUE(IsGrey(picture.At(75, 50)));
    EXPECT_NE(picture.At(75, 50), kBackground);
}

TEST_F(MapPictures, LayersOfAFileHaveOneEach) {
    options.pattern = folder / "all.<UDIM>.exr";
    options.maps = {"normal", "position"};
    EXPECT_EQ(Draw(MakeSheet()), (std::vector{folder / "all.normal.picture.png",
                                              folder / "all.position.picture.png"}));
}

// A range that is given is that of all pictures: the same value has the same colour.
TEST_F(MapPictures, KeepToARangeThatIsGiven) {
    options.previewRange = engine::PreviewRange::Parse("0,2");
    Colour const whole = test::ReadPng(Draw(MakeSheet())[0]).At(30, 50);
    options.tiles = {1001};
    EXPECT_EQ(test::ReadPng(Draw(MakeSheet())[0]).At(30, 50), whole);
    options.previewRange.reset();
    EXPECT_NE(test::ReadPng(Draw(MakeSheet())[0]).At(30, 50), whole);
}

TEST_F(MapPictures, HaveTheSameBytesForAnyNumberOfThreads) {
    options.maps = {"mean", "principal-direction"};
    auto const bytes = [&](int numThreads) {
        std::string all;
        test::WithThreads(numThreads, [&] {
            for (auto const& path : Draw(test::LoadSpot())) all += test::ReadText(path);
        });
        return all;
    };
    EXPECT_TRUE(bytes(1) == bytes(3));
}

// Floats have steps of half a unit there.
TEST_F(MapPictures, AreTheSameFarFromTheOrigin) {
    options.maps = {"overlap"};
    engine::Scene sheet = MakeSheet();
    std::string const near = test::ReadText(Draw(sheet)[0]);
    for (double& x : sheet.positions) x += 4e6;
    EXPECT_TRUE(near == test::ReadText(Draw(sheet)[0]));
}

TEST_F(MapPictures, AFlowHasNoColours) {
    options.maps = {"field"};
    options.field = std::vector<double>(7, 1.0);
    options.space = engine::VectorSpace::UV;
    engine::Scene sheet = MakeSheet();
    sheet.cage.scheme = Sdc::SCHEME_CATMARK;
    auto const report = Bake(std::move(sheet));
    EXPECT_EQ(
        test::CodeOf([&] { engine::WriteMapPictures(*model, options, report, kFromFront, job); }),
        ErrorCode::BadOption);
    EXPECT_FALSE(std::filesystem::exists(folder / "field.picture.png"));
}

TEST_F(MapPictures, GoWithTheFilesTheyWereMadeOf) {
    std::string const picture = Draw(MakeSheet())[0];
    options.skipsExisting = true;
    engine::RemoveMapPictures(*model, options, Bake(MakeSheet()));
    EXPECT_TRUE(std::filesystem::exists(picture)) << "the files are the same";
    options.skipsExisting = false;
    engine::RemoveMapPictures(*model, options, Bake(MakeSheet()));
    EXPECT_FALSE(std::filesystem::exists(picture));
}

TEST_F(MapPictures, NobodyElsesPictureIsRemoved) {
    auto const report = Bake(MakeSheet());
    std::string const other = folder / "primvar_x.picture.png";
    engine::AtomicFile file(other);
    engine::WritePng(file, engine::Picture(2, 2));
    file.Commit();
    engine::RemoveMapPictures(*model, options, report);
    EXPECT_TRUE(std::filesystem::exists(other));
}

}  // namespace
}  // namespace limn
