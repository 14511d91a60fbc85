// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "eval/surface/surface_place.h"
#include "far_ext/rings/ring_subdivision.h"

namespace limn::eval {

class RingNode;
class RingStore;

/// One polynomial piece of a face's limit surface with a point in it.
struct PatchPoint {
    double const* coefficients = nullptr;  ///< [channel][16 or 15], see patch_polynomial.h
    double const* origin = nullptr;        ///< [channel], to be added to the value
    double x = 0.0, y = 0.0;               ///< the point, about the piece's centre
    double scale = 1.0;                    ///< d(x)/d(s): 2^depth, negative in a flipped triangle
    bool isMoved = false;                  ///< the point was moved away from an irregular corner
};

/// A run of samples that lie in one polynomial piece.
struct PatchRun {
    PatchPoint patch;              ///< x and y are not set
    std::span<int const> samples;  ///< indices into the samples given
    std::span<double const> s, t;  ///< in the piece's own domain, one per entry of `samples`
};

/// The limit surface of one face at a time, refined as deep as the samples ask: a quadtree of
/// rings whose leaves are polynomial pieces. Every node keeps its points relative to its own
/// corner, so that neither positions nor derivatives lose digits with depth.
///
/// Depth    A piece at distance d from an irregular corner (in units of the domain) has depth
///          floor(-log2 d) + 1. Samples nearer than 2^-maxDepth are moved radially out to that
///          distance [Limit 10].
/// Threads  One per thread; it reuses its memory from face to face.
/// Life     The surface, its refiner and the values are kept by view and must outlive the tree; a
///          value that changes shows from the next Bind on. Nodes live until the next Bind. Pieces
///          point into memory that grows: they live until the next call that is not const.
/// Errors   BadOption: values that do not reach all control points; a face that does not exist or
///          has no limit; a domain, channel or node that does not exist; (s,t) more than
///          kPlaceSlack outside the domain, or not a number; a question before the first Bind.
class FaceTree {
public:
    /// Second derivatives are taken no nearer to an irregular corner than 2^-16 ...
    static constexpr int kCurvatureDepth = 16;
    /// ... positions and normals this near, which is at the corner as far as doubles can tell.
    static constexpr int kLimitDepth = 120;

    /// \param values  `length` doubles per vertex (or fvar value)
    FaceTree(LimitSurface const& surface, std::span<double const> values, int length);

    /// Several value arrays side by side: channel c of the result is parts[k][...] in order.
    struct Values {
        std::span<double const> data;
        int length;
    };
    FaceTree(LimitSurface const& surface, std::vector<Values> parts);

    /// Makes `face` (with HasLimit) the current one.
    void Bind(Index face);

    /// Makes `face` the current one with weights for values: channel c is the weight of the vertex
    /// (or fvar value) that GetPoints names at c, and there are as many channels as points.
    void BindWeights(Index face);
    std::vector<Index> const& GetPoints() const { return _points; }

    /// The piece that holds (s,t) of a domain of the current face.
    PatchPoint Locate(int domain, double s, double t, int maxDepth);

    /// The same without a look at (s,t), for places that have been checked already; refinement of
    /// the face (RefinedFaces) may since have doubled what they lie outside of it.
    PatchPoint LocateChecked(int domain, double s, double t, int maxDepth);

    /// Sorts samples of one domain into pieces and calls visit(PatchRun const&) for each. Samples
    /// nearer than 2^-maxDepth to an irregular corner are handed to visitNear(sample index).
    template <class Visit, class VisitNear>
    void ForEachPiece(int domain, std::span<double const> s, std::span<double const> t,
                      int maxDepth, Visit visit, VisitNear visitNear);

    /// Nodes, for searches that prune (the UV inversion). The root of a domain:
    int GetRoot(int domain);
    bool IsLeaf(int node) const;
    size_t GetNumNodes() const { return _nodes.size(); }  ///< made by now, of the current face
    int GetChild(int node, int child);                    ///< of a node that is no leaf
    PatchPoint GetLeaf(int node);                         ///< of a leaf
    PatchPoint GetLinearLeaf(int node);  ///< of any node: the linear patch of its corners
    int GetNumDomains() const { return _numDomains; }
    double const* GetOrigin(int node) const { return &_values[NodeAt(node).origin]; }
    /// Bounds of one channel over the control points that shape a node, which hold its limit.
    std::array<double, 2> GetBounds(int node, int channel) const;
    far_ext::SubDomain const& GetDomain(int node) const { return NodeAt(node).domain; }

    Index GetFace() const { return _face; }  ///< the current one; -1 before the first Bind
    int GetLength() const { return _length; }

    /// Refuses a channel beyond the tree's.
    void CheckChannel(int channel) const;

