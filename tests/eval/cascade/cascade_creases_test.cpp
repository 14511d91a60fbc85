// SPDX-License-Identifier: Apache-2.0
//
// Cascades on surfaces with creases.

#include <array>

#include <gtest/gtest.h>

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
using test::AreFinite;
using test::Filter;
using test::kSolvers;
using test::PointAt;
using test::QuarterLevels;
using Points = std::vector<double>;

void CreaseEdges(engine::Scene& scene, std::vector<std::array<Index, 2>> const& edges) {
    for (auto const& edge : edges) {
        scene.cage.creaseVertexPairs.insert(scene.cage.creaseVertexPairs.end(), edge.begin(),
                                            edge.end());
        scene.cage.creaseSharpness.push_back(far_ext::kInfiniteSharpness);
    }
}

// Corners have three creases and stay; along an edge equal steps of a straight line cancel; a
// coordinate across a plane face is constant or linear on it. So the whole cube stays, which
// without creases loses a good part of its corners.
TEST(CascadeCreases, ACubeOfCreasesStays) {
    auto const smooth = test::MakeCube();
    auto creased = test::MakeCube();
    CreaseEdges(creased, {{0, 1},
                          {1, 2},
                          {2, 3},
                          {3, 0},
                          {4, 5},
                          {5, 6},
                          {6, 7},
                          {7, 4},
                          {0, 4},
                          {1, 5},
                          {2, 6},
                          {3, 7}});
    for (auto const& [solver, tolerance] : kSolvers) {
        CascadeOptions const options{.solver = solver, .tolerance = tolerance, .width = 0.3};
        for (engine::Scene const* scene : {&smooth, static_cast<engine::Scene const*>(&creased)}) {
            auto const levels = QuarterLevels(*scene, 4, BoundaryRule::Fixed);
            eval::Cascade<double> cascade(scene->positions, {}, options);
            for (auto const& level : levels) cascade.Step(level, 20);
            double const moved =
                test::LargestDifference(cascade.GetPositions(), cascade.GetStartPositions());
            if (scene == &creased)
                EXPECT_LT(moved, 1e-13);
            else
                EXPECT_GT(moved, 0.05);
        }
    }
}

// A regular n-gon as a crease: edges l = 2 r sin(pi / n), M = l, L X = a / l * 4 sin^2(pi / n) X,
// hence (1 + a / r_k^2) r = r0, whatever n and whatever surfaces meet there: the cylinder's fixed
// point.
TEST(CascadeCreases, ARegularRimFollowsTheRecursionOfACircle) {
    for (int n : {3, 7, 64}) {
        auto scene = test::MakeBipyramid(n);
        scene.positions[2] = 1.7;
        auto mesh = test::MakeSameMesh(scene);
        for (Index i = 0; i < n; ++i) mesh.creases.push_back({2 + i, 2 + (i + 1) % n});
        CascadeLevel const level = far_ext::BuildCascadeLevel(mesh, {}, BoundaryRule::Fixed);
        double const sigma = 0.4, a = sigma * sigma / 2;
        for (auto solver : {CascadeSolver::Exact, CascadeSolver::ConjugateGradients}) {
            eval::Cascade<double> cascade(scene.positions, {},
                                          {.solver = solver, .tolerance = 1e-14, .width = sigma});
            double r = 1.0;
            for (int k = 0; k < 30; ++k) {
                if (k == 0)
                    cascade.Step(level, 100);
                else
                    cascade.Repeat(100);
                r = 1 / (1 + a / (r * r));
                for (Index i = 2; i < n + 2; ++i) {
                    EXPECT_NEAR(PointAt(cascade.GetPositions(), i).norm(), r, 1e-11);
                    EXPECT_NEAR(PointAt(cascade.GetPositions(), i)[2], 0.0, 1e-11);
                }
            }
            EXPECT_NEAR(r, (1 + std::sqrt(1 - 2 * sigma * sigma)) / 2, 1e-11);
        }
    }
}

// A closed crease cuts a surface in two: what is done to one side, the crease and the other side do
// not feel. (Sums of conjugate gradients run over both sides; sweeps and the factorisation do not.)
TEST(CascadeCreases, BothSidesOfAClosedCreaseAreSmoothedOnTheirOwn) {
    auto scene = test::MakeBipyramid(7);
    std::vector<std::array<Index, 2>> rim;
    for (Index i = 0; i < 7; ++i) rim.push_back({2 + i, 2 + (i + 1) % 7});
    CreaseEdges(scene, rim);
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    auto changed = scene;
    changed.positions[0] = 0.3;  // the upper tip
    changed.positions[2] = 1.5;
    for (auto [solver, tolerance] : {std::pair{CascadeSolver::Jacobi, 0.0},
                                     {CascadeSolver::Exact, 1e-14},
                                     {CascadeSolver::ConjugateGradients, 1e-9}}) {
        std::array<Points, 2> found;
        for (size_t i = 0; i < 2; ++i) {
            auto const& own = i == 0 ? scene : changed;
            eval::Cascade<double> cascade(
                own.positions, {},
                {.solver = solver, .tolerance = tolerance > 1e-10 ? 1e-12 : 0.0, .width = 0.2});
            for (auto const& level : levels)
                cascade.Step(level, solver == CascadeSolver::Jacobi ? 20 : 1000);
            EXPECT_TRUE(AreFinite(cascade.GetPositions()));
            found[i] = cascade.GetPositions();
        }
        int numLower = 0, numUpper = 0;
        for (size_t i = 0; i < found[0].size(); i += 3) {
            bool const isUpper = found[0][i + 2] > 1e-9;
            for (size_t c = 0; c < 3 && !isUpper; ++c)
                EXPECT_NEAR(found[0][i + c], found[1][i + c], tolerance);
            isUpper ? ++numUpper : ++numLower;
        }
        EXPECT_GT(numLower, numUpper);  // the rim counts as lower
        EXPECT_GT(test::LargestDifference(found[0], found[1]), 0.1);
    }
}

// Surfaces see their creases solved, not as they were before: the residual mode meets the
// factorisation.
TEST(CascadeCreases, SolversAgreeOnSurfacesWithCreases) {
    for (auto const& [name, scene] : test::MakeFormMeshes()) {
        if (scene.cage.creaseSharpness.empty()) continue;
        auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
        eval::Cascade<double> cascade(scene.positions, {}, {.tolerance = 1e-11, .width = 0.15});
        for (auto const& level : levels) EXPECT_TRUE(cascade.Step(level, 1000).converged) << name;
        auto const exact = Filter(scene, levels, {.solver = CascadeSolver::Exact, .width = 0.15});
        EXPECT_LT(test::LargestDifference(cascade.GetPositions(), exact),
                  1e-9 * test::BoxDiagonal(scene.positions))
            << name;
    }
}

// Creases of every kind and sharpness on triangles and quads, open and closed.
TEST(CascadeCreases, NothingIsNotANumber) {
    for (auto const& [name, scene] : test::MakeFormMeshes()) {
        if (scene.cage.creaseSharpness.empty()) continue;
        auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
        for (auto const& [solver, tolerance] : kSolvers) {
            eval::Cascade<double> cascade(scene.positions, {},
                                          {.solver = solver, .tolerance = tolerance, .width = 0.2});
            for (auto const& level : levels)
                EXPECT_TRUE(std::isfinite(cascade.Step(level, 10).residual)) << name;
            EXPECT_TRUE(AreFinite(cascade.GetPositions())) << name;
        }
    }
}

}  // namespace
}  // namespace limn
