// SPDX-License-Identifier: Apache-2.0
#include "far_ext/cascade/cascade_level.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "far_ext/error.h"
#include "far_ext/rows/breadth_first.h"
#include "far_ext/rows/large_array.h"

namespace limn::far_ext {

namespace {

enum class RowKind : char { Closed, Open, Crease, Fixed };

[[noreturn]] void ThrowNoDisc(Index vertex) {
    throw Error(
        ErrorCode::BadMesh,
        fmt::format("the faces at vertex {} are no disc of one orientation; edges must have 1 or 2 "
                    "faces that run through them in opposite directions",
                    vertex));
}

/// Rings of all vertices in the public order.
struct Rings {
    LargeArray<int> offsets{0};
    LargeArray<Index> neighbours;
    std::vector<RowKind> kinds;
};

/// A face's corner at a vertex: next and previous vertex of the face, and the opposite one of a
/// quad.
struct Corner {
    Index next, previous, opposite;
};

/// Puts the corners at a vertex in order, each one's `previous` being the following one's `next`.
/// \return whether the ring is closed
bool OrderCorners(Index vertex, std::span<Corner> corners) {
    auto const first = std::find_if(corners.begin(), corners.end(), [&](Corner const& c) {
        return std::none_of(corners.begin(), corners.end(),
                            [&](Corner const& d) { return d.previous == c.next; });
    });
    bool const isClosed = first == corners.end();
    if (!isClosed) std::swap(corners.front(), *first);
    for (size_t k = 0; k < corners.size(); ++k) {
        if (corners[k].next == corners[k].previous) ThrowNoDisc(vertex);
        if (k + 1 == corners.size()) break;
        auto const from = corners.begin() + static_cast<std::ptrdiff_t>(k) + 1;
        auto const found = std::find_if(
            from, corners.end(), [&](Corner const& c) { return c.next == corners[k].previous; });
        if (found == corners.end()) ThrowNoDisc(vertex);
        std::swap(*from, *found);
    }
    Index const last = corners.back().previous;
    bool const returns = std::any_of(corners.begin(), corners.end(),
                                     [&](Corner const& c) { return c.next == last; });
    if (isClosed ? last != corners.front().next : returns) ThrowNoDisc(vertex);
    return isClosed;
}

Rings FindRings(CascadeMesh const& mesh, BoundaryRule rule) {
    size_t const numVertices = mesh.numVertices, n = mesh.faceSize;
    LargeArray<int> begins(numVertices + 1, 0);
    for (Index vertex : mesh.faces) ++begins[vertex + 1];
    for (size_t i = 0; i < numVertices; ++i) begins[i + 1] += begins[i];
    LargeArray<Corner> corners(mesh.faces.size());
    LargeArray<int> fill(begins.begin(), begins.end() - 1);
    for (size_t face = 0; face < mesh.faces.size(); face += n) {
        Index const* const f = &mesh.faces[face];
        Index previous = f[n - 1], own = f[0], next = f[1];
        for (size_t k = 0; k < n; ++k) {
            Index const opposite = f[k + 2 < n ? k + 2 : k + 2 - n];
            corners[fill[own]++] = {next, previous, opposite};
            previous = own;
            own = next;
            next = opposite;
        }
    }
    Rings rings;
    rings.kinds.resize(numVertices);
    rings.offsets.reserve(numVertices + 1);
    rings.neighbours.reserve(corners.size() * (n - 2) + numVertices / 8);
    for (size_t i = 0; i < numVertices; ++i) {
        std::span<Corner> const own(corners.data() + begins[i], begins[i + 1] - begins[i]);
        if (own.empty()) {
            rings.kinds[i] = RowKind::Fixed;
        } else {
            bool const isClosed = OrderCorners(static_cast<Index>(i), own);
            for (Corner const& corner : own) {
                rings.neighbours.push_back(corner.next);
                if (n == 4) rings.neighbours.push_back(corner.opposite);
            }
            if (!isClosed) rings.neighbours.push_back(own.back().previous);
            rings.kinds[i] = isClosed                      ? RowKind::Closed
                             : rule == BoundaryRule::Fixed ? RowKind::Fixed
                                                           : RowKind::Open;
        }
        if (rings.neighbours.size() > static_cast<size_t>(std::numeric_limits<int>::max())) {
            throw Error(ErrorCode::TooLarge,
                        "the cascade's level has more than 2^31 neighbours; use fewer levels");
        }
        rings.offsets.push_back(static_cast<int>(rings.neighbours.size()));
    }
    return rings;
}

/// Marks rows on creases. A crease that ends within the surface leaves its end smooth; where
/// creases meet, or meet a boundary, the vertex stays.
/// \return per vertex its two neighbours along a crease
std::vector<std::array<Index, 2>> SplitAtCreases(CascadeMesh const& mesh, Rings& rings) {
    std::vector<std::array<Index, 2>> along(mesh.creases.empty() ? 0 : mesh.numVertices, {-1, -1});
    std::vector<int> counts(along.size(), 0);
    for (auto const& edge : mesh.creases) {
        for (size_t end = 0; end < 2; ++end) {
            int const count = counts[edge[end]]++;
            if (count < 2) along[edge[end]][count] = edge[1 - end];
        }
    }
    for (size_t i = 0; i < counts.size(); ++i) {
        RowKind& kind = rings.kinds[i];
        if (kind == RowKind::Open && counts[i] > 0) kind = RowKind::Fixed;
        if (kind == RowKind::Closed && counts[i] > 1)
            kind = counts[i] == 2 ? RowKind::Crease : RowKind::Fixed;
    }
    for (Index vertex : mesh.corners) rings.kinds[vertex] = RowKind::Fixed;
    return along;
}

BreadthFirstOrder OrderAlongRings(Rings const& rings) {
    auto const visitNeighbours = [&](Index vertex, auto const& visit) {
        for (int k = rings.offsets[vertex]; k < rings.offsets[vertex + 1]; ++k)
            visit(rings.neighbours[k]);
    };
    return OrderBreadthFirst(static_cast<Index>(rings.kinds.size()), visitNeighbours);
}

Index FindBandwidth(CascadeLevel const& level) {
    Index largest = 0;
    for (Index row = 0; row < level.numUnknowns; ++row) {
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
            Index const other = level.neighbours[k];
            if (other < level.numUnknowns) largest = std::max(largest, std::abs(other - row));
        }
    }
    return largest;
}

/// The size that all faces have.
int FindFaceSize(Far::TopologyLevel const& level) {
    int const size = level.GetNumFaces() > 0 ? level.GetFaceVertices(0).size() : 3;
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        int const own = level.GetFaceVertices(face).size();
        if (own == size && (own == 3 || own == 4)) continue;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("face {} has {} corners{}; without refinement all faces must be "
                                "triangles, or all quads. One level makes them so",
                                face, own, own == size ? "" : fmt::format(", face 0 {}", size)));
    }
    return size;
}

