// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/face_tree.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "eval/surface/patch_polynomial.h"
#include "eval/surface/ring_cache.h"
#include "far_ext/error.h"

namespace limn::eval {

FaceTree::FaceTree(LimitSurface const& surface, std::span<double const> values, int length)
    : FaceTree(surface, std::vector<Values>{{values, length}}) {}

FaceTree::FaceTree(LimitSurface const& surface, std::vector<Values> parts)
    : _surface(surface),
      _parts(std::move(parts)),
      _length(0),
      _isLoop(surface.IsLoop()),
      _gatherer(surface._refiner.GetLevel(0), surface._refiner.GetSchemeOptions(),
                surface._channel) {
    for (Values const& part : _parts) {
        surface.CheckValues(part.data, part.length);
        _length += part.length;
    }
    _numChannels = _length;
    _numCoefficients = _isLoop ? kTriangleCoefficients : kQuadCoefficients;
    _centre = _isLoop ? kTriangleCentre : kQuadCentre;
}

int FaceTree::AddNode(RingNode const* ring, size_t numPoints) {
    Node node;
    node.ring = ring;
    node.numPoints = numPoints;
    node.origin = _values.size();
    node.points = node.origin + _length;
    _values.resize(node.points + numPoints * _length);
    _nodes.push_back(node);
    return static_cast<int>(_nodes.size()) - 1;
}

/// The face's control points, in an empty tree, and its ring: null for a plain patch.
RingNode const* FaceTree::Gather(Index face) {
    CheckFace(_surface, face);
    _face = face;
    _numDomains = _surface.GetNumDomains(face);
    _nodes.clear();
    _children.clear();
    _values.assign(1, 0.0);
    if (_surface.IsPlainPatch(face)) {
        _points.resize(_isLoop ? 12 : 16);
        _surface.GatherPlainPoints(face, _points.data());
        return nullptr;
    }
    _gatherer.Gather(face, _ring, _points);
    _surface._cache->Renew(_rings);
    return _rings->Find(_ring);
}

void FaceTree::Bind(Index face) {
    RingNode const* const ring = Gather(face);
    _length = _numChannels;
    AddNode(ring, _points.size());
    double* to = &_values[_nodes[0].points];
    for (Index point : _points) {
        for (Values const& part : _parts) {
            double const* const from = &part.data[static_cast<size_t>(point) * part.length];
            to = std::copy(from, from + part.length, to);
        }
    }
    Recentre(_nodes[0], nullptr);
}

void FaceTree::BindWeights(Index face) {
    RingNode const* const ring = Gather(face);
    _length = static_cast<int>(_points.size());
    AddNode(ring, _points.size());
    for (size_t i = 0; i < _points.size(); ++i)
        _values[_nodes[0].points + i * _points.size() + i] = 1.0;
    Recentre(_nodes[0], nullptr);
}

/// Makes the node's points relative to its first one, which becomes the origin; a root has no
/// parent's.
void FaceTree::Recentre(Node& node, double const* parentOrigin) {
    double* const points = &_values[node.points];
    double* const origin = &_values[node.origin];
    for (int c = 0; c < _length; ++c) {
        double const first = points[c];
        origin[c] = parentOrigin ? parentOrigin[c] + first : first;
        for (size_t i = 0; i < node.numPoints; ++i) points[i * _length + c] -= first;
    }
}

void FaceTree::RefuseNode(int node) const {
    throw Error(ErrorCode::BadOption,
                _face < 0 ? "FaceTree: no face is bound"
                          : fmt::format("node {} does not exist; the tree has {} by now", node,
                                        _nodes.size()));
}

void FaceTree::CheckChannel(int channel) const {
    if (channel >= 0 && channel < _length) return;
    throw Error(ErrorCode::BadOption,
                fmt::format("channel {} does not exist; the tree has {}", channel, _length));
}

int FaceTree::GetRoot(int domain) {
    bool const isOnePiece = IsLeaf(0);
    CheckDomain(_face, domain, _numDomains);
    if (isOnePiece) return 0;
    RingNode const& ring = *_nodes[0].ring;
    bool const hasSubFaces = static_cast<int>(ring.Get().children.size()) != 4;
    return hasSubFaces ? GetChild(0, domain) : 0;
}

bool FaceTree::IsLeaf(int node) const {
    RingNode const* const ring = NodeAt(node).ring;
    return !ring || ring->Get().IsRegular();
}

int FaceTree::GetChild(int parent, int child) {
    RingNode const* const parentRing = NodeAt(parent).ring;
    size_t const numChildren = parentRing ? parentRing->Get().children.size() : 0;
    if (static_cast<size_t>(child) >= numChildren) {
        throw Error(ErrorCode::BadOption, fmt::format("child {} does not exist; node {} has {}",
                                                      child, parent, numChildren));
    }
    auto const& children = parentRing->Get().children;
    if (_nodes[parent].firstChild < 0) {
        _nodes[parent].firstChild = static_cast<int>(_children.size());
        _children.resize(_children.size() + children.size(), -1);
    }
    size_t const slot = _nodes[parent].firstChild + child;
    if (_children[slot] >= 0) return _children[slot];

    auto const& step = children[child];
    RingNode const* const ring = _rings->FindChild(*parentRing, child);
    int const index = AddNode(ring, step.weights.GetNumRows());
    Node& node = _nodes[index];
    Node const& from = _nodes[parent];
    step.weights.Apply(&_values[from.points], &_values[node.points], _length);
    Recentre(node, &_values[from.origin]);
    bool const isSubFace = children.size() != 4;
    node.depth = isSubFace ? 0 : from.depth + 1;
    if (!isSubFace) {
        for (int k = 0; k < 2; ++k) {
            node.domain.origin[k] =
                from.domain.origin[k] + from.domain.scale * step.domain.origin[k];
        }
        node.domain.scale = from.domain.scale * step.domain.scale;
    }
    _children[slot] = index;
    return index;
}

void FaceTree::MakeCoefficients(Node& node) {
    size_t const numControl = _isLoop ? 12 : 16, numCoefficients = _numCoefficients;
    size_t const start = _values.size();
    _values.resize(start + (numCoefficients + numControl) * _length);
    double const* control = &_values[node.points];
    if (node.ring) {
        double* const spline = &_values[start + numCoefficients * _length];
        node.ring->Get().patch.Apply(control, spline, _length);
        control = spline;
    }
    for (int c = 0; c < _length; ++c) {
        double* const to = &_values[start + numCoefficients * c];
        _isLoop ? BoxSplineToPower(control + c, _length, to)
                : BSplineToPower(control + c, _length, to);
    }
    node.coefficients = start;
}

PatchPoint FaceTree::GetLeaf(int node) {
    if (!IsLeaf(node))
        throw Error(ErrorCode::BadOption, fmt::format("node {} is no leaf; it has children", node));
    if (_nodes[node].coefficients == 0) MakeCoefficients(_nodes[node]);
    return MakeLeaf(_nodes[node]);
}

PatchPoint FaceTree::MakeLeaf(Node const& node) const {
    PatchPoint leaf;
    leaf.coefficients = &_values[node.coefficients];
    leaf.origin = &_values[node.origin];
    leaf.scale = 1.0 / node.domain.scale;
    return leaf;
}

std::array<double, 2> FaceTree::GetBounds(int index, int channel) const {
    Node const& node = NodeAt(index);
    CheckChannel(channel);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    auto const add = [&](size_t point) {
        double const value = _values[node.points + point * _length + channel];
        low = std::min(low, value);
        high = std::max(high, value);
    };
    if (node.ring) {
        for (Index point : node.ring->Get().support) add(point);
    } else {
        for (size_t point = 0; point < node.numPoints; ++point) add(point);
    }
    double const origin = _values[node.origin + channel];
    return {origin + low, origin + high};
}

/// Moves (s,t) of a node away from its nearest corner to distance 1, along the line from it; from
/// the corner itself along the diagonal (Loop: the median).
void FaceTree::MoveOut(double& s, double& t) const {
    if (_isLoop) {
        // Distance from corner k is 1 minus its barycentric coordinate.
        double b[3] = {1.0 - s - t, s, t};
        int const k = static_cast<int>(std::max_element(b, b + 3) - b);
        double const distance = 1.0 - b[k];
        for (int i = 0; i < 3; ++i) {
            if (i != k) b[i] = distance > 0.0 ? b[i] / distance : 0.5;
        }
        b[k] = 0.0;
        s = b[1];
        t = b[2];
        return;
    }
    bool const farS = s >= 0.5, farT = t >= 0.5;
    double ds = farS ? 1.0 - s : s, dt = farT ? 1.0 - t : t;
    double const distance = std::max(ds, dt);
    ds = distance > 0.0 ? ds / distance : 1.0;
    dt = distance > 0.0 ? dt / distance : 1.0;
    s = farS ? 1.0 - ds : ds;
    t = farT ? 1.0 - dt : dt;
}

PatchPoint FaceTree::Locate(int domain, double s, double t, int maxDepth) {
    int const root = GetRoot(domain);
    CheckInDomain(_isLoop, {_face, domain, s, t});
    return Descend(root, s, t, maxDepth);
}

PatchPoint FaceTree::LocateChecked(int domain, double s, double t, int maxDepth) {
    return Descend(GetRoot(domain), s, t, maxDepth);
}

PatchPoint FaceTree::Descend(int node, double s, double t, int maxDepth) {
    bool isMoved = false;
    while (!IsLeaf(node)) {
        if (_nodes[node].depth >= maxDepth && !isMoved) {
            MoveOut(s, t);
            isMoved = true;
        }
        if (_nodes[node].depth > kLimitDepth + 1) break;
        node = GetChild(node, GetChildAt(_isLoop, s, t));
    }
    PatchPoint leaf = IsLeaf(node) ? GetLeaf(node) : GetLinearLeaf(node);
    leaf.x = s - _centre;
    leaf.y = t - _centre;
    leaf.isMoved = isMoved;
    return leaf;
}

/// A surface that stays irregular along a whole edge however deep (no OpenSubdiv rule for vertices
/// makes one, face-varying boundaries do) ends in the linear patch of its corners.
PatchPoint FaceTree::GetLinearLeaf(int index) {
    NodeAt(index);
    Node& node = _nodes[index];
    if (node.coefficients == 0) {
        size_t const start = _values.size(), numCoefficients = _numCoefficients;
        _values.resize(start + numCoefficients * _length, 0.0);
        double const* const p = &_values[node.points];
        for (int c = 0; c < _length; ++c) {
            double* const to = &_values[start + numCoefficients * c];
            auto const at = [&](int i) { return p[i * _length + c]; };
            if (_isLoop) {
                double const ds = at(1) - at(0), dt = at(2) - at(0);
                to[0] = at(0) + (ds + dt) * kTriangleCentre;
                to[1] = ds;
                to[5] = dt;
            } else {
                to[0] = (at(0) + at(1) + at(2) + at(3)) / 4;
                to[1] = (at(1) + at(2) - at(0) - at(3)) / 2;
                to[4] = (at(2) + at(3) - at(0) - at(1)) / 2;
                to[5] = at(0) + at(2) - at(1) - at(3);
            }
        }
        node.coefficients = start;
    }
    return MakeLeaf(node);
}

}  // namespace limn::eval
