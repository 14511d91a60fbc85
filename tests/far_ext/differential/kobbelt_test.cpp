// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/kobbelt.h"

#include <array>
#include <map>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

/// A row by control vertex.
std::map<Index, double> GetRow(far_ext::SparseRows const& rows, Index row) {
    std::map<Index, double> weights;
    for (int k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k)
        weights[rows.indices[k]] = rows.weights[k];
    return weights;
}

// A lattice of 5 x 5 quads; vertex (i, j) is 6 j + i.
Index At(int i, int j) {
    return 6 * j + i;
}

void ExpectRow(std::map<Index, double> const& found, std::map<Index, double> const& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (auto const& [vertex, weight] : expected) EXPECT_NEAR(found.at(vertex), weight, 1e-15);
}

class KobbeltOnALattice : public testing::Test {
protected:
    Index FindEdge(Index a, Index b) const { return level.FindEdge(a, b); }
    std::map<Index, double> GetEdgeRow(Index a, Index b) const {
        return GetRow(rows, level.GetEdgeChildVertex(FindEdge(a, b)));
    }

    std::unique_ptr<Far::TopologyRefiner> refiner =
        test::MakeRefiner(test::MakeLattice(5, 5, Sdc::SCHEME_CATMARK), 1);
    Far::TopologyLevel level = refiner->GetLevel(0);
    far_ext::SparseRows rows = far_ext::BuildKobbelt(*refiner, 1, 1.0);
};

TEST_F(KobbeltOnALattice, InnerEdgesHaveFourPoints) {
    ExpectRow(
        GetEdgeRow(At(2, 2), At(3, 2)),
        {{At(1, 2), -1.0 / 16}, {At(2, 2), 9.0 / 16}, {At(3, 2), 9.0 / 16}, {At(4, 2), -1.0 / 16}});
}

// The reflection 2p - q takes the place of what is beyond p.
TEST_F(KobbeltOnALattice, LinesEndAtTheBoundaryInAReflection) {
    ExpectRow(GetEdgeRow(At(0, 2), At(1, 2)),
              {{At(0, 2), 7.0 / 16}, {At(1, 2), 10.0 / 16}, {At(2, 2), -1.0 / 16}});
}

TEST_F(KobbeltOnALattice, BoundaryEdgesFollowTheBoundaryAndEndAtItsCorners) {
    ExpectRow(
        GetEdgeRow(At(2, 0), At(3, 0)),
        {{At(1, 0), -1.0 / 16}, {At(2, 0), 9.0 / 16}, {At(3, 0), 9.0 / 16}, {At(4, 0), -1.0 / 16}});
    ExpectRow(GetEdgeRow(At(0, 0), At(1, 0)),
              {{At(0, 0), 7.0 / 16}, {At(1, 0), 10.0 / 16}, {At(2, 0), -1.0 / 16}});
}

// F of F: products of (-1, 9, 9, -1)/16.
TEST_F(KobbeltOnALattice, InnerFacesHaveSixteenPoints) {
    std::map<Index, double> expected;
    double const weights[] = {-1.0 / 16, 9.0 / 16, 9.0 / 16, -1.0 / 16};
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) expected[At(1 + i, 1 + j)] = weights[i] * weights[j];
    }
    Index const face = 5 * 2 + 2;
    ExpectRow(GetRow(rows, level.GetFaceChildVertex(face)), expected);
}

TEST(Kobbelt, CubicsAreMetInsideALattice) {
    auto scene = test::MakeLattice(5, 5, Sdc::SCHEME_CATMARK);
    auto const height = [](double x, double y) { return x * x * x - 2 * x * y * y + y * y + x; };
    for (size_t i = 0; i < scene.positions.size(); i += 3)
        scene.positions[i + 2] = height(scene.positions[i], scene.positions[i + 1]);
    auto const refiner = test::MakeRefiner(scene, 1);
    auto const fine = test::Apply(far_ext::BuildKobbelt(*refiner, 1, 1.0), scene.positions);
    for (Index face : {6, 7, 8, 11, 12, 13, 16, 17, 18}) {  // the strips stay inside
        double const* const p =
            &fine[3 * static_cast<size_t>(refiner->GetLevel(0).GetFaceChildVertex(face))];
        EXPECT_NEAR(p[2], height(p[0], p[1]), 1e-12);
    }
}

