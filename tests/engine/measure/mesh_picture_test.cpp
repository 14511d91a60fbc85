// SPDX-License-Identifier: Apache-2.0
#include "engine/measure/mesh_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::Picture;
using engine::PictureView;
using Pixel = std::array<uint8_t, 3>;

Pixel const kBackground{38, 38, 38};

Pixel At(Picture const& picture, int x, int y) {
    uint8_t const* const pixel = picture.GetPixels() + 3 * (y * picture.GetWidth() + x);
    return {pixel[0], pixel[1], pixel[2]};
}

size_t Count(Picture const& picture, Pixel const& colour) {
    size_t count = 0;
    for (int y = 0; y < picture.GetHeight(); ++y) {
        for (int x = 0; x < picture.GetWidth(); ++x) count += At(picture, x, y) == colour;
    }
    return count;
}

std::set<Pixel> ListColours(Picture const& picture) {
    std::set<Pixel> colours;
    for (int y = 0; y < picture.GetHeight(); ++y) {
        for (int x = 0; x < picture.GetWidth(); ++x) colours.insert(At(picture, x, y));
    }
    return colours;
}

PictureView const kFromFront{{0.0, 0.0, 1.0}, 200};

// Seen from the front a cube is a square over 94 % of the picture, all in one grey.
TEST(MeshPicture, ACubeFromTheFrontIsASquare) {
    auto const picture = engine::DrawShaded(test::MakeCube(), kFromFront);
    EXPECT_EQ(picture.GetWidth(), 200);
    EXPECT_EQ(picture.GetHeight(), 200);
    EXPECT_EQ(Count(picture, kBackground), size_t{200 * 200 - 188 * 188});
    EXPECT_EQ(ListColours(picture).size(), 2u);
    EXPECT_EQ(At(picture, 5, 100), kBackground);
    EXPECT_NE(At(picture, 7, 100), kBackground);
}

// From a corner three sides are seen, each in its own grey.
TEST(MeshPicture, FlatShadingTellsSidesApart) {
    auto const picture = engine::DrawShaded(test::MakeCube(), {{1.0, 0.6, 0.8}, 200});
    EXPECT_EQ(ListColours(picture).size(), 4u);
}

// A plate behind the cube is not seen; before it, it is.
TEST(MeshPicture, WhatIsNearerHidesWhatIsBehind) {
    auto const plate = [](double z) {
        return test::MakeScene({-1, -1, z, 1, -1, z, 0, 1, z + 0.5}, {{0, 1, 2}});
    };
    auto const cube = engine::DrawShaded(test::MakeCube(), kFromFront);
    auto const draw = [&](double z) {
        return engine::DrawShaded(test::Join({test::MakeCube(), plate(z)}), kFromFront);
    };
    EXPECT_EQ(ListColours(draw(-3.0)), ListColours(cube));
    EXPECT_EQ(ListColours(draw(3.0)).size(), 3u);
}

TEST(MeshPicture, ValuesAreColouredFromVertexToVertex) {
    engine::Scene cube = test::MakeCube();
    cube.primvars = {{"height", 1, {}}};
    for (size_t i = 0; i < 8; ++i)
        cube.primvars[0].values.push_back(static_cast<float>(cube.positions[3 * i + 1]));
    auto const picture = engine::DrawValues(cube, {.name = "height"}, kFromFront);
    EXPECT_GT(picture.GetHeight(), 200);  // the legend
    for (int x : {20, 180}) {             // the same along a row, other ones from row to row
        EXPECT_EQ(At(picture, x, 40), At(picture, 100, 40));
        EXPECT_EQ(At(picture, x, 160), At(picture, 100, 160));
    }
    EXPECT_NE(At(picture, 100, 40), At(picture, 100, 160));
}

TEST(MeshPicture, ValuesMustBeThere) {
    engine::Scene cube = test::MakeCube();
    cube.primvars = {{"colour", 3, std::vector<float>(24, 0.5f)}};
    for (char const* name : {"mean", "colour"}) {
        EXPECT_EQ(test::CodeOf([&] { engine::DrawValues(cube, {.name = name}, kFromFront); }),
                  ErrorCode::BadOption)
            << name;
    }
}

