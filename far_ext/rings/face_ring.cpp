// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rings/face_ring.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include <opensubdiv/far/topologyRefinerFactory.h>

#include "far_ext/error.h"
#include "far_ext/topology/refiner.h"

namespace limn::far_ext {

size_t FaceRing::Hash() const {
    uint64_t hash = 0x9e3779b97f4a7c15u;
    auto const add = [&](uint64_t value) {
        hash = std::rotl(hash ^ value, 23) * 0xd6e8feb86659fd93u;
    };
    for (int size : faceSizes) add(static_cast<uint64_t>(size));
    for (Index vertex : faceVertices) add(static_cast<uint64_t>(vertex));
    for (Index value : valueIndices) add(static_cast<uint64_t>(value));
    for (Edge const& edge : edges) add(std::bit_cast<uint32_t>(edge.sharpness));
    for (Corner const& corner : corners) add(std::bit_cast<uint32_t>(corner.sharpness));
    return hash ^ (hash >> 32);
}

namespace {

/// Where the member that was numbered first stands; those without a number (-1) come last.
template <class NumberOf>
int FindFirstNumbered(int size, NumberOf numberOf) {
    int first = 0;
    for (int i = 1; i < size; ++i) {
        if (static_cast<unsigned>(numberOf(i)) < static_cast<unsigned>(numberOf(first))) first = i;
    }
    return first;
}

}  // namespace

FaceRingGatherer::FaceRingGatherer(Far::TopologyLevel const& level, Sdc::Options options,
                                   int channel, Starts starts)
    : _level(level),
      _channel(channel),
      _starts(starts),
      _isChaikin(options.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN) {
    _faces.Resize(level.GetNumFaces());
    _vertices.Resize(level.GetNumVertices());
    _edges.Resize(level.GetNumEdges());
    if (channel >= 0) _values.Resize(level.GetNumFVarValues(channel));
}

/// Starting after the `first` of them.
void FaceRingGatherer::NumberFacesRound(Index vertex, int first) {
    auto const around = _level.GetVertexFaces(vertex);
    for (int i = 1; i < around.size(); ++i) _faces.Add(around[(first + i) % around.size()]);
}

void FaceRingGatherer::NumberFaces(Index face) {
    _faces.Add(face);
    for (Index vertex : _level.GetFaceVertices(face))
        NumberFacesRound(vertex, _level.GetVertexFaces(vertex).FindIndex(face));
    if (!_isChaikin) return;
    FindCreaseEnds(face);
    for (Index end : _creaseEnds) {
        auto const around = _level.GetVertexFaces(end);
        NumberFacesRound(
            end, FindFirstNumbered(around.size(), [&](int i) { return _faces[around[i]]; }));
    }
}

/// In an order that depends on the face alone: alike surroundings get equal rings.
void FaceRingGatherer::FindCreaseEnds(Index face) {
    _creaseEnds.clear();
    auto const corners = _level.GetFaceVertices(face);
    for (int corner = 0; corner < corners.size(); ++corner) {
        auto const edges = _level.GetVertexEdges(corners[corner]);
        int const start = edges.FindIndex(_level.GetFaceEdges(face)[corner]);
        for (int i = 0; i < edges.size(); ++i) {
            Index const edge = edges[(start + i) % edges.size()];
            if (!Sdc::Crease::IsSemiSharp(_level.GetEdgeSharpness(edge))) continue;
            for (Index end : _level.GetEdgeVertices(edge)) {
                bool const isNew =
                    corners.FindIndex(end) < 0 &&
                    std::find(_creaseEnds.begin(), _creaseEnds.end(), end) == _creaseEnds.end();
                if (isNew) _creaseEnds.push_back(end);
            }
        }
    }
}

/// The corner a face of the ring starts with.
int FaceRingGatherer::FindStart(Far::ConstIndexArray vertices) const {
    if (_starts == Starts::AsInLevel) return 0;
    return FindFirstNumbered(vertices.size(), [&](int i) { return _vertices[vertices[i]]; });
}

void FaceRingGatherer::GatherPoints(Index face, std::vector<Index>& points) {
    NumberFaces(face);
    Numbering& numbering = _channel >= 0 ? _values : _vertices;
    for (Index inRing : _faces.GetMembers()) {
        auto const corners = _channel >= 0 ? _level.GetFaceFVarValues(inRing, _channel)
                                           : _level.GetFaceVertices(inRing);
        for (Index point : corners) numbering.Add(point);
    }
    points = numbering.GetMembers();
    numbering.Reset();
    _faces.Reset();
}

/// What the level says about a vertex, and the sharpness of its edges.
void FaceRingGatherer::FillCorner(Index vertex, FaceRing::Corner& corner, FaceRing& ring) const {
    corner.vertex = _vertices[vertex];
    corner.faces.clear();
    corner.edges.clear();
    corner.sharpness = _level.GetVertexSharpness(vertex);
    corner.isNonManifold = _level.IsVertexNonManifold(vertex);
    for (Index around : _level.GetVertexFaces(vertex)) corner.faces.push_back(_faces[around]);
    int numSemiSharp = 0;
    for (Index around : _level.GetVertexEdges(vertex)) {
        corner.edges.push_back(_edges[around]);
        FaceRing::Edge& edge = ring.edges[_edges[around]];
        edge.sharpness = _level.GetEdgeSharpness(around);
        edge.isNonManifold = _level.IsEdgeNonManifold(around);
        numSemiSharp += Sdc::Crease::IsSemiSharp(edge.sharpness);
    }
    // Chaikin's averages over more than two edges are float sums in their order, which has to be
    // the level's: rounded in another one, two faces would not see the same sharpness.
    bool const keepsOrder = _isChaikin && numSemiSharp > 2;
    // Round an interior vertex the order may start anywhere; starting at the face makes it unique.
    if (!keepsOrder && !corner.isNonManifold && corner.faces.size() == corner.edges.size()) {
        auto const start = std::min_element(corner.faces.begin(), corner.faces.end());
        std::rotate(corner.edges.begin(), corner.edges.begin() + (start - corner.faces.begin()),
                    corner.edges.end());
        std::rotate(corner.faces.begin(), start, corner.faces.end());
    }
}

void FaceRingGatherer::Gather(Index face, FaceRing& ring, std::vector<Index>& points) {
    // A ring that is used again keeps its memory.
    for (auto* list : {&ring.faceVertices, &ring.faceEdges, &ring.valueIndices}) list->clear();
    ring.faceSizes.clear();
    ring.edges.clear();
    NumberFaces(face);
    ring.corners.resize(_level.GetFaceVertices(face).size());
    ring.creaseEnds.resize(_creaseEnds.size());
    for (Index inRing : _faces.GetMembers()) {
        auto const vertices = _level.GetFaceVertices(inRing);
        int const size = vertices.size(), start = inRing == face ? 0 : FindStart(vertices);
        auto const add = [&](auto const& members, Numbering& numbering, std::vector<Index>& list) {
            for (int i = start; i < size; ++i) list.push_back(numbering.Add(members[i]));
            for (int i = 0; i < start; ++i) list.push_back(numbering.Add(members[i]));
        };
        ring.faceSizes.push_back(size);
        add(vertices, _vertices, ring.faceVertices);
        add(_level.GetFaceEdges(inRing), _edges, ring.faceEdges);
        if (_channel >= 0)
            add(_level.GetFaceFVarValues(inRing, _channel), _values, ring.valueIndices);
    }
    ring.numVertices = static_cast<Index>(_vertices.GetMembers().size());
    points = (_channel >= 0 ? _values : _vertices).GetMembers();
    ring.numPoints = static_cast<Index>(points.size());

    for (Index edge : _edges.GetMembers()) {
        auto const ends = _level.GetEdgeVertices(edge);
        Index a = _vertices[ends[0]], b = _vertices[ends[1]];
        if (_starts == Starts::Canonical && a > b) std::swap(a, b);
        ring.edges.push_back({{a, b}});
    }
    auto corner = ring.corners.begin(), end = ring.creaseEnds.begin();
    for (Index vertex : _level.GetFaceVertices(face)) FillCorner(vertex, *corner++, ring);
    for (Index vertex : _creaseEnds) FillCorner(vertex, *end++, ring);
    _faces.Reset();
    _vertices.Reset();
    _edges.Reset();
    _values.Reset();
}

namespace {

/// A ring with the relations OpenSubdiv wants, per edge and per vertex.
struct RingTopology {
    FaceRing const& ring;
    std::vector<std::vector<Index>> edgeFaces, vertexFaces, vertexEdges;
    std::vector<char> isNonManifold;  // per vertex

