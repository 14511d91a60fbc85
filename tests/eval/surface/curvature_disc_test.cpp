// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/curvature_disc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "eval/surface/surface_sample.h"
#include "far_ext/topology/refiner.h"
#include "support/meshes.h"

namespace limn {
namespace {

using Row = std::array<double, 2>;

/// A fan with one vertex of that valence, vertex 0, and the disc round it.
struct Fan {
    Fan(int valence, Sdc::SchemeType scheme, double a, double b)
        : scene(test::MakeFan(valence, scheme, a, b)),
          refiner(far_ext::CreateRefiner(scene.cage)),
          surface(*refiner),
          tree(surface, scene.positions, 3) {
        Index const facesPerSector = surface.GetNumFaces() / valence;
        for (Index k = 0; k < valence; ++k) sectors.push_back({k * facesPerSector, 0, 0, 0.5});
    }
    engine::Scene scene;
    std::unique_ptr<Far::TopologyRefiner> refiner;
    eval::LimitSurface surface;
    eval::FaceTree tree;
    std::vector<eval::DiscSector> sectors;
};

/// Integral of K times the weight, ring by ring towards the vertex down to 2^-15, by 3 x 3 Gauss
/// points of 4 x 4 cells per polynomial piece. What lies nearer follows from the rings' being a
/// geometric series in the end.
template <class Weight>
double IntegrateFinely(Fan& fan, double radius, Weight weight) {
    constexpr double kNodes[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
    constexpr double kWeights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    bool const isLoop = fan.surface.IsLoop();
    std::vector<double> rings(14, 0.0);
    for (eval::DiscSector const& sector : fan.sectors) {
        fan.tree.Bind(sector.face);
        auto const add = [&](double& sum, Row origin, Row x, Row y, bool isTriangle) {
            for (int j = 0; j < 12; ++j) {
                for (int i = 0; i < 12; ++i) {
                    double const p = (i / 3 + kNodes[i % 3]) / 4, q = (j / 3 + kNodes[j % 3]) / 4;
                    double const width = isTriangle ? p : 1.0;
                    double const a = origin[0] + p * x[0] + width * q * y[0],
                                 b = origin[1] + p * x[1] + width * q * y[1];
                    auto const at = eval::EvaluateSample(fan.tree, 0, a, b);
                    double const area = at.tangentS.cross(at.tangentT).norm() *
                                        std::abs(x[0] * y[1] - x[1] * y[0]) * width;
                    sum += at.curvature.gaussian * area * weight(a, b) * kWeights[i % 3] *
                           kWeights[j % 3] / 16;
                }
            }
        };
        double h = 0.5 * radius;
        for (double& ring : rings) {
            if (isLoop) {
                add(ring, {h, 0}, {h, 0}, {-h, h}, true);
                add(ring, {h, h}, {-h, 0}, {h, -h}, true);
                add(ring, {0, h}, {h, 0}, {-h, h}, true);
            } else {
                add(ring, {h, 0}, {h, 0}, {0, h}, false);
                add(ring, {h, h}, {h, 0}, {0, h}, false);
                add(ring, {0, h}, {h, 0}, {0, h}, false);
            }
            h *= 0.5;
        }
    }
    double const last = rings.back(), ratio = last / rings[rings.size() - 2];
    double const rest = std::abs(last) > 1e-9 ? last * ratio / (1.0 - ratio) : 0.0;
    return std::accumulate(rings.begin(), rings.end(), rest);
}

class DiscRound : public testing::TestWithParam<std::pair<int, Sdc::SchemeType>> {
protected:
    /// Of the reference: the larger the valence, the slower its rings shrink, cup and saddle at
    /// rates of their own.
    double GetTolerance() const {
        return GetParam().first > 9 ? 2e-3 : GetParam().first > 6 ? 2e-5 : 2e-6;
    }
};

INSTANTIATE_TEST_SUITE_P(
    Vertices, DiscRound,
    testing::Values(std::pair{3, Sdc::SCHEME_CATMARK}, std::pair{4, Sdc::SCHEME_CATMARK},
                    std::pair{5, Sdc::SCHEME_CATMARK}, std::pair{6, Sdc::SCHEME_CATMARK},
                    std::pair{8, Sdc::SCHEME_CATMARK}, std::pair{12, Sdc::SCHEME_CATMARK},
                    std::pair{3, Sdc::SCHEME_LOOP}, std::pair{5, Sdc::SCHEME_LOOP},
                    std::pair{6, Sdc::SCHEME_LOOP}, std::pair{9, Sdc::SCHEME_LOOP}));

// What the border tells by the theorem of Gauss and Bonnet is what lies inside.
TEST_P(DiscRound, TheBorderKnowsTheCurvatureInside) {
    for (auto const& [a, b] : {std::pair{0.2, 0.0}, {0.0, 0.2}, {0.15, -0.1}}) {
        Fan fan(GetParam().first, GetParam().second, a, b);
        double const inside = IntegrateFinely(fan, 0.25, [](double, double) { return 1.0; });
        EXPECT_NEAR(eval::IntegrateInnerDisc(fan.tree, fan.sectors), inside, GetTolerance())
            << a << " " << b;
    }
}

TEST_P(DiscRound, TheWholeDiscIsWeighted) {
    Fan fan(GetParam().first, GetParam().second, 0.15, -0.1);
    bool const isLoop = fan.surface.IsLoop();
    double const weighted = IntegrateFinely(
        fan, 0.5, [&](double a, double b) { return eval::GetDiscWeight(isLoop, a, b, 0.5); });
    EXPECT_NEAR(eval::IntegrateDisc(fan.tree, fan.sectors), weighted, GetTolerance());
}

// The angle defect of a flat fan is 0, whatever its valence.
TEST_P(DiscRound, APlaneHasNoCurvature) {
    Fan fan(GetParam().first, GetParam().second, 0.0, 0.0);
    EXPECT_NEAR(eval::IntegrateDisc(fan.tree, fan.sectors), 0.0, 1e-9);
}

// Discs of all sizes, which differ only by the ring between them.
TEST_P(DiscRound, SmallerDiscsLeaveTheRingBetween) {
    Fan fan(GetParam().first, GetParam().second, 0.15, -0.1);
    double const large = eval::IntegrateInnerDisc(fan.tree, fan.sectors);
    double const rings = IntegrateFinely(fan, 0.25, [&](double a, double b) {
        return (fan.surface.IsLoop() ? a + b : std::max(a, b)) > 0x1p-6 ? 1.0 : 0.0;
    });
    for (auto& sector : fan.sectors) sector.radius = 0x1p-5;
    EXPECT_NEAR(eval::IntegrateInnerDisc(fan.tree, fan.sectors), large - rings, 1e-7);
}

class DiscWeight : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Schemes, DiscWeight, testing::Bool());

TEST_P(DiscWeight, IsOneInsideZeroOutsideAndTheSameFromBothSidesOfAnEdge) {
    bool const isLoop = GetParam();
    for (int i = 0; i <= 64; ++i) {
        for (int j = 0; j + (isLoop ? i : 0) <= 64; ++j) {
            double const a = i / 64.0, b = j / 64.0, distance = isLoop ? a + b : std::max(a, b);
            double const weight = eval::GetDiscWeight(isLoop, a, b, 0.5);
            EXPECT_EQ(weight, eval::GetDiscWeight(isLoop, b, a, 0.5));
            if (distance > 0.25 && distance < 0.5) continue;
            EXPECT_NEAR(weight, distance <= 0.25 ? 1.0 : 0.0, 1e-15) << a << " " << b;
        }
    }
}

// In the plane of a regular vertex the weight of neighbouring sectors is one smooth function: its
// slope across their common edge vanishes on quads; on triangles, mirrored there, it is that along
// the edge.
TEST_P(DiscWeight, IsSmoothAcrossEdges) {
    bool const isLoop = GetParam();
    double const e = 1e-5;
    for (double a = 0.26; a < 0.5; a += 0.02) {
        double const here = eval::GetDiscWeight(isLoop, a, e, 0.5);
        double const beyond = eval::GetDiscWeight(isLoop, isLoop ? a - e : a, e,
                                                  0.5);  // (a, -e) seen from the other side
        double const middle = eval::GetDiscWeight(isLoop, a, 0.0, 0.5);
        EXPECT_NEAR((here - middle) / e, (middle - beyond) / e, 1e-2) << a;
    }
}

TEST_P(DiscWeight, CornerCoordinatesAreUndone) {
    bool const isLoop = GetParam();
    for (int corner = 0; corner < (isLoop ? 3 : 4); ++corner) {
        auto const [s, t] = eval::FromCorner(isLoop, corner, 0.25, 0.125);
        auto const [a, b] = eval::ToCorner(isLoop, corner, s, t);
        EXPECT_EQ(a, 0.25);
        EXPECT_EQ(b, 0.125);
    }
}

// Along a: towards the next corner; along b: towards the one before.
TEST_P(DiscWeight, CornerCoordinatesFollowTheEdges) {
    bool const isLoop = GetParam();
    int const size = isLoop ? 3 : 4;
    for (int corner = 0; corner < size; ++corner) {
        EXPECT_EQ(eval::FromCorner(isLoop, corner, 1.0, 0.0),
                  eval::FromCorner(isLoop, (corner + 1) % size, 0.0, 0.0));
        EXPECT_EQ(eval::FromCorner(isLoop, corner, 0.0, 1.0),
                  eval::FromCorner(isLoop, (corner + size - 1) % size, 0.0, 0.0));
    }
}

}  // namespace
}  // namespace limn
