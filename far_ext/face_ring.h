#pragma once

#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/control_mesh.h"

namespace limn::far_ext {

/// A face with all faces that share a vertex with it, renumbered locally: everything its limit
/// surface depends on. Two faces with equal rings have equal subdivision matrices.
///
/// Order  face 0 is the face itself, then the faces round its corner 0, 1, ..., each time starting
///        after the face, so that alike surroundings get equal rings. Points are numbered by first appearance, so 0..size-1 are the face's own corners.
///        With face-varying topology, points are values and `vertices` are vertices.
struct FaceRing {
    std::vector<int> faceSizes;
    std::vector<Index> faceVertices;    ///< local vertices, face after face
    std::vector<Index> valueIndices;    ///< local values per corner; empty for vertex topology
    std::vector<Index> sharpEdges;      ///< local vertex pairs at the face's corners, ...
    std::vector<float> edgeSharpness;   ///< ... with their sharpness > 0, boundaries left out
    std::vector<float> cornerSharpness; ///< of the face's corners (OpenSubdiv's effective values)
    Index numVertices = 0;
    Index numPoints = 0;  ///< vertices, or values with face-varying topology

    bool operator==(FaceRing const&) const = default;
    size_t Hash() const;
    bool IsFaceVarying() const { return !valueIndices.empty(); }
};

/// Collects rings from one level. Keeps scratch of the level's size: one per thread and level.
class FaceRingGatherer {
public:
    /// \param level    topology with all relations (a base level, or a refined one asked for them)
    /// \param channel  face-varying channel, or -1 for vertices
    FaceRingGatherer(Far::TopologyLevel const& level, int channel);

    /// The ring of a face, and for each of its points the level's vertex (or value) index.
    void Gather(Index face, FaceRing& ring, std::vector<Index>& points);

    /// Only the points, in the order Gather gives them.
    void GatherPoints(Index face, std::vector<Index>& points);

private:
    void GatherFaces(Index face);
    void GatherSharpness(Index face, FaceRing& ring);
    template <class Visit>
    void NumberPoints(bool byValue, Visit visit);

    Far::TopologyLevel _level;  // a view
    int _channel;
    std::vector<Index> _faces;
    std::vector<Index> _localOfVertex, _localOfValue;  // -1 where not in the ring
    std::vector<char> _isInRing;                       // per face
};

}  // namespace limn::far_ext
