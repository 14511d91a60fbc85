// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/limit_surface.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opensubdiv/bfr/parameterization.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>

#include "eval/differential/refine_values.h"
#include "eval/surface/surface_place.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

namespace Bfr = OpenSubdiv::Bfr;
using eval::FaceTree;
using eval::LimitSurface;

/// OpenSubdiv's own evaluator, isolated as deep as it goes: the slow reference.
class BfrReference {
public:
    BfrReference(Far::TopologyRefiner const& refiner, std::vector<double> const& positions,
                 int level)
        : _factory(refiner, MakeOptions(level)), _positions(positions) {}

    bool Bind(Index face) {
        _surface.reset(_factory.CreateVertexSurface<double>(face));
        if (!_surface || !_surface->IsValid()) return false;
        _points.resize(static_cast<size_t>(_surface->GetNumPatchPoints()) * 3);
        _surface->PreparePatchPoints(_positions.data(), {3}, _points.data(), {3});
        return true;
    }

    /// P, Ps, Pt, Pss, Pst, Ptt
    std::array<Eigen::Vector3d, 6> Evaluate(double s, double t) const {
        double const st[2] = {s, t};
        std::array<Eigen::Vector3d, 6> r;
        _surface->Evaluate(st, _points.data(), {3}, r[0].data(), r[1].data(), r[2].data(),
                           r[3].data(), r[4].data(), r[5].data());
        return r;
    }

    /// OpenSubdiv 3.5 turns the sign of second derivatives in the flipped (middle) triangles of
    /// Loop meshes, so for Loop they come from differences of its first derivatives.
    std::array<Eigen::Vector3d, 6> EvaluateByDifferences(double s, double t) const {
        constexpr double h = 1e-5;
        auto const at = Evaluate(s, t), s0 = Evaluate(s - h, t), s1 = Evaluate(s + h, t);
        auto const t0 = Evaluate(s, t - h), t1 = Evaluate(s, t + h);
        return {at[0],
                at[1],
                at[2],
                (s1[1] - s0[1]) / (2 * h),
                (t1[1] - t0[1]) / (2 * h),
                (t1[2] - t0[2]) / (2 * h)};
    }

    Bfr::Parameterization GetParameterization() const { return _surface->GetParameterization(); }

private:
    static Bfr::SurfaceFactory::Options MakeOptions(int level) {
        Bfr::SurfaceFactory::Options options;
        options.SetApproxLevelSmooth(level);
        options.SetApproxLevelSharp(level);
        return options;
    }

    Bfr::RefinerSurfaceFactory<> _factory;
    std::vector<double> const& _positions;
    std::unique_ptr<Bfr::Surface<double>> _surface;
    std::vector<double> _points;
};

struct Deviation {
    double position = 0.0, normal = 0.0, curvature = 0.0;
    int numSamples = 0, numNormals = 0;
};

