// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/field_match.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include "eval/differential/refine_values.h"
#include "eval/forms/form_wishes.h"
#include "eval/forms/vertex_covectors.h"
#include "far_ext/error.h"
#include "far_ext/forms/face_vectors.h"
#include "far_ext/forms/form_stencils.h"
#include "far_ext/forms/hodge_star.h"

namespace limn::eval {

namespace {

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Triplets = std::vector<Eigen::Triplet<double>>;
using Vector = Eigen::VectorXd;
using VectorRows = std::array<far_ext::WeightRow, 3>;  // x, y and z over the edges

/// The limit's vectors at the vertices of a base level as weights over its edges; where faces are
/// not all quads, by way of its first refinement.
class VertexVectors {
public:
    VertexVectors(Far::TopologyRefiner const& base, std::span<double const> positions)
        : _positions(positions.begin(), positions.end()) {
        bool const isRefined =
            base.GetSchemeType() != Sdc::SCHEME_LOOP && !HasQuadsOnly(base.GetLevel(0));
        if (isRefined) Refine(base);
        _covectors.emplace(isRefined ? *_refined : base, isRefined ? 1 : 0);
    }

    VectorRows Find(Index vertex) const {
        if (!_refined) return _covectors->FindVectorRows(vertex, _positions);
        Index const child = _refined->GetLevel(0).GetVertexChildVertex(vertex);
        VectorRows const fine = _covectors->FindVectorRows(child, _positions);
        VectorRows rows;
        for (size_t axis = 0; axis < 3; ++axis) {
            for (auto const& [edge, weight] : fine[axis].GetEntries()) {
                for (int k = _s1.offsets[edge]; k < _s1.offsets[edge + 1]; ++k)
                    rows[axis].Add(_s1.indices[k], weight * _s1.weights[k]);
            }
        }
        return rows;
    }

private:
    static bool HasQuadsOnly(Far::TopologyLevel const& level) {
        for (Index face = 0; face < level.GetNumFaces(); ++face) {
            if (level.GetFaceVertices(face).size() != 4) return false;
        }
        return true;
    }

    void Refine(Far::TopologyRefiner const& base) {
        _refined.reset(Far::TopologyRefinerFactory<Far::TopologyDescriptor>::Create(base));
        Far::TopologyRefiner::UniformOptions options(1);
        options.fullTopologyInLastLevel = true;
        _refined->RefineUniform(options);
        _s1 = far_ext::BuildFormStencils(*_refined, 1).s1;
        _positions = RefineValues<3>(*_refined, 1, _positions);
    }

    std::vector<double> _positions;
    std::unique_ptr<Far::TopologyRefiner> _refined;
    far_ext::SparseRows _s1;
    std::optional<VertexCovectors> _covectors;
};

VectorRows FindFaceVector(far_ext::SparseRows const& faceVectors, Index face) {
    VectorRows rows;
    for (int axis = 0; axis < 3; ++axis) {
        int const row = 3 * face + axis;
        for (int k = faceVectors.offsets[row]; k < faceVectors.offsets[row + 1]; ++k)
            rows[static_cast<size_t>(axis)].Add(faceVectors.indices[k], faceVectors.weights[k]);
    }
    return rows;
}

void CheckWanted(Far::TopologyLevel const& level, std::span<WantedVector const> wanted) {
    for (WantedVector const& at : wanted) {
        Index const count = at.isFace ? level.GetNumFaces() : level.GetNumVertices();
        if (at.element >= 0 && at.element < count) continue;
        throw Error(ErrorCode::BadOption,
                    fmt::format("{} {} does not exist; there are 0 to {}",
                                at.isFace ? "face" : "vertex", at.element, count - 1));
    }
}

/// Takes off vectors what no field can have there: their parts across the surface.
void RemoveUnreachable(RowMatrix const& rows, Vector& right) {
    constexpr double kNone = 1e-12;  // rounding, of what the most reachable direction has
    for (Eigen::Index place = 0; place < right.size(); place += 3) {
        Eigen::Matrix3d gram;
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) gram(a, b) = rows.row(place + a).dot(rows.row(place + b));
        }
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> const solver(gram);
        Eigen::Vector3d part = Eigen::Vector3d::Zero();
        for (int k = 0; k < 3; ++k) {
            auto const direction = solver.eigenvectors().col(k);
            if (solver.eigenvalues()[k] > kNone * solver.eigenvalues()[2])
                part += direction * direction.dot(right.segment<3>(place));
        }
        right.segment<3>(place) = part;
    }
}

FormWishes MakeWishes(Far::TopologyRefiner const& refiner, std::span<double const> positions,
                      std::vector<double> const& faceAreas, std::span<WantedVector const> wanted) {
    auto const level = refiner.GetLevel(0);
    far_ext::SparseRows const faceVectors = far_ext::BuildFaceVectors(level, positions);
    VertexVectors const vertexVectors(refiner, positions);
    std::vector<double> const dualAreas = FindDualAreas(level, faceAreas);
    Triplets entries;
    Vector right(3 * static_cast<Eigen::Index>(wanted.size()));
    int row = 0;
    for (auto const& [isFace, element, vector] : wanted) {
        double const weight = std::sqrt((isFace ? faceAreas : dualAreas)[element]);
        VectorRows const rows =
            isFace ? FindFaceVector(faceVectors, element) : vertexVectors.Find(element);
        for (size_t axis = 0; axis < 3; ++axis, ++row) {
            for (auto const& [edge, part] : rows[axis].GetEntries())
                entries.emplace_back(row, edge, weight * part);
            right[row] = weight * vector[axis];
        }
    }
    RowMatrix rows(right.size(), level.GetNumEdges());
    rows.setFromTriplets(entries.begin(), entries.end());
    RemoveUnreachable(rows, right);
    return {rows, right};
}

/// Whether there are vectors at nearly all faces, or at nearly all vertices.
bool AreNearlyEverywhere(Far::TopologyLevel const& level, std::span<WantedVector const> wanted) {
    constexpr double kNearlyAll = 0.9;
    std::vector<char> isAtFace(level.GetNumFaces(), 0), isAtVertex(level.GetNumVertices(), 0);
    for (WantedVector const& at : wanted) (at.isFace ? isAtFace : isAtVertex)[at.element] = 1;
    auto const areNearlyAll = [](std::vector<char> const& isAt) {
        return static_cast<double>(std::count(isAt.begin(), isAt.end(), 1)) >=
               kNearlyAll * static_cast<double>(isAt.size());
    };
    return areNearlyAll(isAtFace) || areNearlyAll(isAtVertex);
}

}  // namespace

std::vector<double> MatchVectors(Far::TopologyRefiner const& refiner,
                                 std::span<double const> positions,
                                 std::span<WantedVector const> wanted,
                                 std::function<void()> const& onStep) {
    auto const level = refiner.GetLevel(0);
    CheckWanted(level, wanted);
    far_ext::HodgeStars const stars = far_ext::FindHodgeStars(level, positions);
    WishMatcher matcher(level, stars, MakeWishes(refiner, positions, stars.area, wanted), onStep);
    Eigen::VectorXd form = matcher.FindSmooth();
    if (AreNearlyEverywhere(level, wanted)) form = matcher.FindFewSources(form).value_or(form);
    return {form.data(), form.data() + form.size()};
}

}  // namespace limn::eval
