// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/field_match.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <fmt/format.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include "eval/differential/refine_values.h"
#include "eval/forms/dissection_ordering.h"
#include "eval/forms/vertex_covectors.h"
#include "far_ext/error.h"
#include "far_ext/forms/face_vectors.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/forms/form_stencils.h"
#include "far_ext/forms/hodge_star.h"
#include "far_ext/rows/sparse_matrix.h"

namespace limn::eval {

namespace {

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using ColumnMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;
using Vector = Eigen::VectorXd;
using VectorRows = std::array<far_ext::WeightRow, 3>;  // x, y and z over the edges

constexpr double kSmoothness = 1e-6;  // of curl and divergence, against the vectors
constexpr double kRest = 1e-12;       // of the field itself: decides where nothing else does
constexpr double kRounding = 1e-14;   // of the vectors

// -------- what the vectors say

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

/// Each vertex' share of its faces.
std::vector<double> FindDualAreas(Far::TopologyLevel const& level,
                                  std::vector<double> const& faceAreas) {
    std::vector<double> dualAreas(level.GetNumVertices(), 0.0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        for (Index vertex : vertices) dualAreas[vertex] += faceAreas[face] / vertices.size();
    }
    return dualAreas;
}

/// What the field is to be at the wanted places: rows over the edges, three per place, whose
/// squares add up to an integral.
struct Wishes {
    RowMatrix rows;
    Vector right;

    Vector FindMissing(Vector const& form) const { return right - rows * form; }
};

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

Wishes MakeWishes(Far::TopologyRefiner const& refiner, std::span<double const> positions,
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

// -------- what they leave open

/// d0^T *1: what flows into each vertex.
RowMatrix MakeInflow(Far::TopologyLevel const& level, std::vector<double> const& edgeStars) {
    Triplets entries;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        for (Index vertex : level.GetEdgeVertices(edge))
            entries.emplace_back(vertex, edge,
                                 -far_ext::GetSignFrom(level, edge, vertex) * edgeStars[edge]);
    }
    RowMatrix inflow(level.GetNumVertices(), level.GetNumEdges());
    inflow.setFromTriplets(entries.begin(), entries.end());
    return inflow;
}

/// Finds a form that meets wishes, one among all that do.
class Matcher {
public:
    Matcher(Far::TopologyLevel const& level, far_ext::HodgeStars const& stars, Wishes wishes,
            std::function<void()> const& onStep)
        : _onStep(onStep),
          _stars(stars),
          _dualAreas(FindDualAreas(level, stars.area)),
          _wishes(std::move(wishes)),
          _normal(_wishes.rows.transpose() * _wishes.rows),
          _inflow(MakeInflow(level, stars.edge)) {
        far_ext::SparseRows const d1 = far_ext::BuildD1(level);
        // Edges of a face come in its order; by way of columns a row has them by number.
        _curl = ColumnMatrix(far_ext::AsMatrix(d1, level.GetNumEdges()));
    }

    Vector FindSmooth();
    std::optional<Vector> FindFewSources(Vector const& smooth);

private:
    /// What counts beside the wishes: squares of inflow, curl and values, each with a weight.
    struct Weights {
        Vector ofInflow, ofCurl, ofValues;
    };
    Vector Meet(Weights const& weights, double tolerance);
    bool IsMet(Vector const& form, double share) const {
        return _wishes.FindMissing(form).norm() <= share * _wishes.right.norm();
    }
    bool TurnsInFewFaces(Vector const& form, double largest) const;

