// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/multigrid.h"

#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "far_ext/topology/boundary.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using eval::FixedVertices;
using eval::MultigridLevel;
using Matrix = Eigen::SparseMatrix<double>;

/// G of a level, by its rows; columns of fixed vertices are left out.
Matrix MatrixOf(MultigridLevel const& level) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index row = 0; row < level.numUnknowns; ++row) {
        entries.emplace_back(row, row, level.offsets[row + 1] - level.offsets[row]);
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
            if (level.neighbours[k] < level.numUnknowns)
                entries.emplace_back(row, level.neighbours[k], -1.0);
        }
    }
    Matrix matrix(level.numUnknowns, level.numUnknowns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

/// P from one level to the next.
Matrix ProlongationOf(MultigridLevel const& coarse, MultigridLevel const& fine) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index row = 0; row < fine.numUnknowns; ++row) {
        for (Index parent : fine.parents[row]) {
            if (parent >= 0 && parent < coarse.numUnknowns) entries.emplace_back(row, parent, 0.5);
        }
    }
    Matrix matrix(fine.numUnknowns, coarse.numUnknowns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

std::vector<engine::Scene> TriangleMeshes() {
    std::vector<engine::Scene> scenes{test::MakeTriangleTorus(6, 5),
                                      test::MakeFan(7, Sdc::SCHEME_LOOP, 0.1, 0.05)};
    for (int n = 3; n <= 12; ++n) scenes.push_back(test::MakeBipyramid(n));
    for (char const* name : {"icosa", "gridholetri"})
        scenes.push_back(test::LoadDifferential(name, Sdc::SCHEME_LOOP));
    return scenes;
}

// Each coarse edge is two halves and the two middle edges beside it, each with half of the
// difference: 4 x 1/4 = 1. Inside a fixed boundary as well.
TEST(MultigridLevels, TheCoarseEquationIsGalerkinsOnTriangles) {
    for (auto const& scene : TriangleMeshes()) {
        auto const refiner = test::MakeRefiner(scene, 3);
        auto const levels = eval::BuildMultigridLevels(*refiner, FixedVertices::Boundary);
        for (size_t k = 1; k < levels.size(); ++k) {
            Matrix const P = ProlongationOf(levels[k - 1], levels[k]);
            Matrix const difference =
                Matrix(P.transpose() * MatrixOf(levels[k]) * P) - MatrixOf(levels[k - 1]);
            EXPECT_LT(difference.norm(), 1e-12)
                << scene.cage.numVertices << " vertices, level " << k;
        }
    }
}

/// The largest difference of G x and b over the unknowns.
double LargestDefect(Far::TopologyRefiner const& refiner, MultigridLevel const& graph,
                     std::vector<double> const& b, std::vector<double> const& x) {
    auto const level = refiner.GetLevel(refiner.GetMaxLevel());
    double worst = 0.0;
    for (Index row = 0; row < graph.numUnknowns; ++row) {
        Index const vertex = graph.vertices[row];
        for (size_t c = 0; c < 3; ++c) {
            double defect = b[3 * static_cast<size_t>(vertex) + c];
            for (Index edge : level.GetVertexEdges(vertex)) {
                Index const other = far_ext::GetOtherEnd(level, edge, vertex);
                defect -=
                    x[3 * static_cast<size_t>(vertex) + c] - x[3 * static_cast<size_t>(other) + c];
            }
            worst = test::Worse(worst, std::abs(defect));
        }
    }
    return worst;
}

struct Case {
    char const* name;
    engine::Scene scene;
    int levels, maxIterations;
};

std::vector<Case> AllCases() {
    std::vector<Case> cases{
        {"regular torus", test::MakeTriangleTorus(16, 12), 4, 10},
        {"quad torus", test::MakeTorus(16, 12), 4, 10},
        {"cube", test::MakeCube(), 5, 14},
        {"grid with a hole", test::LoadDifferential("gridholetri", Sdc::SCHEME_LOOP), 4, 14},
        {"quads round a vertex of valence 12", test::MakeFan(12, Sdc::SCHEME_CATMARK, 0.1, 0.0), 4,
         14}};
    for (int n : {3, 4, 5, 7, 8, 10, 12})
        cases.push_back({"bipyramid", test::MakeBipyramid(n), 6, 14});
    return cases;
}

// Fixed vertices keep their values and their neighbours see them; b is projected where constants
// are free.
TEST(Multigrid, SolvesWithinFewIterations) {
    for (auto const& [name, scene, numLevels, maxIterations] : AllCases()) {
        auto const refiner = test::MakeRefiner(scene, numLevels);
        eval::Multigrid multigrid(*refiner, FixedVertices::Boundary);
        auto const size = 3 * static_cast<size_t>(refiner->GetLevel(numLevels).GetNumVertices());
        auto b = test::MakeNoise(size, 1), x = test::MakeNoise(size, 2);
        auto const& graph = multigrid.GetLevels().back();
        if (graph.blocks.front().isSingular) {
            for (size_t c = 0; c < 3; ++c) {
                double sum = 0.0;
                for (size_t i = c; i < size; i += 3) sum += b[i];
                for (size_t i = c; i < size; i += 3) b[i] -= 3.0 * sum / static_cast<double>(size);
            }
        }
        auto const before = x;
        auto const report = multigrid.Solve(b, x, {.tolerance = 1e-8});
        EXPECT_TRUE(report.converged) << name;
        EXPECT_LE(report.iterations, maxIterations) << name << ' ' << scene.cage.numVertices;
        EXPECT_LT(report.residual, 2e-8) << name;
        EXPECT_LT(LargestDefect(*refiner, graph, b, x), 1e-5) << name;
        for (Index row = graph.numUnknowns; row < graph.GetNumRows(); ++row) {
            size_t const at = 3 * static_cast<size_t>(graph.vertices[row]);
            EXPECT_EQ(x[at], before[at]) << name;
        }
    }
}

// A boundary that is free: constants, too, are, and the transfer still serves.
TEST(Multigrid, AFreeBoundaryConverges) {
    for (auto const& scene : {test::LoadDifferential("gridholetri", Sdc::SCHEME_LOOP),
                              test::MakeFan(6, Sdc::SCHEME_CATMARK, 0.1, 0.0)}) {
        auto const refiner = test::MakeRefiner(scene, 4);
        eval::Multigrid multigrid(*refiner, FixedVertices::None);
        auto const size = 3 * static_cast<size_t>(refiner->GetLevel(4).GetNumVertices());
        std::vector<double> x(size, 0.0);
        auto const report = multigrid.Solve(test::MakeNoise(size, 4), x);
        EXPECT_TRUE(report.converged);
        EXPECT_LE(report.iterations, 20);
    }
}

// One vertex of each closed component stays where it was, to the last bit, wherever that is: the
// lowest row, or the one that is named.
TEST(Multigrid, AnchorsStayWhereTheyWere) {
    auto const refiner =
        test::MakeRefiner(test::Join({test::MakeBipyramid(5), test::MakeBipyramid(7)}), 3);
    eval::Multigrid multigrid(*refiner, FixedVertices::None);
    auto const size = 3 * static_cast<size_t>(refiner->GetLevel(3).GetNumVertices());
    auto const& graph = multigrid.GetLevels().back();
    ASSERT_EQ(graph.blocks.size(), 2u);
    std::vector<Index> anchors{graph.vertices[graph.blocks[0].begin],
                               graph.vertices[graph.blocks[1].begin]};
    auto const before = test::MakeNoise(size, 6);
    for (int round = 0; round < 2; ++round) {
        auto x = before;
        for (double& value : x) value += 1e5;
        auto const start = x;
        EXPECT_TRUE(multigrid.Solve(test::MakeNoise(size, 7), x, {.tolerance = 1e-10}).converged);
        for (Index anchor : anchors) {
            for (size_t c = 0; c < 3; ++c) {
                size_t const at = 3 * static_cast<size_t>(anchor) + c;
                EXPECT_EQ(x[at], start[at]);
            }
        }
        anchors = {graph.vertices[graph.blocks[0].end - 1],
                   graph.vertices[graph.blocks[1].end - 3]};
        multigrid.SetAnchors(anchors);
    }
    EXPECT_EQ(test::CodeOf([&] { multigrid.SetAnchors(std::span(anchors).first(1)); }),
              ErrorCode::BadOption);
    std::swap(anchors[0], anchors[1]);
    EXPECT_EQ(test::CodeOf([&] { multigrid.SetAnchors(anchors); }), ErrorCode::BadOption);
}

// With masses and weights the equation is regular everywhere; the other road is a factorisation.
TEST(Multigrid, AgreesWithCholesky) {
    auto const scene = test::LoadDifferential("icosa", Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(scene, 3);
    std::vector<eval::EdgeWeights> weights(4);
    for (int k = 0; k <= 3; ++k) {
        auto const level = refiner->GetLevel(k);
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge)
            weights[k].edges.push_back(1.0 + 0.3 * (edge % 3));
        weights[k].masses.assign(static_cast<size_t>(level.GetNumVertices()), 0.5 / (1 << 2 * k));
    }
    auto const level = refiner->GetLevel(3);
    Eigen::SparseMatrix<double> G(level.GetNumVertices(), level.GetNumVertices());
    std::vector<Eigen::Triplet<double>> entries;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        double const w = weights[3].edges[edge];
        for (auto const& [i, j] : {std::pair{ends[0], ends[1]}, std::pair{ends[1], ends[0]}}) {
            entries.emplace_back(i, i, w);
            entries.emplace_back(i, j, -w);
        }
    }
    for (Index v = 0; v < level.GetNumVertices(); ++v)
        entries.emplace_back(v, v, weights[3].masses[v]);
    G.setFromTriplets(entries.begin(), entries.end());
    auto const b = test::MakeNoise(3 * static_cast<size_t>(level.GetNumVertices()), 3);
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> const cholesky(G);
    Eigen::MatrixXd const reference = cholesky.solve(
        Eigen::Map<Eigen::Matrix<double, -1, 3, Eigen::RowMajor> const>(b.data(), G.rows(), 3));

    eval::Multigrid multigrid(*refiner, FixedVertices::None);
    multigrid.SetWeights(*refiner, weights);
    std::vector<double> x(b.size(), 0.0);
    auto const report = multigrid.Solve(b, x, {.tolerance = 1e-12});
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, 25);
    for (Index v = 0; v < level.GetNumVertices(); ++v) {
        for (Index c = 0; c < 3; ++c)
            EXPECT_NEAR(x[3 * static_cast<size_t>(v) + c], reference(v, c), 1e-9);
    }
}