// Two meshes in one range can be compared: their legends are the same, and so are equal values.
TEST(MeshPicture, ARangeIsShared) {
    engine::Scene cube = test::MakeCube();
    auto const range = engine::PreviewRange::Parse("-2,2");
    auto const draw = [&](float value) {
        cube.primvars = {{"height", 1, std::vector<float>(8, value)}};
        return engine::DrawValues(cube, {.name = "height"}, kFromFront, range);
    };
    auto const one = draw(1.0f), two = draw(2.0f);
    EXPECT_NE(At(one, 100, 100), At(two, 100, 100));
    ASSERT_EQ(one.GetHeight(), two.GetHeight());
    for (int y = 200; y < one.GetHeight(); ++y) {
        for (int x = 0; x < one.GetWidth(); ++x) ASSERT_EQ(At(one, x, y), At(two, x, y));
    }
}

// A plane reflects one height of the horizon all over; a sphere all of them, in 24 stripes.
TEST(MeshPicture, HighlightsAreStripesOnWhatIsRound) {
    auto const flat =
        engine::DrawHighlights(test::MakeLattice(4, 4, Sdc::SCHEME_CATMARK), kFromFront);
    EXPECT_EQ(flat.GetHeight(), 200) << "stripes have no range to tell";
    EXPECT_EQ(At(flat, 100, 50), At(flat, 60, 120));
    auto const sphere = engine::DrawHighlights(test::MakeQuadSphere(3), kFromFront);
    int numChanges = 0;
    bool wasBright = At(sphere, 100, 12)[1] > 128;
    for (int y = 13; y < 188; ++y) {
        bool const isBright = At(sphere, 100, y)[1] > 128;
        numChanges += isBright != wasBright;
        wasBright = isBright;
    }
    EXPECT_GT(numChanges, 20);
}

// Arrows are black, on the mesh only, and none stands where there is no vector.
TEST(MeshPicture, ArrowsStandWhereVectorsAre) {
    engine::Scene const cube = test::MakeCube();
    std::vector<std::array<double, 3>> vectors(8, {0.0, 0.0, 0.0});
    Pixel const black{0, 0, 0};
    EXPECT_EQ(Count(engine::DrawArrows(cube, vectors, kFromFront), black), 0u);
    vectors[6] = {1.0, 0.0, 0.0};  // the upper right corner of the front
    auto const picture = engine::DrawArrows(cube, vectors, kFromFront);
    EXPECT_GT(Count(picture, black), 0u);
    for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 200; ++x) {
            if (At(picture, x, y) != black) continue;
            EXPECT_LT(std::hypot(x - 194, y - 6), 10.0);
        }
    }
    EXPECT_EQ(Count(picture, kBackground), size_t{200 * 200 - 188 * 188});
}

// A line on the front is drawn, one on the back is hidden.
TEST(MeshPicture, LinesAreDrawnWhereTheyAreSeen) {
    engine::Scene const cube = test::MakeCube();
    double const front = cube.positions[3 * 6 + 2];
    Pixel const black{0, 0, 0};
    auto const draw = [&](double z) {
        return engine::DrawLines(cube, {{{-0.2, 0.0, z}, {0.2, 0.0, z}}}, kFromFront);
    };
    EXPECT_GT(Count(draw(front), black), 20u);
    EXPECT_EQ(Count(draw(-front), black), 0u);
}

TEST(MeshPicture, AViewNeedsADirection) {
    PictureView const nowhere{{0.0, 0.0, 0.0}, 200};
    engine::Scene const cube = test::MakeCube();
    EXPECT_EQ(test::CodeOf([&] { engine::DrawShaded(cube, nowhere); }), ErrorCode::BadOption);
    EXPECT_EQ(test::CodeOf([&] { engine::DrawHighlights(cube, nowhere); }), ErrorCode::BadOption);
    EXPECT_EQ(test::CodeOf([&] { engine::DrawArrows(cube, {}, nowhere); }), ErrorCode::BadOption);
}

}  // namespace
}  // namespace limn
