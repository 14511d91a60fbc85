// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/alike_faces.h"

#include <algorithm>

#include "eval/kernels/dispatch.h"
#include "eval/surface/face_tree.h"
#include "eval/surface/patch_polynomial.h"
#include "eval/surface/surface_place.h"

namespace limn::eval {

namespace {

constexpr size_t kRow = kIntegralRow;

/// Power coefficients as rows over a patch's control points.
far_ext::SparseRows MakePowerRows(bool isLoop) {
    size_t const numPoints = isLoop ? 12 : 16,
                 numCoefficients = isLoop ? kTriangleCoefficients : kQuadCoefficients;
    std::vector<far_ext::WeightRow> rows(numCoefficients);
    std::vector<double> coefficients(numCoefficients);
    for (size_t point = 0; point < numPoints; ++point) {
        std::vector<double> control(numPoints, 0.0);
        control[point] = 1.0;
        isLoop ? BoxSplineToPower(control.data(), 1, coefficients.data())
               : BSplineToPower(control.data(), 1, coefficients.data());
        for (size_t i = 0; i < numCoefficients; ++i)
            rows[i].Add(static_cast<Index>(point), coefficients[i]);
    }
    far_ext::SparseRows made;
    for (far_ext::WeightRow const& row : rows) made.AddRow(row);
    return made;
}

void Apply(far_ext::SparseRows const& rows, double const* from, double* to) {
    GetKernel<IntegralKernel>().apply(
        {rows.GetNumRows(), rows.offsets.data(), rows.indices.data(), rows.weights.data()}, from,
        to);
}

}  // namespace

AlikeFaces::AlikeFaces(bool isLoop)
    : _isLoop(isLoop),
      _centre(isLoop ? kTriangleCentre : kQuadCentre),
      _toPower(MakePowerRows(isLoop)) {}

int AlikeFaces::AddNode(RingNode const& ring, int numPoints) {
    Node node;
    node.ring = &ring;
    node.origin = _values.size();
    _values.resize(_values.size() + (1 + static_cast<size_t>(numPoints)) * kRow, 0.0);
    _nodes.push_back(node);
    return static_cast<int>(_nodes.size()) - 1;
}

/// Makes a node's points relative to its first one, which is added to the origin: so neither
/// positions nor derivatives lose digits with depth.
void AlikeFaces::Recentre(Node const& node, int numPoints) {
    double* const origin = &_values[node.origin];
    double* point = origin + kRow;
    std::array<double, kRow> first;
    std::copy_n(point, kRow, first.begin());
    for (size_t i = 0; i < kRow; ++i) origin[i] += first[i];
    for (int k = 0; k < numPoints; ++k, point += kRow) {
        for (size_t i = 0; i < kRow; ++i) point[i] -= first[i];
    }
}

void AlikeFaces::Bind(RingStore& rings, RingNode const& ring, int numPoints,
                      std::array<Index const*, kLanes> const& points,
                      std::span<double const> positions) {
    _rings = &rings;
    _nodes.clear();
    _children.clear();
    _values.assign(1, 0.0);
    AddNode(ring, numPoints);
    double* to = &_values[_nodes[0].origin + kRow];
    for (int point = 0; point < numPoints; ++point, to += kRow) {
        for (size_t lane = 0; lane < kLanes; ++lane) {
            double const* const from = &positions[3 * static_cast<size_t>(points[lane][point])];
            for (size_t c = 0; c < 3; ++c) to[c * kLanes + lane] = from[c];
        }
    }
    Recentre(_nodes[0], numPoints);
}

int AlikeFaces::GetChild(int parent, int child) {
    RingNode const& parentRing = *_nodes[parent].ring;
    auto const& children = parentRing.Get().children;
    if (_nodes[parent].firstChild < 0) {
        _nodes[parent].firstChild = static_cast<int>(_children.size());
        _children.resize(_children.size() + children.size(), -1);
    }
    size_t const slot = static_cast<size_t>(_nodes[parent].firstChild) + child;
    if (_children[slot] >= 0) return _children[slot];

    auto const& step = children[child];
    int const numPoints = step.weights.GetNumRows();
    int const index = AddNode(*_rings->FindChild(parentRing, child), numPoints);
    Node& node = _nodes[index];
    Node const& from = _nodes[parent];
    std::copy_n(&_values[from.origin], kRow, &_values[node.origin]);
    Apply(step.weights, &_values[from.origin + kRow], &_values[node.origin + kRow]);
    Recentre(node, numPoints);
    bool const isSubFace = children.size() != 4;
    if (!isSubFace) {
        node.depth = from.depth + 1;
        for (size_t k = 0; k < 2; ++k) {
            node.domain.origin[k] =
                from.domain.origin[k] + from.domain.scale * step.domain.origin[k];
        }
        node.domain.scale = from.domain.scale * step.domain.scale;
    }
    _children[slot] = index;
    return index;
}

AlikeFaces::Place AlikeFaces::Find(int domain, double s, double t) {
    auto const isLeaf = [&](int node) { return _nodes[node].ring->Get().IsRegular(); };
    int node = 0;
    if (!isLeaf(0) && _nodes[0].ring->Get().children.size() != 4) node = GetChild(0, domain);
    while (!isLeaf(node)) {
        if (_nodes[node].depth >= FaceTree::kCurvatureDepth) return {-1, 0.0, 0.0};
        node = GetChild(node, GetChildAt(_isLoop, s, t));
    }
    return {node, s - _centre, t - _centre};
}

AlikeFaces::Piece AlikeFaces::GetPiece(int piece) {
    Node& node = _nodes[piece];
    if (node.coefficients == 0) {
        far_ext::SparseRows const& patch = node.ring->Get().patch;
        size_t const numCoefficients = static_cast<size_t>(_toPower.GetNumRows());
        node.coefficients = _values.size();
        _values.resize(_values.size() + (numCoefficients + patch.GetNumRows()) * kRow);
        double* const coefficients = &_values[node.coefficients];
        double* const control = coefficients + numCoefficients * kRow;
        Apply(patch, &_values[node.origin + kRow], control);
        Apply(_toPower, control, coefficients);
    }
    return {&_values[node.coefficients], &_values[node.origin], 1.0 / node.domain.scale};
}

}  // namespace limn::eval
