// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
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
///          starting after the face, so that alike surroundings get equal rings; round crease ends
///          likewise, after the face that came first. Vertices, edges and values are numbered by
///          first appearance; 0..size-1 are the face's own corners unless it repeats one.
/// Edges    are told explicitly: at a vertex of valence 2, or beside a face that repeats a corner,
///          two edges can join the same two vertices, and face lists alone would merge them.
struct FaceRing {
    /// What the level says about a vertex whose faces are all here: these and the edges, in order.
    struct Corner {
        Index vertex = -1;
        std::vector<Index> faces, edges;
        float sharpness = 0.0f;  ///< OpenSubdiv's effective value, boundary rules included
        bool isNonManifold = false;

        bool operator==(Corner const&) const = default;
    };
    struct Edge {
        Index vertices[2] = {-1, -1};
        float sharpness = 0.0f;  ///< known (and needed) at corners and crease ends only
        bool isNonManifold = false;

        bool operator==(Edge const&) const = default;
    };

    std::vector<int> faceSizes;
    std::vector<Index> faceVertices;  ///< local vertices, face after face
    std::vector<Index> faceEdges;     ///< local edges: entry i joins corners i and i + 1
    std::vector<Index> valueIndices;  ///< local values per corner; empty for vertex topology
    std::vector<Edge> edges;
    std::vector<Corner> corners;     ///< of face 0
    std::vector<Corner> creaseEnds;  ///< far ends of semi-sharp edges from these (Chaikin only)
    Index numVertices = 0;
    Index numPoints = 0;  ///< vertices, or values with face-varying topology

    bool operator==(FaceRing const&) const = default;
    size_t Hash() const;
    bool IsFaceVarying() const { return !valueIndices.empty(); }
};

/// Collects rings from one level. Keeps scratch of the level's size: one per thread and level.
class FaceRingGatherer {
public:
    /// With which corner the faces round the face start, and which way edges point: as in the
    /// level; or with the corner numbered first, and to the higher number, so that rings which
    /// differ in nothing else become equal. (Sums over a ring's points are then taken in another
    /// order.)
    enum class Starts { AsInLevel, Canonical };

    /// \param level    topology with all relations (a base level, or a refined one asked for them)
    /// \param options  by which the level is subdivided
    /// \param channel  face-varying channel, or -1 for vertices
    FaceRingGatherer(Far::TopologyLevel const& level, Sdc::Options options, int channel,
                     Starts starts = Starts::AsInLevel);

    /// The ring of a face, and for each of its points the level's vertex (or value) index.
    void Gather(Index face, FaceRing& ring, std::vector<Index>& points);

    /// Only the points, in the order Gather gives them. \pre Starts::AsInLevel
    void GatherPoints(Index face, std::vector<Index>& points);

private:
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
        void Reset() {
            for (Index index : _members) _local[index] = -1;
            _members.clear();
        }

    private:
        std::vector<Index> _local, _members;
    };

    void NumberFaces(Index face);
    void NumberFacesRound(Index vertex, int first);
    void FindCreaseEnds(Index face);
    int FindStart(Far::ConstIndexArray vertices) const;
    void FillCorner(Index vertex, FaceRing::Corner& corner, FaceRing& ring) const;

    Far::TopologyLevel _level;  // a view
    int _channel;
    Starts _starts;
    bool _isChaikin;
    Numbering _faces, _vertices, _edges, _values;
    std::vector<Index> _creaseEnds;  // of the face at hand
};

/// Builds a ring's own refiner, with the boundary rule EDGE_ONLY: the ring's rim adds no sharpness.
///
/// \throws Error  BadMesh where OpenSubdiv refuses the topology
std::unique_ptr<Far::TopologyRefiner> CreateRingRefiner(FaceRing const& ring,
                                                        Sdc::SchemeType scheme,
                                                        Sdc::Options options);

}  // namespace limn::far_ext
