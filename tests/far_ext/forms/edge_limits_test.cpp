// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/edge_limits.h"

#include <gtest/gtest.h>
#include <opensubdiv/sdc/crease.h>

#include "far_ext/limit/limit_matrix.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

double Apply(far_ext::WeightRow const& row, std::vector<double> const& values) {
    double sum = 0.0;
    for (auto const& [index, weight] : row.GetEntries())
        sum += weight * values[static_cast<size_t>(index)];
    return sum;
}

/// Meshes whose features are sharp or smooth, nothing between; and whose vertices have limits.
std::vector<std::pair<std::string, engine::Scene>> MakeMeshes() {
    std::vector<std::pair<std::string, engine::Scene>> meshes;
    for (auto& [name, scene] : test::MakeFormMeshes()) {
        bool const isSemiSharp =
            !scene.cage.creaseSharpness.empty() && scene.cage.creaseSharpness[0] < 10.0f;
        if (isSemiSharp || name == "quad disk 2") continue;
        scene.cage.cornerVertices.clear();
        scene.cage.cornerSharpness.clear();
        meshes.emplace_back(name, scene);
    }
    return meshes;
}

class EdgeLimitsWith : public testing::TestWithParam<int> {
protected:
    void Set(engine::Scene& scene) const {
        scene.cage.options.SetVtxBoundaryInterpolation(
            static_cast<Sdc::Options::VtxBoundaryInterpolation>(GetParam()));
    }
};

// Of a gradient: the difference of limits.
TEST_P(EdgeLimitsWith, GradientsAddUpToDifferencesOfLimits) {
    for (auto& [name, scene] : MakeMeshes()) {
        Set(scene);
        auto const refiner = test::MakeRefiner(scene, 2);
        auto const level = refiner->GetLevel(1);
        auto const f = test::MakeNoise(static_cast<size_t>(level.GetNumVertices()), 3);
        auto const A = far_ext::LimitMatrix::Build(*refiner, 1);
        std::vector<double> form;
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            auto const ends = level.GetEdgeVertices(edge);
            form.push_back(f[static_cast<size_t>(std::max(ends[0], ends[1]))] -
                           f[static_cast<size_t>(std::min(ends[0], ends[1]))]);
        }
        Eigen::VectorXd const limits =
            A.AsMatrix() *
            Eigen::Map<Eigen::VectorXd const>(f.data(), static_cast<Eigen::Index>(f.size()));
        far_ext::EdgeLimits edgeLimits(*refiner, 1);
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            auto const ends = level.GetEdgeVertices(edge);
            double const expected =
                limits[std::max(ends[0], ends[1])] - limits[std::min(ends[0], ends[1])];
            ASSERT_NEAR(Apply(edgeLimits.Find(edge), form), expected, 1e-11)
                << name << ", edge " << edge;
        }
    }
}