/// Largest deviation of limn from deep Bfr over samples of every face. Normals and curvatures are
/// compared where both find a tangent plane; curvature relative to the larger of |k1|, |k2|.
Deviation CompareWithBfr(engine::Scene const& scene, int level, int samplesPerSide) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    FaceTree tree(surface, scene.positions, 3);
    BfrReference bfr(*refiner, scene.positions, level);
    bool const isLoop = surface.IsLoop();
    double const size = test::BoxDiagonal(scene.positions);
    Deviation worst;
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        bool const hasLimit = bfr.Bind(face);
        EXPECT_EQ(hasLimit, surface.HasLimit(face)) << "face " << face;
        if (!hasLimit || !surface.HasLimit(face)) continue;
        tree.Bind(face);
        for (int domain = 0; domain < surface.GetNumDomains(face); ++domain) {
            for (int i = 0; i < samplesPerSide; ++i) {
                for (int j = 0; j < samplesPerSide; ++j) {
                    // Not on a dyadic place, and farther from corners than the deepest patch.
                    double s = (i + 0.37) / samplesPerSide, t = (j + 0.41) / samplesPerSide;
                    if (isLoop && s + t > 0.99) continue;
                    double coord[2] = {s, t};
                    if (bfr.GetParameterization().HasSubFaces()) {
                        bfr.GetParameterization().ConvertNormalizedSubFaceToCoord(domain, coord,
                                                                                  coord);
                    }
                    auto const expected = isLoop ? bfr.EvaluateByDifferences(coord[0], coord[1])
                                                 : bfr.Evaluate(coord[0], coord[1]);
                    auto const sample = eval::EvaluateSample(tree, domain, s, t);
                    worst.position =
                        test::Worse(worst.position, (sample.position - expected[0]).norm() / size);
                    ++worst.numSamples;
                    Eigen::Vector3d const n = expected[1].cross(expected[2]);
                    bool const isCollapsed =
                        n.norm() < 1e-10 * size * size ||
                        n.norm() < 1e-6 * expected[1].norm() * expected[2].norm();
                    if (isCollapsed) continue;
                    worst.normal =
                        test::Worse(worst.normal, (sample.normal - n.normalized()).norm());
                    ++worst.numNormals;
                    auto const k = eval::ComputeCurvature(expected[1], expected[2], expected[3],
                                                          expected[4], expected[5]);
                    double const scale = std::max({std::abs(k.k1), std::abs(k.k2), 1e-3 / size});
                    for (double miss : {k.k1 - sample.curvature.k1, k.k2 - sample.curvature.k2})
                        worst.curvature = test::Worse(worst.curvature, std::abs(miss) / scale);
                }
            }
        }
    }
    return worst;
}

/// The regression cages that a test takes.
template <class Takes>
std::vector<std::string> ChooseShapes(Takes takes) {
    auto names = test::ListShapes();
    std::erase_if(names, [&](std::string const& name) { return !takes(name); });
    return names;
}

std::string NameOf(testing::TestParamInfo<std::string> const& cage) {
    return cage.param;
}

class BfrOn : public testing::TestWithParam<std::string> {};

TEST_P(BfrOn, AgreesWithTheLimitSurfaceWhereItGoesDeep) {
    Deviation const d = CompareWithBfr(test::LoadShape(GetParam()), 10, 4);
    EXPECT_GT(d.numSamples, 0);
    EXPECT_GT(d.numNormals, d.numSamples / 2);
    EXPECT_LT(d.position, 1e-6);
    EXPECT_LT(d.normal, 1e-5);
    EXPECT_LT(d.curvature, 1e-4);
}

// Bfr 3.5 crashes on catmark_val2_interior.
INSTANTIATE_TEST_SUITE_P(OpenSubdiv, BfrOn,
                         testing::ValuesIn(ChooseShapes([](std::string const& name) {
                             return name != "catmark_val2_interior";
                         })),
                         NameOf);

// -------- independent of Bfr: uniform refinement converges to the limit

class CornersOf : public testing::TestWithParam<std::string> {};

// A corner of the cage, refined six times, lies within O(4^-6) of its limit; for valence 2 and
// repeated corners, where Bfr is wrong or crashes, this is the reference.
TEST_P(CornersOf, AreWhereRefinementLeads) {
    engine::Scene const scene = test::LoadShape(GetParam());
    constexpr int kLevels = 6;
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const deep = far_ext::CreateRefiner(scene.cage);
    deep->RefineUniform(Far::TopologyRefiner::UniformOptions(kLevels));
    std::vector<double> points = scene.positions;
    for (int level = 1; level <= kLevels; ++level)
        points = eval::RefineValues<3>(*deep, level, points);
    LimitSurface const surface(*refiner);
    FaceTree tree(surface, scene.positions, 3);
    double const size = test::BoxDiagonal(scene.positions);
    auto const base = deep->GetLevel(0);
    int numCompared = 0;
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (!surface.HasLimit(face)) continue;
        ++numCompared;
        tree.Bind(face);
        auto const vertices = base.GetFaceVertices(face);
        for (int corner = 0; corner < vertices.size(); ++corner) {
            Index vertex = vertices[corner];
            for (int level = 0; level < kLevels; ++level)
                vertex = deep->GetLevel(level).GetVertexChildVertex(vertex);
            auto const place = eval::GetCornerPlace(surface, face, corner);
            auto const sample = eval::EvaluateSample(tree, place.domain, place.s, place.t);
            EXPECT_LT((sample.position - Eigen::Vector3d(&points[3 * static_cast<size_t>(vertex)]))
                          .norm(),
                      2e-3 * size)
                << "face " << face << " corner " << corner;
            EXPECT_TRUE(sample.normal.allFinite());
        }
    }
    EXPECT_GT(numCompared, 0);
}

