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
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr double kSmoothness = 1e-6;  // of curl and divergence, against the vectors
constexpr double kRest = 1e-12;       // of the field itself: decides where nothing else does

}  // namespace

std::vector<double> MatchVectors(Far::TopologyLevel const& level, std::span<double const> positions,
                                 std::span<WantedVector const> wanted) {
    far_ext::HodgeStars const stars = far_ext::FindHodgeStars(level, positions);
    Index const numEdges = level.GetNumEdges();
    far_ext::SparseRows const faceVectorRows = far_ext::BuildFaceVectors(level, positions),
                              curlRows = far_ext::BuildD1(level);
    RowMatrix const faceVectors = far_ext::AsMatrix(faceVectorRows, numEdges);
    double const meanArea = std::accumulate(stars.area.begin(), stars.area.end(), 0.0) /
                            static_cast<double>(stars.area.size());

    // Three rows per wanted vector, over the faces' vectors.
    Triplets picks;
    Eigen::VectorXd right(3 * static_cast<Eigen::Index>(wanted.size()));
    for (size_t i = 0; i < wanted.size(); ++i) {
        int const row = 3 * static_cast<int>(i);
        double area = 0.0;
        std::vector<Index> faces;
        if (wanted[i].isFace)
            faces.push_back(wanted[i].element);
        else
            for (Index face : level.GetVertexFaces(wanted[i].element)) faces.push_back(face);
        for (Index face : faces) area += stars.area[face];
        double const weight = std::sqrt(wanted[i].isFace ? area : area / 3.0);
        for (int axis = 0; axis < 3; ++axis) {
            for (Index face : faces)
                picks.emplace_back(row + axis, 3 * face + axis, weight * stars.area[face] / area);
            right[row + axis] = faces.empty() ? 0.0 : weight * wanted[i].vector[axis];
        }
    }
    RowMatrix pick(right.size(), faceVectors.rows());
    pick.setFromTriplets(picks.begin(), picks.end());
    RowMatrix const fit = pick * faceVectors;

    Triplets divergences;
    std::vector<double> dualAreas(level.GetNumVertices(), 0.0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        for (Index vertex : vertices) dualAreas[vertex] += stars.area[face] / vertices.size();
    }
    for (Index edge = 0; edge < numEdges; ++edge) {
        for (Index vertex : level.GetEdgeVertices(edge)) {
            if (dualAreas[vertex] == 0.0) continue;
            divergences.emplace_back(vertex, edge,
                                     far_ext::GetSignFrom(level, edge, vertex) * stars.edge[edge] /
                                         std::sqrt(dualAreas[vertex]));
        }
    }
    RowMatrix divergence(level.GetNumVertices(), numEdges);
    divergence.setFromTriplets(divergences.begin(), divergences.end());
    RowMatrix curl = far_ext::AsMatrix(curlRows, numEdges);
    for (Index face = 0; face < level.GetNumFaces(); ++face)
        curl.row(face) /= std::sqrt(stars.area[face]);

    Eigen::SparseMatrix<double> system = RowMatrix(fit.transpose() * fit);
    system += Eigen::SparseMatrix<double>(RowMatrix(
        kSmoothness * meanArea *
        (RowMatrix(divergence.transpose() * divergence) + RowMatrix(curl.transpose() * curl))));
    Eigen::SparseMatrix<double> rest(numEdges, numEdges);
    rest.setIdentity();
    for (Index edge = 0; edge < numEdges; ++edge)
        rest.coeffRef(edge, edge) = kRest * stars.edge[edge];
    system += rest;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower,
                          Eigen::MetisOrdering<int>> const solver(system);
    Eigen::VectorXd const form = solver.solve(fit.transpose() * right);
    return {form.data(), form.data() + form.size()};
}

}  // namespace limn::eval
