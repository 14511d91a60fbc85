// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/reconstruct.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "eval/differential/subdivide_values.h"
#include "far_ext/differential/laplacian.h"
#include "far_ext/topology/boundary.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using far_ext::SubdivisionRule;

/// Differential subdivision of a scene: its coordinates at the last level, and the result.
struct Differential {
    std::vector<double> deltas, spatial, positions;
    eval::ReconstructReport report;

    Differential(engine::Scene const& scene, Far::TopologyRefiner const& refiner,
                 SubdivisionRule rule, double tolerance = 1e-12, int coarsest = 0) {
        deltas =
            test::Apply(far_ext::BuildCombinatorialLaplacian(refiner.GetLevel(0)), scene.positions);
        spatial = scene.positions;
        for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
            deltas = eval::SubdivideValues<3>(refiner, level, rule, deltas);
            spatial = eval::SubdivideValues<3>(refiner, level, rule, spatial);
            for (double& delta : deltas) delta *= 0.25;
        }
        positions = spatial;
        report = eval::Reconstructor(refiner, {}, coarsest)
                     .Solve(deltas, positions, {.tolerance = tolerance});
    }
};

struct DifferentialReference {
    char const *mesh, *rule;
    SubdivisionRule subdivision;
    Sdc::SchemeType scheme;
};

class DifferentialOf : public testing::TestWithParam<DifferentialReference> {};
INSTANTIATE_TEST_SUITE_P(
    References, DifferentialOf,
    testing::Values(
        DifferentialReference{"icosa", "loop", SubdivisionRule::Scheme, Sdc::SCHEME_LOOP},
        DifferentialReference{"icosa", "butterfly", SubdivisionRule::Butterfly, Sdc::SCHEME_LOOP},
        DifferentialReference{"torustri", "loop", SubdivisionRule::Scheme, Sdc::SCHEME_LOOP},
        DifferentialReference{"torustri", "butterfly", SubdivisionRule::Butterfly,
                              Sdc::SCHEME_LOOP},
        DifferentialReference{"gridholetri", "loop", SubdivisionRule::Scheme, Sdc::SCHEME_LOOP},
        DifferentialReference{"gridholetri", "butterfly", SubdivisionRule::Butterfly,
                              Sdc::SCHEME_LOOP},
        DifferentialReference{"cube", "cc", SubdivisionRule::Scheme, Sdc::SCHEME_CATMARK}));

// An independent implementation's coordinates and positions: closed, two boundary loops, quads.
TEST_P(DifferentialOf, TheReferenceIsMet) {
    auto const& [mesh, rule, subdivision, scheme] = GetParam();
    auto const scene = test::LoadDifferential(mesh, scheme);
    auto const refiner = test::MakeRefiner(scene, 2);
    Differential const result(scene, *refiner, subdivision);
    double const box = test::BoxDiagonal(scene.positions);
    std::string const name = fmt::format("differential/{}_dss_{}", mesh, rule);
    auto deltas = result.deltas;
    for (double& delta : deltas) delta *= 16.0;  // the reference's are not scaled
    EXPECT_LT(test::LargestDifference(deltas, test::LoadPoints(name + "_delta_L2.obj")),
              1e-13 * box);
    EXPECT_LT(test::LargestDifference(result.positions, test::LoadPoints(name + "_L2.obj"), true),
              1e-8 * box);
    EXPECT_TRUE(result.report.converged);
}

std::vector<engine::Scene> AllMeshes() {
    std::vector<engine::Scene> scenes{test::MakeCube(), test::MakeTorus(7, 5),
                                      test::MakeTriangleTorus(6, 5),
                                      test::MakeFan(5, Sdc::SCHEME_CATMARK, 0.1, 0.05)};
    for (int n = 3; n <= 12; ++n) scenes.push_back(test::MakeBipyramid(n));
    scenes.push_back(test::LoadDifferential("gridholetri", Sdc::SCHEME_LOOP));
    return scenes;
}

