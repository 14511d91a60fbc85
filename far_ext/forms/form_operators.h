// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/rows/sparse_rows.h"
#include "far_ext/topology/control_mesh.h"

namespace limn::far_ext {

// Discrete forms on a level of a refinement: a 0-form has a value per vertex, a 1-form per edge
// (the integral along it), a 2-form per face (the integral over it). Edges are Far's; each runs
// from its lower vertex to its higher one. Faces run as they are listed.
//
// Source  [Wang06] Sec. 2; [Forms 1].

/// An edge and whether the walk at hand goes along its direction (+1) or against it (-1).
struct OrientedEdge {
    Index edge;
    double sign;
};

/// +1 if a walk that leaves `edge`'s end `from` goes from its lower vertex to its higher one.
inline double GetSignFrom(Far::TopologyLevel const& level, Index edge, Index from) {
    auto const ends = level.GetEdgeVertices(edge);
    return from == (ends[0] < ends[1] ? ends[0] : ends[1]) ? 1.0 : -1.0;
}

/// The j-th edge of a face, from its j-th vertex to the next.
inline OrientedEdge GetFaceSide(Far::TopologyLevel const& level, Index face, int j) {
    Index const edge = level.GetFaceEdges(face)[j];
    return {edge, GetSignFrom(level, edge, level.GetFaceVertices(face)[j])};
}

/// A smooth vertex with faces all round it and no sharp edge: no feature reaches it.
bool IsSmoothInterior(Far::TopologyLevel const& level, Index vertex);

/// Whether all faces are what the scheme's refined ones are: quads, for Loop triangles.
bool HasRefinedFaces(ControlMesh const& mesh);

/// d0: edges x vertices. (d0 f)(a -> b) = f(b) - f(a).
SparseRows BuildD0(Far::TopologyLevel const& level);

/// d0 f without the matrix.
std::vector<double> TakeDifferences(Far::TopologyLevel const& level, std::span<double const> f);

/// d1: faces x edges. (d1 w)(face) = sum of w along its sides. d1 d0 = 0.
SparseRows BuildD1(Far::TopologyLevel const& level);

/// Refuses a base mesh on which forms cannot be subdivided.
///
/// \throws Error  BadMesh: an edge with more than two faces, a vertex whose faces form more than
///                one fan, faces wound against each other (a face is named), a surface that cannot
///                be oriented.  BadOption: another scheme than Catmull-Clark and Loop, boundaries
///                that are not interpolated.  Unsupported: OpenSubdiv's smooth triangle rule where
///                a mesh has triangles
void CheckForms(Far::TopologyRefiner const& refiner);

}  // namespace limn::far_ext
