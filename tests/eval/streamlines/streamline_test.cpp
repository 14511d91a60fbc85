// SPDX-License-Identifier: Apache-2.0
#include "eval/streamlines/streamline.h"

#include <cmath>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "eval/surface/surface_sample.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/rows/points.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"
#include "support/streamlines.h"
#include "support/threads.h"

namespace limn {
namespace {

using eval::FlowSurface;
using eval::SurfacePlace;

/// A place on each face, off its middle.
std::vector<SurfacePlace> MakeSeeds(FlowSurface const& flow) {
    std::vector<SurfacePlace> seeds;
    for (Index face = 0; face < flow.GetLevel().GetNumFaces(); ++face) {
        if (flow.GetSurface().HasLimit(face)) seeds.push_back({face, 0, 0.3, 0.4});
    }
    return seeds;
}

/// d0 of a function, on all edges of a cage.
std::vector<double> MakeGradient(engine::Scene const& scene, std::vector<double> const& values) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    return far_ext::BuildD0(refiner->GetLevel(0)).Apply(values);
}

std::vector<engine::Scene> MakeScenes() {
    return {test::MakeQuadSphere(2),  test::MakeIcosphere(2),
            test::MakeTorus(12, 8),   test::MakeGridWithHole(9, 7),
            test::MakeDodecahedron(), test::MakeIrregularTriangles(9, 8, 3)};
}

// A line of V = grad f has df = |V| ds > 0, where V is exact; where it is blended, next to
// irregular vertices, nearly so.
TEST(Streamline, OfAGradientRises) {
    for (auto const& scene : MakeScenes()) {
        auto const values = test::MakeSmoothFunction(scene);
        FlowSurface const flow(scene.cage, scene.positions, MakeGradient(scene, values));
        auto const lines =
            TraceStreamlines(flow, MakeSeeds(flow), test::MakeStreamlineOptions(flow, 0.1));
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        eval::LimitSurface const surface(*refiner);
        eval::FaceTree tree(surface, values, 1);
        size_t numSteps = 0;
        for (auto const& line : lines) {
            ASSERT_FALSE(line.isClosed);
            double last = -1e300;
            for (auto const& point : line.points) {
                auto const place = flow.FindOnCage(point.place);
                if (tree.GetFace() != place.face) tree.Bind(place.face);
                double const value = EvaluateChannel(tree, place.domain, place.s, place.t, 0);
                EXPECT_GT(value, last) << place.face;
                last = value;
                ++numSteps;
            }
        }
        EXPECT_GT(numSteps, 10 * lines.size());
    }
}

TEST(Streamline, LiesOnTheLimitAndMeasuresItself) {
    for (auto const& scene : MakeScenes()) {
        FlowSurface const flow(scene.cage, scene.positions,
                               MakeGradient(scene, test::MakeSmoothFunction(scene)));
        auto const options = test::MakeStreamlineOptions(flow, 0.1);
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        eval::LimitSurface const surface(*refiner);
        eval::FaceTree tree(surface, scene.positions, 3);
        double const diagonal = test::BoxDiagonal(scene.positions);
        for (auto const& line : TraceStreamlines(flow, MakeSeeds(flow), options)) {
            for (size_t i = 0; i < line.points.size(); ++i) {
                auto const place = flow.FindOnCage(line.points[i].place);
                tree.Bind(place.face);
                auto const here = EvaluateDerivatives(tree, place.domain, place.s, place.t);
                EXPECT_LT((here.position - line.points[i].position).norm(), 1e-9 * diagonal);
                if (i == 0) continue;
                double const length = line.points[i].length - line.points[i - 1].length,
                             chord = (line.points[i].position - line.points[i - 1].position).norm();
                EXPECT_LE(chord, 1.01 * length + 1e-3 * options.step);
                // Directions within a step differ by up to 60 degrees.
                EXPECT_GE(chord, 0.9 * length - 1e-3 * options.step);
                EXPECT_LE(length, options.step * (1.0 + 1e-12));
            }
            EXPECT_EQ(line.points[0].length, 0.0);
        }
    }
}

// Mirror planes through the axis turn a rotation round; so whatever the limit's metric, a line that
// comes from one mirror plane to the next goes on as its mirror image, and every line is closed.
TEST(Streamline, OfARotationCloses) {
    for (auto const& scene : {test::MakeQuadSphere(2), test::MakeIcosphere(2)}) {
        // A corner of valence 3 or 5, round which both meshes are mirror images of themselves.
        Eigen::Vector3d const axis = far_ext::Points(scene.positions)[0];
        FlowSurface const flow(scene.cage, scene.positions, test::MakeRotationForm(scene, axis));
        size_t const count = 40;
        auto seeds = MakeSeeds(flow);
        for (size_t i = 0; i < count; ++i) seeds[i] = seeds[i * seeds.size() / count];
        seeds.resize(count);
        auto options = test::MakeStreamlineOptions(flow, 0.05);
        options.maxLength = 20.0;
        for (auto const& line : TraceStreamlines(flow, seeds, options)) {
            EXPECT_TRUE(line.isClosed);
            EXPECT_EQ(line.ends, std::vector{eval::StreamEnd::Closed});
        }
    }
}

// The end of a line of fixed length, against that of very short steps: half the step, a sixteenth
// of the error.
TEST(Streamline, ConvergesWithTheOrderOfRungeAndKutta) {
    for (auto const& scene : {test::MakeTorus(12, 8), test::MakeTriangleTorus(12, 8)}) {
        FlowSurface const flow(scene.cage, scene.positions,
                               test::MakeRotationForm(scene, {0.1, 0.3, 1.0}));
        double errors[2] = {0.0, 0.0};
        for (SurfacePlace const& seed : {SurfacePlace{5, 0, 0.3, 0.3},
                                         {17, 0, 0.3, 0.4},
                                         {40, 0, 0.2, 0.3},
                                         {60, 0, 0.1, 0.4}}) {
            auto const walk = [&](double step) {
                eval::StreamTracer tracer(flow, step, 1e-9);
                Eigen::Vector3d end = Eigen::Vector3d::Zero();
                auto const stopped = tracer.Walk(seed, eval::Heading::Forward, 2.0,
                                                 [&](eval::StreamPoint const& point) {
                                                     end = point.position;
                                                     return true;
                                                 });
                EXPECT_EQ(stopped, eval::StreamEnd::Length);
                return end;
            };
            Eigen::Vector3d const exact = walk(0.002);
            errors[0] += (walk(0.1) - exact).norm();
            errors[1] += (walk(0.05) - exact).norm();
        }
        EXPECT_LT(errors[0], 1e-4);
        EXPECT_GT(errors[0], 8.0 * errors[1]);
    }
}

// The boundary of a flat ring under a field along x.
TEST(Streamline, EndsAtABoundary) {
    auto const scene = test::MakeLattice(6, 5, Sdc::SCHEME_CATMARK);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const form = test::MakeCoordinateForm(refiner->GetLevel(0), scene.positions, 0);
    FlowSurface const flow(scene.cage, scene.positions, form);
    auto options = test::MakeStreamlineOptions(flow, 0.25);
    for (auto const& line : TraceStreamlines(flow, MakeSeeds(flow), options)) {
        EXPECT_EQ(line.ends, (std::vector{eval::StreamEnd::Boundary, eval::StreamEnd::Boundary}));
        EXPECT_NEAR(line.points.front().position.x(), 0.0, 1e-9);
        EXPECT_NEAR(line.points.back().position.x(), 6.0, 1e-9);
        EXPECT_NEAR(line.length, 6.0, 1e-9);
        for (auto const& point : line.points)
            EXPECT_NEAR(point.position.y(), line.points[0].position.y(), 1e-9);
    }
    // Along the very lines of the lattice, from vertex to vertex.
    options.isForwardOnly = true;
    auto const line = TraceStreamlines(flow, std::vector{SurfacePlace{7, 0, 0.0, 0.0}}, options)[0];
    EXPECT_EQ(line.ends, std::vector{eval::StreamEnd::Boundary});
    EXPECT_NEAR(line.points.back().position.x(), 6.0, 1e-9);
    EXPECT_NEAR(line.points.back().position.y(), line.points[0].position.y(), 1e-9);
}

TEST(Streamline, IsNoLongerThanItMayBe) {
    auto const scene = test::MakeTorus(12, 8);
    FlowSurface const flow(scene.cage, scene.positions,
                           test::MakeRotationForm(scene, {0.0, 0.0, 1.0}));
    auto options = test::MakeStreamlineOptions(flow, 0.05);
    options.maxLength = 1.0;
    for (auto const& line : TraceStreamlines(flow, MakeSeeds(flow), options)) {
        EXPECT_NEAR(line.length, 1.0, 1e-5);
        EXPECT_EQ(line.ends, (std::vector{eval::StreamEnd::Length, eval::StreamEnd::Length}));
    }
}

TEST(Streamline, DoesNotDependOnThreads) {
    auto const scene = test::MakeQuadSphere(2);
    FlowSurface const flow(scene.cage, scene.positions,
                           MakeGradient(scene, test::MakeSmoothFunction(scene)));
    auto const options = test::MakeStreamlineOptions(flow, 0.1);
    auto const seeds = MakeSeeds(flow);
    std::vector<eval::Streamline> found[2];
    for (int i = 0; i < 2; ++i) {
        test::WithThreads(1 + 3 * i, [&] { found[i] = TraceStreamlines(flow, seeds, options); });
    }
    ASSERT_EQ(found[0].size(), found[1].size());
    for (size_t line = 0; line < found[0].size(); ++line) {
        auto const &a = found[0][line].points, &b = found[1][line].points;
        ASSERT_EQ(a.size(), b.size());
        for (size_t i = 0; i < a.size(); ++i) {
            EXPECT_EQ(a[i].position, b[i].position);
            EXPECT_EQ(a[i].length, b[i].length);
        }
    }
}

// A field that is 0 has no lines, and a seed is all there is of them.
TEST(Streamline, OfNoFieldIsItsSeed) {
    auto const scene = test::MakeCube();
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    FlowSurface const flow(scene.cage, scene.positions,
                           std::vector<double>(refiner->GetLevel(0).GetNumEdges(), 0.0));
    auto const lines =
        TraceStreamlines(flow, MakeSeeds(flow), test::MakeStreamlineOptions(flow, 0.1));
    for (auto const& line : lines) {
        EXPECT_EQ(line.points.size(), 1u);
        EXPECT_EQ(line.ends, (std::vector{eval::StreamEnd::Singular, eval::StreamEnd::Singular}));
    }
}

}  // namespace
}  // namespace limn