// The others are too large to be refined six times.
INSTANTIATE_TEST_SUITE_P(OpenSubdiv, CornersOf,
                         testing::ValuesIn(ChooseShapes([](std::string const& name) {
                             return test::LoadShape(name).cage.GetNumFaces() <= 500;
                         })),
                         NameOf);

// -------- extraordinary vertices [Limit 10]

/// Mean curvature along the diagonal of the fan's first face at distances 2^-level.
std::vector<double> MeanTowardsVertex(int valence, double cup, double saddle, int fromLevel,
                                      int toLevel) {
    engine::Scene const scene = test::MakeFan(valence, Sdc::SCHEME_CATMARK, cup, saddle);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    FaceTree tree(surface, scene.positions, 3);
    tree.Bind(0);
    std::vector<double> values;
    for (int level = fromLevel; level <= toLevel; ++level) {
        double const at = std::ldexp(0.75, -level);
        auto const sample = eval::EvaluateSample(tree, 0, at, at);
        EXPECT_FALSE(sample.isMoved);
        values.push_back(sample.curvature.mean);
    }
    return values;
}

struct GrowthCase {
    int valence;
    double factor;
};

class CurvatureGrowth : public testing::TestWithParam<GrowthCase> {};

// Cup mode: from level to level curvature grows by mu/lambda^2, with lambda the subdominant and mu
// the next rotation-free eigenvalue of Catmull-Clark's matrix: 0.991 at valence 3, 1.066 at 5,
// 1.186 at 8.
TEST_P(CurvatureGrowth, OfTheCupModeIsThatOfTheEigenvalues) {
    auto const h = MeanTowardsVertex(GetParam().valence, -0.1, 0.0, 10, 14);
    for (size_t i = 1; i < h.size(); ++i) EXPECT_NEAR(h[i] / h[i - 1], GetParam().factor, 1.5e-3);
}

INSTANTIATE_TEST_SUITE_P(Valences, CurvatureGrowth,
                         testing::Values(GrowthCase{3, 0.991}, GrowthCase{5, 1.066},
                                         GrowthCase{8, 1.186}),
                         [](testing::TestParamInfo<GrowthCase> const& growth) {
                             return "valence" + std::to_string(growth.param.valence);
                         });

TEST(LimitSurface, SamplesNearerThanTheLimitAreMovedAndSaySo) {
    engine::Scene const scene = test::MakeFan(6, Sdc::SCHEME_CATMARK, 0.1, 0.05);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    FaceTree tree(surface, scene.positions, 3);
    tree.Bind(0);
    auto const edge = eval::EvaluateSample(tree, 0, 0x1p-16, 0x1p-17);  // at the limit distance
    auto const near = eval::EvaluateSample(tree, 0, 0x1p-20, 0x1p-21);  // same direction, nearer
    auto const corner = eval::EvaluateSample(tree, 0, 0.0, 0.0);
    EXPECT_FALSE(edge.isMoved);
    EXPECT_TRUE(near.isMoved);
    EXPECT_TRUE(corner.isMoved);
    EXPECT_NEAR(near.curvature.k1, edge.curvature.k1, 1e-9 * std::abs(edge.curvature.k1));
    // Position and normal are those of the place itself.
    EXPECT_LT((near.position - corner.position).norm(), 1e-4);
    EXPECT_LT((near.position - corner.position).norm(),
              0.2 * (edge.position - corner.position).norm());
    EXPECT_NEAR(near.normal.dot(corner.normal), 1.0, 1e-7);
}