    explicit RingTopology(FaceRing const& r) : ring(r) {
        edgeFaces.resize(ring.edges.size());
        vertexFaces.resize(ring.numVertices);
        vertexEdges.resize(vertexFaces.size());
        // The faces round a vertex of the rim are not all here; its rules are of no consequence.
        isNonManifold.assign(vertexFaces.size(), 1);
        size_t corner = 0;
        for (Index face = 0; face < static_cast<Index>(ring.faceSizes.size()); ++face) {
            for (int i = 0; i < ring.faceSizes[face]; ++i, ++corner) {
                edgeFaces[ring.faceEdges[corner]].push_back(face);
                vertexFaces[ring.faceVertices[corner]].push_back(face);
            }
        }
        for (Index edge = 0; edge < static_cast<Index>(ring.edges.size()); ++edge) {
            auto const& [a, b] = ring.edges[edge].vertices;
            vertexEdges[a].push_back(edge);
            vertexEdges[b].push_back(edge);
        }
        for (FaceRing::Corner const& known : ring.corners) SetSurroundings(known);
        for (FaceRing::Corner const& known : ring.creaseEnds) SetSurroundings(known);
    }

    void SetSurroundings(FaceRing::Corner const& of) {
        vertexFaces[of.vertex] = of.faces;
        vertexEdges[of.vertex] = of.edges;
        isNonManifold[of.vertex] = of.isNonManifold;
    }
};

}  // namespace
}  // namespace limn::far_ext

