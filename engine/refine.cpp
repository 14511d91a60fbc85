#include "engine/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>

#include <fmt/format.h>
#include <opensubdiv/far/primvarRefiner.h>

#include "engine/job.h"
#include "eval/vertex_limits.h"
#include "far_ext/error.h"
#include "far_ext/refiner.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;

/// N doubles, as Far's refiner reads and blends them.
template <size_t N>
struct Row {
    std::array<double, N> values;

    void Clear() { values.fill(0.0); }
    void AddWithWeight(Row const& other, double weight) {
        for (size_t c = 0; c < N; ++c) values[c] += weight * other.values[c];
    }
};

/// Refines values of length N through all levels: of vertices, or of a face-varying channel.
template <size_t N>
std::vector<double> RefineValues(Far::TopologyRefiner const& refiner, std::span<double const> base, int fvarChannel = -1) {
    static_assert(sizeof(Row<N>) == N * sizeof(double));
    Far::PrimvarRefinerReal<double> const primvars(refiner);
    std::vector<Row<N>> rows(base.size() / N);
    std::memcpy(rows.data(), base.data(), base.size_bytes());
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        CheckInterrupted();
        auto const topology = refiner.GetLevel(level);
        bool const isFVar = fvarChannel >= 0;
        std::vector<Row<N>> fine(
            static_cast<size_t>(isFVar ? topology.GetNumFVarValues(fvarChannel) : topology.GetNumVertices()));
        if (isFVar) primvars.InterpolateFaceVarying(level, rows, fine, fvarChannel);
        else primvars.Interpolate(level, rows, fine);
        rows = std::move(fine);
    }
    std::vector<double> refined(rows.size() * N);
    std::memcpy(refined.data(), rows.data(), refined.size() * sizeof(double));
    return refined;
}

Primvar RefinePrimvar(Far::TopologyRefiner const& refiner, Primvar const& primvar) {
    Primvar fine{primvar.name, primvar.numChannels, {}};
    size_t const n = static_cast<size_t>(primvar.numChannels);
    for (size_t c = 0; c < n; ++c) {
        std::vector<double> channel;
        for (size_t i = c; i < primvar.values.size(); i += n) channel.push_back(static_cast<double>(primvar.values[i]));
        auto const refined = RefineValues<1>(refiner, channel);
        fine.values.resize(refined.size() * n);
        for (size_t i = 0; i < refined.size(); ++i) fine.values[i * n + c] = static_cast<float>(refined[i]);
    }
    return fine;
}

/// The base face of every face of the last level.
std::vector<Index> FindBaseFaces(Far::TopologyRefiner const& refiner) {
    int const last = refiner.GetMaxLevel();
    std::vector<Index> base(static_cast<size_t>(refiner.GetLevel(last).GetNumFaces()));
    for (Index face = 0; face < static_cast<Index>(base.size()); ++face) {
        Index at = face;
        for (int level = last; level > 0; --level) at = refiner.GetLevel(level).GetFaceParentFace(at);
        base[face] = at;
    }
    return base;
}

/// Tags as the last level has them. Boundaries are sharp by rule and need none, unless the rule gives them
/// no surface, where a tag tells which of them have one.
void CopyTags(Level const& level, Sdc::Options::VtxBoundaryInterpolation boundary, far_ext::ControlMesh& cage) {
    bool const isBoundaryByRule = boundary != Sdc::Options::VTX_BOUNDARY_NONE;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        float const sharpness = level.GetEdgeSharpness(edge);
        bool const isByRule = (isBoundaryByRule && level.IsEdgeBoundary(edge)) || level.IsEdgeNonManifold(edge);
        if (sharpness <= 0.0f || isByRule) continue;
        auto const ends = level.GetEdgeVertices(edge);
        cage.creaseVertexPairs.insert(cage.creaseVertexPairs.end(), {ends[0], ends[1]});
        cage.creaseSharpness.push_back(sharpness);
    }
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        float const sharpness = level.GetVertexSharpness(vertex);
        bool const isByRule = level.IsVertexNonManifold(vertex) ||
                              (boundary == Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER && level.IsVertexCorner(vertex));
        if (sharpness <= 0.0f || isByRule) continue;
        cage.cornerVertices.push_back(vertex);
        cage.cornerSharpness.push_back(sharpness);
    }
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        if (level.IsFaceHole(face)) cage.holes.push_back(face);
    }
}

/// Moves refined vertices to the limit. Vertices without a face that has one stay.
void MoveToLimit(Scene& fine) {
    auto const refiner = far_ext::CreateRefiner(fine.cage);
    eval::LimitSurface const surface(*refiner);
    fine.positions = eval::EvaluateVertexLimits(surface, fine.positions, 3, eval::FaceTree::kLimitDepth, CheckInterrupted).values;
}

}  // namespace

Scene RefineUniformly(Scene const& scene, int levels, bool toLimit) {
    if (levels < 0 || levels > 10) {
        throw Error(ErrorCode::BadOption, fmt::format("--levels: {} is not from 0 to 10", levels));
    }
    double const corners = static_cast<double>(scene.cage.faceVertices.size()) * std::pow(4.0, levels);
    if (corners > 2e9) {
        throw Error(ErrorCode::TooLarge, fmt::format("{}: {} levels would make {:.1e} face corners; at most 2e9 can be "
                                                     "indexed",
                                                     scene.path, levels, corners));
    }
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    Far::TopologyRefiner::UniformOptions uniform(levels);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    Level const last = refiner->GetLevel(levels);

    Scene fine;
    fine.path = scene.path;
    fine.name = scene.name;
    fine.cage.scheme = scene.cage.scheme;
    fine.cage.options = scene.cage.options;
    fine.cage.numVertices = last.GetNumVertices();
    for (Index face = 0; face < last.GetNumFaces(); ++face) {
        auto const vertices = last.GetFaceVertices(face);
        fine.cage.faceSizes.push_back(vertices.size());
        fine.cage.faceVertices.insert(fine.cage.faceVertices.end(), vertices.begin(), vertices.end());
    }
    CopyTags(last, scene.cage.options.GetVtxBoundaryInterpolation(), fine.cage);
    fine.positions = RefineValues<3>(*refiner, scene.positions);
    if (scene.HasUVs()) {
        fine.uvs = RefineValues<2>(*refiner, scene.uvs, 0);
        far_ext::FVarChannel channel{last.GetNumFVarValues(0), {}};
        for (Index face = 0; face < last.GetNumFaces(); ++face) {
            auto const values = last.GetFaceFVarValues(face, 0);
            channel.valueIndices.insert(channel.valueIndices.end(), values.begin(), values.end());
        }
        fine.cage.fvarChannels.push_back(std::move(channel));
    }
    for (Primvar const& primvar : scene.primvars) fine.primvars.push_back(RefinePrimvar(*refiner, primvar));
    std::vector<Index> const base = FindBaseFaces(*refiner);
    for (size_t kind = 0; kind < 3; ++kind) {
        fine.groups[kind].names = scene.groups[kind].names;
        if (scene.groups[kind].faceGroup.empty()) continue;
        for (Index face : base) fine.groups[kind].faceGroup.push_back(scene.groups[kind].faceGroup[face]);
    }
    if (toLimit) MoveToLimit(fine);
    return fine;
}

}  // namespace limn::engine
