// SPDX-License-Identifier: Apache-2.0
//
// Smooth with triangles cut only where it asks for them.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/smooth/smooth.h"
#include "support/adaptive_meshes.h"
#include "support/cascade_meshes.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::ConstantWidth;
using engine::Job;
using engine::Model;
using engine::SmoothOptions;

engine::SmoothResult Smooth(engine::Scene const& scene, engine::FilterWidths const& widths,
                            SmoothOptions const& options) {
    Job job;
    return engine::Smooth(Model::Build(scene), widths, options, job);
}

engine::SmoothResult Adapt(engine::Scene const& scene, double width, double error, int levels = 8) {
    return Smooth(scene, ConstantWidth{width}, {.levels = levels, .adaptive = error});
}

void ExpectConforming(engine::Scene const& scene, bool isClosed) {
    for (int size : scene.cage.faceSizes) ASSERT_EQ(size, 3);
    for (auto const& [edge, count] : test::CountFacesAtEdges(scene.cage.faceVertices)) {
        EXPECT_LE(count, 2);
        EXPECT_GE(count, isClosed ? 2 : 1);
    }
}

/// The uniform cascade, settled.
engine::Scene MakeUniform(engine::Scene const& scene, double width, int levels) {
    return Smooth(scene, ConstantWidth{width}, {.levels = levels, .settle = 1e-4}).mesh.value();
}

// The error is to the settled uniform result, which itself is off by about a third of what the last
// level changed, as errors fall by four with each.
TEST(Adaptive, MeetsItsErrorWithFewerVertices) {
    struct Case {
        engine::Scene scene;
        double share;  // of the width in the diagonal
        int levels;
    };
    for (auto const& [scene, share, levels] :
         {Case{test::MakeTriangleCube(), 0.029, 5}, Case{test::MakeWindowFrame(), 0.02, 4}}) {
        double const diagonal = test::BoxDiagonal(scene.positions), asked = 1.5e-3,
                     width = share * diagonal;
        auto const found = Adapt(scene, width, asked);
        auto const& adaption = found.report.adaption.value();
        auto const finest = MakeUniform(scene, width, levels),
                   finer = MakeUniform(scene, width, levels - 1);
        double const reach = 0.02 * diagonal,
                     last = test::FindLargestDistance(finer, finest, reach) / diagonal,
                     error = test::FindLargestDistance(*found.mesh, finest, reach) / diagonal;
        EXPECT_LE(error, asked + last / 3);
        EXPECT_LE(adaption.estimated, 1.2 * asked);
        EXPECT_EQ(adaption.vertices, found.mesh->cage.numVertices);
        EXPECT_LT(3 * adaption.vertices, adaption.uniformVertices);
        ExpectConforming(*found.mesh, true);
    }
}

TEST(Adaptive, LessErrorTakesMoreVertices) {
    auto const cube = test::MakeTriangleCube();
    Index last = 0;
    for (double error : {1e-2, 4e-3, 2e-3}) {
        auto const found = Adapt(cube, 0.1, error);
        EXPECT_GT(found.report.adaption->vertices, last);
        EXPECT_GT(found.report.adaption->smallestEdge, 0.0);
        last = found.report.adaption->vertices;
        // What is left to move is a geometric series, and below a fifth of the error.
        EXPECT_LT(found.report.settleMoves.back(), error / 5);
    }
}

TEST(Adaptive, WhereNothingBendsNothingIsCut) {
    auto flat = test::LoadMesh("gridholetri");
    for (size_t i = 2; i < flat.positions.size(); i += 3) flat.positions[i] = 0.0;
    auto const found = Adapt(flat, 0.1, 1e-4);
    EXPECT_EQ(found.report.adaption->passes, 0);
    EXPECT_EQ(found.mesh->cage.numVertices, flat.cage.numVertices);
    auto const still = Adapt(test::MakeTriangleCube(), 0.0, 1e-4);
    EXPECT_EQ(still.report.adaption->passes, 0);
    EXPECT_EQ(still.mesh->positions, test::MakeTriangleCube().positions);
}

