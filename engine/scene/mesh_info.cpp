// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/mesh_info.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <unordered_map>

#include <fmt/format.h>

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;

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

/// True if both faces of an edge walk it the same way, as wrongly wound neighbours do.
bool IsWalkedTwice(Level const& level, Index edge) {
    auto const faces = level.GetEdgeFaces(edge);
    auto const locals = level.GetEdgeFaceLocalIndices(edge);
    return level.GetFaceVertices(faces[0])[locals[0]] == level.GetFaceVertices(faces[1])[locals[1]];
}

class DefectFinder {
public:
    DefectFinder(Scene const& scene, Level const& level) : _scene(scene), _level(level) {}

    std::vector<Defect> Find() {
        FindEdgeDefects();
        FindFaceDefects();
        FindVertexDefects();
        FindTagDefects();
        return std::move(_defects);
    }

private:
    uint32_t LineOf(Index face) const {
        return static_cast<size_t>(face) < _scene.faceLines.size() ? _scene.faceLines[face] : 0;
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
                _scene.NameFace(faces[0]));
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
                _scene.NameFace(faces[0]), _scene.NameFace(faces[1]),
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
                                       _scene.NameFace(repeated.element));
        _defects.push_back(repeated);
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
        auto const& cage = _scene.cage;
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

    Scene const& _scene;
    Level const& _level;
    std::vector<Defect> _defects;
};

/// Marks faces whose texture polygons share samples of a 512 x 512 grid per tile. Tiles are looked
/// at one after another, so that memory holds one.
class OverlapFinder {
public:
    using Polygon = std::vector<std::array<double, 2>>;

    explicit OverlapFinder(size_t numFaces) : _overlaps(numFaces, 0) {}

    void StartTile(int tileU, int tileV) {
        _tileU = tileU;
        _tileV = tileV;
        _owners.assign(kSize * kSize, -1);
    }

    /// Adds the part of a face's polygon that lies in the tile.
    void Add(Index face, Polygon const& polygon) {
        double minV = 1e300, maxV = -1e300;
        for (auto const& p : polygon) {
            minV = std::min(minV, p[1]);
            maxV = std::max(maxV, p[1]);
        }
        int const first = ToSample(minV - _tileV, kOffsetV),
                  last = ToSample(maxV - _tileV, kOffsetV) - 1;
        for (int row = first; row <= last; ++row) {
            double const v = _tileV + (row + kOffsetV) / kSize;
            _crossings.clear();
            for (size_t i = 0; i < polygon.size(); ++i) {
                auto const& a = polygon[i];
                auto const& b = polygon[(i + 1) % polygon.size()];
                if ((a[1] <= v) != (b[1] <= v)) {
                    _crossings.push_back(a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
                }
            }
            std::sort(_crossings.begin(), _crossings.end());
            for (size_t i = 0; i + 1 < _crossings.size(); i += 2) {
                int const from = ToSample(_crossings[i] - _tileU, kOffsetU),
                          to = ToSample(_crossings[i + 1] - _tileU, kOffsetU);
                for (int column = from; column < to; ++column) Claim(face, row, column);
            }
        }
    }

    size_t GetCount() const {
        return static_cast<size_t>(std::count(_overlaps.begin(), _overlaps.end(), 1));
    }

private:
    static constexpr int kSize = 512;
    // Samples lie on no simple fraction and on no diagonal of the texel grid, where layouts have
    // their edges.
    static constexpr double kOffsetU = 0.41421356, kOffsetV = 0.73205081;

    /// The first sample at or after a coordinate of the tile, within 0 .. kSize. Spans end before
    /// theirs, so that a sample on a shared edge belongs to one side.
    static int ToSample(double x, double offset) {
        return static_cast<int>(
            std::ceil(std::clamp(x * kSize - offset, 0.0, static_cast<double>(kSize))));
    }

    void Claim(Index face, int row, int column) {
        Index& owner = _owners[static_cast<size_t>(row * kSize + column)];
        if (owner >= 0 && owner != face)
            _overlaps[owner] = _overlaps[face] = 1;
        else
            owner = face;
    }

    int _tileU = 0, _tileV = 0;
    std::vector<Index> _owners;
    std::vector<char> _overlaps;
    std::vector<double> _crossings;
};

OverlapFinder::Polygon GetTexturePolygon(Scene const& scene, Index const* values, int size) {
    OverlapFinder::Polygon polygon;
    for (int i = 0; i < size; ++i)
        polygon.push_back({scene.uvs[2 * values[i]], scene.uvs[2 * values[i] + 1]});
    return polygon;
}

double GetSignedArea(OverlapFinder::Polygon const& polygon) {
    double area = 0.0;
    auto const& o = polygon[0];
    for (size_t i = 1; i + 1 < polygon.size(); ++i) {
        auto const &a = polygon[i], &b = polygon[i + 1];
        area += 0.5 * ((a[0] - o[0]) * (b[1] - o[1]) - (b[0] - o[0]) * (a[1] - o[1]));
    }
    return area;
}

UVInfo DescribeUVs(Scene const& scene) {
    UVInfo info;
    info.present = scene.HasUVs();
    if (!info.present) return info;
    std::set<int> tiles;
    std::map<int, std::vector<std::pair<Index, size_t>>> facesOfTile;  // with their first corner
    Index const* const values = scene.cage.fvarChannels[0].valueIndices.data();
    size_t corner = 0;
    for (Index face = 0; face < scene.cage.GetNumFaces(); ++face) {
        int const size = scene.cage.faceSizes[face];
        auto const polygon = GetTexturePolygon(scene, values + corner, size);
        double minU = 1e300, maxU = -1e300, minV = 1e300, maxV = -1e300;
        for (auto const& [u, v] : polygon) {
            minU = std::min(minU, u);
            maxU = std::max(maxU, u);
            minV = std::min(minV, v);
            maxV = std::max(maxV, v);
        }
        double const area = GetSignedArea(polygon);
        bool const isFlat = std::abs(area) <= 1e-12;
        info.zeroAreaFaces += isFlat;
        info.flippedFaces += !isFlat && area < 0.0;
        bool const isInRange = minU >= 0.0 && maxU <= 10.0 && minV >= 0.0 && maxV <= 900.0;
        info.outOfRangeFaces += !isInRange;
        if (isInRange) {
            // The tile of the middle: borders belong to both sides, as do faces a hair over them.
            int const u = std::min(9, static_cast<int>(0.5 * (minU + maxU)));
            int const v = std::min(899, static_cast<int>(0.5 * (minV + maxV)));
            tiles.insert(1001 + u + 10 * v);
            for (int row = static_cast<int>(minV);
                 !isFlat && row <= std::min(899, static_cast<int>(maxV)); ++row) {
                for (int column = static_cast<int>(minU);
                     column <= std::min(9, static_cast<int>(maxU)); ++column) {
                    facesOfTile[1001 + column + 10 * row].emplace_back(face, corner);
                }
            }
        }
        corner += static_cast<size_t>(size);
    }
    info.tiles.assign(tiles.begin(), tiles.end());
    OverlapFinder overlaps(scene.cage.faceSizes.size());
    for (auto const& [tile, faces] : facesOfTile) {
        overlaps.StartTile((tile - 1001) % 10, (tile - 1001) / 10);
        for (auto const& [face, first] : faces) {
            overlaps.Add(face,
                         GetTexturePolygon(scene, values + first, scene.cage.faceSizes[face]));
        }
    }
    info.overlapFaces = overlaps.GetCount();
    return info;
}

}  // namespace