namespace OpenSubdiv {
namespace OPENSUBDIV_VERSION {
namespace Far {

using limn::far_ext::RingTopology;

template <>
bool TopologyRefinerFactory<RingTopology>::resizeComponentTopology(TopologyRefiner& refiner,
                                                                   RingTopology const& topology) {
    auto const& ring = topology.ring;
    setNumBaseFaces(refiner, static_cast<int>(ring.faceSizes.size()));
    setNumBaseEdges(refiner, static_cast<int>(ring.edges.size()));
    setNumBaseVertices(refiner, ring.numVertices);
    for (size_t face = 0; face < ring.faceSizes.size(); ++face) {
        setNumBaseFaceVertices(refiner, static_cast<Index>(face), ring.faceSizes[face]);
    }
    for (size_t edge = 0; edge < ring.edges.size(); ++edge) {
        setNumBaseEdgeFaces(refiner, static_cast<Index>(edge),
                            static_cast<int>(topology.edgeFaces[edge].size()));
    }
    for (Index vertex = 0; vertex < ring.numVertices; ++vertex) {
        setNumBaseVertexFaces(refiner, vertex,
                              static_cast<int>(topology.vertexFaces[vertex].size()));
        // OpenSubdiv sizes buffers for a vertex' faces by the largest number of edges it has heard
        // of; where edges have three faces and more, a vertex has fewer edges than faces.
        setNumBaseVertexEdges(refiner, vertex,
                              static_cast<int>(topology.vertexFaces[vertex].size()));
        setNumBaseVertexEdges(refiner, vertex,
                              static_cast<int>(topology.vertexEdges[vertex].size()));
    }
    return true;
}

template <>
bool TopologyRefinerFactory<RingTopology>::assignComponentTopology(TopologyRefiner& refiner,
                                                                   RingTopology const& topology) {
    auto const& ring = topology.ring;
    auto const copy = [](auto const& from, IndexArray to) {
        std::copy(from.begin(), from.end(), to.begin());
    };
    auto vertex = ring.faceVertices.begin();
    auto edge = ring.faceEdges.begin();
    for (Index face = 0; face < static_cast<Index>(ring.faceSizes.size()); ++face) {
        int const size = ring.faceSizes[face];
        std::copy_n(vertex, size, getBaseFaceVertices(refiner, face).begin());
        std::copy_n(edge, size, getBaseFaceEdges(refiner, face).begin());
        vertex += size;
        edge += size;
    }
    for (Index e = 0; e < static_cast<Index>(ring.edges.size()); ++e) {
        std::copy_n(ring.edges[e].vertices, 2, getBaseEdgeVertices(refiner, e).begin());
        copy(topology.edgeFaces[e], getBaseEdgeFaces(refiner, e));
    }
    for (Index v = 0; v < ring.numVertices; ++v) {
        copy(topology.vertexFaces[v], getBaseVertexFaces(refiner, v));
        copy(topology.vertexEdges[v], getBaseVertexEdges(refiner, v));
    }
    populateBaseLocalIndices(refiner);
    for (Index e = 0; e < static_cast<Index>(ring.edges.size()); ++e) {
        if (ring.edges[e].isNonManifold) setBaseEdgeNonManifold(refiner, e, true);
    }
    for (Index v = 0; v < ring.numVertices; ++v) {
        if (topology.isNonManifold[v]) setBaseVertexNonManifold(refiner, v, true);
    }
    return true;
}

template <>
bool TopologyRefinerFactory<RingTopology>::assignComponentTags(TopologyRefiner& refiner,
                                                               RingTopology const& topology) {
    auto const& ring = topology.ring;
    for (size_t edge = 0; edge < ring.edges.size(); ++edge) {
        setBaseEdgeSharpness(refiner, static_cast<Index>(edge), ring.edges[edge].sharpness);
    }
    for (auto const& corner : ring.corners) {
        setBaseVertexSharpness(refiner, corner.vertex, corner.sharpness);
    }
    return true;
}

template <>
bool TopologyRefinerFactory<RingTopology>::assignFaceVaryingTopology(TopologyRefiner& refiner,
                                                                     RingTopology const& topology) {
    auto const& ring = topology.ring;
    if (!ring.IsFaceVarying()) return true;
    int const channel = createBaseFVarChannel(refiner, ring.numPoints);
    auto value = ring.valueIndices.begin();
    for (Index face = 0; face < static_cast<Index>(ring.faceSizes.size()); ++face) {
        std::copy_n(value, ring.faceSizes[face],
                    getBaseFaceFVarValues(refiner, face, channel).begin());
        value += ring.faceSizes[face];
    }
    return true;
}

}  // namespace Far
}  // namespace OPENSUBDIV_VERSION
}  // namespace OpenSubdiv

namespace limn::far_ext {

std::unique_ptr<Far::TopologyRefiner> CreateRingRefiner(FaceRing const& ring,
                                                        Sdc::SchemeType scheme,
                                                        Sdc::Options options) {
    using Factory = Far::TopologyRefinerFactory<RingTopology>;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    FarReportGuard guard;
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(RingTopology(ring), Factory::Options(scheme, options)));
    guard.ThrowIfReported("building the topology round a face");
    if (!refiner) throw Error(ErrorCode::BadMesh, "OpenSubdiv refused the topology round a face");
    return refiner;
}

}  // namespace limn::far_ext
