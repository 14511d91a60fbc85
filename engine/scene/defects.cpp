// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/defects.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/scene/coincidence.h"
#include "engine/scene/parity_sets.h"
#include "engine/scene/weld.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;

/// True if both faces of an edge walk it the same way, as wrongly wound neighbours do.
bool IsWalkedTwice(Level const& level, Index edge) {
    auto const faces = level.GetEdgeFaces(edge);
    auto const locals = level.GetEdgeFaceLocalIndices(edge);
    return level.GetFaceVertices(faces[0])[locals[0]] == level.GetFaceVertices(faces[1])[locals[1]];
}

/// A number that looks random, the same for the same vertex.
uint64_t Scatter(Index vertex) {
    uint64_t x = static_cast<uint64_t>(vertex) * 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    return x ^ (x >> 31);
}

class DefectFinder {
public:
    explicit DefectFinder(Model const& model) : _model(model), _level(model.GetLevel()) {}

    std::vector<Defect> Find() {
        FindEdgeDefects();
        FindFaceDefects();
        FindDoubledFaces();
        FindVertexDefects();
        FindCoincidentVertices();
        FindTagDefects();
        return std::move(_defects);
    }

private:
    uint32_t LineOf(Index face) const {
        auto const& lines = _model.GetFaceLines();
        return static_cast<size_t>(face) < lines.size() ? lines[face] : 0;
    }
    static std::string Count(size_t count, char const* one, char const* many) {
        return count == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", count, many);
    }
    std::string NameEdge(Index edge) const {
        auto const ends = _level.GetEdgeVertices(edge);
        return fmt::format("edge {} {}", ends[0], ends[1]);
    }