std::vector<Defect> FindDefects(Scene const& scene, Level const& level) {
    return DefectFinder(scene, level).Find();
}

MeshInfo DescribeMesh(Scene const& scene, Level const& level) {
    MeshInfo info;
    info.vertices = level.GetNumVertices();
    info.edges = level.GetNumEdges();
    info.faces = level.GetNumFaces();
    info.creases = scene.cage.creaseSharpness.size();
    info.corners = scene.cage.cornerSharpness.size();
    info.holes = scene.cage.holes.size();
    info.groups = ListGroups(scene);
    info.defects = FindDefects(scene, level);

    ParitySets components(level.GetNumVertices());
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        ++info.facesBySize[vertices.size()];
        for (Index vertex : vertices) components.Join(vertices[0], vertex, 0);
    }
    Index numUsed = 0;
    ParitySets loops(level.GetNumEdges());
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (level.GetVertexFaces(vertex).size() == 0) continue;
        ++numUsed;
        info.components += components.Find(vertex).first == vertex;
        auto const edges = level.GetVertexEdges(vertex);
        info.minValence =
            info.maxValence == 0 ? edges.size() : std::min(info.minValence, edges.size());
        info.maxValence = std::max(info.maxValence, edges.size());
        Index previous = -1;
        for (Index edge : edges) {
            if (!level.IsEdgeBoundary(edge)) continue;
            if (previous >= 0) loops.Join(previous, edge, 0);
            previous = edge;
        }
    }
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        info.boundaryLoops += level.IsEdgeBoundary(edge) && loops.Find(edge).first == edge;
    }
    info.eulerCharacteristic = numUsed - info.edges + info.faces;
    bool const isOrientedManifold =
        std::none_of(info.defects.begin(), info.defects.end(), [](Defect const& defect) {
            return defect.kind.starts_with("non_manifold") || defect.kind == "not_orientable" ||
                   defect.kind == "repeated_corner";
        });
    if (isOrientedManifold)
        info.genus = (2 * info.components - info.eulerCharacteristic - info.boundaryLoops) / 2;
    info.uv = DescribeUVs(scene);
    return info;
}

}  // namespace limn::engine
