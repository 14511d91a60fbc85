// SPDX-License-Identifier: Apache-2.0
//
// Smooth of order 4, and with features kept.

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/fit/bands.h"
#include "engine/smooth/smooth.h"
#include "support/cascade_meshes.h"
#include "support/dense_filter.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::ConstantWidth;
using engine::Job;
using engine::Model;
using engine::SmoothOptions;
using eval::CascadeSolver;

engine::SmoothResult FairOnce(engine::Scene const& scene, double width, SmoothOptions options) {
    options.levels = 0;
    Job job;
    return engine::Smooth(Model::Build(scene), ConstantWidth{width}, options, job);
}

std::vector<double> FairWith(engine::Scene const& scene, double width,
                             SmoothOptions const& options) {
    return FairOnce(scene, width, options).mesh.value().positions;
}

/// X of (M + b L M^-1 L) X = M X0, b = sigma^4 / 4, with Y = M^-1 L X 0 where vertices are fixed:
/// one dense system for X and Y together.
Eigen::MatrixXd SolveFourthOrder(engine::Scene const& scene, double width) {
    test::DenseFilter const dense(scene.cage.faceVertices, scene.positions);
    auto const model = Model::Build(scene);
    Eigen::Index const n = dense.M.rows();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n), B = Eigen::MatrixXd::Zero(2 * n, 3);
    test::Rows const X0 = test::ToRows(scene.positions);
    double const b = std::pow(width, 4) / 4;
    for (Eigen::Index i = 0; i < n; ++i) {
        if (model.GetLevel().IsVertexBoundary(static_cast<Index>(i))) {
            A(i, i) = A(n + i, n + i) = 1.0;
            B.row(i) = X0.row(i);
            continue;
        }
        A(i, i) = dense.M(i, i);
        A.block(i, n, 1, n) = b * dense.L.row(i);
        A.block(n + i, 0, 1, n) = -dense.L.row(i);
        A(n + i, n + i) = dense.M(i, i);
        B.row(i) = dense.M(i, i) * X0.row(i);
    }
    return A.partialPivLu().solve(B).topRows(n);
}

TEST(FourthOrder, SolvesItsEquationByBothSolvers) {
    for (char const* name : {"icosa", "torustri", "gridholetri"}) {
        auto const scene = test::LoadMesh(name);
        double const width = 0.5 * test::MeasureEdges(scene).mean,
                     size = test::BoxDiagonal(scene.positions);
        Eigen::MatrixXd const X = SolveFourthOrder(scene, width);
        auto const exact = FairWith(scene, width, {.order = 4, .solver = CascadeSolver::Exact});
        EXPECT_LT(test::LargestOf(test::ToRows(exact) - X), 1e-12 * size) << name;
        auto const found =
            FairOnce(scene, width, {.order = 4, .stop = engine::StopAtResidual{1e-11}});
        EXPECT_TRUE(found.report.HasConverged());
        EXPECT_LT(test::LargestOf(test::ToRows(found.mesh->positions) - X), 1e-9 * size) << name;
    }
}

// b = sigma^4/4 times the square of 2/r^2: r / (1 + sigma^4 / (N r^4)), N times.
TEST(FourthOrder, ASphereShrinksByItsLaw) {
    for (int steps : {1, 3}) {
        double radius = 1.0;
        for (int step = 0; step < steps; ++step)
            radius /= 1.0 + std::pow(0.4, 4) / (steps * std::pow(radius, 4));
        EXPECT_NEAR(
            test::MeanRadius(FairWith(test::MakeIcosphere(4), 0.4, {.steps = steps, .order = 4})),
            radius, 2e-5)
            << steps;
    }
}

// Both orders halve what has k^2 = 2 / sigma^2: the coordinates of a sphere of radius sigma.
TEST(FourthOrder, HasAGainOfOneHalfWhereTheSecondHas) {
    for (int order : {2, 4})
        EXPECT_NEAR(test::MeanRadius(FairWith(test::MakeIcosphere(4), 1.0, {.order = order})), 0.5,
                    1e-3);
}

TEST(FourthOrder, LosesLessOfTheVolume) {
    auto scene = test::MakeIcosphere(3);
    test::AddNoise(scene, 0.05, 7);
    auto const volumeOf = [&](int order) {
        auto mesh = FairOnce(scene, 0.2, {.order = order}).mesh.value();
        auto const model = Model::Build(std::move(mesh));
        return engine::MeasureExtent(model, model.GetPositions()).volume.value();
    };
    auto const model = Model::Build(scene);
    double const start = engine::MeasureExtent(model, scene.positions).volume.value();
    EXPECT_LT(start - volumeOf(4), 0.25 * (start - volumeOf(2)));
    EXPECT_GT(start - volumeOf(2), 0.0);
}

