// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/places.h"

#include <cmath>
#include <limits>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::LocatePlaces;
using engine::Model;

/// Vertices 0 to 6 as one face, on an arc.
Model MakePolygon(int size) {
    std::vector<double> positions;
    std::vector<Index> face;
    for (int i = 0; i < size; ++i) {
        positions.insert(positions.end(), {std::cos(0.5 * i), std::sin(0.5 * i), 0.0});
        face.push_back(i);
    }
    return Model::Build(test::MakeScene(std::move(positions), {face}));
}

std::vector<eval::SurfacePlace> Locate(Model const& model, std::vector<Index> const& faces,
                                       std::vector<double> const& s, std::vector<double> const& t) {
    return LocatePlaces(model, {faces, s, t});
}

TEST(Places, OfQuadsAreTheirOwnDomain) {
    auto const found = Locate(Model::Build(test::MakeCube()), {5, 0}, {0.25, 1.0}, {0.75, 0.0});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].face, 5);
    EXPECT_EQ(found[0].domain, 0);
    EXPECT_EQ(found[0].s, 0.25);
    EXPECT_EQ(found[0].t, 0.75);
    EXPECT_EQ(found[1].face, 0);
}

// A pentagon's sub-faces are tiles of half a unit in rows of three: corner 4 is the second of the
// second row.
TEST(Places, OfPolygonsLieInTheTileOfACorner) {
    auto const found = Locate(MakePolygon(5), {0, 0}, {0.0, 1.25}, {0.0, 1.125});
    EXPECT_EQ(found[0].domain, 0);
    EXPECT_EQ(found[0].s, 0.0);
    EXPECT_EQ(found[1].domain, 4);
    EXPECT_EQ(found[1].s, 0.5);
    EXPECT_EQ(found[1].t, 0.25);
}

// There and back: coordinates of a place are those that locate it.
TEST(Places, HaveTheCoordinatesThatLocateThem) {
    for (int size : {4, 5, 7}) {
        Model const model = MakePolygon(size);
        for (int domain = 0; domain < (size == 4 ? 1 : size); ++domain) {
            auto const [s, t] = FindCoordinates(model, {0, domain, 0.25, 0.625});
            auto const found = Locate(model, {0}, {s}, {t}).at(0);
            EXPECT_EQ(found.domain, domain);
            EXPECT_EQ(found.s, 0.25);
            EXPECT_EQ(found.t, 0.625);
        }
    }
}

struct Outside {
    char const* name;
    int faceSize;
    double s, t;
};
void PrintTo(Outside const& outside, std::ostream* stream) {
    *stream << outside.name;
}
class OutsidePlaces : public testing::TestWithParam<Outside> {};

TEST_P(OutsidePlaces, AreRefusedByTheirNumber) {
    auto const [name, faceSize, s, t] = GetParam();
    Model const model = MakePolygon(faceSize);
    try {
        Locate(model, {0, 0, 0}, {0.1, s, 0.2}, {0.1, t, 0.2});
        FAIL() << "no error";
    } catch (engine::PlaceError const& error) {
        EXPECT_EQ(error.GetCode(), ErrorCode::BadMesh);
        EXPECT_EQ(error.GetPlace(), 1u);
        EXPECT_EQ("place 1: " + error.GetReason(), error.what());
        EXPECT_NE(error.GetReason().find("lies outside face 0, which has " +
                                         std::to_string(faceSize) + " corners"),
                  std::string::npos);
    }
}

double const kNaN = std::numeric_limits<double>::quiet_NaN(),
             kInfinity = std::numeric_limits<double>::infinity();
INSTANTIATE_TEST_SUITE_P(
    , OutsidePlaces,
    testing::Values(Outside{"QuadRight", 4, 1.01, 0.5}, Outside{"QuadLeft", 4, -0.01, 0.5},
                    Outside{"QuadAbove", 4, 0.5, 1.01}, Outside{"QuadNaN", 4, kNaN, 0.5},
                    Outside{"QuadInfinite", 4, 0.5, kInfinity},
                    Outside{"BetweenTiles", 5, 0.75, 0.25}, Outside{"BesideTheRows", 5, 3.0, 0.25},
                    Outside{"AboveTheRows", 5, 0.25, 7.0}, Outside{"NoSixthTile", 5, 2.25, 1.25},
                    Outside{"TileNaN", 5, 0.25, kNaN}, Outside{"TileLeft", 5, -0.25, 0.25},
                    Outside{"TileInfinite", 5, kInfinity, 0.25}),
    [](auto const& instance) { return std::string(instance.param.name); });

TEST(Places, OfTrianglesEndAtTheirDiagonal) {
    Model const model =
        Model::Build(test::MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 2}}, Sdc::SCHEME_LOOP));
    EXPECT_EQ(Locate(model, {0}, {0.5}, {0.5}).size(), 1u);
    EXPECT_EQ(test::CodeOf([&] { Locate(model, {0}, {0.75}, {0.5}); }), ErrorCode::BadMesh);
}

TEST(Places, OnFacesThatAreNotThereAreRefusedByTheirNumber) {
    Model const model = Model::Build(test::MakeCube());
    for (Index face : {-1, 6, std::numeric_limits<Index>::max()}) {
        EXPECT_EQ(test::RefusalOf([&] { Locate(model, {0, 1, face}, {0, 0, 0}, {0, 0, 0}); }),
                  "place 2: face " + std::to_string(face) + " does not exist; faces are 0 to 5");
    }
}

TEST(Places, NeedArraysOfOneLength) {
    Model const model = Model::Build(test::MakeCube());
    EXPECT_EQ(test::CodeOf([&] { Locate(model, {0, 1}, {0.5}, {0.5, 0.5}); }),
              ErrorCode::BadOption);
    EXPECT_EQ(test::CodeOf([&] { Locate(model, {0, 1}, {0.5, 0.5}, {0.5}); }),
              ErrorCode::BadOption);
    EXPECT_EQ(test::CodeOf([&] { Locate(model, {}, {0.5}, {0.5}); }), ErrorCode::BadOption);
}

}  // namespace
}  // namespace limn
