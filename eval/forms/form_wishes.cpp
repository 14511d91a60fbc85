// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/form_wishes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "far_ext/forms/form_operators.h"
#include "far_ext/rows/sparse_matrix.h"

namespace limn::eval {

namespace {

constexpr double kSmoothness = 1e-6;  // of curl and divergence, against the wishes
constexpr double kRest = 1e-12;       // of the field itself: decides where nothing else does
constexpr double kRounding = 1e-14;   // of the wishes

/// d0^T *1: what flows into each vertex.
Eigen::SparseMatrix<double, Eigen::RowMajor> MakeInflow(Far::TopologyLevel const& level,
                                                        std::vector<double> const& edgeStars) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        for (Index vertex : level.GetEdgeVertices(edge))
            entries.emplace_back(vertex, edge,
                                 -far_ext::GetSignFrom(level, edge, vertex) * edgeStars[edge]);
    }
    Eigen::SparseMatrix<double, Eigen::RowMajor> inflow(level.GetNumVertices(),
                                                        level.GetNumEdges());
    inflow.setFromTriplets(entries.begin(), entries.end());
    return inflow;
}

}  // namespace

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

WishMatcher::WishMatcher(Far::TopologyLevel const& level, far_ext::HodgeStars const& stars,
                         FormWishes wishes, std::function<void()> const& onStep)
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

/// Least squares; then the same for what is still missing, as long as that helps and more than a
/// share of the wishes is. So the weights decide only what the wishes leave open.
Eigen::VectorXd WishMatcher::Meet(Weights const& weights, double tolerance) {
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
Eigen::VectorXd WishMatcher::FindSmooth() {
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

/// By squares again and again, each weighted with the inverse of what it was before.
std::optional<Eigen::VectorXd> WishMatcher::FindFewSources(Vector const& smooth) {
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
bool WishMatcher::TurnsInFewFaces(Vector const& form, double largest) const {
    constexpr double kFew = 0.25, kNone = 1e-4;
    auto const numTurning = ((_curl * form).array().abs() > kNone * largest).count();
    return static_cast<double>(numTurning) <= kFew * static_cast<double>(_curl.rows());
}

}  // namespace limn::eval
