// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/boundary_problem.h"

#include <cmath>

#include <gtest/gtest.h>

#include "far_ext/forms/form_operators.h"
#include "far_ext/rows/points.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using eval::BoundaryData;
using eval::BoundaryProblem;

/// A flat ring of triangles between the circles of radius 1 and 2: vertices 0 to m - 1 are the
/// inner circle.
engine::Scene MakeRing(int numRings, int m) {
    std::vector<double> positions;
    std::vector<std::vector<Index>> faces;
    for (int i = 0; i <= numRings; ++i) {
        for (int j = 0; j < m; ++j) {
            double const radius = 1.0 + static_cast<double>(i) / numRings,
                         angle = 2.0 * M_PI * j / m;
            positions.insert(positions.end(),
                             {radius * std::cos(angle), radius * std::sin(angle), 0.0});
        }
    }
    for (int i = 0; i < numRings; ++i) {
        for (int j = 0; j < m; ++j) {
            Index const a = i * m + j, b = i * m + (j + 1) % m;
            faces.push_back({a, a + m, b});
            faces.push_back({b, a + m, b + m});
        }
    }
    return test::MakeScene(std::move(positions), faces, Sdc::SCHEME_LOOP);
}

class Ring {
public:
    explicit Ring(int numRings)
        : scene(MakeRing(numRings, 12 * numRings)),
          refiner(far_ext::CreateRefiner(scene.cage)),
          level(refiner->GetLevel(0)),
          data{std::vector<char>(level.GetNumEdges(), 0),
               std::vector<double>(level.GetNumEdges(), 0.0)} {}

    bool IsOnInner(Index edge) const {
        auto const ends = level.GetEdgeVertices(edge);
        return level.GetEdgeFaces(edge).size() == 1 && ends[0] < numInner && ends[1] < numInner;
    }
    bool IsOnOuter(Index edge) const {
        return level.GetEdgeFaces(edge).size() == 1 && !IsOnInner(edge);
    }

    /// A total on a circle, the same on all of its edges: circulation counter-clockwise.
    void SetCircle(bool isInner, bool isCirculation, double total) {
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            if (isInner ? !IsOnInner(edge) : !IsOnOuter(edge)) continue;
            auto const ends = level.GetEdgeVertices(edge);
            auto const a = far_ext::Points(scene.positions)[std::min(ends[0], ends[1])],
                       b = far_ext::Points(scene.positions)[std::max(ends[0], ends[1])];
            double const sign = a.x() * b.y() - a.y() * b.x() > 0.0 ? 1.0 : -1.0;
            data.isCirculation[edge] = isCirculation;
            data.values[edge] = (isCirculation ? sign : 1.0) * total / numInner;
        }
    }

    /// The largest difference to a form of angle and radius, over its largest value.
    template <class Potential>
    double Compare(std::vector<double> const& form, Potential const& integrate) const {
        double worst = 0.0, largest = 0.0;
        far_ext::Points const points(scene.positions);
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            auto const ends = level.GetEdgeVertices(edge);
            double const exact =
                integrate(points[std::min(ends[0], ends[1])], points[std::max(ends[0], ends[1])]);
            worst = test::Worse(worst, std::abs(form[edge] - exact));
            largest = std::max(largest, std::abs(exact));
        }
        return worst / largest;
    }

    engine::Scene scene;
    std::unique_ptr<Far::TopologyRefiner> refiner;
    Far::TopologyLevel const& level;
    Index numInner = 0;
    BoundaryData data;
};

Ring MakeRingOf(int numRings) {
    Ring ring(numRings);
    ring.numInner = 12 * numRings;
    return ring;
}

std::vector<double> Zero(int count) {
    return std::vector<double>(static_cast<size_t>(count), 0.0);
}

// d(angle)/2pi: circulation 1 round every circle, no flux.
TEST(BoundaryProblem, CirculationRoundARingIsTheAngle) {
    Ring ring = MakeRingOf(4);
    ring.SetCircle(false, true, 1.0);
    BoundaryProblem const problem(ring.level, ring.scene.positions, ring.data);
    auto const sources = Zero(ring.level.GetNumVertices()),
               vortices = Zero(ring.level.GetNumFaces());
    std::vector<double> const arcs(problem.GetArcs().count, 0.0);
    auto const form = problem.Solve(sources, vortices, arcs);
    EXPECT_LT(problem.FindResidual(form, sources, vortices, arcs), 1e-12);
    EXPECT_LT(ring.Compare(form,
                           [](auto const& a, auto const& b) {
                               return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)) /
                                      (2.0 * M_PI);
                           }),
              3e-3);
}

