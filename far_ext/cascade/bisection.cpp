// SPDX-License-Identifier: Apache-2.0
#include "far_ext/cascade/bisection.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "far_ext/cascade/edge_numbers.h"
#include "far_ext/rows/points.h"

namespace limn::far_ext {

namespace {

int FindLongestEdge(Index const* face, Points points) {
    int longest = 0;
    double best = -1.0;
    std::array<Index, 2> bestPair{};
    for (int k = 0; k < 3; ++k) {
        Index const a = face[k], b = face[(k + 1) % 3];
        std::array<Index, 2> const pair{std::min(a, b), std::max(a, b)};
        double const square = (points[pair[1]] - points[pair[0]]).squaredNorm();
        if (square < best || (square == best && bestPair < pair)) continue;
        longest = k;
        best = square;
        bestPair = pair;
    }
    return longest;
}

/// A corner of a triangle: its vertex and face-varying value.
struct CutCorner {
    Index vertex, value;
};

}  // namespace

/// The edges of a mesh, and which of them a pass cuts.
struct Bisection::CutEdges {
    EdgeNumbers numbers;
    std::vector<std::array<Index, 2>> ends;
    std::vector<Index> ofCorner;  // per corner: the edge to the next one
    std::vector<Index> middles;   // per edge: its new vertex, or -1

    Index FindMiddle(Index a, Index b) const {
        Index const edge = numbers.Find(a, b);
        return edge < 0 ? -1 : middles[edge];
    }
};

/// What a pass makes.
struct Bisection::Halves {
    CutEdges const& edges;
    std::vector<Index>& faces;
    std::vector<Index>& baseFaces;
    std::vector<Index>* fvarValues;  // null without a channel
    Index numFVarValues;
    std::vector<std::array<Index, 2>>& fvarParents;
    EdgeNumbers fvarEdges;  // that are cut