// After projection the equations L V = Delta hold: closed, open, genus 1, valence 3 to 12.
TEST(Reconstruct, EquationsHold) {
    for (auto const& scene : AllMeshes()) {
        auto const refiner = test::MakeRefiner(scene, 3);
        Differential const result(scene, *refiner, SubdivisionRule::Scheme, 1e-11);
        auto const level = refiner->GetLevel(3);
        auto const found =
            test::Apply(far_ext::BuildCombinatorialLaplacian(level), result.positions);
        // The projection takes d (d . Delta) / (d . d) away, here nearly nothing; the rest must be
        // met.
        double defect = 0.0, size = 0.0;
        for (size_t i = 0; i < found.size(); ++i) {
            defect += std::pow(found[i] - result.deltas[i], 2);
            size += std::pow(result.deltas[i], 2);
        }
        EXPECT_TRUE(result.report.converged);
        EXPECT_LT(result.report.residual, 1e-10);
        EXPECT_LT(std::sqrt(defect / size), result.report.compatibilityDefect + 1e-10)
            << scene.cage.numVertices;
        EXPECT_LE(result.report.iterations, 20);
    }
}

// The two roads to the solution: levels, and one factorisation of the finest.
TEST(Reconstruct, MultigridAgreesWithCholesky) {
    for (auto const& scene : AllMeshes()) {
        auto const refiner = test::MakeRefiner(scene, 3);
        Differential const multigrid(scene, *refiner, SubdivisionRule::Scheme),
            cholesky(scene, *refiner, SubdivisionRule::Scheme, 1e-12, 3);
        EXPECT_LT(test::LargestDifference(multigrid.positions, cholesky.positions), 1e-9);
        EXPECT_LE(cholesky.report.iterations, 4);
    }
}

// The handle keeps the place it came with, to the last bit; everything else only shifts with it.
TEST(Reconstruct, HandlesStay) {
    auto const scene = test::MakeBipyramid(7);
    auto const refiner = test::MakeRefiner(scene, 2);
    Differential const standard(scene, *refiner, SubdivisionRule::Scheme);
    std::vector<double> other = standard.spatial;
    Index const handles[] = {4};
    eval::Reconstructor(*refiner, handles).Solve(standard.deltas, other, {.tolerance = 1e-12});
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(standard.positions[c], standard.spatial[c]);  // vertex 0 is the lowest
        EXPECT_EQ(other[12 + c], standard.spatial[12 + c]);
    }
    EXPECT_LT(test::LargestDifference(standard.positions, other, true), 1e-10);
}

TEST(Reconstruct, HandlesThatCannotServeAreNamed) {
    auto const refuse = [](engine::Scene const& scene, std::vector<Index> const& handles) {
        auto const refiner = test::MakeRefiner(scene, 1);
        return test::RefusalOf([&] { eval::Reconstructor(*refiner, handles); });
    };
    EXPECT_NE(refuse(test::MakeBipyramid(5), {1, 3}).find("handles 1 and 3"), std::string::npos);
    EXPECT_NE(refuse(test::MakeBipyramid(5), {7}).find("handle 7: there are vertices 0 to 6"),
              std::string::npos);
    EXPECT_NE(refuse(test::MakeFan(5, Sdc::SCHEME_LOOP, 0.1, 0.0), {0}).find("inside a boundary"),
              std::string::npos);
}

// Two components, one of them open, and a vertex without any face: each is placed by itself.
TEST(Reconstruct, ComponentsDoNotMix) {
    auto const one = test::MakeBipyramid(5), two = test::MakeFan(6, Sdc::SCHEME_LOOP, 0.1, 0.05);
    auto both = test::Join({one, two});
    both.positions.insert(both.positions.end(), {5, 6, 7});
    ++both.cage.numVertices;
    auto const refiner = test::MakeRefiner(both, 2), alone = test::MakeRefiner(one, 2);
    Differential const result(both, *refiner, SubdivisionRule::Scheme),
        single(one, *alone, SubdivisionRule::Scheme);
    for (Index v = 0; v < one.cage.numVertices; ++v) {
        for (size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(result.positions[3 * static_cast<size_t>(v) + c],
                        single.positions[3 * static_cast<size_t>(v) + c], 1e-9);
        }
    }
    for (double x : result.positions) EXPECT_TRUE(std::isfinite(x));
    size_t const isolated = 3 * static_cast<size_t>(both.cage.numVertices - 1);
    EXPECT_EQ(result.positions[isolated + 2], 7.0);
}

Eigen::Vector3d PointOf(std::vector<double> const& points, Index i) {
    return Eigen::Vector3d(&points[3 * static_cast<size_t>(i)]);
}