/// Where a vertex comes from: a vertex, an edge or a face of the coarser level.
enum class ParentKind : char { Vertex, Edge, Face };

std::vector<std::pair<ParentKind, Index>> FindSources(Far::TopologyRefiner const& refiner,
                                                      int level) {
    auto const coarse = refiner.GetLevel(level - 1), fine = refiner.GetLevel(level);
    std::vector<std::pair<ParentKind, Index>> sources(fine.GetNumVertices());
    for (Index i = 0; i < coarse.GetNumVertices(); ++i)
        sources[coarse.GetVertexChildVertex(i)] = {ParentKind::Vertex, i};
    for (Index i = 0; i < coarse.GetNumEdges(); ++i)
        sources[coarse.GetEdgeChildVertex(i)] = {ParentKind::Edge, i};
    bool const areQuads = refiner.GetSchemeType() != Sdc::SCHEME_LOOP;
    for (Index i = 0; areQuads && i < coarse.GetNumFaces(); ++i)
        sources[coarse.GetFaceChildVertex(i)] = {ParentKind::Face, i};
    return sources;
}

void AddParents(Far::TopologyRefiner const& refiner, int level, CascadeMesh& mesh) {
    auto const coarse = refiner.GetLevel(level - 1);
    for (auto const& [kind, source] : FindSources(refiner, level)) {
        if (kind == ParentKind::Vertex) {
            mesh.parents.push_back(source);
        } else {
            auto const vertices = kind == ParentKind::Edge ? coarse.GetEdgeVertices(source)
                                                           : coarse.GetFaceVertices(source);
            mesh.parents.insert(mesh.parents.end(), vertices.begin(), vertices.end());
        }
        mesh.parentOffsets.push_back(static_cast<int>(mesh.parents.size()));
    }
}