// Of any form: both halves add up to the whole.
TEST_P(EdgeLimitsWith, HalvesAddUp) {
    for (auto& [name, scene] : MakeMeshes()) {
        Set(scene);
        auto const refiner = test::MakeRefiner(scene, 3);
        auto const level = refiner->GetLevel(1), fine = refiner->GetLevel(2);
        auto const form = test::MakeNoise(static_cast<size_t>(level.GetNumEdges()), 5);
        std::vector<double> next(static_cast<size_t>(fine.GetNumEdges()));
        far_ext::BuildFormStencils(*refiner, 2).s1.Apply(form.data(), next.data(), 1);
        far_ext::EdgeLimits coarse(*refiner, 1), finer(*refiner, 2);
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            auto const ends = level.GetEdgeVertices(edge);
            auto const halves = level.GetEdgeChildEdges(edge);
            Index const middle = level.GetEdgeChildVertex(edge);
            double sum = 0.0;
            for (int side : {0, 1}) {
                Index const vertex = level.GetVertexChildVertex(ends[side]);
                bool const leaves =
                    (side == 0) ==
                    (ends[0] < ends[1]);  // the walk from low to high starts at this end
                sum += (leaves ? 1.0 : -1.0) * (vertex < middle ? 1.0 : -1.0) *
                       Apply(finer.Find(halves[side]), next);
            }
            ASSERT_NEAR(Apply(coarse.Find(edge), form), sum, 1e-11) << name << ", edge " << edge;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Boundaries, EdgeLimitsWith,
    testing::Values(static_cast<int>(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY),
                    static_cast<int>(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER)));

engine::Scene WithCrease(engine::Scene scene) {
    for (size_t corner : {0u, 1u}) {  // two sides of the first face: darts at both ends
        scene.cage.creaseVertexPairs.insert(
            scene.cage.creaseVertexPairs.end(),
            {scene.cage.faceVertices[corner], scene.cage.faceVertices[corner + 1]});
        scene.cage.creaseSharpness.push_back(Sdc::Crease::SHARPNESS_INFINITE);
    }
    return scene;
}

// What six refinements add up to, closed, open and creased: the limit but for what they leave.
TEST(EdgeLimits, AgreeWithRefining) {
    for (auto const& scene :
         {test::MakeIrregularTriangles(5, 4, 2), test::MakeCube(),
          test::MakeLattice(2, 2, Sdc::SCHEME_LOOP), test::MakeGridWithHole(3, 3),
          WithCrease(test::MakeTorus(5, 4)), WithCrease(test::MakeIrregularTriangles(5, 4, 2))}) {
        auto const refiner = test::MakeRefiner(scene, 7);
        auto const level = refiner->GetLevel(1);
        auto const form = test::MakeNoise(static_cast<size_t>(level.GetNumEdges()), 5);
        std::vector<double> values = form;
        for (int next = 2; next <= 7; ++next) {
            auto const s1 = far_ext::BuildFormStencils(*refiner, next).s1;
            std::vector<double> refined(static_cast<size_t>(s1.GetNumRows()));
            s1.Apply(values.data(), refined.data(), 1);
            values = std::move(refined);
        }
        far_ext::EdgeLimits limits(*refiner, 1);
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            // All descendants of an edge, each with the direction of the walk from low to high.
            std::vector<std::pair<Index, bool>> pieces{{edge, true}};
            for (int depth = 1; depth < 7; ++depth) {
                auto const here = refiner->GetLevel(depth);
                std::vector<std::pair<Index, bool>> children;
                for (auto const& [piece, isAlong] : pieces) {
                    auto const ends = here.GetEdgeVertices(piece);
                    for (int side : {0, 1}) {
                        bool const leaves = (side == 0) == (ends[0] < ends[1]);
                        bool const isLow =
                            here.GetVertexChildVertex(ends[side]) < here.GetEdgeChildVertex(piece);
                        children.emplace_back(here.GetEdgeChildEdges(piece)[side],
                                              (leaves == isLow) == isAlong);
                    }
                }
                pieces = children;
            }
            double sum = 0.0;
            for (auto const& [piece, isAlong] : pieces)
                sum += (isAlong ? 1.0 : -1.0) * values[static_cast<size_t>(piece)];
            EXPECT_NEAR(Apply(limits.Find(edge), form), sum, 5e-3);
        }
    }
}

// Limits ask for sharpness that has faded; on the level where it has, they are there.
TEST(EdgeLimits, SemiSharpFeaturesAreRefinedAway) {
    engine::Scene scene = test::MakeTorus(5, 4);
    scene.cage.creaseVertexPairs = {scene.cage.faceVertices[0], scene.cage.faceVertices[1]};
    scene.cage.creaseSharpness = {1.5f};
    auto const refiner = test::MakeRefiner(scene, 3);
    Index const edge =
        refiner->GetLevel(0).FindEdge(scene.cage.faceVertices[0], scene.cage.faceVertices[1]);
    EXPECT_NE(
        test::RefusalOf([&] { far_ext::EdgeLimits(*refiner, 0).Find(edge); }).find("semi-sharp"),
        std::string::npos);
    far_ext::EdgeLimits faded(*refiner, 2);
    for (Index fine = 0; fine < refiner->GetLevel(2).GetNumEdges(); ++fine)
        EXPECT_NO_THROW(faded.Find(fine));
}

TEST(EdgeLimits, LargeFansAreRefused) {
    auto const refiner = test::MakeRefiner(test::MakeFan(80, Sdc::SCHEME_LOOP, 0.1, 0.0), 1);
    Index const edge = refiner->GetLevel(0).GetVertexEdges(0)[0];
    EXPECT_NE(test::RefusalOf([&] {
                  far_ext::EdgeLimits(*refiner, 0).Find(edge);
              }).find("a fan of 80 faces"),
              std::string::npos);
}

}  // namespace
}  // namespace limn
