#include "far_ext/face_ring.h"

#include <algorithm>
#include <bit>
#include <compare>
#include <cstdint>

namespace limn::far_ext {

size_t FaceRing::Hash() const {
    uint64_t hash = 0x9e3779b97f4a7c15u;
    auto const add = [&](uint64_t value) { hash = std::rotl(hash ^ value, 23) * 0xd6e8feb86659fd93u; };
    for (int size : faceSizes) add(static_cast<uint64_t>(size));
    for (Index vertex : faceVertices) add(static_cast<uint64_t>(vertex));
    for (Index value : valueIndices) add(static_cast<uint64_t>(value));
    for (Index vertex : sharpEdges) add(static_cast<uint64_t>(vertex));
    for (float sharpness : edgeSharpness) add(std::bit_cast<uint32_t>(sharpness));
    for (float sharpness : cornerSharpness) add(std::bit_cast<uint32_t>(sharpness));
    return static_cast<size_t>(hash ^ (hash >> 32));
}

FaceRingGatherer::FaceRingGatherer(Far::TopologyLevel const& level, int channel)
    : _level(level),
      _channel(channel),
      _localOfVertex(static_cast<size_t>(level.GetNumVertices()), -1),
      _isInRing(static_cast<size_t>(level.GetNumFaces()), 0) {
    if (channel >= 0) _localOfValue.assign(static_cast<size_t>(level.GetNumFVarValues(channel)), -1);
}

void FaceRingGatherer::GatherFaces(Index face) {
    _faces.assign(1, face);
    _isInRing[face] = 1;
    for (Index vertex : _level.GetFaceVertices(face)) {
        auto const around = _level.GetVertexFaces(vertex);
        int const start = around.FindIndex(face);
        for (int i = 1; i < around.size(); ++i) {
            Index const neighbour = around[(start + i) % around.size()];
            if (!_isInRing[neighbour]) {
                _isInRing[neighbour] = 1;
                _faces.push_back(neighbour);
            }
        }
    }
    for (Index inRing : _faces) _isInRing[inRing] = 0;
}

/// Numbers vertices (or values) by first appearance and calls visit(level index, local, isNew).
template <class Visit>
void FaceRingGatherer::NumberPoints(bool byValue, Visit visit) {
    auto& local = byValue ? _localOfValue : _localOfVertex;
    Index count = 0;
    for (Index face : _faces) {
        auto const indices =
            byValue ? _level.GetFaceFVarValues(face, _channel) : _level.GetFaceVertices(face);
        for (Index index : indices) {
            bool const isNew = local[index] < 0;
            if (isNew) local[index] = count++;
            visit(index, local[index], isNew);
        }
    }
}

void FaceRingGatherer::GatherPoints(Index face, std::vector<Index>& points) {
    GatherFaces(face);
    points.clear();
    bool const byValue = _channel >= 0;
    NumberPoints(byValue, [&](Index index, Index, bool isNew) {
        if (isNew) points.push_back(index);
    });
    for (Index index : points) (byValue ? _localOfValue : _localOfVertex)[index] = -1;
}

void FaceRingGatherer::Gather(Index face, FaceRing& ring, std::vector<Index>& points) {
    ring = FaceRing{};
    GatherFaces(face);
    for (Index inRing : _faces) ring.faceSizes.push_back(_level.GetFaceVertices(inRing).size());

    std::vector<Index> vertices;
    NumberPoints(false, [&](Index vertex, Index local, bool isNew) {
        ring.faceVertices.push_back(local);
        if (isNew) vertices.push_back(vertex);
    });
    ring.numVertices = ring.numPoints = static_cast<Index>(vertices.size());
    points = vertices;
    if (_channel >= 0) {
        points.clear();
        NumberPoints(true, [&](Index value, Index local, bool isNew) {
            ring.valueIndices.push_back(local);
            if (isNew) points.push_back(value);
        });
        ring.numPoints = static_cast<Index>(points.size());
        for (Index value : points) _localOfValue[value] = -1;
    }

    GatherSharpness(face, ring);
    for (Index vertex : vertices) _localOfVertex[vertex] = -1;
}

void FaceRingGatherer::GatherSharpness(Index face, FaceRing& ring) {
    struct SharpEdge {
        Index low, high;
        float sharpness;
        auto operator<=>(SharpEdge const&) const = default;
    };
    std::vector<SharpEdge> edges;
    for (Index vertex : _level.GetFaceVertices(face)) {
        ring.cornerSharpness.push_back(_level.GetVertexSharpness(vertex));
        for (Index edge : _level.GetVertexEdges(vertex)) {
            float const sharpness = _level.GetEdgeSharpness(edge);
            if (sharpness <= 0.0f || _level.IsEdgeBoundary(edge)) continue;
            auto const ends = _level.GetEdgeVertices(edge);
            auto const [low, high] = std::minmax({_localOfVertex[ends[0]], _localOfVertex[ends[1]]});
            edges.push_back({low, high, sharpness});
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (SharpEdge const& edge : edges) {
        ring.sharpEdges.push_back(edge.low);
        ring.sharpEdges.push_back(edge.high);
        ring.edgeSharpness.push_back(edge.sharpness);
    }
}

}  // namespace limn::far_ext