void AddOwnParents(CascadeMesh& mesh) {
    for (Index vertex = 0; vertex < mesh.numVertices; ++vertex) {
        mesh.parents.push_back(vertex);
        mesh.parentOffsets.push_back(vertex + 1);
    }
}

void AddTags(Far::TopologyLevel const& level, CascadeMesh& mesh) {
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        if (level.GetEdgeSharpness(edge) <= 0.0f || level.IsEdgeBoundary(edge)) continue;
        auto const ends = level.GetEdgeVertices(edge);
        mesh.creases.push_back({ends[0], ends[1]});
    }
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (level.GetVertexSharpness(vertex) > 0.0f && !level.IsVertexBoundary(vertex))
            mesh.corners.push_back(vertex);
    }
}

}  // namespace

CascadeLevel BuildCascadeLevel(CascadeMesh const& mesh, std::span<Index const> coarseVertices,
                               BoundaryRule rule) {
    Rings rings = FindRings(mesh, rule);
    auto const along = SplitAtCreases(mesh, rings);
    std::vector<Index> const order = OrderAlongRings(rings).rows;
    CascadeLevel level;
    level.faceSize = mesh.faceSize;
    level.vertices.reserve(order.size());
    std::array<Index, 4> ends{};
    for (RowKind kind : {RowKind::Closed, RowKind::Open, RowKind::Crease, RowKind::Fixed}) {
        std::copy_if(order.begin(), order.end(), std::back_inserter(level.vertices),
                     [&](Index vertex) { return rings.kinds[vertex] == kind; });
        ends[static_cast<size_t>(kind)] = level.GetNumRows();
    }
    level.numClosed = ends[0];
    level.numSurface = ends[1];
    level.numUnknowns = ends[2];

    LargeArray<Index> const rows = InvertOrder(level.vertices),
                            coarseRows = InvertOrder(coarseVertices);
    level.offsets.reserve(size_t{1} + level.numUnknowns);
    level.offsets.push_back(0);
    level.neighbours.reserve(rings.neighbours.size());
    level.parentOffsets.reserve(order.size() + 1);
    level.parentOffsets.push_back(0);
    level.parents.reserve(mesh.parents.size());
    for (Index row = 0; row < level.GetNumRows(); ++row) {
        Index const vertex = level.vertices[row];
        if (row < level.numSurface) {
            for (int k = rings.offsets[vertex]; k < rings.offsets[vertex + 1]; ++k)
                level.neighbours.push_back(rows[rings.neighbours[k]]);
        } else if (row < level.numUnknowns) {
            for (Index other : along[vertex]) level.neighbours.push_back(rows[other]);
        }
        if (row < level.numUnknowns)
            level.offsets.push_back(static_cast<int>(level.neighbours.size()));
        for (int k = mesh.parentOffsets[vertex]; k < mesh.parentOffsets[vertex + 1]; ++k) {
            level.parents.push_back(coarseRows.empty() ? mesh.parents[k]
                                                       : coarseRows[mesh.parents[k]]);
        }
        level.parentOffsets.push_back(static_cast<int>(level.parents.size()));
    }
    level.bandwidth = FindBandwidth(level);
    return level;
}

CascadeMesh MakeCascadeMesh(Far::TopologyRefiner const& refiner, int level) {
    auto const fine = refiner.GetLevel(level);
    CascadeMesh mesh;
    mesh.numVertices = fine.GetNumVertices();
    mesh.faceSize = level == 0                                    ? FindFaceSize(fine)
                    : refiner.GetSchemeType() == Sdc::SCHEME_LOOP ? 3
                                                                  : 4;
    mesh.faces.reserve(fine.GetNumFaceVertices());
    for (Index face = 0; face < fine.GetNumFaces(); ++face) {
        auto const vertices = fine.GetFaceVertices(face);
        mesh.faces.insert(mesh.faces.end(), vertices.begin(), vertices.end());
    }
    if (level == 0)
        AddOwnParents(mesh);
    else
        AddParents(refiner, level, mesh);
    AddTags(fine, mesh);
    return mesh;
}

}  // namespace limn::far_ext
