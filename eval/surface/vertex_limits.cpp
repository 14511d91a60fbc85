// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/vertex_limits.h"

#include <tbb/enumerable_thread_specific.h>

#include "eval/parallel/rows.h"
#include "eval/surface/surface_sample.h"

namespace limn::eval {

namespace {

/// The face that evaluates each vertex: one that is a plain patch where there is one, else the
/// first.
std::vector<Index> ChooseFaces(LimitSurface const& surface, Far::TopologyLevel const& level) {
    std::vector<Index> chosen(level.GetNumVertices(), -1);
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (!surface.HasLimit(face)) continue;
        for (Index vertex : level.GetFaceVertices(face)) {
            Index& known = chosen[vertex];
            if (known < 0 || (surface.IsPlainPatch(face) && !surface.IsPlainPatch(known)))
                known = face;
        }
    }
    return chosen;
}

}  // namespace

VertexLimits EvaluateVertexLimits(LimitSurface const& surface, std::span<double const> values,
                                  int length, int maxDepth, std::function<void()> const& onBlock) {
    surface.CheckValues(values, length);
    Far::TopologyLevel const level = surface.GetRefiner().GetLevel(0);
    std::vector<Index> const chosen = ChooseFaces(surface, level);
    VertexLimits limits{{values.begin(), values.end()}, std::vector<char>(chosen.size(), 0)};
    tbb::enumerable_thread_specific<FaceTree> trees(
        [&] { return FaceTree(surface, values, length); });
    constexpr Index kFacesPerBlock = 256;
    ForEachBlock(surface.GetNumFaces(), kFacesPerBlock, [&](Index begin, Index end) {
        if (onBlock) onBlock();
        FaceTree& tree = trees.local();
        for (Index face = begin; face < end; ++face) {
            if (!surface.HasLimit(face)) continue;
            auto const vertices = level.GetFaceVertices(face);
            bool isBound = false;
            for (int corner = 0; corner < vertices.size(); ++corner) {
                size_t const vertex = vertices[corner];
                if (chosen[vertex] != face) continue;
                if (!isBound) tree.Bind(face);
                isBound = true;
                auto const place = GetCornerPlace(surface, face, corner);
                for (int c = 0; c < length; ++c) {
                    limits.values[vertex * length + c] =
                        EvaluateChannel(tree, place.domain, place.s, place.t, c, maxDepth);
                }
                limits.hasLimit[vertex] = 1;
            }
        }
    });
    return limits;
}

}  // namespace limn::eval
