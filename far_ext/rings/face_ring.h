// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>
#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/topology/control_mesh.h"

namespace limn::far_ext {

/// A face with all faces that share a vertex with it, renumbered locally: everything its limit
/// surface depends on. Two faces with equal rings have equal subdivision matrices.
///
/// Creases  Chaikin's rule takes the sharpness of an edge's half from all edges at that end. So
///          where a semi-sharp edge leaves the face, the faces round its far end belong to the ring
///          as well: whether the new vertex on the edge is smooth depends on them.
/// Order    Face 0 is the face itself, then the faces round its corner 0, 1, ..., each time
///          starting after the face; round crease ends likewise, after the face that came first.
///          Face 0 starts with its own first corner, as its domain does, every other face with the
///          vertex numbered first; edges point to the higher number. So alike surroundings get
///          equal rings, however the mesh writes its faces and edges. Vertices, edges and values
///          are numbered by first appearance; 0..size-1 are the face's own corners unless it
///          repeats one.
/// Edges    are told explicitly: at a vertex of valence 2, or beside a face that repeats a corner,
///          two edges can join the same two vertices, and face lists alone would merge them.
/// Memory   one array, hashed when it is gathered. Lists are views into it.
class FaceRing {
public:
    struct Edge {
        std::array<Index, 2> vertices;
        float sharpness;  ///< known (and needed) at corners and crease ends only
        bool isNonManifold;
    };
    /// What the level says about a vertex whose faces are all here: these and the edges, in order.
    struct Corner {
        Index vertex;
        float sharpness;  ///< OpenSubdiv's effective value, boundary rules included
        bool isNonManifold;
        std::span<Index const> faces, edges;
    };

    int GetNumFaces() const { return static_cast<int>(GetFaceSizes().size()); }
    std::span<Index const> GetFaceSizes() const { return Get(Part::FaceSizes); }
    /// Local vertices, face after face.
    std::span<Index const> GetFaceVertices() const { return Get(Part::FaceVertices); }
    /// Local edges: entry i joins corners i and i + 1.
    std::span<Index const> GetFaceEdges() const { return Get(Part::FaceEdges); }
    /// What is interpolated: local values per corner, or the vertices.
    std::span<Index const> GetFacePoints() const {
        return Get(IsFaceVarying() ? Part::FaceValues : Part::FaceVertices);
    }
    bool IsFaceVarying() const { return !Get(Part::FaceValues).empty(); }

    Index GetNumVertices() const { return Get(Part::Counts)[0]; }
    /// Vertices, or values with face-varying topology.
    Index GetNumPoints() const { return Get(Part::Counts)[1]; }

    int GetNumEdges() const;
    Edge GetEdge(int edge) const;

    /// The corners of face 0, then the far ends of semi-sharp edges from these (Chaikin only).
    int GetNumCorners() const;
    Corner GetCorner(int corner) const;

    size_t GetHash() const { return _hash; }
    size_t GetNumBytes() const { return sizeof(*this) + _words.capacity() * sizeof(Index); }
    bool operator==(FaceRing const&) const = default;

private:
    friend class FaceRingGatherer;
    enum class Part {
        Counts,
        FaceSizes,
        FaceVertices,
        FaceEdges,
        FaceValues,
        Edges,        // kWordsPerEdge each: vertices, sharpness, whether it is non-manifold
        Corners,      // kWordsPerCorner each: vertex, sharpness, whether it is non-manifold, number
                      // of faces, of edges, where these begin in Surroundings
        Surroundings  // faces, then edges, of corner after corner
    };
    static constexpr size_t kNumParts = 8, kWordsPerEdge = 4, kWordsPerCorner = 6;
    using Parts = std::array<std::vector<Index>, kNumParts>;

    std::span<Index const> Get(Part part) const {
        auto const* const ends = &_words[static_cast<size_t>(part)];
        return std::span(_words).subspan(ends[0], ends[1] - ends[0]);
    }
    void Assign(Parts const& parts);

    size_t _hash = 0;
    std::vector<Index> _words;  // where each part begins, where the last one ends; the parts
};

/// Collects rings from one level. Keeps scratch of the level's size: one per thread and level.
class FaceRingGatherer {
public:
    /// \param level    topology with all relations (a base level, or a refined one asked for them)
    /// \param options  by which the level is subdivided
    /// \param channel  face-varying channel, or -1 for vertices
    FaceRingGatherer(Far::TopologyLevel const& level, Sdc::Options options, int channel);

    /// The ring of a face, and for each of its points the level's vertex (or value) index.
    void Gather(Index face, FaceRing& ring, std::vector<Index>& points);

private:
    using Part = FaceRing::Part;

    /// Numbers what it is given by first appearance until it is reset.
    class Numbering {
    public:
        void Resize(int count) { _local.assign(count, -1); }
        Index Add(Index index) {
            if (_local[index] < 0) {
                _local[index] = static_cast<Index>(_members.size());
                _members.push_back(index);
            }
            return _local[index];
        }
        Index operator[](Index index) const { return _local[index]; }  ///< -1: not numbered
        std::vector<Index> const& GetMembers() const { return _members; }
        Index GetCount() const { return static_cast<Index>(_members.size()); }
        void Reset() {
            for (Index index : _members) _local[index] = -1;
            _members.clear();
        }

    private:
        std::vector<Index> _local, _members;
    };

    std::vector<Index>& PartOf(Part part) { return _parts[static_cast<size_t>(part)]; }
    void NumberFaces(Index face);
    void NumberFacesRound(Index vertex, int first);
    void FindCreaseEnds(Index face);
    void AddFace(Index face);
    void AddEdges();
    void AddCorner(Index vertex);

    Far::TopologyLevel _level;  // a view
    int _channel;
    bool _isChaikin;
    Numbering _faces, _vertices, _edges, _values;
    std::vector<Index> _creaseEnds;  // of the face at hand, like the parts of its ring
    FaceRing::Parts _parts;
};

/// Builds a ring's own refiner, with the boundary rule EDGE_ONLY: the ring's rim adds no sharpness.
///
/// \throws Error  BadMesh where OpenSubdiv refuses the topology
std::unique_ptr<Far::TopologyRefiner> CreateRingRefiner(FaceRing const& ring,
                                                        Sdc::SchemeType scheme,
                                                        Sdc::Options options);

}  // namespace limn::far_ext