// A quadratic height field's limit on a regular grid is a paraboloid; its curvature at the apex is
// 2a in every direction (z = a r^2, seen from above: curved away from the normal, so -2a).
TEST(LimitSurface, LargeRingsAreRefusedByNumber) {
    auto const hasExcess = [](engine::Scene const& scene) {
        return LimitSurface::FindExcess(*far_ext::CreateRefiner(scene.cage)).has_value();
    };
    auto const refuse = [](engine::Scene const& scene) {
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        return test::RefusalOf([&] { LimitSurface const surface(*refiner); });
    };
    auto const polygon = [](int size) {
        std::vector<std::vector<Index>> faces(1);
        for (Index i = 0; i < size; ++i) faces[0].push_back(i);
        return test::MakeScene(std::vector<double>(3 * static_cast<size_t>(size)), faces);
    };
    auto const fan = [](int valence) { return test::MakeFan(valence, Sdc::SCHEME_LOOP, 0, 0); };
    EXPECT_FALSE(hasExcess(polygon(LimitSurface::kMaxCorners)));
    EXPECT_EQ(refuse(polygon(LimitSurface::kMaxCorners + 1)),
              "face 0 has 257 corners; a limit surface takes up to 256");
    EXPECT_FALSE(hasExcess(fan(LimitSurface::kMaxValence)));
    EXPECT_EQ(refuse(fan(LimitSurface::kMaxValence + 1)),
              "vertex 0 has 513 faces; a limit surface takes up to 512");
}

TEST(LimitSurface, AParaboloidHasItsCurvature) {
    engine::Scene const scene = test::MakeFan(4, Sdc::SCHEME_CATMARK, 0.1, 0.0);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    FaceTree tree(surface, scene.positions, 3);
    tree.Bind(0);
    auto const apex = eval::EvaluateSample(tree, 0, 0.0, 0.0);
    EXPECT_NEAR(apex.normal[2], 1.0, 1e-12);
    EXPECT_NEAR(apex.curvature.k1, -0.2, 1e-12);
    EXPECT_NEAR(apex.curvature.k2, -0.2, 1e-12);
    auto const turned = eval::EvaluateSample(tree, 0, 0.0, 0.0, Orientation::Left);
    EXPECT_NEAR(turned.normal[2], -1.0, 1e-12);
    EXPECT_NEAR(turned.curvature.k1, 0.2, 1e-12);
}

class LimitSurfaceOf : public testing::TestWithParam<std::string> {};

// Rotating the cage rotates positions and normals and leaves curvature alone.
TEST_P(LimitSurfaceOf, RotatesWithItsCage) {
    engine::Scene const scene = test::LoadShape(GetParam());
    Eigen::Matrix3d const R = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(-1.1, Eigen::Vector3d::UnitZ()))
                                  .toRotationMatrix();
    std::vector<double> turned = scene.positions;
    for (size_t v = 0; v < turned.size(); v += 3) {
        Eigen::Map<Eigen::Vector3d>{&turned[v]} =
            R * Eigen::Map<Eigen::Vector3d const>(&scene.positions[v]);
    }
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    FaceTree before(surface, scene.positions, 3), after(surface, turned, 3);
    double const size = test::BoxDiagonal(scene.positions);
    Index const step = std::max(1, surface.GetNumFaces() / 100);
    int numCompared = 0;
    for (Index face = 0; face < surface.GetNumFaces(); face += step) {
        if (!surface.HasLimit(face)) continue;
        ++numCompared;
        before.Bind(face);
        after.Bind(face);
        auto const a = eval::EvaluateSample(before, 0, 0.3, 0.4),
                   b = eval::EvaluateSample(after, 0, 0.3, 0.4);
        EXPECT_LT((R * a.position - b.position).norm(), 1e-12 * size);
        if (a.isDegenerate || a.tangentS.cross(a.tangentT).norm() < 1e-9 * size * size) continue;
        EXPECT_LT((R * a.normal - b.normal).norm(), 1e-9);
        EXPECT_NEAR(a.curvature.mean, b.curvature.mean,
                    1e-8 * (std::abs(a.curvature.k1) + std::abs(a.curvature.k2) + 1 / size));
    }
    EXPECT_GT(numCompared, 0);
}

INSTANTIATE_TEST_SUITE_P(OpenSubdiv, LimitSurfaceOf, testing::ValuesIn(test::ListShapes()), NameOf);

}  // namespace
}  // namespace limn