TEST(KeptFeatures, AnInfiniteBoundIsThePlainFilter) {
    double const infinite = std::numeric_limits<double>::infinity();
    for (char const* name : {"icosa", "torustri", "gridholetri"}) {
        auto const scene = test::LoadMesh(name);
        double const width = 0.3 * test::MeasureEdges(scene).mean;
        SmoothOptions options{.steps = 2, .solver = CascadeSolver::Exact};
        auto const plain = FairWith(scene, width, options);
        options.keptFeatures = infinite;
        EXPECT_LT(test::LargestDifference(FairWith(scene, width, options), plain),
                  2e-15 * test::BoxDiagonal(scene.positions))
            << name;
    }
}

/// A cube from -1 to 1 of 2 n^2 triangles a side, and the distance of points from its surface.
engine::Scene MakeFineCube(int levels) {
    auto cube = test::MakeCube();
    std::vector<std::vector<Index>> faces;
    for (size_t face = 0; face < cube.cage.faceVertices.size(); face += 4) {
        Index const* const f = &cube.cage.faceVertices[face];
        faces.push_back({f[0], f[1], f[2]});
        faces.push_back({f[0], f[2], f[3]});
    }
    Job job;
    return engine::Smooth(Model::Build(test::MakeScene(cube.positions, faces, Sdc::SCHEME_LOOP)),
                          ConstantWidth{0.0}, {.levels = levels}, job)
        .mesh.value();
}

double FindDistanceFromCube(std::vector<double> const& points) {
    double sum = 0.0;
    for (size_t i = 0; i < points.size(); i += 3) {
        double const largest =
            std::max({std::abs(points[i]), std::abs(points[i + 1]), std::abs(points[i + 2])});
        sum += (largest - 1.0) * (largest - 1.0);
    }
    return std::sqrt(3.0 * sum / static_cast<double>(points.size()));
}

// The edges of a noisy cube: the plain filter rounds them, the other does not.
TEST(KeptFeatures, NoiseGoesAndEdgesStay) {
    auto const clean = MakeFineCube(4);
    auto noisy = clean;
    test::AddNoise(noisy, 0.1, 5);
    double const edge = test::MeasureEdges(clean).mean, width = 1.5 * edge;
    auto const plain = FairWith(noisy, width, {.steps = 3}),
               kept = FairWith(noisy, width, {.steps = 3, .keptFeatures = 0.2 / edge});
    double const before = FindDistanceFromCube(noisy.positions);
    EXPECT_LT(FindDistanceFromCube(kept), 0.7 * before);
    EXPECT_LT(FindDistanceFromCube(kept), 0.5 * FindDistanceFromCube(plain));
}

/// What a filter made of a noisy cube.
struct CleanedCube {
    engine::Scene const& clean;
    std::vector<double> positions;

    bool IsOn(size_t i) const { return std::abs(std::abs(clean.positions[i]) - 1.0) < 1e-9; }

    /// Of face normals, in the middle of the sides; radians, rms.
    double FindNormalsError() const {
        double sum = 0.0, count = 0.0;
        auto const& faces = clean.cage.faceVertices;
        auto const normalOf = [&](std::vector<double> const& points, Index const* f) {
            Eigen::Vector3d const a = test::PointAt(points, f[0]);
            return (test::PointAt(points, f[1]) - a).cross(test::PointAt(points, f[2]) - a).eval();
        };
        for (size_t face = 0; face < faces.size(); face += 3) {
            Index const* const f = &faces[face];
            Eigen::Vector3d size = test::PointAt(clean.positions, f[0]).cwiseAbs();
            std::sort(size.begin(), size.end());
            if (size[1] > 0.6) continue;
            Eigen::Vector3d const found = normalOf(positions, f),
                                  right = normalOf(clean.positions, f);
            double const angle = std::atan2(found.cross(right).norm(), found.dot(right));
            sum += angle * angle;
            count += 1.0;
        }
        return std::sqrt(sum / count);
    }

    /// Of vertices on edges and corners, across these; rms.
    double FindEdgesError() const {
        double sum = 0.0, count = 0.0;
        for (size_t i = 0; i < positions.size(); i += 3) {
            if (IsOn(i) + IsOn(i + 1) + IsOn(i + 2) < 2) continue;
            for (size_t c = i; c < i + 3; ++c)
                sum += IsOn(c) ? std::pow(positions[c] - clean.positions[c], 2) : 0.0;
            count += 1.0;
        }
        return std::sqrt(sum / count);
    }

    double FindVolume() const {
        auto scene = clean;
        scene.positions = positions;
        auto const model = Model::Build(std::move(scene));
        return engine::MeasureExtent(model, model.GetPositions()).volume.value();
    }
};

