// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/limit_surface.h"

#include <algorithm>

#include <fmt/format.h>

#include "eval/parallel/rows.h"
#include "eval/surface/ring_cache.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

using Level = Far::TopologyLevel;

int RegularValence(bool isLoop) {
    return isLoop ? 6 : 4;
}
int RegularSize(bool isLoop) {
    return isLoop ? 3 : 4;
}

/// Interior, of regular valence, among regular faces, without sharpness.
std::vector<char> FindRegularVertices(Level const& level, bool isLoop) {
    std::vector<char> isRegular(level.GetNumVertices(), 0);
    int const valence = RegularValence(isLoop), size = RegularSize(isLoop);
    ForEachRow(level.GetNumVertices(), [&](Index v) {
        auto const faces = level.GetVertexFaces(v);
        auto const edges = level.GetVertexEdges(v);
        bool regular = faces.size() == valence && edges.size() == valence &&
                       !level.IsVertexBoundary(v) && !level.IsVertexNonManifold(v) &&
                       level.GetVertexSharpness(v) <= 0.0f;
        for (int i = 0; regular && i < valence; ++i) {
            regular = level.GetFaceVertices(faces[i]).size() == size &&
                      level.GetEdgeSharpness(edges[i]) <= 0.0f;
        }
        isRegular[v] = regular;
    });
    return isRegular;
}

}  // namespace

LimitSurface::LimitSurface(Far::TopologyRefiner const& refiner, int fvarChannel,
                           size_t mostRingBytes)
    : _refiner(refiner),
      _channel(fvarChannel),
      _cache(std::make_unique<RingCache>(refiner.GetSchemeType(), refiner.GetSchemeOptions(),
                                         mostRingBytes)) {
    if (_channel >= refiner.GetNumFVarChannels()) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("face-varying channel {} does not exist; the mesh has {}", _channel,
                                refiner.GetNumFVarChannels()));
    }
    CheckExcess(refiner);
    Classify();
}

LimitSurface::~LimitSurface() = default;
LimitSurface::LimitSurface(LimitSurface&&) noexcept = default;

std::optional<LimitSurface::Excess> LimitSurface::FindExcess(Far::TopologyRefiner const& refiner,
                                                             int level) {
    Level const& topology = refiner.GetLevel(level);
    for (Index vertex = 0; vertex < topology.GetNumVertices(); ++vertex) {
        int const valence = topology.GetVertexFaces(vertex).size();
        if (valence > kMaxValence) return Excess{false, vertex, valence};
    }
    for (Index face = 0; face < topology.GetNumFaces(); ++face) {
        int const size = topology.GetFaceVertices(face).size();
        if (size > kMaxCorners) return Excess{true, face, size};
    }
    return std::nullopt;
}

void LimitSurface::CheckExcess(Far::TopologyRefiner const& refiner, int level) {
    if (auto const excess = FindExcess(refiner, level)) {
        throw Error(ErrorCode::TooLarge,
                    excess->Describe(
                        fmt::format("{} {}", excess->isFace ? "face" : "vertex", excess->element)));
    }
}

std::string LimitSurface::Excess::Describe(std::string const& name) const {
    return fmt::format("{} has {} {}; a limit surface takes up to {}", name, count,
                       isFace ? "corners" : "faces", isFace ? kMaxCorners : kMaxValence);
}

void LimitSurface::CheckValues(std::span<double const> values, int length) const {
    Level const level = _refiner.GetLevel(0);
    bool const isFVar = _channel >= 0;
    far_ext::CheckLength("control points", values,
                         isFVar ? level.GetNumFVarValues(_channel) : level.GetNumVertices(),
                         isFVar ? "face-varying values" : "vertices", length);
}

int LimitSurface::GetNumDomains(Index face) const {
    int const size = _refiner.GetLevel(0).GetFaceVertices(face).size();
    return size == RegularSize(IsLoop()) ? 1 : size;
}

