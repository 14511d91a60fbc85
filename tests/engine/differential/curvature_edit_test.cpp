// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/curvature_edit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/differential/differential.h"
#include "engine/scene/refine.h"
#include "far_ext/differential/butterfly.h"
#include "far_ext/differential/laplacian.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using engine::CurvatureEdit;
using engine::DifferentialOptions;

engine::DifferentialResult Refine(engine::Scene const& scene, CurvatureEdit const& edit,
                                  DifferentialOptions options = {}) {
    options.edit = edit;
    options.tolerance = 1e-12;
    engine::Job job;
    return engine::RefineDifferentially(engine::Model::Build(scene), options, job);
}

/// A flat plate of 20 x 20 unit quads, and the 81 vertices in its middle; vertex (i, j) is
/// 21 j + i.
engine::Scene MakePlate() {
    return test::MakeLattice(20, 20, Sdc::SCHEME_CATMARK);
}
std::vector<Index> ListMiddle() {
    std::vector<Index> vertices;
    for (int j = 6; j <= 14; ++j) {
        for (int i = 6; i <= 14; ++i) vertices.push_back(21 * j + i);
    }
    return vertices;
}
constexpr Index kMiddle = 21 * 10 + 10;

CurvatureEdit BendMiddle(double mean) {
    CurvatureEdit edit;
    for (Index vertex : ListMiddle()) edit.means.push_back({vertex, mean});
    return edit;
}

double GetHeight(engine::Scene const& scene, Index vertex) {
    return scene.positions[3 * static_cast<size_t>(vertex) + 2];
}

// Level 0 alone shows the equation: v - mean of neighbours is mean times half a squared edge where
// asked for, along the plate's normal, and stays 0 elsewhere.
TEST(CurvatureEdit, BendsAFlatPlateByWhatWasSet) {
    auto const plate = MakePlate();
    auto const bent = Refine(plate, BendMiddle(0.05), {.levels = 0}).mesh;
    auto const middle = ListMiddle();
    for (int j = 1; j < 20; ++j) {
        for (int i = 1; i < 20; ++i) {
            Index const v = 21 * j + i;
            double const mean = 0.25 * (GetHeight(bent, v - 1) + GetHeight(bent, v + 1) +
                                        GetHeight(bent, v - 21) + GetHeight(bent, v + 21));
            bool const isSet = std::ranges::count(middle, v) > 0;
            EXPECT_NEAR(GetHeight(bent, v) - mean, isSet ? 0.025 : 0.0, 1e-11);
        }
    }
    EXPECT_GT(GetHeight(bent, kMiddle), 1.0);
    for (size_t i = 0; i < plate.positions.size(); ++i) {
        if (i % 3 == 2) continue;
        EXPECT_NEAR(bent.positions[i], plate.positions[i], 1e-12);
    }
}

TEST(CurvatureEdit, WhatWasSetIsReachedInsideABentPlate) {
    auto const found = Refine(MakePlate(), BendMiddle(0.05), {.levels = 2}).report.edits;
    ASSERT_EQ(found.size(), 81u);
    for (auto const& [target, reached] : found) {
        int const i = target.vertex % 21, j = target.vertex / 21;
        if (std::max(std::abs(i - 10), std::abs(j - 10)) > 2) continue;  // the rim is smoothed
        EXPECT_EQ(std::get<double>(target.asked), 0.05);
        EXPECT_NEAR(reached.value(), 0.05, 0.004);
    }
}

TEST(CurvatureEdit, SeenFromTheOtherSideAPlateBendsTheOtherWay) {
    auto const right = Refine(MakePlate(), BendMiddle(0.05)).mesh,
               left =
                   Refine(MakePlate(), BendMiddle(0.05), {.orientation = Orientation::Left}).mesh;
    EXPECT_NEAR(GetHeight(left, kMiddle), -GetHeight(right, kMiddle), 1e-10);
}

// Nothing times a factor is nothing.
TEST(CurvatureEdit, FactorsAloneLeaveAPlateFlat) {
    CurvatureEdit edit;
    for (Index vertex : ListMiddle()) edit.factors.push_back({vertex, 40.0});
    auto const mesh = Refine(MakePlate(), edit).mesh;
    for (size_t i = 2; i < mesh.positions.size(); i += 3) EXPECT_NEAR(mesh.positions[i], 0, 1e-12);
}