TEST(Kobbelt, WithoutTensionPointsAreMeans) {
    auto const scene = test::MakeTorus(7, 5);
    auto const refiner = test::MakeRefiner(scene, 1);
    auto const level = refiner->GetLevel(0);
    auto const rows = far_ext::BuildKobbelt(*refiner, 1, 0.0);
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        ExpectRow(GetRow(rows, level.GetEdgeChildVertex(edge)), {{ends[0], 0.5}, {ends[1], 0.5}});
    }
}

// Both strips of a face at an irregular vertex give one point: with t = w/(8 + w) of the virtual
// point, which is what tells it from w/(4 + w). A face's point is then F along either strip alone.
TEST(Kobbelt, BothStripsAgreeRoundAnIrregularVertex) {
    for (int n : {3, 5, 6, 9}) {
        auto const scene = test::MakeFan(n, Sdc::SCHEME_CATMARK, 0.3, 0.2);
        auto const refiner = test::MakeRefiner(scene, 1);
        auto const level = refiner->GetLevel(0);
        for (double tension : {1.0, 1.7}) {
            auto const fine =
                test::Apply(far_ext::BuildKobbelt(*refiner, 1, tension), scene.positions);
            auto const pointOf = [&](Index edge) {
                return Eigen::Map<Eigen::Vector3d const>(
                    &fine[3 * static_cast<size_t>(level.GetEdgeChildVertex(edge))]);
            };
            for (Index face : level.GetVertexFaces(0)) {
                auto const edges = level.GetFaceEdges(face);
                for (int strip : {0, 1}) {
                    Eigen::Vector3d point = Eigen::Vector3d::Zero();
                    for (Index edge : {edges[strip], edges[strip + 2]}) {
                        auto const faces = level.GetEdgeFaces(edge);
                        int const side = faces[0] == face ? 1 : 0;
                        int const corner = level.GetEdgeFaceLocalIndices(edge)[side];
                        Index const next = level.GetFaceEdges(faces[side])[(corner + 2) % 4];
                        point += (8 + tension) / 16 * pointOf(edge) - tension / 16 * pointOf(next);
                    }
                    double const* const p =
                        &fine[3 * static_cast<size_t>(level.GetFaceChildVertex(face))];
                    for (int c = 0; c < 3; ++c) EXPECT_NEAR(p[c], point[c], 1e-14) << n;
                }
            }
        }
    }
}

TEST(Kobbelt, OtherFacesAndSchemesAreRefused) {
    auto const prism = test::MakeRefiner(test::MakePrism(5), 1);
    EXPECT_NE(test::RefusalOf([&] {
                  far_ext::BuildKobbelt(*prism, 1, 1.0);
              }).find("face 0 has 5 corners; Kobbelt's rule needs quads"),
              std::string::npos);
    auto const triangles = test::MakeRefiner(test::MakeBipyramid(5), 1);
    EXPECT_EQ(test::CodeOf([&] { far_ext::BuildKobbelt(*triangles, 1, 1.0); }),
              ErrorCode::Unsupported);
}

/// The refusal of a mesh of quads, whose vertices' places do not matter.
std::string RefuseQuads(Index numVertices, std::vector<std::vector<Index>> const& faces) {
    std::vector<double> const positions = test::MakeNoise(3 * static_cast<size_t>(numVertices), 1);
    auto const refiner = test::MakeRefiner(test::MakeScene(positions, faces), 1);
    return test::RefusalOf([&] { far_ext::BuildKobbelt(*refiner, 1, 1.0); });
}

TEST(Kobbelt, SurfacesThatMeetAreRefused) {
    EXPECT_NE(RefuseQuads(8, {{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}})
                  .find("vertex 0 has 3 boundary edges"),
              std::string::npos);
    EXPECT_NE(RefuseQuads(7, {{0, 1, 2, 3}, {0, 4, 5, 6}}).find("vertex 0 has 4 boundary edges"),
              std::string::npos);
    std::vector<std::vector<Index>> faces;  // two cubes that share vertex 0
    for (Index first : {0, 7}) {
        auto const at = [first](Index corner) { return corner == 0 ? 0 : first + corner; };
        for (auto const& [a, b, c, d] : std::vector<std::array<Index, 4>>{{0, 1, 3, 2},
                                                                          {4, 6, 7, 5},
                                                                          {0, 4, 5, 1},
                                                                          {2, 3, 7, 6},
                                                                          {0, 2, 6, 4},
                                                                          {1, 5, 7, 3}})
            faces.push_back({at(a), at(b), at(c), at(d)});
    }
    EXPECT_NE(RefuseQuads(15, faces).find("at vertex 0 surfaces meet in a point"),
              std::string::npos);
}

}  // namespace
}  // namespace limn
