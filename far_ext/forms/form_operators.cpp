// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/form_operators.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::far_ext {

namespace {

/// How two faces meet in an edge that both have once.
bool RunsTheSameWay(Far::TopologyLevel const& level, Index edge) {
    auto const faces = level.GetEdgeFaces(edge);
    auto const places = level.GetEdgeFaceLocalIndices(edge);
    return level.GetFaceVertices(faces[0])[places[0]] == level.GetFaceVertices(faces[1])[places[1]];
}

/// Whether turning some faces over would make all agree, and if so one of those that would have to
/// turn.
struct Turning {
    bool isPossible = true;
    Index face = -1;
};

Turning FindTurning(Far::TopologyLevel const& level) {
    Turning result;
    std::vector<signed char> side(level.GetNumFaces(), 0);
    std::vector<Index> open;
    for (Index seed = 0; seed < level.GetNumFaces(); ++seed) {
        if (side[seed] != 0) continue;
        side[seed] = 1;
        open.assign(1, seed);
        while (!open.empty()) {
            Index const face = open.back();
            open.pop_back();
            for (Index edge : level.GetFaceEdges(face)) {
                auto const faces = level.GetEdgeFaces(edge);
                if (faces.size() != 2) continue;
                signed char const wanted = static_cast<signed char>(
                    RunsTheSameWay(level, edge) ? -side[face] : side[face]);
                Index const other = faces[0] == face ? faces[1] : faces[0];
                if (other == face) {
                    if (wanted != side[face]) result.isPossible = false;
                } else if (side[other] == 0) {
                    side[other] = wanted;
                    if (wanted < 0 && result.face < 0) result.face = other;
                    open.push_back(other);
                } else if (side[other] != wanted) {
                    result.isPossible = false;
                }
            }
        }
    }
    return result;
}

void CheckWinding(Far::TopologyLevel const& level) {
    Turning const turning = FindTurning(level);
    if (!turning.isPossible) {
        throw Error(ErrorCode::BadMesh,
                    "the surface is non-orientable (like a Moebius band): it has no two sides, so "
                    "forms cannot be "
                    "subdivided on it; cut it open along a loop of edges");
    }
    if (turning.face >= 0) {
        throw Error(ErrorCode::BadMesh, fmt::format("inconsistent winding: face {} is listed "
                                                    "against its neighbours; reverse its vertices",
                                                    turning.face));
    }
}

}  // namespace

bool IsSmoothInterior(Far::TopologyLevel const& level, Index vertex) {
    if (level.GetVertexRule(vertex) != Sdc::Crease::RULE_SMOOTH || level.IsVertexBoundary(vertex))
        return false;
    auto const edges = level.GetVertexEdges(vertex);
    return std::all_of(edges.begin(), edges.end(),
                       [&](Index edge) { return level.GetEdgeSharpness(edge) <= 0.0f; });
}

bool HasRefinedFaces(ControlMesh const& mesh) {
    int const wanted = mesh.scheme == Sdc::SCHEME_LOOP ? 3 : 4;
    return std::all_of(mesh.faceSizes.begin(), mesh.faceSizes.end(),
                       [&](int size) { return size == wanted; });
}

std::vector<double> TakeDifferences(Far::TopologyLevel const& level, std::span<double const> f) {
    std::vector<double> form(level.GetNumEdges());
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        form[edge] = f[std::max(ends[0], ends[1])] - f[std::min(ends[0], ends[1])];
    }
    return form;
}

SparseRows BuildD0(Far::TopologyLevel const& level) {
    SparseRows rows;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        double const sign = GetSignFrom(level, edge, ends[0]);
        rows.indices.insert(rows.indices.end(), {ends[0], ends[1]});
        rows.weights.insert(rows.weights.end(), {-sign, sign});
        rows.offsets.push_back(static_cast<int>(rows.indices.size()));
    }
    return rows;
}

SparseRows BuildD1(Far::TopologyLevel const& level) {
    SparseRows rows;
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        for (int j = 0; j < level.GetFaceEdges(face).size(); ++j) {
            OrientedEdge const side = GetFaceSide(level, face, j);
            rows.indices.push_back(side.edge);
            rows.weights.push_back(side.sign);
        }
        rows.offsets.push_back(static_cast<int>(rows.indices.size()));
    }
    return rows;
}

void CheckForms(Far::TopologyRefiner const& refiner) {
    if (refiner.GetSchemeType() == Sdc::SCHEME_BILINEAR) {
        throw Error(ErrorCode::BadOption,
                    "forms are subdivided by Catmull-Clark or Loop; use `scheme` catmark or loop");
    }
    auto const level = refiner.GetLevel(0);
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        int const numFaces = level.GetEdgeFaces(edge).size();
        if (numFaces > 2) {
            throw Error(
                ErrorCode::BadMesh,
                fmt::format("the edge from vertex {} to {} has {} faces; forms need at most two",
                            ends[0], ends[1], numFaces));
        }
        if (ends[0] == ends[1])
            throw Error(
                ErrorCode::BadMesh,
                fmt::format("an edge joins vertex {} to itself; forms need two ends", ends[0]));
    }
    CheckWinding(level);
    bool hasBoundary = false;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (level.GetVertexFaces(vertex).size() == 0) continue;
        if (level.IsVertexNonManifold(vertex)) {
            throw Error(
                ErrorCode::BadMesh,
                fmt::format("the faces at vertex {} form more than one fan; split the vertex",
                            vertex));
        }
        hasBoundary |= level.IsVertexBoundary(vertex);
    }
    if (hasBoundary && refiner.GetSchemeOptions().GetVtxBoundaryInterpolation() ==
                           Sdc::Options::VTX_BOUNDARY_NONE) {
        throw Error(ErrorCode::BadOption,
                    "forms have no rule at boundaries under `boundary` none; use edge-only or "
                    "edge-and-corner");
    }
    if (refiner.GetSchemeType() == Sdc::SCHEME_CATMARK &&
        refiner.GetSchemeOptions().GetTriangleSubdivision() == Sdc::Options::TRI_SUB_SMOOTH) {
        for (Index face = 0; face < level.GetNumFaces(); ++face) {
            if (level.GetFaceVertices(face).size() != 3) continue;
            throw Error(
                ErrorCode::Unsupported,
                fmt::format(
                    "face {} is a triangle; forms have no rule for `triangles` smooth, use catmark",
                    face));
        }
    }
}

}  // namespace limn::far_ext