// The equation is linear: turning all that is asked for by 20 degrees turns all moves by them.
TEST(CurvatureEdit, TiltedNormalsTiltTheMoves) {
    double const tilt = 20.0 * std::numbers::pi / 180.0;
    auto const plate = MakePlate();
    auto edit = BendMiddle(0.05);
    auto const upright = Refine(plate, edit, {.levels = 0}).mesh;
    for (Index vertex : ListMiddle())
        edit.normals.push_back({vertex, {3.0 * std::sin(tilt), 0.0, 3.0 * std::cos(tilt)}});
    auto const tilted = Refine(plate, edit, {.levels = 0}).mesh;
    for (Index v = 0; v < plate.cage.numVertices; ++v) {
        double const height = GetHeight(upright, v);
        EXPECT_NEAR(GetHeight(tilted, v), height * std::cos(tilt), 1e-11);
        EXPECT_NEAR(tilted.positions[3 * static_cast<size_t>(v)],
                    plate.positions[3 * static_cast<size_t>(v)] + height * std::sin(tilt), 1e-11);
    }
}

/// Deltas of a mesh, an edit applied to them, and what it asked for.
struct Edited {
    std::vector<double> before, after;
    std::vector<engine::EditTarget> targets;
};

Edited Apply(engine::Scene const& scene, CurvatureEdit const& edit) {
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const level = refiner->GetLevel(0);
    Edited edited;
    edited.before =
        far_ext::FindDeltas(far_ext::BuildCombinatorialLaplacian(level), scene.positions);
    edited.after = edited.before;
    edited.targets = engine::ApplyEdit(
        edit, {level, scene.positions, engine::FindCombinatorialLengths(level, scene.positions)},
        "mesh.obj", edited.after);
    return edited;
}

engine::Scene MakeBumpy() {
    auto scene = test::MakeIcosphere(1);
    for (size_t i = 0; i < scene.positions.size(); ++i)
        scene.positions[i] *= 1.0 + 0.1 * std::sin(static_cast<double>(i / 3));
    return scene;
}

/// An icosahedron whose edges are cut in the middle three times, each time out to the sphere: edges
/// are as even as triangles on a sphere have them.
engine::Scene MakeEvenSphere() {
    auto sphere = test::MakeIcosphere(0);
    for (int level = 0; level < 3; ++level) {
        auto const refiner = test::MakeRefiner(sphere, 1);
        auto points =
            test::Apply(far_ext::BuildOriginalButterfly(*refiner, 1, 0.0), sphere.positions);
        for (size_t i = 0; i < points.size(); i += 3) {
            double const length = std::hypot(points[i], points[i + 1], points[i + 2]);
            for (size_t c = 0; c < 3; ++c) points[i + c] /= length;
        }
        sphere = test::Refine(sphere, 1);
        sphere.positions = points;
    }
    return sphere;
}

// Along the normal a coordinate of a sphere of radius r is 1/r times half a squared edge, so that a
// factor of 1 asks for 1/r, but for normals that are not quite the sphere's.
TEST(CurvatureEdit, KnowsTheCurvatureOfSpheres) {
    for (double radius : {1.0, 3.0}) {
        auto scene = MakeEvenSphere();
        for (double& x : scene.positions) x *= radius;
        CurvatureEdit edit;
        for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex)
            edit.factors.push_back({vertex, 1.0});
        for (auto const& target : Apply(scene, edit).targets)
            EXPECT_NEAR(std::get<double>(target.asked) * radius, 1.0, 0.004);
    }
}

TEST(CurvatureEdit, UnnamedVerticesKeepTheirBits) {
    CurvatureEdit edit;
    edit.means = {{3, 0.7}};
    edit.factors = {{5, 2.0}};
    edit.normals = {{7, {0, 1, 1}}};
    edit.rotations = {{9, {1, 2, 3}, 25.0}};
    auto const [before, after, targets] = Apply(MakeBumpy(), edit);
    for (size_t i = 0; i < before.size(); ++i) {
        bool const isNamed = i / 3 == 3 || i / 3 == 5 || i / 3 == 7 || i / 3 == 9;
        if (isNamed) continue;
        EXPECT_EQ(after[i], before[i]);
    }
    ASSERT_EQ(targets.size(), 4u);
    for (size_t i = 0; i < 4; ++i) EXPECT_EQ(targets[i].vertex, static_cast<Index>(3 + 2 * i));
}

// A factor multiplies what was set; a rotation turns the normal that was set.
TEST(CurvatureEdit, ListsActInTheirOrder) {
    CurvatureEdit inSteps, atOnce;
    inSteps.means = {{3, 0.4}};
    inSteps.factors = {{3, 1.5}, {3, -2.0}};
    inSteps.normals = {{3, {0, 0, 2}}};
    inSteps.rotations = {{3, {1, 0, 0}, -90.0}};
    atOnce.means = {{3, -1.2}};
    atOnce.normals = {{3, {0, 5, 0}}};
    auto const scene = MakeBumpy();
    auto const a = Apply(scene, inSteps), b = Apply(scene, atOnce);
    EXPECT_LT(test::LargestDifference(a.after, b.after), 1e-15);
    ASSERT_EQ(a.targets.size(), 2u);
    EXPECT_NEAR(std::get<double>(a.targets[0].asked), -1.2, 1e-15);
    EXPECT_NEAR((std::get<std::array<double, 3>>(a.targets[1].asked)[1]), 1.0, 1e-15);
}

