// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rings/ring_subdivision.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>

#include "far_ext/topology/refiner.h"
#include "support/meshes.h"

namespace limn {
namespace {

using far_ext::FaceRing;
using far_ext::FaceRingGatherer;
using far_ext::RingSubdivision;

/// Calls visit(scene, refiner, face, ring, points) for the vertex ring of every face of every
/// regression cage; of large ones, of some forty.
template <class Visit>
void ForEachRing(Visit visit) {
    for (std::string const& name : test::ListShapes()) {
        engine::Scene scene = test::LoadShape(name);
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        FaceRingGatherer gatherer(refiner->GetLevel(0), scene.cage.options, -1);
        FaceRing ring;
        std::vector<Index> points;
        Index const step = std::max<Index>(1, scene.cage.GetNumFaces() / 40);
        for (Index face = 0; face < scene.cage.GetNumFaces(); face += step) {
            gatherer.Gather(face, ring, points);
            SCOPED_TRACE(name + " face " + std::to_string(face));
            visit(scene, *refiner, face, ring, points);
        }
    }
}

void ExpectRowsSumToOne(far_ext::SparseRows const& rows) {
    for (int row = 0; row < rows.GetNumRows(); ++row) {
        double const sum = std::accumulate(rows.weights.begin() + rows.offsets[row],
                                           rows.weights.begin() + rows.offsets[row + 1], 0.0);
        ASSERT_NEAR(sum, 1.0, 1e-14);
    }
}

// Subdivision and extrapolation are affine: moving all points moves the result.
TEST(RingSubdivision, RowsSumToOne) {
    ForEachRing(
        [](engine::Scene const& scene, auto const&, Index, FaceRing const& ring, auto const&) {
            auto const step = RingSubdivision::Build(ring, scene.cage.scheme, scene.cage.options);
            ExpectRowsSumToOne(step.patch);
            for (auto const& child : step.children) ExpectRowsSumToOne(child.weights);
        });
}

// A child's own corners must be the points that OpenSubdiv's refinement of the whole mesh gives
// them.
TEST(RingSubdivision, ChildrenAreTheRefinedFacesOfTheWholeMesh) {
    struct Point {
        double x = 0.0;
        void Clear() { x = 0.0; }
        void AddWithWeight(Point const& other, double weight) { x += weight * other.x; }
    };
    ForEachRing([](engine::Scene const& scene, auto const&, Index face, FaceRing const& ring,
                   std::vector<Index> const& points) {
        auto const step = RingSubdivision::Build(ring, scene.cage.scheme, scene.cage.options);
        if (step.children.empty()) return;
        auto const whole = far_ext::CreateRefiner(scene.cage);
        whole->RefineUniform(Far::TopologyRefiner::UniformOptions(1));
        auto const coarse = whole->GetLevel(0), fine = whole->GetLevel(1);
        std::vector<Point> from(static_cast<size_t>(coarse.GetNumVertices()));
        std::vector<Point> to(static_cast<size_t>(fine.GetNumVertices()));
        for (size_t v = 0; v < from.size(); ++v) from[v].x = scene.positions[3 * v];
        Far::PrimvarRefinerReal<double>(*whole).Interpolate(1, from, to);

        auto const childFaces = coarse.GetFaceChildFaces(face);
        ASSERT_EQ(static_cast<size_t>(childFaces.size()), step.children.size());
        for (int c = 0; c < childFaces.size(); ++c) {
            auto const& weights = step.children[c].weights;
            auto const vertices = fine.GetFaceVertices(childFaces[c]);
            for (int corner = 0; corner < vertices.size(); ++corner) {
                int const row = step.children[c].ring.GetFaceVertices()[corner];
                double x = 0.0;
                for (int k = weights.offsets[row]; k < weights.offsets[row + 1]; ++k) {
                    x += weights.weights[k] *
                         scene.positions[3 * static_cast<size_t>(points[weights.indices[k]])];
                }
                ASSERT_NEAR(x, to[vertices[corner]].x,
                            1e-6 * (1.0 + std::abs(x)));  // Loop rounds its weights to float
            }
        }
    });
}

// At an extraordinary vertex the corner child has the ring of its parent from the second step on:
// what makes a few matrices serve every depth.
TEST(RingSubdivision, ExtraordinaryCornersBecomeStationary) {
    for (int valence : {3, 5, 8, 12}) {
        engine::Scene const scene = test::MakeFan(valence, Sdc::SCHEME_CATMARK, 0.1, 0.1);
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        FaceRingGatherer gatherer(refiner->GetLevel(0), scene.cage.options, -1);
        FaceRing ring;
        std::vector<Index> points;
        gatherer.Gather(0, ring, points);  // its corner 0 is the extraordinary vertex
        auto const first = RingSubdivision::Build(ring, scene.cage.scheme, scene.cage.options);
        FaceRing const& child = first.children[0].ring;
        auto const second = RingSubdivision::Build(child, scene.cage.scheme, scene.cage.options);
        EXPECT_EQ(second.children[0].ring, child) << "valence " << valence;
        for (int regular : {1, 2, 3}) {
            auto const piece = RingSubdivision::Build(second.children[regular].ring,
                                                      scene.cage.scheme, scene.cage.options);
            EXPECT_TRUE(piece.IsRegular());
        }
    }
}

// Children tile their parent: the middle child of a triangle is turned round. Also where two
// corners are one vertex, as at a pinched end.
TEST(RingSubdivision, DomainsOfChildrenTileTheParent) {
    std::vector<double> const positions{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    engine::Scene const scenes[] = {
        test::MakeFan(5, Sdc::SCHEME_CATMARK, 0.1, 0.0),
        test::MakeFan(5, Sdc::SCHEME_LOOP, 0.1, 0.0),
        test::MakeScene(positions, {{0, 0, 1, 2}, {0, 2, 3, 3}}),
        test::MakeScene(positions, {{0, 1, 0}, {0, 1, 2}}, Sdc::SCHEME_LOOP)};
    for (engine::Scene const& scene : scenes) {
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        FaceRingGatherer gatherer(refiner->GetLevel(0), scene.cage.options, -1);
        FaceRing ring;
        std::vector<Index> points;
        gatherer.Gather(0, ring, points);
        auto const step = RingSubdivision::Build(ring, scene.cage.scheme, scene.cage.options);
        ASSERT_EQ(step.children.size(), 4u);
        bool const isLoop = scene.cage.scheme == Sdc::SCHEME_LOOP;
        double const expected[4][3] = {{0, 0, 0.5},
                                       {0.5, 0, 0.5},
                                       {isLoop ? 0.0 : 0.5, 0.5, 0.5},
                                       {isLoop ? 0.5 : 0.0, 0.5, isLoop ? -0.5 : 0.5}};
        for (int c = 0; c < 4; ++c) {
            auto const& domain = step.children[c].domain;
            EXPECT_EQ(domain.origin[0], expected[c][0]) << c;
            EXPECT_EQ(domain.origin[1], expected[c][1]) << c;
            EXPECT_EQ(domain.scale, expected[c][2]) << c;
        }
    }
}

}  // namespace
}  // namespace limn