    std::function<void()> const& _onStep;
    far_ext::HodgeStars const& _stars;
    std::vector<double> _dualAreas;
    Wishes _wishes;
    ColumnMatrix _normal;  // of the wishes
    RowMatrix _inflow, _curl;
    Eigen::SimplicialLDLT<ColumnMatrix, Eigen::Lower, DissectionOrdering> _solver;
    bool _isOrdered = false;
};

/// Least squares; then the same for what is still missing, as long as that helps and more than a
/// share of the wishes is. So the weights decide only what the wishes leave open.
Vector Matcher::Meet(Weights const& weights, double tolerance) {
    ColumnMatrix system = _normal;
    system += ColumnMatrix(_inflow.transpose() * weights.ofInflow.asDiagonal() * _inflow);
    system += ColumnMatrix(_curl.transpose() * weights.ofCurl.asDiagonal() * _curl);
    system.diagonal() += weights.ofValues;
    if (_onStep) _onStep();
    if (!_isOrdered) _solver.analyzePattern(system);
    _isOrdered = true;
    _solver.factorize(system);

    constexpr int kMaxSteps = 40;
    constexpr double kHelps = 0.9;  // what a step has to leave less of
    Vector form = _solver.solve(_wishes.rows.transpose() * _wishes.right);
    Vector missing = _wishes.FindMissing(form);
    for (int step = 1; step < kMaxSteps && !IsMet(form, tolerance); ++step) {
        if (_onStep) _onStep();
        Vector const next = form + _solver.solve(_wishes.rows.transpose() * missing);
        Vector const stillMissing = _wishes.FindMissing(next);
        if (!(stillMissing.norm() < kHelps * missing.norm())) break;
        form = next;
        missing = stillMissing;
    }
    return form;
}

/// Inflow and curl over areas are densities, whose squares add up to an integral.
Vector Matcher::FindSmooth() {
    double const meanArea = std::accumulate(_stars.area.begin(), _stars.area.end(), 0.0) /
                            static_cast<double>(_stars.area.size());
    auto const weigh = [&](std::vector<double> const& areas) {
        Vector weights(areas.size());
        for (size_t i = 0; i < areas.size(); ++i)
            weights[i] = areas[i] > 0.0 ? kSmoothness * meanArea / areas[i] : 0.0;
        return weights;
    };
    Eigen::Map<Vector const> const edgeStars(_stars.edge.data(), _normal.cols());
    return Meet({weigh(_dualAreas), weigh(_stars.area), kRest * edgeStars}, kRounding);
}

/// The form that meets the wishes with the least sum of |inflow| and |curl|, which finds the one
/// that few sources and vortices make; none, if it is no such form. By squares again and again,
/// each weighted with the inverse of what it was before.
std::optional<Vector> Matcher::FindFewSources(Vector const& smooth) {
    constexpr double kNearlyMet = 1e-3, kMet = 1e-6, kMetOnTheWay = 1e-8;
    constexpr double kLastFloor = 1e-9;
    constexpr double kInflow = 0.01;  // counts less: subdivision keeps curls of 0, not inflows
    double const largest = std::max((_inflow * smooth).lpNorm<Eigen::Infinity>(),
                                    (_curl * smooth).lpNorm<Eigen::Infinity>());
    if (largest == 0.0 || !IsMet(smooth, kNearlyMet)) return {};
    Vector form = smooth;
    for (double floor = 0.25; floor > kLastFloor; floor *= 0.25) {
        double const none = floor * largest;
        auto const weigh = [&](Vector const& values) {
            return Vector(none / (values.array().square() + none * none).sqrt());
        };
        form = Meet({kSmoothness * kInflow * weigh(_inflow * form),
                     kSmoothness * weigh(_curl * form), Vector::Zero(form.size())},
                    kMetOnTheWay);
    }
    if (!IsMet(form, kMet) || !TurnsInFewFaces(form, largest)) return {};
    return form;
}

/// A form without curl has as many unknowns as there are vertices, half of what vectors at vertices
/// say: with few more it is still the only one.
bool Matcher::TurnsInFewFaces(Vector const& form, double largest) const {
    constexpr double kFew = 0.25, kNone = 1e-4;
    auto const numTurning = ((_curl * form).array().abs() > kNone * largest).count();
    return static_cast<double>(numTurning) <= kFew * static_cast<double>(_curl.rows());
}

}  // namespace

std::vector<double> MatchVectors(Far::TopologyRefiner const& refiner,
                                 std::span<double const> positions,
                                 std::span<WantedVector const> wanted,
                                 std::function<void()> const& onStep) {
    auto const level = refiner.GetLevel(0);
    CheckWanted(level, wanted);
    far_ext::HodgeStars const stars = far_ext::FindHodgeStars(level, positions);
    Matcher matcher(level, stars, MakeWishes(refiner, positions, stars.area, wanted), onStep);
    Vector form = matcher.FindSmooth();
    if (AreNearlyEverywhere(level, wanted)) form = matcher.FindFewSources(form).value_or(form);
    return {form.data(), form.data() + form.size()};
}

}  // namespace limn::eval
