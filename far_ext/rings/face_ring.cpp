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

int FaceRing::GetNumEdges() const {
    return static_cast<int>(Get(Part::Edges).size() / kWordsPerEdge);
}

FaceRing::Edge FaceRing::GetEdge(int edge) const {
    auto const words = Get(Part::Edges).subspan(edge * kWordsPerEdge, kWordsPerEdge);
    return {{words[0], words[1]}, std::bit_cast<float>(words[2]), words[3] != 0};
}

int FaceRing::GetNumCorners() const {
    return static_cast<int>(Get(Part::Corners).size() / kWordsPerCorner);
}

FaceRing::Corner FaceRing::GetCorner(int corner) const {
    auto const words = Get(Part::Corners).subspan(corner * kWordsPerCorner, kWordsPerCorner);
    size_t const numFaces = words[3], numEdges = words[4];
    auto const around = Get(Part::Surroundings).subspan(words[5]);
    return {words[0], std::bit_cast<float>(words[1]), words[2] != 0, around.first(numFaces),
            around.subspan(numFaces, numEdges)};
}

void FaceRing::Assign(Parts const& parts) {
    _words.clear();
    size_t end = kNumParts + 1;
    _words.push_back(static_cast<Index>(end));
    for (auto const& part : parts) _words.push_back(static_cast<Index>(end += part.size()));
    _words.reserve(end);
    for (auto const& part : parts) _words.insert(_words.end(), part.begin(), part.end());

    uint64_t hash = 0x9e3779b97f4a7c15u;
    for (Index word : _words)
        hash = std::rotl(hash ^ static_cast<uint32_t>(word), 23) * 0xd6e8feb86659fd93u;
    _hash = hash ^ (hash >> 32);
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
                                   int channel)
    : _level(level),
      _channel(channel),
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

/// The next face of the ring, from the corner that is numbered first.
void FaceRingGatherer::AddFace(Index face) {
    auto const vertices = _level.GetFaceVertices(face);
    int const size = vertices.size();
    int const start = FindFirstNumbered(size, [&](int i) { return _vertices[vertices[i]]; });
    auto const add = [&](auto const& members, Numbering& numbering, Part part) {
        auto& list = PartOf(part);
        for (int i = start; i < size; ++i) list.push_back(numbering.Add(members[i]));
        for (int i = 0; i < start; ++i) list.push_back(numbering.Add(members[i]));
    };
    PartOf(Part::FaceSizes).push_back(size);
    add(vertices, _vertices, Part::FaceVertices);
    add(_level.GetFaceEdges(face), _edges, Part::FaceEdges);
    if (_channel >= 0) add(_level.GetFaceFVarValues(face, _channel), _values, Part::FaceValues);
}

/// Their ends; sharpness comes with the corners.
void FaceRingGatherer::AddEdges() {
    for (Index edge : _edges.GetMembers()) {
        auto const ends = _level.GetEdgeVertices(edge);
        auto const [low, high] = std::minmax({_vertices[ends[0]], _vertices[ends[1]]});
        PartOf(Part::Edges).insert(PartOf(Part::Edges).end(), {low, high, 0, 0});
    }
}

/// What the level says about a vertex, and the sharpness of its edges.
void FaceRingGatherer::AddCorner(Index vertex) {
    auto const faces = _level.GetVertexFaces(vertex);
    auto const edges = _level.GetVertexEdges(vertex);
    bool const isNonManifold = _level.IsVertexNonManifold(vertex);
    auto& around = PartOf(Part::Surroundings);
    PartOf(Part::Corners)
        .insert(PartOf(Part::Corners).end(),
                {_vertices[vertex], std::bit_cast<Index>(_level.GetVertexSharpness(vertex)),
                 isNonManifold, faces.size(), edges.size(), static_cast<Index>(around.size())});
    int numSemiSharp = 0;
    for (Index edge : edges) {
        float const sharpness = _level.GetEdgeSharpness(edge);
        Index* const words = &PartOf(Part::Edges)[_edges[edge] * FaceRing::kWordsPerEdge];
        words[2] = std::bit_cast<Index>(sharpness);
        words[3] = _level.IsEdgeNonManifold(edge);
        numSemiSharp += Sdc::Crease::IsSemiSharp(sharpness);
    }
    // Chaikin's averages over more than two edges are float sums in their order, which has to be
    // the level's: rounded in another one, two faces would not see the same sharpness.
    bool const keepsOrder = _isChaikin && numSemiSharp > 2;
    // Round an interior vertex the order may start anywhere; starting at the face makes it unique.
    bool const isCycle = !keepsOrder && !isNonManifold && faces.size() == edges.size();
    int const start =
        isCycle ? FindFirstNumbered(faces.size(), [&](int i) { return _faces[faces[i]]; }) : 0;
    auto const add = [&](auto const& members, Numbering const& numbering) {
        for (int i = start; i < members.size(); ++i) around.push_back(numbering[members[i]]);
        for (int i = 0; i < start; ++i) around.push_back(numbering[members[i]]);
    };
    add(faces, _faces);
    add(edges, _edges);
}