double DistanceToTriangle(Eigen::Vector3d const& p, Eigen::Vector3d const& a,
                          Eigen::Vector3d const& b, Eigen::Vector3d const& c) {
    Eigen::Vector3d const normal = (b - a).cross(c - a);
    auto const isInside = [&](Eigen::Vector3d const& u, Eigen::Vector3d const& v) {
        return normal.cross(v - u).dot(p - u) >= 0.0;
    };
    if (isInside(a, b) && isInside(b, c) && isInside(c, a))
        return std::abs(normal.normalized().dot(p - a));
    auto const toSegment = [&](Eigen::Vector3d const& u, Eigen::Vector3d const& v) {
        double const t = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
        return (p - u - t * (v - u)).norm();
    };
    return std::min({toSegment(a, b), toSegment(b, c), toSegment(c, a)});
}

/// Distance of a point from a level's triangles at some vertices.
double DistanceToFaces(Far::TopologyLevel const& level, std::vector<double> const& points,
                       std::vector<Index> const& vertices, Eigen::Vector3d const& p) {
    double nearest = 1e300;
    for (Index vertex : vertices) {
        for (Index face : level.GetVertexFaces(vertex)) {
            auto const v = level.GetFaceVertices(face);
            nearest =
                std::min(nearest, DistanceToTriangle(p, PointOf(points, v[0]),
                                                     PointOf(points, v[1]), PointOf(points, v[2])));
        }
    }
    return nearest;
}

/// Hausdorff distance of the last two levels, each vertex looked for near where it comes from or
/// goes to.
double FindChange(Far::TopologyRefiner const& refiner, std::vector<double> const& fine,
                  std::vector<double> const& coarse) {
    int const last = refiner.GetMaxLevel();
    auto const level = refiner.GetLevel(last - 1), fineLevel = refiner.GetLevel(last);
    double worst = 0.0;
    for (Index v = 0; v < level.GetNumVertices(); ++v) {
        Index const child = level.GetVertexChildVertex(v);
        worst = test::Worse(worst, DistanceToFaces(level, coarse, {v}, PointOf(fine, child)));
        std::vector<Index> near{child};
        for (Index edge : fineLevel.GetVertexEdges(child))
            near.push_back(far_ext::GetOtherEnd(fineLevel, edge, child));
        worst = test::Worse(worst, DistanceToFaces(fineLevel, fine, near, PointOf(coarse, v)));
    }
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        worst = test::Worse(worst, DistanceToFaces(level, coarse, {ends[0], ends[1]},
                                                   PointOf(fine, level.GetEdgeChildVertex(edge))));
    }
    return worst;
}

void CentreMean(std::vector<double>& points) {
    double mean[3] = {0, 0, 0};
    for (size_t i = 0; i < points.size(); ++i)
        mean[i % 3] += 3.0 * points[i] / static_cast<double>(points.size());
    for (size_t i = 0; i < points.size(); ++i) points[i] -= mean[i % 3];
}

// i^1.5 h_i falls from level to level at every valence ([Zhu11] Fig. 4), with vertex means in one
// place.
TEST(Reconstruct, LevelsConverge) {
    for (SubdivisionRule rule : {SubdivisionRule::Scheme, SubdivisionRule::Butterfly}) {
        for (int n = 3; n <= 12; ++n) {
            auto const scene = test::MakeBipyramid(n);
            std::vector<double> before = scene.positions;
            double last = 1e300;
            for (int levels = 1; levels <= 5; ++levels) {
                auto const refiner = test::MakeRefiner(scene, levels);
                auto positions = Differential(scene, *refiner, rule, 1e-10).positions;
                CentreMean(positions);
                double const change =
                    std::pow(levels, 1.5) * FindChange(*refiner, positions, before);
                EXPECT_LT(change, last) << "valence " << n << " level " << levels;
                last = change;
                before = std::move(positions);
            }
        }
    }
}

// A closed mesh shrinks or grows, and nothing hides it: the icosahedron has 0.537 of the control
// mesh's rms radius.
TEST(Reconstruct, SizeIsNotPreserved) {
    auto const scene = test::LoadDifferential("icosa", Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(scene, 4);
    Differential const result(scene, *refiner, SubdivisionRule::Scheme);
    double sum = 0.0, count = static_cast<double>(result.positions.size()) / 3.0;
    double centre[3] = {0, 0, 0};
    for (size_t i = 0; i < result.positions.size(); ++i)
        centre[i % 3] += result.positions[i] / count;
    for (size_t i = 0; i < result.positions.size(); ++i)
        sum += std::pow(result.positions[i] - centre[i % 3], 2) / count;
    double const control = std::hypot(scene.positions[0], scene.positions[1], scene.positions[2]);
    EXPECT_NEAR(std::sqrt(sum) / control, 0.537, 0.001);
}

}  // namespace
}  // namespace limn
