// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "far_ext/types.h"

namespace limn::far_ext {

/// Edges between points, numbered by first appearance. A point has few edges: they are found along
/// a list that hangs on the smaller of their ends.
class EdgeNumbers {
public:
    explicit EdgeNumbers(Index numPoints) : _first(numPoints, -1) {}

    /// The edge's number, a new one where it has none.
    Index Get(Index a, Index b) {
        Index const found = Find(a, b);
        if (found >= 0) return found;
        auto const number = static_cast<Index>(_edges.size());
        Index& first = _first[std::min(a, b)];
        _edges.push_back({std::max(a, b), first});
        first = number;
        return number;
    }

    /// The edge's number, or -1.
    Index Find(Index a, Index b) const {
        Index const other = std::max(a, b);
        Index edge = _first[std::min(a, b)];
        while (edge >= 0 && _edges[edge].other != other) edge = _edges[edge].next;
        return edge;
    }

    Index GetCount() const { return static_cast<Index>(_edges.size()); }

private:
    struct Edge {
        Index other, next;  // the larger end; the next edge of the smaller one
    };

    std::vector<Index> _first;
    std::vector<Edge> _edges;
};

}  // namespace limn::far_ext
