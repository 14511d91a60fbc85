// SPDX-License-Identifier: Apache-2.0
#include "far_ext/limit/corner_limit.h"

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "far_ext/rings/ring_subdivision.h"

namespace limn::far_ext {

namespace {

/// Row `row` of weights, over what `points` are rows over.
WeightRow Compose(SparseRows const& weights, int row, std::vector<WeightRow> const& points) {
    WeightRow composed;
    for (int k = weights.offsets[row]; k < weights.offsets[row + 1]; ++k) {
        composed.AddWithWeight(points[weights.indices[k]], weights.weights[k]);
    }
    return composed;
}

/// The corner of a patch: (1,4,1) x (1,4,1) / 36 of a bicubic B-spline, (6 + 6 x 1) / 12 of the box
/// spline.
WeightRow EvaluatePatchCorner(SparseRows const& patch, int corner,
                              std::vector<WeightRow> const& points) {
    WeightRow limit;
    if (patch.GetNumRows() == 16) {
        constexpr int kPlace[4][2] = {{1, 1}, {1, 2}, {2, 2}, {2, 1}};  // row t, column s
        for (int dt = -1; dt <= 1; ++dt) {
            for (int ds = -1; ds <= 1; ++ds) {
                double const weight = (dt == 0 ? 4.0 : 1.0) * (ds == 0 ? 4.0 : 1.0) / 36.0;
                int const row = 4 * (kPlace[corner][0] + dt) + kPlace[corner][1] + ds;
                limit.AddWithWeight(Compose(patch, row, points), weight);
            }
        }
        return limit;
    }
    constexpr int kPlace[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    for (int row = 0; row < 12; ++row) {
        int const di = kBoxSplineLattice[row][0] - kPlace[corner][0],
                  dj = kBoxSplineLattice[row][1] - kPlace[corner][1];
        // Lattice neighbours are (+-1,0), (0,+-1), (1,-1), (-1,1).
        bool const isNear = std::abs(di) <= 1 && std::abs(dj) <= 1 && std::abs(di + dj) <= 1;
        if (isNear)
            limit.AddWithWeight(Compose(patch, row, points), di == 0 && dj == 0 ? 0.5 : 1.0 / 12.0);
    }
    return limit;
}

/// Row `point` of the infinite power of a stationary step. Every mode but the constant one shrinks
/// by at least 0.66 per step (valence without bound), so that the 128th power is the limit to the
/// last digit.
WeightRow FindStationaryLimit(SparseRows const& step, Index point,
                              std::vector<WeightRow> const& points) {
    int const size = step.GetNumRows();
    Eigen::MatrixXd power = Eigen::MatrixXd::Zero(size, size);
    for (int row = 0; row < size; ++row) {
        for (int k = step.offsets[row]; k < step.offsets[row + 1]; ++k)
            power(row, step.indices[k]) += step.weights[k];
    }
    for (int doubling = 0; doubling < 7; ++doubling) power = (power * power).eval();
    WeightRow limit;
    for (int column = 0; column < size; ++column)
        limit.AddWithWeight(points[column], power(point, column));
    return limit;
}

/// Without the weights that are rounding only.
WeightRow Prune(WeightRow const& row) {
    WeightRow pruned;
    for (auto const& [index, weight] : row.GetEntries()) {
        if (std::abs(weight) > 1e-15) pruned.Add(index, weight);
    }
    return pruned;
}

}  // namespace

WeightRow BuildCornerLimit(FaceRing const& base, int corner, Sdc::SchemeType scheme,
                           Sdc::Options options) {
    // Sharpness decays within 10 steps, the ring repeats soon after; where it never does
    // (non-manifold vertices), this many steps are the limit as far as doubles can tell.
    constexpr int kMaxSteps = 64;
    FaceRing ring = base;
    std::vector<WeightRow> points =
        WeightRow::Identity(ring.GetNumPoints());  // of `ring`, over those of `base`
    for (int stepCount = 0; stepCount < kMaxSteps; ++stepCount) {
        RingSubdivision const subdivision = RingSubdivision::Build(ring, scheme, options);
        if (subdivision.IsRegular())
            return Prune(EvaluatePatchCorner(subdivision.patch, corner, points));
        RingSubdivision::Child const& child = subdivision.children[corner];
        // OpenSubdiv numbers a child's corners like its parent's, those of a polygon's child from
        // the vertex.
        bool const isRenumbered = scheme != Sdc::SCHEME_LOOP && ring.GetFaceSizes()[0] != 4;
        corner = isRenumbered ? 0 : corner;
        if (child.ring == ring)
            return Prune(
                FindStationaryLimit(child.weights, ring.GetFaceVertices()[corner], points));
        std::vector<WeightRow> childPoints;
        childPoints.reserve(child.weights.GetNumRows());
        for (int row = 0; row < child.weights.GetNumRows(); ++row)
            childPoints.push_back(Compose(child.weights, row, points));
        points = std::move(childPoints);
        ring = child.ring;
    }
    return Prune(points[ring.GetFaceVertices()[corner]]);
}

}  // namespace limn::far_ext