    /// Cuts a triangle whose refinement edge is (face[0], face[1]), and its halves. New triangles
    /// have their refinement edge, opposite the newest vertex, first as well.
    void Cut(std::array<CutCorner, 3> const& face, Index baseFace) {
        Index const middle = edges.FindMiddle(face[0].vertex, face[1].vertex);
        if (middle < 0) {
            for (CutCorner const& corner : face) {
                faces.push_back(corner.vertex);
                if (fvarValues) fvarValues->push_back(corner.value);
            }
            baseFaces.push_back(baseFace);
            return;
        }
        CutCorner const cut{middle, fvarValues ? CutValue(face[0].value, face[1].value) : 0};
        Cut({face[2], face[0], cut}, baseFace);
        Cut({face[1], face[2], cut}, baseFace);
    }

private:
    Index CutValue(Index a, Index b) {
        Index const number = fvarEdges.Get(a, b);
        if (static_cast<size_t>(number) == fvarParents.size()) fvarParents.push_back({a, b});
        return numFVarValues + number;
    }
};

Bisection::Bisection(Index numVertices, std::vector<Index> faces, std::span<double const> positions,
                     std::vector<std::array<Index, 2>> creases, std::vector<Index> corners) {
    _mesh.numVertices = numVertices;
    _mesh.faces = std::move(faces);
    _mesh.creases = std::move(creases);
    _mesh.corners = std::move(corners);
    for (size_t corner = 0; corner < _mesh.faces.size(); corner += 3)
        _refinementEdges.push_back(FindLongestEdge(&_mesh.faces[corner], positions));
    _baseFaces.resize(_refinementEdges.size());
    std::iota(_baseFaces.begin(), _baseFaces.end(), 0);
}

void Bisection::SetFVarChannel(Index numValues, std::vector<Index> values) {
    _numFVarValues = numValues;
    _fvarValues = std::move(values);
}

/// Per edge whether it is cut: the refinement edges of marked triangles, and of all that have a cut
/// edge.
std::vector<char> Bisection::CloseCuts(CutEdges const& edges,
                                       std::span<char const> isMarked) const {
    std::vector<char> isCut(edges.ends.size(), 0);
    auto const getRefinementEdge = [&](size_t face) {
        return edges.ofCorner[3 * face + static_cast<size_t>(_refinementEdges[face])];
    };
    for (size_t face = 0; face < _refinementEdges.size(); ++face) {
        if (isMarked[face]) isCut[getRefinementEdge(face)] = 1;
    }
    for (bool isClosed = false; !isClosed;) {
        isClosed = true;
        for (size_t face = 0; face < _refinementEdges.size(); ++face) {
            Index const* const own = &edges.ofCorner[3 * face];
            char& isOwnCut = isCut[getRefinementEdge(face)];
            if (isOwnCut || !(isCut[own[0]] || isCut[own[1]] || isCut[own[2]])) continue;
            isOwnCut = 1;
            isClosed = false;
        }
    }
    return isCut;
}

/// Numbers the edges of the mesh, and those among them that are cut.
Bisection::CutEdges Bisection::FindCutEdges(std::span<char const> isMarked) const {
    std::vector<Index> const& faces = _mesh.faces;
    CutEdges edges{EdgeNumbers(_mesh.numVertices), {}, {}, {}};
    edges.ofCorner.reserve(faces.size());
    for (size_t at = 0; at < faces.size(); at += 3) {
        for (size_t k = 0; k < 3; ++k) {
            Index const a = faces[at + k], b = faces[at + (k + 1) % 3];
            edges.ofCorner.push_back(edges.numbers.Get(a, b));
            if (static_cast<size_t>(edges.ofCorner.back()) == edges.ends.size())
                edges.ends.push_back({a, b});
        }
    }
    Index numVertices = _mesh.numVertices;
    for (char cut : CloseCuts(edges, isMarked)) edges.middles.push_back(cut ? numVertices++ : -1);
    return edges;
}

void Bisection::AddVertices(Index numCoarse, CutEdges const& edges) {
    _mesh.numVertices = numCoarse;
    for (Index i = 0; i < numCoarse; ++i) {
        _mesh.parents.push_back(i);
        _mesh.parentOffsets.push_back(static_cast<int>(_mesh.parents.size()));
    }
    for (size_t edge = 0; edge < edges.ends.size(); ++edge) {
        if (edges.middles[edge] < 0) continue;
        ++_mesh.numVertices;
        auto const& ends = edges.ends[edge];
        _mesh.parents.insert(_mesh.parents.end(), ends.begin(), ends.end());
        _mesh.parentOffsets.push_back(static_cast<int>(_mesh.parents.size()));
    }
}

void Bisection::CutFaces(std::vector<Index> const& coarse, CutEdges const& edges) {
    std::vector<Index> const coarseBaseFaces = std::exchange(_baseFaces, {}),
                             coarseValues = std::exchange(_fvarValues, {});
    _numFVarValues += static_cast<Index>(_fvarParents.size());
    _fvarParents.clear();
    Halves halves{edges,
                  _mesh.faces,
                  _baseFaces,
                  coarseValues.empty() ? nullptr : &_fvarValues,
                  _numFVarValues,
                  _fvarParents,
                  EdgeNumbers(_numFVarValues)};
    for (size_t face = 0; face < _refinementEdges.size(); ++face) {
        size_t const k = _refinementEdges[face];
        auto const corner = [&](size_t i) -> CutCorner {
            size_t const at = 3 * face + (k + i) % 3;
            return {coarse[at], coarseValues.empty() ? 0 : coarseValues[at]};
        };
        halves.Cut({corner(0), corner(1), corner(2)}, coarseBaseFaces[face]);
    }
    _refinementEdges.assign(_baseFaces.size(), 0);
}

void Bisection::CutCreases(std::vector<std::array<Index, 2>> const& coarse, CutEdges const& edges) {
    for (auto const& crease : coarse) {
        Index const middle = edges.FindMiddle(crease[0], crease[1]);
        if (middle < 0) {
            _mesh.creases.push_back(crease);
        } else {
            _mesh.creases.push_back({crease[0], middle});
            _mesh.creases.push_back({middle, crease[1]});
        }
    }
}

CascadeMesh const& Bisection::Refine() {
    return Refine(std::vector<char>(_refinementEdges.size(), 1));
}

CascadeMesh const& Bisection::Refine(std::span<char const> isMarked) {
    CutEdges const edges = FindCutEdges(isMarked);
    CascadeMesh const coarse = std::exchange(_mesh, {});
    AddVertices(coarse.numVertices, edges);
    CutFaces(coarse.faces, edges);
    CutCreases(coarse.creases, edges);
    _mesh.corners = coarse.corners;
    return _mesh;
}

}  // namespace limn::far_ext