/// Three steps, of the width that leaves normals in the middle of the sides off by 0.1.
CleanedCube Clean(engine::Scene const& clean, engine::Scene const& noisy,
                  SmoothOptions const& options) {
    double low = 0.0, high = 4.0 * test::MeasureEdges(clean).mean;
    for (int k = 0; k < 12; ++k) {
        double const width = (low + high) / 2;
        bool const isEnough =
            CleanedCube{clean, FairWith(noisy, width, options)}.FindNormalsError() < 0.1;
        (isEnough ? high : low) = width;
    }
    return {clean, FairWith(noisy, high, options)};
}

// At equal noise in the middle of the sides: order 4 loses a small part of the volume that order 2
// loses, and only where features are kept edges come out nearer than they went in.
TEST(Orders, CleanANoisyScanEachInItsWay) {
    auto const clean = MakeFineCube(4);
    auto noisy = clean;
    test::AddNoise(noisy, 0.12, 3);
    CleanedCube const start{clean, noisy.positions};
    double const lambda = 0.2 / test::MeasureEdges(clean).mean;
    CleanedCube const second = Clean(clean, noisy, {.steps = 3}),
                      fourth = Clean(clean, noisy, {.steps = 3, .order = 4}),
                      kept = Clean(clean, noisy, {.steps = 3, .keptFeatures = lambda});
    double const lost = start.FindVolume() - second.FindVolume();
    EXPECT_GT(lost, 0.0);
    EXPECT_LT(std::abs(start.FindVolume() - fourth.FindVolume()), 0.3 * lost);
    EXPECT_LT(std::abs(start.FindVolume() - kept.FindVolume()), 0.3 * lost);
    EXPECT_LT(kept.FindEdgesError(), start.FindEdgesError());
    EXPECT_LT(kept.FindEdgesError(), fourth.FindEdgesError());
    EXPECT_LT(fourth.FindEdgesError(), second.FindEdgesError());
    EXPECT_GT(second.FindEdgesError(), start.FindEdgesError());
}

TEST(KeptFeatures, RotateThenFilterIsFilterThenRotate) {
    auto scene = test::LoadMesh("gridholetri");
    Eigen::Matrix3d const rotation =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    double const edge = test::MeasureEdges(scene).mean;
    SmoothOptions const options{
        .steps = 2, .keptFeatures = 0.2 / edge, .solver = CascadeSolver::Exact};
    auto const rotated =
        test::Transform(FairWith(scene, edge, options), rotation, Eigen::Vector3d::Zero());
    scene.positions = test::Transform(scene.positions, rotation, Eigen::Vector3d::Zero());
    EXPECT_LT(test::LargestDifference(FairWith(scene, edge, options), rotated),
              1e-13 * test::BoxDiagonal(scene.positions));
}

TEST(Orders, WhatDoesNotGoTogetherIsRefused) {
    auto const icosa = test::LoadMesh("icosa");
    auto const refusal = [&](SmoothOptions const& options) {
        return test::RefusalOf([&] {
            Job job;
            engine::Smooth(Model::Build(icosa), ConstantWidth{0.1}, options, job);
        });
    };
    for (auto const& [options, message] :
         {std::pair<SmoothOptions, std::string>{{.order = 4}, "`order` 4 needs `levels` 0"},
          {{.levels = 0, .order = 3}, "neither 2 nor 4"},
          {{.levels = 0, .order = 4, .boundary = far_ext::BoundaryRule::Natural}, "`Natural`"},
          {{.levels = 0, .order = 4, .keptFeatures = 1.0}, "exclude each other"},
          {{.levels = 0,
            .order = 4,
            .solver = CascadeSolver::Jacobi,
            .stop = engine::SweepsOnFinest{1}},
           "`solver`"},
          {{.keptFeatures = 1.0}, "needs `levels` 0"},
          {{.levels = 0, .keptFeatures = -1.0}, "not above 0"},
          {{.levels = 0, .adaptive = 1e-3}, "from 1 to 10"},
          {{.steps = 2, .adaptive = 1e-3}, "`steps`"},
          {{.settle = 1e-3, .adaptive = 1e-3}, "`settle`"},
          {{.adaptive = 1e-3, .stop = engine::SweepsOnFinest{2}}, "`stop`"}}) {
        EXPECT_NE(refusal(options).find(message), std::string::npos) << refusal(options);
    }
    auto const quads = test::MakeQuadSphere(1);
    EXPECT_NE(test::RefusalOf([&] {
                  FairWith(quads, 0.1, {.keptFeatures = 1.0});
              }).find("face 0 has 4 corners; `keptFeatures` needs triangles"),
              std::string::npos);
}

}  // namespace
}  // namespace limn