/// Signed lengths of deltas, as the filter sees them.
std::vector<double> FindMagnitudes(engine::Scene const& scene, std::vector<double> const& deltas) {
    std::vector<double> magnitudes;
    for (size_t i = 0; i < deltas.size(); i += 3) {
        double const length = std::hypot(deltas[i], deltas[i + 1], deltas[i + 2]);
        double out = 0.0;  // a sphere's normal is its point
        for (size_t c = 0; c < 3; ++c) out += deltas[i + c] * scene.positions[i + c];
        magnitudes.push_back(out > 0.0 ? length : -length);
    }
    return magnitudes;
}

TEST(CurvatureEdit, AFilterOfTheDiagonalChangesNothing) {
    CurvatureEdit edit;
    edit.filterPoints = {{0.0, 0.0}, {1.0, 1.0}};
    auto const [before, after, targets] = Apply(MakeBumpy(), edit);
    EXPECT_LT(test::LargestDifference(before, after), 1e-15);
    EXPECT_TRUE(targets.empty());
}

// The filter comes last, and its curve acts on the range as lists have left it.
TEST(CurvatureEdit, AFilterKeepsTheRangeAndComesLast) {
    auto const scene = MakeBumpy();
    CurvatureEdit edit;
    edit.means = {{3, 4.0}};
    auto const unfiltered = FindMagnitudes(scene, Apply(scene, edit).after);
    edit.filterPoints = {{0.0, 0.0}, {0.5, 0.1}, {1.0, 1.0}};
    auto const filtered = FindMagnitudes(scene, Apply(scene, edit).after);
    auto const [low, high] = std::ranges::minmax(unfiltered);
    EXPECT_NEAR(std::ranges::min(filtered), low, 1e-14);
    EXPECT_NEAR(filtered[3], high, 1e-14);  // the vertex that was set has the most
    for (size_t i = 0; i < filtered.size(); ++i)
        EXPECT_LE(filtered[i], unfiltered[i] + 1e-14);  // the curve lies below the diagonal
}

TEST(CurvatureEdit, EndlessCoordinatesAreRefusedByVertex) {
    for (double mean : {1e60, 1.7e308, -1.7e308}) {
        CurvatureEdit edit;
        edit.means = {{4, mean}};
        auto const error = test::CatchError([&] { Apply(MakeBumpy(), edit); });
        ASSERT_TRUE(error);
        EXPECT_EQ(error->GetCode(), ErrorCode::BadMesh);
        EXPECT_NE(std::string(error->what()).find("vertex 4"), std::string::npos);
    }
}

// Boundary vertices have no mean curvature that could be measured; normals they have.
TEST(CurvatureEdit, OnABoundaryOnlyNormalsAreMeasured) {
    CurvatureEdit edit;
    edit.means = {{0, 0.1}};
    edit.normals = {{0, {0, 0, 1}}};
    auto const found = Refine(MakePlate(), edit).report.edits;
    ASSERT_EQ(found.size(), 2u);
    EXPECT_FALSE(found[0].reached);
    EXPECT_TRUE(found[1].reached);
}

// Asked for what is there, a normal is met; turned by some degrees, the angle tells how far off.
TEST(CurvatureEdit, NormalsAreMeasuredInDegrees) {
    auto const scene = test::MakeIcosphere(2);
    double const* const p = &scene.positions[3 * 20];
    Eigen::Vector3d const there(p[0], p[1], p[2]),
        turned = Eigen::AngleAxisd(0.5, there.unitOrthogonal()) * there;
    for (auto const& [normal, degrees] : {std::pair{there, 0.0}, std::pair{turned, 28.6}}) {
        CurvatureEdit edit;
        edit.normals = {{20, {normal[0], normal[1], normal[2]}}};
        auto const found = Refine(scene, edit).report.edits;
        ASSERT_EQ(found.size(), 1u);
        EXPECT_GE(found[0].reached.value(), 0.0);
        EXPECT_NEAR(found[0].reached.value(), degrees, degrees == 0.0 ? 0.5 : 15.0);
    }
}

// Coordinates by areas are twice the mean curvature, whatever lengths edges have.
TEST(CurvatureEdit, MeansAreMeansForLaplaciansThatKnowAreas) {
    CurvatureEdit edit;
    edit.factors = {{20, 1.0}};
    auto const found = Refine(test::MakeIcosphere(2), edit,
                              {.laplacian = engine::Laplacian::Cotangent, .fitTolerance = 0.1})
                           .report.edits;
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(std::get<double>(found[0].target.asked), 1.0, 0.02);
    EXPECT_NEAR(found[0].reached.value(), 1.0, 0.1);
}

}  // namespace
}  // namespace limn