void LimitSurface::Classify() {
    Level const level = _refiner.GetLevel(0);
    bool const isBilinear = _refiner.GetSchemeType() == Sdc::SCHEME_BILINEAR;
    bool const isLinear =
        isBilinear || (_channel >= 0 && _refiner.GetSchemeOptions().GetFVarLinearInterpolation() ==
                                            Sdc::Options::FVAR_LINEAR_ALL);
    auto const isRegularVertex = FindRegularVertices(level, IsLoop());
    _kinds.assign(level.GetNumFaces(), FaceKind::None);
    ForEachRow(level.GetNumFaces(), [&](Index face) {
        if (level.IsFaceHole(face)) return;
        auto const corners = level.GetFaceVertices(face);
        bool const isPlain = !isLinear && corners.size() == RegularSize(IsLoop()) &&
                             std::all_of(corners.begin(), corners.end(),
                                         [&](Index v) { return isRegularVertex[v]; }) &&
                             (_channel < 0 || level.DoesFaceFVarTopologyMatch(face, _channel));
        _kinds[face] = isPlain ? FaceKind::Plain : FaceKind::Ring;
    });
}

namespace {

/// The 16 points round a quad among regular vertices; see PatchFinder for the ring's general case.
template <class FaceValues>
void GatherQuadPoints(Level const& level, Index face, FaceValues valuesOf, Index* points) {
    // Places on the 4x4 grid (4 t + s) of: the corner, then across it from the face: the vertex
    // opposite to the next corner, the diagonal one, the vertex opposite to the previous corner.
    constexpr int kPlaces[4][4] = {{5, 4, 0, 1}, {6, 2, 3, 7}, {10, 11, 15, 14}, {9, 13, 12, 8}};
    auto const corners = level.GetFaceVertices(face);
    auto const own = valuesOf(face);
    for (int i = 0; i < 4; ++i) {
        auto const faces = level.GetVertexFaces(corners[i]);
        auto const locals = level.GetVertexFaceLocalIndices(corners[i]);
        int const opposite = (faces.FindIndex(face) + 2) & 3;
        auto const values = valuesOf(faces[opposite]);
        int const at = locals[opposite];
        points[kPlaces[i][0]] = own[i];
        for (int k = 1; k < 4; ++k) points[kPlaces[i][k]] = values[(at + k) & 3];
    }
}

/// The 12 points round a triangle among regular vertices, in the order of kBoxSplineLattice.
template <class FaceValues>
void GatherTrianglePoints(Level const& level, Index face, FaceValues valuesOf, Index* points) {
    constexpr int kCorner[3] = {4, 5, 8};
    // Lattice places of the third to sixth neighbour of each corner, counter-clockwise.
    constexpr int kPlaces[3][4] = {{7, 3, 0, 1}, {1, 2, 6, 9}, {9, 11, 10, 7}};
    auto const corners = level.GetFaceVertices(face);
    auto const own = valuesOf(face);
    for (int i = 0; i < 3; ++i) {
        auto const faces = level.GetVertexFaces(corners[i]);
        auto const locals = level.GetVertexFaceLocalIndices(corners[i]);
        int const start = faces.FindIndex(face);
        points[kCorner[i]] = own[i];
        for (int k = 0; k < 4; ++k) {
            int const at = (start + 1 + k) % 6;
            points[kPlaces[i][k]] = valuesOf(faces[at])[(locals[at] + 2) % 3];
        }
    }
}

}  // namespace

void LimitSurface::GatherPlainPoints(Index face, Index* points) const {
    Level const level = _refiner.GetLevel(0);
    auto const gather = [&](auto valuesOf) {
        IsLoop() ? GatherTrianglePoints(level, face, valuesOf, points)
                 : GatherQuadPoints(level, face, valuesOf, points);
    };
    if (_channel < 0) {
        gather([&](Index f) { return level.GetFaceVertices(f); });
    } else {
        gather([&](Index f) { return level.GetFaceFVarValues(f, _channel); });
    }
}

}  // namespace limn::eval
