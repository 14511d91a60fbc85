// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/vertex_limits.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include "eval/parallel/rows.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/limit/limit_row.h"
#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

using VertexLevel = Far::TopologyLevel;

bool HasFaceWithLimit(VertexLevel const& level, Index vertex) {
    auto const faces = level.GetVertexFaces(vertex);
    return std::any_of(faces.begin(), faces.end(),
                       [&](Index face) { return !level.IsFaceHole(face); });
}

/// The face that evaluates a vertex: the first of those that are plain patches, where there is
/// none of these the first of all; -1 where none has a limit.
Index ChooseFace(LimitSurface const& surface, VertexLevel const& level, Index vertex) {
    Index chosen = -1;
    for (Index face : level.GetVertexFaces(vertex)) {
        if (!surface.HasLimit(face)) continue;
        auto const rank = [&](Index f) { return std::pair(!surface.IsPlainPatch(f), f); };
        if (chosen < 0 || rank(face) < rank(chosen)) chosen = face;
    }
    return chosen;
}

/// Adds what takes a vertex to its limit: a sum of differences, which is as exact far from the
/// origin as near it.
void AddOffset(far_ext::LimitRow const& row, Index vertex, std::span<double const> from, int length,
               double* to) {
    auto const at = [&](Index point, int c) {
        return from[static_cast<size_t>(point) * length + c];
    };
    for (int c = 0; c < length; ++c) {
        double offset = 0.0;
        for (size_t k = 0; k < row.indices.size(); ++k)
            offset += row.GetWeight(k) * (at(row.indices[k], c) - at(vertex, c));
        to[c] += offset;
    }
}

}  // namespace

VertexLimits FindVertexLimits(Far::TopologyRefiner const& refiner, int level,
                              std::span<double const> values, int length,
                              std::function<void()> const& onBlock) {
    VertexLevel const& topology = refiner.GetLevel(level);
    Index const count = topology.GetNumVertices();
    far_ext::CheckLength("control points", values, count, "vertices", length);
    VertexLimits limits{{values.begin(), values.end()},
                        std::vector<char>(static_cast<size_t>(count), 0)};
    struct Scratch {
        far_ext::LimitRowBuilder builder;
        far_ext::LimitRow row;
    };
    tbb::enumerable_thread_specific<Scratch> scratchOfThread(
        [&] { return Scratch{far_ext::LimitRowBuilder(refiner, level), {}}; });
    constexpr Index kVerticesPerBlock = 1024;
    ForEachBlock(count, kVerticesPerBlock, [&](Index begin, Index end) {
        if (onBlock) onBlock();
        auto& [builder, row] = scratchOfThread.local();
        for (Index vertex = begin; vertex < end; ++vertex) {
            builder.Build(vertex, row);
            AddOffset(row, vertex, values, length,
                      &limits.values[static_cast<size_t>(vertex) * length]);
            limits.hasLimit[vertex] = HasFaceWithLimit(topology, vertex);
        }
    });
    return limits;
}

VertexLimits EvaluateVertexLimits(LimitSurface const& surface, std::span<double const> values,
                                  int length, int maxDepth, std::function<void()> const& onBlock) {
    surface.CheckValues(values, length);
    std::vector<Index> all(surface.GetRefiner().GetLevel(0).GetNumVertices());
    std::iota(all.begin(), all.end(), 0);
    VertexLimits limits{{values.begin(), values.end()}, std::vector<char>(all.size(), 0)};
    EvaluateVertexLimitsAt(all, surface, values, length, limits, maxDepth, onBlock);
    return limits;
}

void EvaluateVertexLimitsAt(std::span<Index const> vertices, LimitSurface const& surface,
                            std::span<double const> values, int length, VertexLimits& limits,
                            int maxDepth, std::function<void()> const& onBlock) {
    surface.CheckValues(values, length);
    VertexLevel const level = surface.GetRefiner().GetLevel(0);
    tbb::enumerable_thread_specific<FaceTree> trees(
        [&] { return FaceTree(surface, values, length); });
    constexpr Index kVerticesPerBlock = 256;
    ForEachBlock(
        static_cast<Index>(vertices.size()), kVerticesPerBlock, [&](Index begin, Index end) {
            if (onBlock) onBlock();
            FaceTree& tree = trees.local();
            for (Index const vertex : vertices.subspan(begin, end - begin)) {
                Index const face = ChooseFace(surface, level, vertex);
                limits.hasLimit[vertex] = face >= 0;
                if (face < 0) continue;
                if (tree.GetFace() != face) tree.Bind(face);
                auto const place =
                    GetCornerPlace(surface, face, level.GetFaceVertices(face).FindIndex(vertex));
                for (int c = 0; c < length; ++c) {
                    limits.values[static_cast<size_t>(vertex) * length + c] =
                        EvaluateChannel(tree, place.domain, place.s, place.t, c, maxDepth);
                }
            }
        });
}

}  // namespace limn::eval
