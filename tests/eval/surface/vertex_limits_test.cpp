// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/vertex_limits.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/refined.h"
#include "support/scan_meshes.h"

namespace limn {
namespace {

// The limit of a cube's corner: own weight 9/24, three edge ends 4/24 each, three face opposites
// 1/24 each; of coordinates +-1 that leaves (9 + 4 - 1) / 24.
TEST(VertexLimits, ACubesCornersMoveInByHalf) {
    auto const cube = test::MakeCube();
    auto const refiner = test::MakeRefiner(cube, 0);
    eval::LimitSurface const surface(*refiner);
    double const corner = std::abs(cube.positions[0]);
    auto const limits = eval::EvaluateVertexLimits(surface, cube.positions, 3);
    EXPECT_EQ(limits.hasLimit, std::vector<char>(8, 1));
    for (size_t i = 0; i < cube.positions.size(); ++i)
        EXPECT_NEAR(limits.values[i], 0.5 * cube.positions[i], 1e-12 * corner);
}

/// Shapes with every kind of vertex, and a scan.
std::vector<engine::Scene> MakeLimitScenes() {
    std::vector<engine::Scene> scenes{test::MakeScan(12)};
    for (std::string const& name : test::ListShapes()) scenes.push_back(test::LoadShape(name));
    return scenes;
}

// Two roads to a limit point: a row of A, and refinement of a face towards its corner.
TEST(VertexLimits, RowsMeetTheRefinedSurfaceOnEveryKindOfMesh) {
    for (engine::Scene const& scene : MakeLimitScenes()) {
        SCOPED_TRACE(scene.path);
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        auto const found = eval::FindVertexLimits(*refiner, 0, scene.positions, 3);
        auto const evaluated =
            eval::EvaluateVertexLimits(eval::LimitSurface(*refiner), scene.positions, 3);
        EXPECT_EQ(found.hasLimit, evaluated.hasLimit);
        double const size = test::BoxDiagonal(scene.positions);
        for (size_t i = 0; i < found.values.size(); ++i)
            ASSERT_NEAR(found.values[i], evaluated.values[i], 1e-12 * size) << "vertex " << i / 3;
    }
}

// Refining moves no limit: a level's vertices have those of their parents.
TEST(VertexLimits, AVertexAndItsChildHaveOneLimit) {
    for (engine::Scene const& scene : MakeLimitScenes()) {
        SCOPED_TRACE(scene.path);
        auto const refiner = test::MakeRefiner(scene, 1);
        auto const coarse = eval::FindVertexLimits(*refiner, 0, scene.positions, 3);
        auto const children = eval::RefineValues<3>(*refiner, 1, scene.positions);
        auto const fine = eval::FindVertexLimits(*refiner, 1, children, 3);
        double const size = test::BoxDiagonal(scene.positions);
        for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex) {
            if (!coarse.hasLimit[static_cast<size_t>(vertex)]) continue;
            size_t const child =
                static_cast<size_t>(refiner->GetLevel(0).GetVertexChildVertex(vertex));
            for (size_t c = 0; c < 3; ++c) {
                ASSERT_NEAR(fine.values[3 * child + c],
                            coarse.values[3 * static_cast<size_t>(vertex) + c], 1e-6 * size)
                    << "vertex " << vertex;  // Loop's rules are rounded to float
            }
        }
    }
}

// Every refinement in double takes the vertices nearer, by a third at least.
TEST(VertexLimits, RowsAreWhatUniformRefinementRunsInto) {
    engine::Scene const scan = test::MakeScan(12);
    constexpr int kLevels = 5;
    auto const refiner = test::MakeRefiner(scan, kLevels);
    auto const limits = eval::FindVertexLimits(*refiner, 0, scan.positions, 3);
    std::vector<Index> descendants(static_cast<size_t>(scan.cage.numVertices));
    std::iota(descendants.begin(), descendants.end(), 0);
    std::vector<double> values = scan.positions;
    auto const findMiss = [&] {
        double miss = 0.0;
        for (size_t i = 0; i < descendants.size(); ++i) {
            for (size_t c = 0; c < 3; ++c) {
                double const at = values[3 * static_cast<size_t>(descendants[i]) + c];
                miss = test::Worse(miss, std::abs(at - limits.values[3 * i + c]));
            }
        }
        return miss;
    };
    double miss = findMiss();
    for (int level = 1; level <= kLevels; ++level) {
        values = eval::RefineValues<3>(*refiner, level, values);
        for (Index& vertex : descendants)
            vertex = refiner->GetLevel(level - 1).GetVertexChildVertex(vertex);
        double const next = findMiss();
        EXPECT_LT(next, miss / 1.5) << "level " << level;
        miss = next;
    }
}

// Whole millions are exact in double, and so must be what is added to them.
TEST(VertexLimits, RowsAreAsExactFarFromTheOrigin) {
    engine::Scene scan = test::MakeScan(12);
    for (double& x : scan.positions) x = std::nearbyint(x * 0x1p20) / 0x1p20;
    auto const refiner = far_ext::CreateRefiner(scan.cage);
    auto const near = eval::FindVertexLimits(*refiner, 0, scan.positions, 3);
    std::vector<double> moved = scan.positions;
    for (double& x : moved) x += 0x1p22;
    auto const far = eval::FindVertexLimits(*refiner, 0, moved, 3);
    for (size_t i = 0; i < moved.size(); ++i)
        ASSERT_NEAR(far.values[i] - 0x1p22, near.values[i], 0x1p-30);  // rounding at 2^22
}

TEST(VertexLimits, ValuesThatAreTooShortAreRefused) {
    auto const refiner = test::MakeRefiner(test::MakeCube(), 0);
    eval::LimitSurface const surface(*refiner);
    std::vector<double> const six(6);
    constexpr char const* kRefusal = "control points: 6 values are too few for 8 vertices of 3";
    EXPECT_EQ(test::RefusalOf([&] { eval::EvaluateVertexLimits(surface, six, 3); }), kRefusal);
    EXPECT_EQ(test::RefusalOf([&] { eval::FindVertexLimits(*refiner, 0, six, 3); }), kRefusal);
}

}  // namespace
}  // namespace limn
