// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/field_match.h"

#include <cmath>
#include <iostream>  // Eigen's MetisSupport needs it
#include <numeric>

#include <Eigen/MetisSupport>
#include <Eigen/SparseCholesky>

#include "far_ext/forms/face_vectors.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/forms/hodge_star.h"
#include "far_ext/rows/sparse_matrix.h"

namespace limn::eval {

namespace {

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using ColumnMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr double kSmoothness = 1e-6;  // of curl and divergence, against the vectors
constexpr double kRest = 1e-12;       // of the field itself: decides where nothing else does

/// What the field is to be at the wanted places: rows over the faces' vectors, three per place.
struct Wishes {
    RowMatrix rows;
    Eigen::VectorXd right;
};

std::vector<Index> FindFaces(Far::TopologyLevel const& level, WantedVector const& wanted) {
    if (wanted.isFace) return {wanted.element};
    auto const faces = level.GetVertexFaces(wanted.element);
    return {faces.begin(), faces.end()};
}

Wishes MakeWishes(Far::TopologyLevel const& level, std::vector<double> const& faceAreas,
                  std::span<WantedVector const> wanted) {
    Triplets entries;
    Eigen::VectorXd right(3 * static_cast<Eigen::Index>(wanted.size()));
    for (size_t i = 0; i < wanted.size(); ++i) {
        int const row = 3 * static_cast<int>(i);
        std::vector<Index> const faces = FindFaces(level, wanted[i]);
        double area = 0.0;
        for (Index face : faces) area += faceAreas[face];
        double const weight = std::sqrt(wanted[i].isFace ? area : area / 3.0);
        for (int axis = 0; axis < 3; ++axis) {
            for (Index face : faces)
                entries.emplace_back(row + axis, 3 * face + axis, weight * faceAreas[face] / area);
            right[row + axis] = faces.empty() ? 0.0 : weight * wanted[i].vector[axis];
        }
    }
    RowMatrix rows(right.size(), 3 * static_cast<Eigen::Index>(level.GetNumFaces()));
    rows.setFromTriplets(entries.begin(), entries.end());
    return {rows, right};
}

std::vector<double> FindDualAreas(Far::TopologyLevel const& level,
                                  std::vector<double> const& faceAreas) {
    std::vector<double> dualAreas(level.GetNumVertices(), 0.0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        for (Index vertex : vertices) dualAreas[vertex] += faceAreas[face] / vertices.size();
    }
    return dualAreas;
}

/// Rows whose squares add up to the integral of the squared divergence.
RowMatrix MakeDivergence(Far::TopologyLevel const& level, far_ext::HodgeStars const& stars) {
    std::vector<double> const dualAreas = FindDualAreas(level, stars.area);
    Triplets entries;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        for (Index vertex : level.GetEdgeVertices(edge)) {
            if (dualAreas[vertex] == 0.0) continue;
            entries.emplace_back(vertex, edge,
                                 far_ext::GetSignFrom(level, edge, vertex) * stars.edge[edge] /
                                     std::sqrt(dualAreas[vertex]));
        }
    }
    RowMatrix divergence(level.GetNumVertices(), level.GetNumEdges());
    divergence.setFromTriplets(entries.begin(), entries.end());
    return divergence;
}

/// Rows whose squares add up to the integral of the squared curl.
RowMatrix MakeCurl(Far::TopologyLevel const& level, std::vector<double> const& faceAreas) {
    far_ext::SparseRows const rows = far_ext::BuildD1(level);
    RowMatrix curl = far_ext::AsMatrix(rows, level.GetNumEdges());
    for (Index face = 0; face < level.GetNumFaces(); ++face)
        curl.row(face) /= std::sqrt(faceAreas[face]);
    return curl;
}

ColumnMatrix MakeRest(std::vector<double> const& edgeStars) {
    Index const numEdges = static_cast<Index>(edgeStars.size());
    ColumnMatrix rest(numEdges, numEdges);
    rest.setIdentity();
    for (Index edge = 0; edge < numEdges; ++edge)
        rest.coeffRef(edge, edge) = kRest * edgeStars[edge];
    return rest;
}

/// Normal equations of the wishes `fit`, of smoothness and of the rest.
ColumnMatrix MakeSystem(Far::TopologyLevel const& level, far_ext::HodgeStars const& stars,
                        RowMatrix const& fit) {
    double const meanArea = std::accumulate(stars.area.begin(), stars.area.end(), 0.0) /
                            static_cast<double>(stars.area.size());
    RowMatrix const divergence = MakeDivergence(level, stars), curl = MakeCurl(level, stars.area);
    ColumnMatrix system = RowMatrix(fit.transpose() * fit);
    system += ColumnMatrix(RowMatrix(
        kSmoothness * meanArea *
        (RowMatrix(divergence.transpose() * divergence) + RowMatrix(curl.transpose() * curl))));
    system += MakeRest(stars.edge);
    return system;
}

}  // namespace

std::vector<double> MatchVectors(Far::TopologyLevel const& level, std::span<double const> positions,
                                 std::span<WantedVector const> wanted) {
    far_ext::HodgeStars const stars = far_ext::FindHodgeStars(level, positions);
    far_ext::SparseRows const faceVectors = far_ext::BuildFaceVectors(level, positions);
    Wishes const wishes = MakeWishes(level, stars.area, wanted);
    RowMatrix const fit = wishes.rows * far_ext::AsMatrix(faceVectors, level.GetNumEdges());
    Eigen::SimplicialLDLT<ColumnMatrix, Eigen::Lower, Eigen::MetisOrdering<int>> const solver(
        MakeSystem(level, stars, fit));
    Eigen::VectorXd const form = solver.solve(fit.transpose() * wishes.right);
    return {form.data(), form.data() + form.size()};
}

}  // namespace limn::eval
