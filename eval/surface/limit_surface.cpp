// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/limit_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/enumerable_thread_specific.h>

#include "eval/parallel/rows.h"
#include "eval/surface/patch_polynomial.h"

namespace limn::eval {

namespace {

using Level = Far::TopologyLevel;

int RegularValence(bool isLoop) {
    return isLoop ? 6 : 4;
}
int RegularSize(bool isLoop) {
    return isLoop ? 3 : 4;
}

/// Interior, of regular valence, among regular faces, without sharpness.
std::vector<char> FindRegularVertices(Level const& level, bool isLoop) {
    std::vector<char> isRegular(level.GetNumVertices(), 0);
    int const valence = RegularValence(isLoop), size = RegularSize(isLoop);
    ForEachRow(level.GetNumVertices(), [&](Index v) {
        auto const faces = level.GetVertexFaces(v);
        auto const edges = level.GetVertexEdges(v);
        bool regular = faces.size() == valence && edges.size() == valence &&
                       !level.IsVertexBoundary(v) && !level.IsVertexNonManifold(v) &&
                       level.GetVertexSharpness(v) <= 0.0f;
        for (int i = 0; regular && i < valence; ++i) {
            regular = level.GetFaceVertices(faces[i]).size() == size &&
                      level.GetEdgeSharpness(edges[i]) <= 0.0f;
        }
        isRegular[v] = regular;
    });
    return isRegular;
}

}  // namespace

LimitSurface::LimitSurface(Far::TopologyRefiner const& refiner, int fvarChannel)
    : _refiner(refiner),
      _channel(fvarChannel),
      _cache(std::make_unique<RingCache>(refiner.GetSchemeType(), refiner.GetSchemeOptions())) {
    Classify();
}

int LimitSurface::GetNumDomains(Index face) const {
    int const size = _refiner.GetLevel(0).GetFaceVertices(face).size();
    return size == RegularSize(IsLoop()) ? 1 : size;
}

void LimitSurface::Classify() {
    Level const level = _refiner.GetLevel(0);
    bool const isBilinear = _refiner.GetSchemeType() == Sdc::SCHEME_BILINEAR;
    bool const isLinear =
        isBilinear || (_channel >= 0 && _refiner.GetSchemeOptions().GetFVarLinearInterpolation() ==
                                            Sdc::Options::FVAR_LINEAR_ALL);
    auto const isRegularVertex = FindRegularVertices(level, IsLoop());
    _kinds.assign(level.GetNumFaces(), FaceKind::None);
    _ringOfFace.assign(_kinds.size(), nullptr);

    struct Scratch {
        far_ext::FaceRingGatherer gatherer;
        far_ext::FaceRing ring;
        std::vector<Index> points;
    };
    tbb::enumerable_thread_specific<Scratch> scratchOfThread(
        [&] { return Scratch{far_ext::FaceRingGatherer(level, _channel), {}, {}}; });
    constexpr Index kFacesPerBlock = 1024;
    ForEachBlock(level.GetNumFaces(), kFacesPerBlock, [&](Index begin, Index end) {
        auto& [gatherer, ring, points] = scratchOfThread.local();
        for (Index face = begin; face < end; ++face) {
            if (level.IsFaceHole(face)) continue;
            auto const corners = level.GetFaceVertices(face);
            bool const isPlain = !isLinear && corners.size() == RegularSize(IsLoop()) &&
                                 std::all_of(corners.begin(), corners.end(),
                                             [&](Index v) { return isRegularVertex[v]; }) &&
                                 (_channel < 0 || level.DoesFaceFVarTopologyMatch(face, _channel));
            if (isPlain) {
                _kinds[face] = FaceKind::Plain;
                continue;
            }
            gatherer.Gather(face, ring, points);
            _ringOfFace[face] = _cache->Find(ring);
            _kinds[face] = FaceKind::Ring;
        }
    });
}

namespace {

/// The 16 points round a quad among regular vertices; see PatchFinder for the ring's general case.
template <class FaceValues>
void GatherQuadPoints(Level const& level, Index face, FaceValues valuesOf, Index* points) {
    // Places on the 4x4 grid (4 t + s) of: the corner, then across it from the face: the vertex
    // opposite to the next corner, the diagonal one, the vertex opposite to the previous corner.
    constexpr int kPlaces[4][4] = {{5, 4, 0, 1}, {6, 2, 3, 7}, {10, 11, 15, 14}, {9, 13, 12, 8}};
    auto const corners = level.GetFaceVertices(face);
    auto const own = valuesOf(face);
    for (int i = 0; i < 4; ++i) {
        auto const faces = level.GetVertexFaces(corners[i]);
        auto const locals = level.GetVertexFaceLocalIndices(corners[i]);
        int const opposite = (faces.FindIndex(face) + 2) & 3;
        auto const values = valuesOf(faces[opposite]);
        int const at = locals[opposite];
        points[kPlaces[i][0]] = own[i];
        for (int k = 1; k < 4; ++k) points[kPlaces[i][k]] = values[(at + k) & 3];
    }
}

/// The 12 points round a triangle among regular vertices, in the order of kBoxSplineLattice.
template <class FaceValues>
void GatherTrianglePoints(Level const& level, Index face, FaceValues valuesOf, Index* points) {
    constexpr int kCorner[3] = {4, 5, 8};
    // Lattice places of the third to sixth neighbour of each corner, counter-clockwise.
    constexpr int kPlaces[3][4] = {{7, 3, 0, 1}, {1, 2, 6, 9}, {9, 11, 10, 7}};
    auto const corners = level.GetFaceVertices(face);
    auto const own = valuesOf(face);
    for (int i = 0; i < 3; ++i) {
        auto const faces = level.GetVertexFaces(corners[i]);
        auto const locals = level.GetVertexFaceLocalIndices(corners[i]);
        int const start = faces.FindIndex(face);
        points[kCorner[i]] = own[i];
        for (int k = 0; k < 4; ++k) {
            int const at = (start + 1 + k) % 6;
            points[kPlaces[i][k]] = valuesOf(faces[at])[(locals[at] + 2) % 3];
        }
    }
}

}  // namespace

void LimitSurface::GatherPlainPoints(Index face, Index* points) const {
    Level const level = _refiner.GetLevel(0);
    auto const gather = [&](auto valuesOf) {
        IsLoop() ? GatherTrianglePoints(level, face, valuesOf, points)
                 : GatherQuadPoints(level, face, valuesOf, points);
    };
    if (_channel < 0) {
        gather([&](Index f) { return level.GetFaceVertices(f); });
    } else {
        gather([&](Index f) { return level.GetFaceFVarValues(f, _channel); });
    }
}

FaceTree::FaceTree(LimitSurface const& surface, std::span<double const> values, int length)
    : FaceTree(surface, std::vector<Values>{{values, length}}) {}

FaceTree::FaceTree(LimitSurface const& surface, std::vector<Values> parts)
    : _surface(surface),
      _parts(std::move(parts)),
      _length(0),
      _isLoop(surface.IsLoop()),
      _gatherer(surface._refiner.GetLevel(0), surface._channel) {
    for (Values const& part : _parts) _length += part.length;
    _numCoefficients = _isLoop ? kTriangleCoefficients : kQuadCoefficients;
    _centre = _isLoop ? kTriangleCentre : kQuadCentre;
}

int FaceTree::AddNode(RingNode const* ring, size_t numPoints) {
    Node node;
    node.ring = ring;
    node.numPoints = numPoints;
    node.origin = _values.size();
    node.points = node.origin + static_cast<size_t>(_length);
    _values.resize(node.points + numPoints * static_cast<size_t>(_length));
    _nodes.push_back(node);
    return static_cast<int>(_nodes.size()) - 1;
}

void FaceTree::GatherPoints(Index face) {
    _face = face;
    _nodes.clear();
    _children.clear();
    _values.assign(1, 0.0);
    if (_surface._ringOfFace[face]) {
        _gatherer.GatherPoints(face, _points);
    } else {
        _points.resize(_isLoop ? 12 : 16);
        _surface.GatherPlainPoints(face, _points.data());
    }
}

void FaceTree::Bind(Index face) {
    GatherPoints(face);
    AddNode(_surface._ringOfFace[face], _points.size());
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
    GatherPoints(face);
    _length = static_cast<int>(_points.size());
    AddNode(_surface._ringOfFace[face], _points.size());
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

int FaceTree::GetRoot(int domain) {
    if (IsLeaf(0)) return 0;
    RingNode const& ring = *_nodes[0].ring;
    bool const hasSubFaces = static_cast<int>(ring.Get().children.size()) != 4;
    return hasSubFaces ? GetChild(0, domain) : 0;
}

bool FaceTree::IsLeaf(int node) {
    RingNode const* const ring = _nodes[node].ring;
    return !ring || ring->Get().IsRegular();
}

int FaceTree::GetChild(int parent, int child) {
    auto const& children = _nodes[parent].ring->Get().children;
    if (_nodes[parent].firstChild < 0) {
        _nodes[parent].firstChild = static_cast<int>(_children.size());
        _children.resize(_children.size() + children.size(), -1);
    }
    size_t const slot = _nodes[parent].firstChild + child;
    if (_children[slot] >= 0) return _children[slot];

    auto const& step = children[child];
    RingNode const* const ring = _surface._cache->FindChild(*_nodes[parent].ring, child);
    int const index = AddNode(ring, static_cast<size_t>(step.weights.GetNumRows()));
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
    size_t const numControl = _isLoop ? 12 : 16;
    size_t const start = _values.size();
    _values.resize(start + static_cast<size_t>(_length * _numCoefficients) + numControl * _length);
    double const* control = &_values[node.points];
    if (node.ring) {
        double* const spline = &_values[start + static_cast<size_t>(_length * _numCoefficients)];
        node.ring->Get().patch.Apply(control, spline, _length);
        control = spline;
    }
    for (int c = 0; c < _length; ++c) {
        double* const to = &_values[start + static_cast<size_t>(c * _numCoefficients)];
        _isLoop ? BoxSplineToPower(control + c, _length, to)
                : BSplineToPower(control + c, _length, to);
    }
    node.coefficients = start;
}

PatchPoint FaceTree::GetLeaf(int index) {
    if (_nodes[index].coefficients == 0) MakeCoefficients(_nodes[index]);
    Node const& node = _nodes[index];
    PatchPoint leaf;
    leaf.coefficients = &_values[node.coefficients];
    leaf.origin = &_values[node.origin];
    leaf.scale = 1.0 / node.domain.scale;
    return leaf;
}

std::array<double, 2> FaceTree::GetBounds(int index, int channel) const {
    Node const& node = _nodes[index];
    double low = std::numeric_limits<double>::infinity(), high = -low;
    auto const add = [&](size_t point) {
        double const value = _values[node.points + point * static_cast<size_t>(_length) + channel];
        low = std::min(low, value);
        high = std::max(high, value);
    };
    if (node.ring) {
        for (Index point : node.ring->Get().support) add(static_cast<size_t>(point));
    } else {
        for (size_t point = 0; point < node.numPoints; ++point) add(point);
    }
    double const origin = _values[node.origin + static_cast<size_t>(channel)];
    return {origin + low, origin + high};
}

double const* FaceTree::GetOrigin(int node) const {
    return &_values[_nodes[node].origin];
}

int GetChildAt(bool isLoop, double& s, double& t) {
    if (isLoop) {
        int child = 0;
        if (s >= 0.5)
            child = 1;
        else if (t >= 0.5)
            child = 2;
        else if (s + t > 0.5)
            child = 3;
        s = child == 3 ? 1.0 - 2.0 * s : 2.0 * s - (child == 1);
        t = child == 3 ? 1.0 - 2.0 * t : 2.0 * t - (child == 2);
        return child;
    }
    int const i = s >= 0.5, j = t >= 0.5;
    s = 2.0 * s - i;
    t = 2.0 * t - j;
    return j ? 3 - i : i;
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
    int node = GetRoot(domain);
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
    Node& node = _nodes[index];
    if (node.coefficients == 0) {
        size_t const start = _values.size();
        _values.resize(start + static_cast<size_t>(_length * _numCoefficients), 0.0);
        double const* const p = &_values[node.points];
        for (int c = 0; c < _length; ++c) {
            double* const to = &_values[start + static_cast<size_t>(c * _numCoefficients)];
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
    return GetLeaf(index);
}

}  // namespace limn::eval
