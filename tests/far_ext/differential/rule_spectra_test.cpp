// SPDX-License-Identifier: Apache-2.0
//
// How interpolating rules behave round an irregular vertex: the eigenvalues of a step, from the
// rows as they are built, from small blocks written down by hand, and as they are published.

#include <algorithm>
#include <complex>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "far_ext/differential/subdivision_rows.h"
#include "far_ext/topology/boundary.h"
#include "support/refined.h"

namespace limn {
namespace {

using far_ext::SubdivisionRule;
using Complex = std::complex<double>;
using Block = Eigen::MatrixXcd;
using Row = Eigen::RowVectorXcd;
using Level = Far::TopologyLevel;

Index FindNeighbour(Level const& level, Index vertex, Index edge, int turns) {
    auto const edges = level.GetVertexEdges(vertex);
    return far_ext::GetOtherEnd(level, edges[(edges.FindIndex(edge) + turns) % edges.size()],
                                vertex);
}

/// The vertex that follows `to` on the line from `from`: half way round it.
Index GoStraight(Level const& level, Index from, Index to) {
    return FindNeighbour(level, to, level.FindEdge(from, to), level.GetVertexEdges(to).size() / 2);
}

/// A vertex of a mesh that a step makes another of, and that one's number on the next level.
struct Followed {
    Index vertex, child;
};

/// Vertex 0 of a fan with two rings, sector by sector: the end of its edge j, l_j; of triangles the
/// vertex m across l_j l_j+1, and the one straight on from l_j.
std::vector<Followed> FollowTriangles(Level const& level) {
    auto const edges = level.GetVertexEdges(0);
    int const n = edges.size();
    std::vector<Followed> rings{{0, level.GetVertexChildVertex(0)}};
    for (int j = 0; j < n; ++j) {
        Index const a = far_ext::GetOtherEnd(level, edges[j], 0),
                    b = far_ext::GetOtherEnd(level, edges[(j + 1) % n], 0),
                    across = level.FindEdge(a, b);
        rings.push_back({a, level.GetEdgeChildVertex(edges[j])});
        rings.push_back({FindNeighbour(level, a, across, 5), level.GetEdgeChildVertex(across)});
        rings.push_back({GoStraight(level, 0, a), level.GetVertexChildVertex(a)});
    }
    return rings;
}

/// Of quads l_j, the face's far corner k, what is straight on from l_j, from l_j+1 through k and
/// from l_j through k, and the far corner beyond k.
std::vector<Followed> FollowQuads(Level const& level) {
    auto const edges = level.GetVertexEdges(0);
    int const n = edges.size();
    std::vector<Followed> rings{{0, level.GetVertexChildVertex(0)}};
    for (int j = 0; j < n; ++j) {
        Index const a = far_ext::GetOtherEnd(level, edges[j], 0),
                    b = far_ext::GetOtherEnd(level, edges[(j + 1) % n], 0),
                    face = level.GetVertexFaces(0)[j];
        int const corner = level.GetVertexFaceLocalIndices(0)[j];
        Index const k = level.GetFaceVertices(face)[(corner + 2) % 4], x = GoStraight(level, b, k),
                    y = GoStraight(level, a, k);
        rings.push_back({a, level.GetEdgeChildVertex(edges[j])});
        rings.push_back({k, level.GetFaceChildVertex(face)});
        rings.push_back({GoStraight(level, 0, a), level.GetVertexChildVertex(a)});
        rings.push_back({x, level.GetEdgeChildVertex(level.FindEdge(a, k))});
        rings.push_back({y, level.GetEdgeChildVertex(level.FindEdge(b, k))});
        rings.push_back(
            {GoStraight(level, GoStraight(level, 0, b), y), level.GetVertexChildVertex(k)});
    }
    return rings;
}

std::vector<double> FindModuli(Eigen::MatrixXcd const& matrix) {
    Eigen::VectorXcd const values =
        Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(matrix, /*computeEigenvectors=*/false)
            .eigenvalues();
    std::vector<double> moduli;
    for (Complex value : values) moduli.push_back(std::abs(value));
    return moduli;
}

/// Moduli of the eigenvalues of a step of the rule at vertex 0, largest first.
std::vector<double> FindBuiltModuli(int valence, Sdc::SchemeType scheme, SubdivisionRule rule) {
    auto const scene = test::MakeFan(valence, scheme, 0.1, 0.05);
    auto const refiner = test::MakeRefiner(scene, 1);
    auto const rows = far_ext::BuildSubdivisionRows(*refiner, 1, rule);
    auto const level = refiner->GetLevel(0);
    auto const rings = scheme == Sdc::SCHEME_LOOP ? FollowTriangles(level) : FollowQuads(level);
    std::vector<int> columns(level.GetNumVertices(), -1);
    for (size_t i = 0; i < rings.size(); ++i) columns[rings[i].vertex] = static_cast<int>(i);
    auto const size = static_cast<Eigen::Index>(rings.size());
    Eigen::MatrixXcd matrix = Eigen::MatrixXcd::Zero(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        Index const child = rings[static_cast<size_t>(i)].child;
        for (int k = rows.offsets[child]; k < rows.offsets[child + 1]; ++k) {
            int const column = columns[rows.indices[k]];
            EXPECT_GE(column, 0) << "a step looks beyond two rings";
            if (column >= 0) matrix(i, column) = rows.weights[k];
        }
    }
    auto moduli = FindModuli(matrix);
    std::ranges::sort(moduli, std::greater());
    return moduli;
}

using Row = Eigen::RowVectorXcd;

/// The block of wave number k of n: z takes a value to the next sector. Row and column 0 are the
/// middle vertex, which only wave number 0 moves or sees.
struct Wave {
    int n, k;
    Complex z = std::polar(1.0, 2.0 * std::numbers::pi * k / n), back = std::conj(z);
    double isConstant = k == 0 ? 1.0 : 0.0;