// A flow from the inner circle to the outer one is d(log r)/2pi; finer rings are nearer to it.
TEST(BoundaryProblem, FluxThroughARingIsTheLogarithm) {
    double last = 1.0;
    for (int numRings : {4, 8, 16}) {
        Ring ring = MakeRingOf(numRings);
        ring.SetCircle(true, false, -1.0);
        ring.SetCircle(false, false, 1.0);
        BoundaryProblem const problem(ring.level, ring.scene.positions, ring.data);
        auto const sources = Zero(ring.level.GetNumVertices()),
                   vortices = Zero(ring.level.GetNumFaces());
        auto const form = problem.Solve(sources, vortices, {});
        EXPECT_LT(problem.FindResidual(form, sources, vortices, {}), 1e-10);
        double const error = ring.Compare(form, [](auto const& a, auto const& b) {
            return 0.5 * std::log(b.squaredNorm() / a.squaredNorm()) / (2.0 * M_PI);
        });
        EXPECT_LT(error, 0.8 * last);
        last = error;
    }
    EXPECT_LT(last, 5e-3);
}

// Half of the outer circle normal: curl, circulation and divergence are met, and what comes in on
// the inner circle leaves there.
TEST(BoundaryProblem, MixedDataAreMet) {
    Ring ring = MakeRingOf(8);
    ring.SetCircle(true, false, -1.0);
    for (Index edge = 0; edge < ring.level.GetNumEdges(); ++edge) {
        Index const end = ring.level.GetEdgeVertices(edge)[0];
        if (ring.IsOnOuter(edge) && far_ext::Points(ring.scene.positions)[end].y() > 0.0)
            ring.data.isCirculation[edge] = 1;
    }
    BoundaryProblem const problem(ring.level, ring.scene.positions, ring.data);
    ASSERT_GE(problem.GetArcs().count, 1);
    std::vector<double> const arcs(problem.GetArcs().count, 0.0);
    auto sources = Zero(ring.level.GetNumVertices()), vortices = Zero(ring.level.GetNumFaces());
    sources[200] = 0.5;
    vortices[100] = 2.0;
    auto const form = problem.Solve(sources, vortices, arcs);
    EXPECT_LT(problem.FindResidual(form, sources, vortices, arcs), 1e-12);
    auto const outflow = problem.FindOutflow(form, sources);
    double out = 0.0;
    for (Index vertex = 0; vertex < ring.level.GetNumVertices(); ++vertex) {
        if (problem.GetArcs().ofVertex[vertex] >= 0) out += outflow[vertex];
    }
    EXPECT_NEAR(out, 1.5, 1e-10);
}

// Two normal circles: the first one takes what flows, the other lets out what it is told to.
TEST(BoundaryProblem, ArcsLetOutWhatTheyAreTold) {
    Ring ring = MakeRingOf(4);
    ring.SetCircle(true, true, 0.0);
    ring.SetCircle(false, true, 0.0);
    BoundaryProblem const problem(ring.level, ring.scene.positions, ring.data);
    ASSERT_EQ(problem.GetArcs().count, 2);
    auto sources = Zero(ring.level.GetNumVertices());
    auto const vortices = Zero(ring.level.GetNumFaces());
    sources[60] = 1.0;
    for (double const wanted : {0.0, 0.25, 1.0}) {
        std::vector<double> arcs(2, 0.0);
        arcs[problem.GetArcs().isFirst[0] ? 1 : 0] = wanted;
        auto const form = problem.Solve(sources, vortices, arcs);
        auto const outflow = problem.FindOutflow(form, sources);
        std::vector<double> out(2, 0.0);
        for (Index vertex = 0; vertex < ring.level.GetNumVertices(); ++vertex) {
            int const arc = problem.GetArcs().ofVertex[vertex];
            if (arc >= 0) out[arc] += outflow[vertex];
        }
        EXPECT_NEAR(out[1], wanted, 1e-11);
        EXPECT_NEAR(out[0], 1.0 - wanted, 1e-11);
    }
}

TEST(BoundaryProblem, BalancesTellWhatHasToBeEqual) {
    Ring ring = MakeRingOf(4);
    ring.SetCircle(true, false, -1.0);
    ring.SetCircle(false, true, 3.0);
    BoundaryProblem const mixed(ring.level, ring.scene.positions, ring.data);
    auto sources = Zero(ring.level.GetNumVertices()), vortices = Zero(ring.level.GetNumFaces());
    sources[30] = 0.5;
    vortices[7] = 2.0;
    auto const balance = mixed.FindBalances(sources, vortices).at(0);
    EXPECT_TRUE(balance.hasArc && balance.hasFreeEdge);
    EXPECT_NEAR(balance.sources, 0.5, 1e-15);
    EXPECT_NEAR(balance.fluxes, -1.0, 1e-12);
    EXPECT_NEAR(balance.vortices, 2.0, 1e-15);
    EXPECT_NEAR(balance.circulations, 3.0, 1e-12);
}

}  // namespace
}  // namespace limn
