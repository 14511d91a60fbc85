// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/polyline_chains.h"

#include <algorithm>
#include <utility>

namespace limn::engine {

size_t PolylineChains::GetVertex(End end) const {
    auto const& vertices = _pieces[end.piece].vertices;
    return end.isBack ? vertices.back() : vertices.front();
}

/// Notes at its vertices that a piece ends or passes there.
void PolylineChains::Meet(size_t piece) {
    auto const& vertices = _pieces[piece].vertices;
    size_t const largest = *std::ranges::max_element(vertices);
    if (_joints.size() <= largest) _joints.resize(std::max(largest + 1, 2 * _joints.size()));
    bool const isClosed = _pieces[piece].IsClosed();
    for (size_t i = 0; i < vertices.size(); ++i) {
        Joint& joint = _joints[vertices[i]];
        bool const isEnd = !isClosed && (i == 0 || i + 1 == vertices.size());
        if (!isEnd) {
            ++joint.numPassing;
        } else {
            if (joint.numEnds < 2) joint.ends[joint.numEnds] = {piece, i > 0};
            ++joint.numEnds;
        }
    }
}

std::optional<PolylineChains::Branch> PolylineChains::FindBranch() {
    _joints.clear();
    for (size_t piece = 0; piece < _pieces.size(); ++piece) {
        Meet(piece);
        for (size_t vertex : _pieces[piece].vertices) {
            Joint const& joint = _joints[vertex];
            bool const isBranch = joint.numEnds > 2 || (joint.numEnds > 0 && joint.numPassing > 0);
            if (isBranch) return Branch{vertex, _pieces[piece].line};
        }
    }
    return std::nullopt;
}

/// The other end at the vertex of an end.
std::optional<PolylineChains::End> PolylineChains::FindPartner(End end) const {
    Joint const& joint = _joints[GetVertex(end)];  // a closed piece has none of its ends
    if (joint.numEnds < 2) return std::nullopt;
    return joint.ends[joint.ends[0] == end];
}

/// Where the chain of a piece begins: at its free end, against the piece's direction, or with the
/// piece itself if the chain is a loop.
PolylineChains::End PolylineChains::FindStart(size_t piece) const {
    End start{piece, false};
    for (auto partner = FindPartner(start); partner && partner->piece != piece;
         partner = FindPartner(start)) {
        start = {partner->piece, !partner->isBack};
    }
    bool const isLoop = FindPartner(start).has_value();
    return isLoop ? End{piece, false} : start;
}

Polyline PolylineChains::WalkFrom(End start) {
    Polyline chain;
    for (std::optional<End> next = start; next && !_isJoined[next->piece];) {
        _isJoined[next->piece] = 1;
        auto vertices = _pieces[next->piece].vertices;
        if (next->isBack) std::ranges::reverse(vertices);
        if (!chain.vertices.empty()) chain.vertices.pop_back();  // the joint is both pieces'
        chain.vertices.insert(chain.vertices.end(), vertices.begin(), vertices.end());
        next = FindPartner({next->piece, !next->isBack});
    }
    return chain;
}

std::vector<Polyline> PolylineChains::Join() {
    _isJoined.assign(_pieces.size(), 0);
    std::vector<Polyline> chains;
    for (size_t piece = 0; piece < _pieces.size(); ++piece) {
        if (_isJoined[piece]) continue;
        chains.push_back(WalkFrom(FindStart(piece)));
        chains.back().line = _pieces[piece].line;
    }
    return chains;
}

}  // namespace limn::engine