    void FindEdgeDefects() {
        Defect crowded{"non_manifold_edge", -1, 0, 0, {}}, wound{"winding", -1, 0, 0, {}};
        bool isOrientable = true;
        ParitySets sides(_level.GetNumFaces());
        for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
            auto const faces = _level.GetEdgeFaces(edge);
            if (faces.size() > 2) {
                if (crowded.count++ == 0) crowded.element = edge;
            } else if (faces.size() == 2) {
                bool const isTwice = IsWalkedTwice(_level, edge);
                if (isTwice && wound.count++ == 0) wound.element = edge;
                isOrientable &= sides.Join(faces[0], faces[1], isTwice);
            }
        }
        if (crowded.count) {
            auto const faces = _level.GetEdgeFaces(crowded.element);
            crowded.line = LineOf(faces[0]);
            crowded.message = fmt::format(
                "{} with more than 2 faces, first {} with {} ({} among them); OpenSubdiv makes "
                "them sharp",
                Count(crowded.count, "edge", "edges"), NameEdge(crowded.element), faces.size(),
                _model.NameFace(faces[0]));
            _defects.push_back(crowded);
        }
        if (wound.count) {
            auto const faces = _level.GetEdgeFaces(wound.element);
            wound.line = LineOf(faces[1]);
            wound.message = fmt::format(
                "{} join faces wound in opposite directions, first {} between {} and {}; "
                "OpenSubdiv "
                "makes them sharp{}",
                Count(wound.count, "edge", "edges"), NameEdge(wound.element),
                _model.NameFace(faces[0]), _model.NameFace(faces[1]),
                isOrientable ? "; turn the faces of one side round"
                             : "; no turning helps, the surface cannot be oriented");
            if (!isOrientable) wound.kind = "not_orientable";
            _defects.push_back(wound);
        }
    }

    void FindFaceDefects() {
        Defect repeated{"repeated_corner", -1, 0, 0, {}};
        std::vector<Index> sorted;
        for (Index face = 0; face < _level.GetNumFaces(); ++face) {
            auto const vertices = _level.GetFaceVertices(face);
            sorted.assign(vertices.begin(), vertices.end());
            std::sort(sorted.begin(), sorted.end());
            bool const isRepeated =
                std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
            if (isRepeated && repeated.count++ == 0) repeated.element = face;
        }
        if (repeated.count == 0) return;
        repeated.line = LineOf(repeated.element);
        repeated.message = fmt::format("{} the same vertex more than once, first {}",
                                       Count(repeated.count, "face uses", "faces use"),
                                       _model.NameFace(repeated.element));
        _defects.push_back(repeated);
    }

    std::vector<Index> SortedVertices(Index face) const {
        auto const vertices = _level.GetFaceVertices(face);
        std::vector<Index> sorted(vertices.begin(), vertices.end());
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    }

    /// An earlier face with the same vertices, in whatever order; -1 without one. Such faces share
    /// all their edges, so one edge has them all; sums over vertices rule out nearly all others.
    Index FindTwin(Index face, std::vector<uint64_t> const& sums) const {
        for (Index other : _level.GetEdgeFaces(_level.GetFaceEdges(face)[0])) {
            if (other < face && sums[other] == sums[face] &&
                SortedVertices(other) == SortedVertices(face))
                return other;
        }
        return -1;
    }

    void FindDoubledFaces() {
        std::vector<uint64_t> sums(static_cast<size_t>(_level.GetNumFaces()), 0);
        for (Index face = 0; face < _level.GetNumFaces(); ++face) {
            for (Index vertex : _level.GetFaceVertices(face)) sums[face] += Scatter(vertex);
        }
        Defect doubled{"doubled_face", -1, 0, 0, {}};
        Index firstTwin = -1;
        for (Index face = 0; face < _level.GetNumFaces(); ++face) {
            Index const twin = FindTwin(face, sums);
            if (twin < 0 || doubled.count++ > 0) continue;
            doubled.element = face;
            firstTwin = twin;
        }
        if (doubled.count == 0) return;
        doubled.line = LineOf(doubled.element);
        doubled.message = fmt::format(
            "{} the vertices of another one, first {} those of {}; leave one out unless both are "
            "meant",
            Count(doubled.count, "face has", "faces have"), _model.NameFace(doubled.element),
            _model.NameFace(firstTwin));
        _defects.push_back(doubled);
    }

    std::vector<char> FindBoundary() const {
        std::vector<char> isBoundary(static_cast<size_t>(_level.GetNumVertices()), 0);
        for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
            if (_level.GetEdgeFaces(edge).size() != 1) continue;
            for (Index vertex : _level.GetEdgeVertices(edge)) isBoundary[vertex] = 1;
        }
        return isBoundary;
    }

    /// Sheets that touch without being joined. Welding says itself what it leaves apart.
    void FindCoincidentVertices() {
        if (_model.GetWeld()) return;
        auto const groupOf = GroupCoincident(_model.GetPositions(), FindBoundary(), 0.0);
        Defect coincident{"coincident_vertices", -1, 0, 0, {}};
        std::vector<char> isCounted(groupOf.size(), 0);
        Index second = -1;
        for (Index vertex = 0; vertex < static_cast<Index>(groupOf.size()); ++vertex) {
            Index const first = groupOf[vertex];
            if (first == vertex) continue;
            coincident.count += isCounted[first] ? 1 : 2;
            isCounted[first] = 1;
            if (second < 0 || first < coincident.element) {
                coincident.element = first;
                second = vertex;
            }
        }
        if (coincident.count == 0) return;
        coincident.line = LineOf(_level.GetVertexFaces(coincident.element)[0]);
        // Where nothing can be joined Weld says why.
        bool const isCurable = CanWeld(_model.GetCage(), _model.GetPositions(), 0.0);
        coincident.message = fmt::format(
            "{} boundary vertices coincide with others, first vertex {} with {}: sheets that only "
            "touch come apart as they are subdivided; `weld` 0 {}",
            coincident.count, coincident.element, second,
            isCurable ? "joins them" : "can join none of them as they are");
        _defects.push_back(coincident);
    }

    void FindVertexDefects() {
        Defect unused{"unreferenced_vertex", -1, 0, 0, {}},
            fans{"non_manifold_vertex", -1, 0, 0, {}};
        for (Index vertex = 0; vertex < _level.GetNumVertices(); ++vertex) {
            if (_level.GetVertexFaces(vertex).size() == 0) {
                if (unused.count++ == 0) unused.element = vertex;
                continue;
            }
            if (!_level.IsVertexNonManifold(vertex)) continue;
            auto const edges = _level.GetVertexEdges(vertex);
            bool const byEdge = std::any_of(edges.begin(), edges.end(),
                                            [&](Index e) { return _level.IsEdgeNonManifold(e); });
            if (!byEdge && fans.count++ == 0) fans.element = vertex;
        }
        if (fans.count) {
            fans.message = fmt::format(
                "{} where surfaces touch in a point, first vertex {}; OpenSubdiv makes them sharp",
                Count(fans.count, "vertex", "vertices"), fans.element);
            _defects.push_back(fans);
        }
        if (unused.count) {
            unused.message = fmt::format(
                "{} no face, first vertex {}",
                Count(unused.count, "vertex is used by", "vertices are used by"), unused.element);
            _defects.push_back(unused);
        }
    }

    void FindTagDefects() {
        Defect loose{"crease_without_edge", -1, 0, 0, {}};
        auto const& cage = _model.GetCage();
        for (size_t i = 0; i < cage.creaseSharpness.size(); ++i) {
            Index const a = cage.creaseVertexPairs[2 * i], b = cage.creaseVertexPairs[2 * i + 1];
            auto const edges = _level.GetVertexEdges(a);
            bool const exists = std::any_of(edges.begin(), edges.end(), [&](Index edge) {
                auto const ends = _level.GetEdgeVertices(edge);
                return ends[0] == b || ends[1] == b;
            });
            if (!exists && loose.count++ == 0) loose.element = static_cast<Index>(i);
        }
        if (loose.count == 0) return;
        loose.message = fmt::format("{} vertices that no edge joins and {} no effect, first {} {}",
                                    Count(loose.count, "crease names", "creases name"),
                                    loose.count == 1 ? "has" : "have",
                                    cage.creaseVertexPairs[2 * loose.element],
                                    cage.creaseVertexPairs[2 * loose.element + 1]);
        _defects.push_back(loose);
    }

    Model const& _model;
    Level const& _level;
    std::vector<Defect> _defects;
};

}  // namespace

std::vector<Defect> FindDefects(Model const& model) {
    return DefectFinder(model).Find();
}

}  // namespace limn::engine
