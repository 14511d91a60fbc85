// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numeric>
#include <utility>
#include <vector>

#include "far_ext/types.h"

namespace limn::engine {

/// Sets that grow together, each member with its parity (0 or 1) to its root.
class ParitySets {
public:
    explicit ParitySets(Index count)
        : _parent(static_cast<size_t>(count)), _parity(_parent.size(), 0) {
        std::iota(_parent.begin(), _parent.end(), 0);
    }

    /// The root, and the member's parity to it.
    std::pair<Index, char> Find(Index member) {
        Index root = member;
        char parity = 0;
        while (_parent[root] != root) {
            parity ^= _parity[root];
            root = _parent[root];
        }
        char rest = parity;
        while (_parent[member] != root && member != root) {  // shorten the way for the next one
            Index const next = _parent[member];
            char const own = _parity[member];
            _parent[member] = root;
            _parity[member] = rest;
            rest ^= own;
            member = next;
        }
        return {root, parity};
    }

    /// Joins two members that differ by `parity`; false if they already differ by the other one.
    bool Join(Index a, Index b, char parity) {
        auto const [rootA, parityA] = Find(a);
        auto const [rootB, parityB] = Find(b);
        if (rootA == rootB) return (parityA ^ parityB) == parity;
        _parent[rootA] = rootB;
        _parity[rootA] = static_cast<char>(parityA ^ parityB ^ parity);
        return true;
    }

private:
    std::vector<Index> _parent;
    std::vector<char> _parity;
};

}  // namespace limn::engine
