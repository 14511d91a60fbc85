// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "eval/surface/integral_kernel.h"
#include "eval/surface/ring_cache.h"

namespace limn::eval {

/// The limit surfaces of faces with equal rings, side by side: what a FaceTree is to one face, with
/// a lane per face. Rings say where pieces lie and how their points weigh, so that all lanes take
/// the same steps.
///
/// Threads  one per thread; it uses its memory again
/// Life     of a piece: until the next call that is not const
class AlikeFaces {
public:
    static constexpr int kLanes = kIntegralLanes;

    explicit AlikeFaces(bool isLoop);

    /// Makes faces the current ones.
    ///
    /// \param rings   that `ring` is in; kept by reference
    /// \param points  per lane: the vertices of the ring's points
    void Bind(RingStore& rings, RingNode const& ring, int numPoints,
              std::array<Index const*, kLanes> const& points, std::span<double const> positions);

    /// The piece that holds a place, and where in it.
    struct Place {
        int piece;    ///< -1: a piece deeper than FaceTree::kCurvatureDepth
        double x, y;  ///< about the piece's centre
    };
    Place Find(int domain, double s, double t);

    struct Piece {
        double const* coefficients;  ///< see IntegralPlaces
        double const* origin;
        double scale;
    };
    Piece GetPiece(int piece);

private:
    struct Node {
        RingNode const* ring = nullptr;
        size_t origin = 0;        // into _values; the points follow
        size_t coefficients = 0;  // into _values; 0 until made
        int firstChild = -1;      // into _children; -1 until made
        int depth = 0;
        far_ext::SubDomain domain;
    };

    int AddNode(RingNode const& ring, int numPoints);
    void Recentre(Node const& node, int numPoints);
    int GetChild(int parent, int child);

    bool _isLoop;
    double _centre;
    far_ext::SparseRows _toPower;
    RingStore* _rings = nullptr;
    std::vector<Node> _nodes;
    std::vector<int> _children;
    std::vector<double> _values;  // an arena, reset by Bind; entry 0 is unused
};

}  // namespace limn::eval