    Row See(int column, int size) const {
        Row row = Row::Zero(size);
        row[column] = column == 0 ? isConstant : 1.0;
        return row;
    }
    /// The sum over all sectors.
    Row Sum(Row const& row) const { return n * isConstant * row; }
};

Eigen::MatrixXcd MakeOriginalButterflyBlock(Wave const& wave) {
    constexpr double w = 1.0 / 16;
    auto const [n, k, z, back, isConstant] = wave;
    Row const v = wave.See(0, 4), l = wave.See(1, 4), m = wave.See(2, 4), p = wave.See(3, 4);
    Eigen::MatrixXcd block(4, 4);
    block << v,  //
        0.5 * (v + l) + 2 * w * (z + back) * l - w * ((z * z + back * back) * l + m + back * m),
        0.5 * (1.0 + z) * l + 2 * w * (v + m) - w * ((back + z * z) * l + p + z * p),  //
        l;
    return block;
}

Eigen::MatrixXcd MakeInterpolatingLoopBlock(Wave const& wave) {
    auto const [n, k, z, back, isConstant] = wave;
    Row const v = wave.See(0, 4), l = wave.See(1, 4), m = wave.See(2, 4), p = wave.See(3, 4);
    double const c = 3.0 / 8 + std::cos(2 * std::numbers::pi / n) / 4, beta = (5.0 / 8 - c * c) / n;
    Row const moveV = -n * beta * v + beta * wave.Sum(l),
              moveL = (v + z * l + back * l + m + back * m + p - 6.0 * l) / 16.0;
    Eigen::MatrixXcd block(4, 4);
    block << v,  //
        3.0 / 8 * (v + l) + (z + back) / 8.0 * l - 0.5 * (moveV + moveL),
        3.0 / 8 * (1.0 + z) * l + (v + m) / 8.0 - 0.5 * (1.0 + z) * moveL,  //
        l;
    return block;
}

Eigen::MatrixXcd MakeKobbeltBlock(Wave const& wave) {
    static constexpr double a = 9.0 / 16, b = -1.0 / 16, t = 1.0 / 9;
    auto const [n, k, z, back, isConstant] = wave;
    Row const v = wave.See(0, 7), l = wave.See(1, 7), far = wave.See(2, 7), d = wave.See(3, 7),
              x = wave.See(4, 7), y = wave.See(5, 7), q = wave.See(6, 7);
    Row const beyond = 4.0 / n * (wave.Sum(l) - t * wave.Sum(far)) - (back + 1.0 + z) * l +
                       t * (back * back + back + 1.0 + z) * far;
    auto const fourPoint = [](Row const& p0, Row const& p1, Row const& p2, Row const& p3) -> Row {
        return a * (p1 + p2) + b * (p0 + p3);
    };
    Row const spoke = fourPoint(beyond, v, l, d), newX = fourPoint(back * far, l, far, y),
              newY = fourPoint(z * far, z * l, far, x), outer = fourPoint(z * x, z * d, y, q);
    Eigen::MatrixXcd block(7, 7);
    block << v, spoke, fourPoint(back * newX, spoke, newY, outer), l, newX, newY, far;
    return block;
}

Eigen::MatrixXcd MakeInterpolatingCatmarkBlock(Wave const& wave) {
    auto const [n, k, z, back, isConstant] = wave;
    Row const v = wave.See(0, 7), l = wave.See(1, 7), far = wave.See(2, 7), d = wave.See(3, 7),
              x = wave.See(4, 7), y = wave.See(5, 7), q = wave.See(6, 7);
    double const square = n * n;
    Row const moveV = -7.0 / (4 * n) * v + 3 / (2 * square) * wave.Sum(l) +
                      1 / (4 * square) * wave.Sum(far),
              moveL = 3.0 / 32 * (v + d + far + back * far) +
                      ((z + back) * l + x + back * y) / 64.0 - 7.0 / 16 * l,
              moveK = 3.0 / 32 * (l + z * l + x + y) + (v + d + z * d + q) / 64.0 - 7.0 / 16 * far;
    Eigen::MatrixXcd block(7, 7);
    block << v,  //
        3.0 / 8 * (v + l) + ((z + back) * l + far + back * far) / 16.0 - 0.5 * (moveV + moveL),
        0.25 * (v + l + z * l + far - moveV - moveL - z * moveL - moveK),
        l,  //
        3.0 / 8 * (l + far) + (v + z * l + d + x) / 16.0 - 0.5 * (moveL + moveK),
        3.0 / 8 * (z * l + far) + (v + l + z * d + y) / 16.0 - 0.5 * (z * moveL + moveK),  //
        far;
    return block;
}

struct Case {
    char const* name;
    Sdc::SchemeType scheme;
    SubdivisionRule rule;
    Eigen::MatrixXcd (*makeBlock)(Wave const&);
    struct Published {
        int valence;
        double second;
    };
    std::vector<Published> published;
};

class RuleSpectra : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Rules, RuleSpectra,
    testing::Values(
        Case{"OriginalButterfly",
             Sdc::SCHEME_LOOP,
             SubdivisionRule::OriginalButterfly,
             MakeOriginalButterflyBlock,
             {{3, 0.25}, {4, 0.469}, {5, 0.507}, {6, 0.5}, {7, 0.482}, {8, 0.469}, {10, 0.507}}},
        Case{"InterpolatingLoop",
             Sdc::SCHEME_LOOP,
             SubdivisionRule::Interpolating,
             MakeInterpolatingLoopBlock,
             {{3, 0.27}, {4, 0.391}, {5, 0.459}, {6, 0.5}, {7, 0.526}, {10, 0.566}}},
        Case{"Kobbelt",
             Sdc::SCHEME_CATMARK,
             SubdivisionRule::Kobbelt,
             MakeKobbeltBlock,
             {{3, 0.426}, {4, 0.5}, {5, 0.538}, {6, 0.560}, {8, 0.582}, {12, 0.599}}},
        Case{"InterpolatingCatmark",
             Sdc::SCHEME_CATMARK,
             SubdivisionRule::Interpolating,
             MakeInterpolatingCatmarkBlock,
             {{3, 0.415}, {4, 0.5}, {5, 0.546}, {6, 0.574}, {8, 0.603}}}),
    [](auto const& test) { return test.param.name; });

TEST_P(RuleSpectra, TheRowsHaveTheEigenvaluesOfTheBlocks) {
    for (auto const& [n, second] : GetParam().published) {
        auto const built = FindBuiltModuli(n, GetParam().scheme, GetParam().rule);
        std::vector<double> expected;
        for (int k = 0; k < n; ++k) {
            auto const block = GetParam().makeBlock({n, k});
            auto const inner = block.rows() - (k == 0 ? 0 : 1);  // others leave the middle out
            for (double modulus : FindModuli(block.bottomRightCorner(inner, inner)))
                expected.push_back(modulus);
        }
        std::ranges::sort(expected, std::greater());
        ASSERT_EQ(built.size(), expected.size());
        // Where the blocks have fewer eigenvectors than eigenvalues these are found to 1e-6 only.
        for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(built[i], expected[i], 1e-5) << n << ": " << i;
        EXPECT_NEAR(built[0], 1.0, 1e-12) << n;
        EXPECT_NEAR(built[1], second, 0.0051 * (second == 0.27) + 0.00051) << n;
    }
}

// A tangent plane needs the second eigenvalue twice, and the next ones below it.
TEST(RuleSpectra, KobbeltsLeaveATangentPlaneAtAllValences) {
    for (int n : {3, 4, 5, 6, 8, 12}) {
        auto const moduli = FindBuiltModuli(n, Sdc::SCHEME_CATMARK, SubdivisionRule::Kobbelt);
        EXPECT_NEAR(moduli[1], moduli[2], 1e-9) << n;
        EXPECT_LT(moduli[3], moduli[1] - 0.02) << n;
    }
}

// Valence 3 has none under the original Butterfly: 1/4 is there more than twice.
TEST(RuleSpectra, TheOriginalButterflyLeavesNoTangentPlaneAtValenceThree) {
    auto const moduli = FindBuiltModuli(3, Sdc::SCHEME_LOOP, SubdivisionRule::OriginalButterfly);
    EXPECT_NEAR(moduli[3], 0.25, 1e-5);
}

}  // namespace
}  // namespace limn