TEST(Adaptive, BoundariesStayWhereTheyWere) {
    auto scene = test::LoadMesh("gridholetri");
    for (size_t i = 0; i < scene.positions.size(); i += 3)
        scene.positions[i + 2] = 0.3 * std::sin(2.0 * scene.positions[i]);
    auto const found = Adapt(scene, 0.4, 2e-3);
    EXPECT_GT(found.report.adaption->passes, 0);
    ExpectConforming(*found.mesh, false);
    // Each boundary vertex lies on the start mesh.
    auto const model = Model::Build(*found.mesh);
    test::TriangleGrid const start(scene, 0.1);
    for (Index vertex = 0; vertex < found.mesh->cage.numVertices; ++vertex) {
        if (!model.GetLevel().IsVertexBoundary(vertex)) continue;
        EXPECT_LT(start.FindDistance(test::PointAt(found.mesh->positions, vertex)), 1e-12);
    }
}

TEST(Adaptive, ComponentsAndPlacesDoNotMatter) {
    auto const cube = test::MakeTriangleCube();
    auto other = test::MakeIcosphere(1);
    auto const shift = [](engine::Scene scene, double x) {
        for (size_t i = 0; i < scene.positions.size(); i += 3) scene.positions[i] += x;
        return scene;
    };
    auto const both = Adapt(test::Join({cube, other}), 0.1, 2e-3);
    ExpectConforming(*both.mesh, true);
    auto const far = Adapt(shift(cube, 4e6), 0.1, 2e-3), near = Adapt(cube, 0.1, 2e-3);
    EXPECT_EQ(far.mesh->cage.faceVertices, near.mesh->cage.faceVertices);
    EXPECT_LT(test::LargestDifference(shift(*far.mesh, -4e6).positions, near.mesh->positions),
              1e-7);
}

TEST(Adaptive, OnlyEdgesWithAWidthAreCut) {
    auto const cube = test::MakeTriangleCube();
    auto const model = Model::Build(cube);
    Job job;
    engine::EdgeWidths const widths(model, {{{0, 1}, 0.1}});
    auto const found = engine::Smooth(model, widths, {.levels = 8, .adaptive = 2e-3}, job);
    ExpectConforming(*found.mesh, true);
    auto const all = Adapt(cube, 0.1, 2e-3);
    EXPECT_LT(2 * found.report.adaption->vertices, all.report.adaption->vertices);
    EXPECT_LE(found.report.adaption->estimated, 1.2 * 2e-3);
}

TEST(Adaptive, LocalWidthsAreFilteredAlong) {
    auto const model = Model::Build(test::MakeTriangleCube());
    Job job;
    auto const found =
        engine::Smooth(model, engine::MakeLocalWidths(model, 0.05), {.adaptive = 4e-3}, job);
    ASSERT_TRUE(found.mesh);
    for (float width : found.mesh->primvars.back().values) {
        EXPECT_GT(width, 0.05f);
        EXPECT_LT(width, 0.15f);
    }
}

TEST(Adaptive, WhatTheDepthCannotReachIsWarnedOf) {
    test::Listener host;
    Job job(host.MakeHost());
    auto const found = engine::Smooth(Model::Build(test::MakeTriangleCube()), ConstantWidth{0.1},
                                      {.levels = 2, .adaptive = 1e-3}, job);
    ASSERT_TRUE(found.mesh);
    EXPECT_EQ(found.report.adaption->passes, 4);
    EXPECT_GT(found.report.adaption->estimated, 1e-3);
    ASSERT_FALSE(host.warnings.empty());
    EXPECT_NE(host.warnings.front().find("4 passes of bisection leave an error"), std::string::npos)
        << host.warnings.front();
}

TEST(Adaptive, NeedsTriangles) {
    EXPECT_NE(test::RefusalOf([] { Adapt(test::MakeCube(), 0.1, 1e-2); }).find("4 corners"),
              std::string::npos);
}

TEST(Adaptive, StopsWhereItsHostWants) {
    EXPECT_TRUE(test::StopsHalfway([](Job& job) {
        engine::Smooth(Model::Build(test::MakeTriangleCube()), ConstantWidth{0.1},
                       {.levels = 6, .adaptive = 2e-3}, job);
    }));
}

}  // namespace
}  // namespace limn