void FaceRingGatherer::Gather(Index face, FaceRing& ring, std::vector<Index>& points) {
    for (auto& part : _parts) part.clear();
    NumberFaces(face);
    for (Index inRing : _faces.GetMembers()) AddFace(inRing);
    AddEdges();
    for (Index vertex : _level.GetFaceVertices(face)) AddCorner(vertex);
    for (Index vertex : _creaseEnds) AddCorner(vertex);
    points = (_channel >= 0 ? _values : _vertices).GetMembers();
    PartOf(Part::Counts) = {_vertices.GetCount(), static_cast<Index>(points.size())};
    ring.Assign(_parts);
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
        edgeFaces.resize(ring.GetNumEdges());
        vertexFaces.resize(ring.GetNumVertices());
        vertexEdges.resize(vertexFaces.size());
        // The faces round a vertex of the rim are not all here; its rules are of no consequence.
        isNonManifold.assign(vertexFaces.size(), 1);
        size_t corner = 0;
        for (Index face = 0; face < ring.GetNumFaces(); ++face) {
            for (int i = 0; i < ring.GetFaceSizes()[face]; ++i, ++corner) {
                edgeFaces[ring.GetFaceEdges()[corner]].push_back(face);
                vertexFaces[ring.GetFaceVertices()[corner]].push_back(face);
            }
        }
        for (Index edge = 0; edge < ring.GetNumEdges(); ++edge) {
            for (Index end : ring.GetEdge(edge).vertices) vertexEdges[end].push_back(edge);
        }
        for (int i = 0; i < ring.GetNumCorners(); ++i) {
            FaceRing::Corner const known = ring.GetCorner(i);
            vertexFaces[known.vertex].assign(known.faces.begin(), known.faces.end());
            vertexEdges[known.vertex].assign(known.edges.begin(), known.edges.end());
            isNonManifold[known.vertex] = known.isNonManifold;
        }
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
    setNumBaseFaces(refiner, ring.GetNumFaces());
    setNumBaseEdges(refiner, ring.GetNumEdges());
    setNumBaseVertices(refiner, ring.GetNumVertices());
    for (Index face = 0; face < ring.GetNumFaces(); ++face) {
        setNumBaseFaceVertices(refiner, face, ring.GetFaceSizes()[face]);
    }
    for (Index edge = 0; edge < ring.GetNumEdges(); ++edge) {
        setNumBaseEdgeFaces(refiner, edge, static_cast<int>(topology.edgeFaces[edge].size()));
    }
    for (Index vertex = 0; vertex < ring.GetNumVertices(); ++vertex) {
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
    auto vertex = ring.GetFaceVertices().begin();
    auto edge = ring.GetFaceEdges().begin();
    for (Index face = 0; face < ring.GetNumFaces(); ++face) {
        int const size = ring.GetFaceSizes()[face];
        std::copy_n(vertex, size, getBaseFaceVertices(refiner, face).begin());
        std::copy_n(edge, size, getBaseFaceEdges(refiner, face).begin());
        vertex += size;
        edge += size;
    }
    for (Index e = 0; e < ring.GetNumEdges(); ++e) {
        copy(ring.GetEdge(e).vertices, getBaseEdgeVertices(refiner, e));
        copy(topology.edgeFaces[e], getBaseEdgeFaces(refiner, e));
    }
    for (Index v = 0; v < ring.GetNumVertices(); ++v) {
        copy(topology.vertexFaces[v], getBaseVertexFaces(refiner, v));
        copy(topology.vertexEdges[v], getBaseVertexEdges(refiner, v));
    }
    populateBaseLocalIndices(refiner);
    for (Index e = 0; e < ring.GetNumEdges(); ++e) {
        if (ring.GetEdge(e).isNonManifold) setBaseEdgeNonManifold(refiner, e, true);
    }
    for (Index v = 0; v < ring.GetNumVertices(); ++v) {
        if (topology.isNonManifold[v]) setBaseVertexNonManifold(refiner, v, true);
    }
    return true;
}

template <>
bool TopologyRefinerFactory<RingTopology>::assignComponentTags(TopologyRefiner& refiner,
                                                               RingTopology const& topology) {
    auto const& ring = topology.ring;
    for (Index edge = 0; edge < ring.GetNumEdges(); ++edge) {
        setBaseEdgeSharpness(refiner, edge, ring.GetEdge(edge).sharpness);
    }
    for (int i = 0; i < ring.GetFaceSizes()[0]; ++i) {
        auto const corner = ring.GetCorner(i);
        setBaseVertexSharpness(refiner, corner.vertex, corner.sharpness);
    }
    return true;
}

template <>
bool TopologyRefinerFactory<RingTopology>::assignFaceVaryingTopology(TopologyRefiner& refiner,
                                                                     RingTopology const& topology) {
    auto const& ring = topology.ring;
    if (!ring.IsFaceVarying()) return true;
    int const channel = createBaseFVarChannel(refiner, ring.GetNumPoints());
    auto value = ring.GetFacePoints().begin();
    for (Index face = 0; face < ring.GetNumFaces(); ++face) {
        std::copy_n(value, ring.GetFaceSizes()[face],
                    getBaseFaceFVarValues(refiner, face, channel).begin());
        value += ring.GetFaceSizes()[face];
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