    int GetNumCoefficients() const { return _numCoefficients; }
    double GetCentre() const { return _centre; }

private:
    struct Node {
        RingNode const* ring = nullptr;  // null: a plain patch
        size_t points = 0;               // into _values
        size_t numPoints = 0;
        size_t origin = 0;        // into _values
        size_t coefficients = 0;  // into _values; 0 until made
        int firstChild = -1;      // into _children; -1 until made
        int depth = 0;
        far_ext::SubDomain domain;  // of the domain it belongs to
    };

    Node const& NodeAt(int node) const {
        if (static_cast<size_t>(node) < _nodes.size()) return _nodes[node];
        RefuseNode(node);
    }
    [[noreturn]] void RefuseNode(int node) const;
    PatchPoint MakeLeaf(Node const& node) const;
    RingNode const* Gather(Index face);
    int AddNode(RingNode const* ring, size_t numPoints);
    void Recentre(Node& node, double const* parentOrigin);
    void MakeCoefficients(Node& node);
    PatchPoint Descend(int node, double s, double t, int maxDepth);
    void MoveOut(double& s, double& t) const;
    template <class Visit, class VisitNear>
    void Split(int node, std::span<int> samples, std::span<double> s, std::span<double> t,
               int maxDepth, Visit& visit, VisitNear& visitNear);

    LimitSurface const& _surface;
    std::vector<Values> _parts;
    int _numChannels;  // of the values
    int _length;       // of a point now: as many, or with BindWeights as there are points
    int _numCoefficients;
    double _centre;
    bool _isLoop;
    Index _face = -1;
    int _numDomains = 0;
    far_ext::FaceRingGatherer _gatherer;
    std::shared_ptr<RingStore> _rings;  // that the current face's nodes are in
    far_ext::FaceRing _ring;            // scratch
    std::vector<Node> _nodes;
    std::vector<int> _children;
    std::vector<double> _values;  // an arena, reset by Bind; entry 0 is unused
    std::vector<Index> _points;
    // scratch of ForEachPiece
    std::vector<int> _identity, _samples, _sampleBuffer;
    std::vector<double> _s, _t, _sBuffer, _tBuffer;
    std::vector<unsigned char> _childOfSample;
};

template <class Visit, class VisitNear>
void FaceTree::ForEachPiece(int domain, std::span<double const> s, std::span<double const> t,
                            int maxDepth, Visit visit, VisitNear visitNear) {
    int const root = GetRoot(domain);
    CheckInDomain(_isLoop, _face, domain, s, t);
    for (size_t i = _identity.size(); i < s.size(); ++i) _identity.push_back(static_cast<int>(i));
    std::span<int const> const all(_identity.data(), s.size());
    if (IsLeaf(root)) return visit(PatchRun{GetLeaf(root), all, s, t});
    _samples.assign(all.begin(), all.end());
    _s.assign(s.begin(), s.end());
    _t.assign(t.begin(), t.end());
    _sampleBuffer.resize(s.size());
    _sBuffer.resize(s.size());
    _tBuffer.resize(s.size());
    _childOfSample.resize(s.size());
    Split(root, _samples, _s, _t, maxDepth, visit, visitNear);
}

template <class Visit, class VisitNear>
void FaceTree::Split(int node, std::span<int> samples, std::span<double> s, std::span<double> t,
                     int maxDepth, Visit& visit, VisitNear& visitNear) {
    if (samples.empty()) return;
    if (IsLeaf(node)) return visit(PatchRun{GetLeaf(node), samples, s, t});
    if (_nodes[node].depth >= maxDepth) {
        for (int sample : samples) visitNear(sample);
        return;
    }
    // A stable counting sort by child.
    size_t const base = samples.data() - _samples.data();
    size_t count[5] = {0, 0, 0, 0, 0};
    for (size_t i = 0; i < samples.size(); ++i) {
        int const child = GetChildAt(_isLoop, s[i], t[i]);
        _childOfSample[base + i] = static_cast<unsigned char>(child);
        ++count[child + 1];
    }
    for (int c = 0; c < 4; ++c) count[c + 1] += count[c];
    size_t next[4] = {count[0], count[1], count[2], count[3]};
    for (size_t i = 0; i < samples.size(); ++i) {
        size_t const to = base + next[_childOfSample[base + i]]++;
        _sampleBuffer[to] = samples[i];
        _sBuffer[to] = s[i];
        _tBuffer[to] = t[i];
    }
    for (size_t i = 0; i < samples.size(); ++i) {
        samples[i] = _sampleBuffer[base + i];
        s[i] = _sBuffer[base + i];
        t[i] = _tBuffer[base + i];
    }
    for (int c = 0; c < 4; ++c) {
        size_t const size = count[c + 1] - count[c];
        if (size == 0) continue;
        Split(GetChild(node, c), samples.subspan(count[c], size), s.subspan(count[c], size),
              t.subspan(count[c], size), maxDepth, visit, visitNear);
    }
}

}  // namespace limn::eval