// Sums are added in an order that threads do not change.
TEST(Multigrid, TheBitsDoNotDependOnThreads) {
    auto const refiner = test::MakeRefiner(test::MakeBipyramid(7), 6);
    auto const size = 3 * static_cast<size_t>(refiner->GetLevel(6).GetNumVertices());
    std::vector<std::vector<double>> results;
    for (int threads : {1, 2, 3}) {
        tbb::global_control const limit(tbb::global_control::max_allowed_parallelism,
                                        static_cast<size_t>(threads));
        tbb::task_arena arena(threads);
        arena.execute([&] {
            eval::Multigrid multigrid(*refiner, FixedVertices::None);
            std::vector<double> x(size, 0.0);
            multigrid.Solve(test::MakeNoise(size, 5), x);
            results.push_back(std::move(x));
        });
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

TEST(Multigrid, NothingToDoIsDone) {
    auto const refiner = test::MakeRefiner(
        test::MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 2}}, Sdc::SCHEME_LOOP), 0);
    eval::Multigrid multigrid(*refiner, FixedVertices::Boundary);
    std::vector<double> x(9, 2.0);
    auto const report = multigrid.Solve(std::vector<double>(9, 1.0), x);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_EQ(x, std::vector<double>(9, 2.0));
}

TEST(Multigrid, WeightsThatDoNotFitAreRefused) {
    auto const refiner = test::MakeRefiner(test::MakeBipyramid(5), 1);
    eval::Multigrid multigrid(*refiner, FixedVertices::None);
    EXPECT_EQ(test::CodeOf([&] { multigrid.SetWeights(*refiner, {}); }), ErrorCode::BadOption);
}

}  // namespace
}  // namespace limn
