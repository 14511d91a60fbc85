// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "far_ext/cascade/cascade_level.h"

namespace limn::far_ext {

/// Bisection of triangles: every pass cuts each triangle at its refinement edge, and its halves
/// again where that of a neighbour runs along theirs. Refinement edges are the longest of the first
/// mesh (of equal ones that with the smallest pair of vertices), afterwards the edge opposite the
/// newest vertex. Two passes about quarter the triangles.
///
/// Order   vertices stay; new ones follow in the order of the edges, numbered by first appearance
///         along the faces.
/// Source  [Diewald02] Sec. 7, Fig. 6
class Bisection {
public:
    /// \param faces      3 vertices per triangle
    /// \param positions  3 per vertex
    Bisection(Index numVertices, std::vector<Index> faces, std::span<double const> positions,
              std::vector<std::array<Index, 2>> creases, std::vector<Index> corners);

    /// One pass over all triangles. \return the finer mesh, with parents in the one before
    CascadeMesh const& Refine();

    /// One pass that cuts the marked triangles, and others only as far as their edges are cut: a
    /// triangle with a cut edge is cut at its own refinement edge first, so that no vertex lies on
    /// the edge of a triangle.
    ///
    /// \param isMarked  per triangle
    CascadeMesh const& Refine(std::span<char const> isMarked);

    /// The mesh as it is, without parents before the first pass.
    CascadeMesh const& GetMesh() const { return _mesh; }

    /// Carries a face-varying channel along: values stay, new ones follow. To be called before the
    /// first pass.
    ///
    /// \param values  per corner of the triangles
    void SetFVarChannel(Index numValues, std::vector<Index> values);

    /// Per triangle of the mesh handed back last: the triangle of the first mesh it lies in.
    std::vector<Index> const& GetBaseFaces() const { return _baseFaces; }

    /// Per corner of these triangles: its face-varying value.
    std::vector<Index> const& GetFVarValues() const { return _fvarValues; }

    /// The two values that each new one of the last pass lies between.
    std::vector<std::array<Index, 2>> const& GetFVarParents() const { return _fvarParents; }

private:
    struct CutEdges;
    struct Halves;

    CutEdges FindCutEdges(std::span<char const> isMarked) const;
    std::vector<char> CloseCuts(CutEdges const& edges, std::span<char const> isMarked) const;
    void AddVertices(Index numCoarse, CutEdges const& edges);
    void CutFaces(std::vector<Index> const& coarse, CutEdges const& edges);
    void CutCreases(std::vector<std::array<Index, 2>> const& coarse, CutEdges const& edges);

    CascadeMesh _mesh;
    Index _numFVarValues = 0;
    std::vector<Index> _fvarValues;
    std::vector<std::array<Index, 2>> _fvarParents;
    std::vector<int> _refinementEdges;  // per triangle: the corner before the edge
    std::vector<Index> _baseFaces;
};

}  // namespace limn::far_ext
