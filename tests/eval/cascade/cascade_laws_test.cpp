// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "eval/cascade/cascade.h"
#include "support/cascade_meshes.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"

namespace limn {
namespace {

using eval::CascadeOptions;
using eval::CascadeSolver;
using far_ext::BoundaryRule;
using far_ext::CascadeLevel;
using test::Filter;
using test::kPi;
using test::kSolvers;
using test::LoadMesh;
using test::MeasureEdges;
using test::PointAt;
using test::QuarterLevels;
using test::Transform;
using Points = std::vector<double>;

// ---- motions ------------------------------------------------------------------------------------

TEST(CascadeLaws, RotateThenFilterIsFilterThenRotate) {
    Eigen::Matrix3d const rotation =
        Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    Eigen::Vector3d const shift(3, -2, 5);
    for (bool isQuads : {false, true}) {
        auto scene = isQuads ? test::MakeGridWithHole(6, 5) : LoadMesh("gridholetri");
        auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
        CascadeOptions const options{.solver = CascadeSolver::Exact, .width = 0.3};
        auto const rotated = Transform(Filter(scene, levels, options), rotation, shift);
        scene.positions = Transform(scene.positions, rotation, shift);
        EXPECT_LT(test::LargestDifference(Filter(scene, levels, options), rotated),
                  1e-13 * test::BoxDiagonal(scene.positions));
    }
}

// M grows by s^2, and L by the square of the width.
TEST(CascadeLaws, ScaledPointsWithAScaledWidthScaleTheResult) {
    auto scene = LoadMesh("torustri");
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    auto const points = Filter(scene, levels, {.solver = CascadeSolver::Exact, .width = 0.1});
    for (double s : {1e-6, 3.7, 1e6}) {
        auto scaled = scene;
        scaled.positions =
            Transform(scene.positions, s * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
        auto const expected =
            Transform(points, s * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
        auto const found =
            Filter(scaled, levels, {.solver = CascadeSolver::Exact, .width = 0.1 * s});
        EXPECT_LT(test::LargestDifference(found, expected),
                  1e-13 * test::BoxDiagonal(scaled.positions));
    }
}

// The residual is to |M (X0 - centroid)|: where a mesh lies does not matter. Far off, points have
// fewer digits: 1e3 of the box leaves 13.
TEST(CascadeLaws, IterationsDoNotDependOnWhereAMeshLies) {
    auto const scene = LoadMesh("torustri");
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    std::vector<std::array<double, 2>> found;
    for (double shift : {0.0, 3e3}) {
        auto const points =
            Transform(scene.positions, Eigen::Matrix3d::Identity(), {shift, -shift, shift});
        eval::Cascade<double> cascade(points, {}, {.tolerance = 1e-6, .width = 0.1});
        eval::CascadeStepReport report;
        for (auto const& level : levels) report = cascade.Step(level, 1000);
        found.push_back({static_cast<double>(report.sweeps), report.residual});
    }
    EXPECT_EQ(found[0][0], found[1][0]);
    EXPECT_NEAR(found[0][1], found[1][1], 1e-2 * found[0][1]);
}

// Float has 7 digits; the differences that sweeps add lose some of them.
TEST(CascadeLaws, SweepsInSinglePrecisionAreThoseInDouble) {
    for (bool isQuads : {false, true}) {
        auto const scene = isQuads ? test::MakeGridWithHole(6, 5) : LoadMesh("torustri");
        auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
        CascadeOptions const options{.solver = CascadeSolver::Jacobi, .width = 0.2};
        eval::Cascade<float> single(scene.positions, {}, options);
        eval::Cascade<double> twice(scene.positions, {}, options);
        for (auto const& level : levels) {
            auto const a = single.Step(level, 3), b = twice.Step(level, 3);
            EXPECT_NEAR(a.residual, b.residual, 1e-6);
            EXPECT_GT(b.residual, 1e-5);
        }
        EXPECT_LT(test::LargestDifference(single.GetPositions(), twice.GetPositions()),
                  2e-6 * test::BoxDiagonal(scene.positions));
        EXPECT_GT(test::LargestDifference(twice.GetPositions(), twice.GetStartPositions()), 1e-2);
    }
}

// ---- fixed points -------------------------------------------------------------------------------

// On a polyhedron whose vertices are all alike, L X points along X. X . L X over all vertices is a
// times twice the area (the area's gradient, and Euler on a function of degree 2), X . M X is r^2
// times the area: (r_k^2 + sigma^2) r = r_k^2 r0.
TEST(CascadeLaws, RegularPolyhedraFollowTheRecursionOfASphere) {
    for (auto scene :
         {test::MakeTetrahedron(), test::MakeBipyramid(4), LoadMesh("icosa"), test::MakeCube()}) {
        double const r0 = PointAt(scene.positions, 0).norm();
        for (double share : {0.1, 0.3, 0.45, 0.5, 0.7}) {
            double const sigma = share * r0;
            CascadeLevel const level =
                far_ext::BuildCascadeLevel(test::MakeSameMesh(scene), {}, BoundaryRule::Fixed);
            eval::Cascade<double> cascade(scene.positions, {},
                                          {.solver = CascadeSolver::Exact, .width = sigma});
            double r = r0;
            for (int k = 0; k < 60; ++k) {
                if (k == 0)
                    cascade.Step(level, 1);
                else
                    cascade.Repeat(1);
                double const next = r0 / (1 + sigma * sigma / (r * r));
                if (next < 1e-6 * r0) break;  // gone
                r = next;
                EXPECT_NEAR(test::MeanRadius(cascade.GetPositions()), r, 1e-10 * r0)
                    << share << " step " << k;
            }
            // The fixed point, where there is one; at 0.45 a step leaves 2 sigma^2 / (r r0) = 0.56
            // of the distance to it.
            if (share < 0.5) {
                EXPECT_NEAR(r, (r0 + std::sqrt(r0 * r0 - 4 * sigma * sigma)) / 2, 1e-10 * r0);
            }
            if (share > 0.5) {
                EXPECT_LT(r, 1e-3 * r0);
            }
        }
    }
}

// The middle of a tube between fixed rims. Area per ring of vertices: 2 n sin(pi / n) r h; its
// radial derivative gives r (r0 - r) = a: the cylinder's fixed point, exactly. What the rims do
// decays as exp(-distance sqrt(2) / sigma).
TEST(CascadeLaws, ATubeSettlesAtTheFixedPointOfACylinder) {
    constexpr int n = 12, m = 60;
    double const sigma = 0.3, h = 0.15;
    for (bool isQuads : {false, true}) {
        Points positions;
        std::vector<std::vector<Index>> faces;
        for (int j = 0; j <= m; ++j) {
            for (int i = 0; i < n; ++i) {
                positions.insert(positions.end(),
                                 {std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), h * j});
                if (j == m) continue;
                int const a = j * n + i, b = j * n + (i + 1) % n;
                if (isQuads) {
                    faces.push_back({a, b, b + n, a + n});
                } else {
                    faces.push_back({a, b, b + n});
                    faces.push_back({a, b + n, a + n});
                }
            }
        }
        auto const scene =
            test::MakeScene(positions, faces, isQuads ? Sdc::SCHEME_CATMARK : Sdc::SCHEME_LOOP);
        CascadeLevel const level =
            far_ext::BuildCascadeLevel(test::MakeSameMesh(scene), {}, BoundaryRule::Fixed);
        eval::Cascade<double> cascade(positions, {},
                                      {.solver = CascadeSolver::Exact, .width = sigma});
        cascade.Step(level, 1);
        for (int repeat = 0; repeat < 30; ++repeat) EXPECT_FALSE(cascade.Repeat(1).isMetricFrozen);
        auto const points = cascade.GetPositions();
        for (Index i = n * m / 2; i < n * m / 2 + n; ++i) {
            auto const point = PointAt(points, i);
            EXPECT_NEAR(std::hypot(point[0], point[1]), (1 + std::sqrt(1 - 2 * sigma * sigma)) / 2,
                        1e-9);
            EXPECT_NEAR(point[2], h * m / 2, 1e-9);
        }
    }
}

// On a sphere of many triangles the fixed point is met, in the mean, to the square of the edges.
TEST(CascadeLaws, ASphereMeetsItsFixedPointToSecondOrder) {
    double const sigma = 0.3, fixedPoint = (1 + std::sqrt(1 - 4 * sigma * sigma)) / 2;
    std::vector<double> errors;
    for (int k = 1; k <= 3; ++k) {
        auto const scene = test::MakeIcosphere(k);
        CascadeLevel const level =
            far_ext::BuildCascadeLevel(test::MakeSameMesh(scene), {}, BoundaryRule::Fixed);
        eval::Cascade<double> cascade(scene.positions, {}, {.tolerance = 1e-12, .width = sigma});
        cascade.Step(level, 1000);
        for (int repeat = 0; repeat < 60; ++repeat) cascade.Repeat(1000);
        errors.push_back(std::abs(test::MeanRadius(cascade.GetPositions()) - fixedPoint));
    }
    EXPECT_LT(errors[0], 1e-3);
    for (size_t k = 0; k < 2; ++k) EXPECT_NEAR(std::log2(errors[k] / errors[k + 1]), 2.0, 0.3);
}

// ---- local widths -------------------------------------------------------------------------------

/// Runs a cascade with widths and counts vertices that are not where they started, to the bit: of
/// all, and of `marked`.
template <class Scalar>
std::pair<int, int> CountMoved(engine::Scene const& scene, std::list<CascadeLevel> const& levels,
                               std::vector<double> const& widths, CascadeOptions const& options,
                               std::vector<char> const& marked) {
    eval::Cascade<Scalar> cascade(scene.positions, widths, options);
    for (auto const& level : levels) cascade.Step(level, 12);
    auto const points = cascade.GetPositions(), start = cascade.GetStartPositions();
    std::pair<int, int> moved{0, 0};
    for (size_t i = 0; i < points.size() / 3; ++i) {
        bool const hasMoved = points[3 * i] != start[3 * i] ||
                              points[3 * i + 1] != start[3 * i + 1] ||
                              points[3 * i + 2] != start[3 * i + 2];
        moved.first += hasMoved;
        moved.second += hasMoved && marked[i];
    }
    return moved;
}

/// All solvers, in double and where they can in float: marked vertices stay to the bit, more than
/// `atLeast` others move.
void ExpectStill(engine::Scene const& scene, std::list<CascadeLevel> const& levels,
                 std::vector<double> const& widths, std::vector<char> const& marked, int atLeast) {
    for (auto const& [solver, tolerance] : kSolvers) {
        auto const moved = CountMoved<double>(scene, levels, widths,
                                              {.solver = solver, .tolerance = tolerance}, marked);
        EXPECT_GT(moved.first, atLeast);
        EXPECT_EQ(moved.second, 0);
    }
    auto const moved =
        CountMoved<float>(scene, levels, widths, {.solver = CascadeSolver::Jacobi}, marked);
    EXPECT_GT(moved.first, atLeast);
    EXPECT_EQ(moved.second, 0);
}

/// Vertices of level `count` in faces of the start mesh that the filter leaves alone. Widths are
/// filtered, too, and enter a ring of neighbours at each level, 1/4 + 1/8 + ... of an edge of the
/// start mesh: less than the ring that is left out here.
std::vector<char> MarkStill(engine::Scene const& scene, int count,
                            std::vector<double> const& widths) {
    auto const refiner = test::MakeRefiner(scene, count);
    auto const base = refiner->GetLevel(0);
    auto const allOf = [](auto const& indices, auto const& holds) {
        return std::all_of(indices.begin(), indices.end(), holds);
    };
    std::vector<char> isFar(widths.size()), isStill;
    for (Index i = 0; i < base.GetNumVertices(); ++i) {
        isFar[i] = allOf(base.GetVertexFaces(i), [&](Index face) {
            return allOf(base.GetFaceVertices(face), [&](Index j) { return widths[j] == 0.0; });
        });
    }
    for (Index face = 0; face < base.GetNumFaces(); ++face)
        isStill.push_back(allOf(base.GetFaceVertices(face), [&](Index i) { return isFar[i]; }));
    for (int k = 1; k <= count; ++k) {
        auto const level = refiner->GetLevel(k);
        std::vector<char> fine;
        for (Index face = 0; face < level.GetNumFaces(); ++face)
            fine.push_back(isStill[level.GetFaceParentFace(face)]);
        isStill = fine;
    }
    auto const last = refiner->GetLevel(count);
    std::vector<char> marked(static_cast<size_t>(last.GetNumVertices()), 0);
    for (Index face = 0; face < last.GetNumFaces(); ++face) {
        for (Index vertex : last.GetFaceVertices(face)) marked[vertex] |= isStill[face];
    }
    return marked;
}

// Widths on the edges of a cube alone, on faces of two triangles or one quad each that have been
// refined before: all that lies in faces away from the edges stays, to the bit, by every solver, in
// both precisions.
TEST(CascadeLaws, OnlyEdgesOfACubeAreFiltered) {
    for (bool isQuads : {false, true}) {
        engine::Scene cube = test::MakeCube();
        if (!isQuads) {
            std::vector<std::vector<Index>> faces;
            for (size_t f = 0; f < 24; f += 4) {
                auto const& v = cube.cage.faceVertices;
                faces.push_back({v[f], v[f + 1], v[f + 2]});
                faces.push_back({v[f], v[f + 2], v[f + 3]});
            }
            cube = test::MakeScene(cube.positions, faces, Sdc::SCHEME_LOOP);
        }
        // Three levels of linear interpolation make the start mesh.
        auto const refiner = test::MakeRefiner(cube, 3);
        eval::Cascade<double> flat(cube.positions, {},
                                   {.solver = CascadeSolver::Jacobi, .width = 0.0});
        auto const flatLevels = QuarterLevels(cube, 3, BoundaryRule::Fixed);
        for (auto const& level : flatLevels) flat.Step(level, 0);
        std::vector<std::vector<Index>> faces;
        for (Index face = 0; face < refiner->GetLevel(3).GetNumFaces(); ++face) {
            auto const corners = refiner->GetLevel(3).GetFaceVertices(face);
            faces.emplace_back(corners.begin(), corners.end());
        }
        auto const scene = test::MakeScene(flat.GetPositions(), faces, cube.cage.scheme);
        std::vector<double> widths;
        for (Index i = 0; i < scene.cage.numVertices; ++i) {
            Eigen::Vector3d const point = PointAt(scene.positions, i);
            widths.push_back((point.array().abs() == 1.0).count() >= 2 ? 0.2 : 0.0);
        }
        auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
        auto const marked = MarkStill(scene, 2, widths);
        // The middle 4 x 4 of the 8 x 8 parts of each face, quartered twice.
        EXPECT_EQ(std::count(marked.begin(), marked.end(), 1), 6 * 17 * 17);
        ExpectStill(scene, levels, widths, marked, 100);
    }
}

// An open mesh, and widths zero in a part of it that is no straight one.
TEST(CascadeLaws, WithoutWidthOnATriangleItStaysToTheBit) {
    for (auto rule : {BoundaryRule::Fixed, BoundaryRule::Natural}) {
        auto const scene = LoadMesh("gridholetri");
        std::vector<double> widths;
        for (Index i = 0; i < scene.cage.numVertices; ++i)
            widths.push_back(PointAt(scene.positions, i)[0] > 3.5 ? 0.2 : 0.0);
        auto const levels = QuarterLevels(scene, 3, rule);
        auto const marked = MarkStill(scene, 3, widths);
        ASSERT_GT(std::count(marked.begin(), marked.end(), 1), 300);
        ExpectStill(scene, levels, widths, marked, 300);
    }
}

// A width that is the same everywhere stays so (constants are kept), and is the width for all.
TEST(CascadeLaws, EqualLocalWidthsAreAWidthForAll) {
    auto const scene = LoadMesh("torustri");
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    eval::Cascade<double> local(
        scene.positions, std::vector<double>(static_cast<size_t>(scene.cage.numVertices), 0.1),
        {.solver = CascadeSolver::Exact});
    for (auto const& level : levels) local.Step(level, 1);
    for (double width : local.GetWidths()) EXPECT_NEAR(width, 0.1, 1e-13);
    auto const global = Filter(scene, levels, {.solver = CascadeSolver::Exact, .width = 0.1});
    EXPECT_LT(test::LargestDifference(local.GetPositions(), global), 1e-12);
}

// ---- threads ------------------------------------------------------------------------------------

template <class Scalar>
void ExpectSameBits(engine::Scene const& scene, std::list<CascadeLevel> const& levels,
                    std::vector<double> const& widths, CascadeOptions const& options) {
    Points first;
    double residual = 0.0;
    for (int threads : {1, 4}) {
        tbb::global_control const limit(tbb::global_control::max_allowed_parallelism,
                                        static_cast<size_t>(threads));
        tbb::task_arena arena(threads);
        eval::Cascade<Scalar> cascade(scene.positions, widths, options);
        eval::CascadeStepReport report;
        arena.execute([&] {
            for (auto const& level : levels) report = cascade.Step(level, 20);
        });
        if (threads == 1) {
            first = cascade.GetPositions();
            residual = report.residual;
        }
        EXPECT_EQ(cascade.GetPositions(), first);
        EXPECT_EQ(report.residual, residual);
    }
}

// 24576 rows: a dozen of blocks.
TEST(CascadeLaws, ThreadsDoNotChangeABit) {
    auto const scene = LoadMesh("torustri");
    auto const levels = QuarterLevels(scene, 4, BoundaryRule::Fixed);
    ASSERT_EQ(levels.back().GetNumRows(), 96 * 256);
    std::vector<double> widths;
    for (double length : MeasureEdges(scene).atVertices) widths.push_back(0.12 * length);
    for (auto const& [solver, tolerance] : kSolvers) {
        ExpectSameBits<double>(scene, levels, {},
                               {.solver = solver, .tolerance = tolerance, .width = 0.1});
        ExpectSameBits<double>(scene, levels, widths, {.solver = solver, .tolerance = tolerance});
    }
    ExpectSameBits<float>(scene, levels, {}, {.solver = CascadeSolver::Jacobi, .width = 0.1});
    ExpectSameBits<float>(scene, levels, widths, {.solver = CascadeSolver::Jacobi});
}

}  // namespace
}  // namespace limn
