// SPDX-License-Identifier: Apache-2.0
#include "engine/field/circulation.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/refine.h"
#include "far_ext/forms/edge_limits.h"
#include "far_ext/forms/form_stencils.h"

namespace limn::engine {

namespace {

/// The first level on which no semi-sharp feature is left.
int FindSettledLevel(far_ext::ControlMesh const& cage) {
    float sharpest = 0.0f;
    auto const look = [&](std::vector<float> const& weights) {
        for (float const sharpness : weights) {
            if (sharpness < far_ext::kInfiniteSharpness) sharpest = std::max(sharpest, sharpness);
        }
    };
    look(cage.creaseSharpness);
    look(cage.cornerSharpness);
    return static_cast<int>(std::ceil(sharpest));
}

/// Calls visit(edge, sign) for the pieces of an edge on a finer level.
template <class Visit>
void ForEachPiece(Far::TopologyRefiner const& refiner, int level, int last, Index edge, double sign,
                  Visit const& visit) {
    if (level == last) return visit(edge, sign);
    auto const coarse = refiner.GetLevel(level), fine = refiner.GetLevel(level + 1);
    auto const ends = coarse.GetEdgeVertices(edge);
    Index const from = coarse.GetVertexChildVertex(std::min(ends[0], ends[1]));
    for (Index child : coarse.GetEdgeChildEdges(edge)) {
        auto const childEnds = fine.GetEdgeVertices(child);
        bool const isFirst = childEnds[0] == from || childEnds[1] == from;
        Index const middle = coarse.GetEdgeChildVertex(edge);
        double const along = far_ext::GetSignFrom(fine, child, isFirst ? from : middle);
        ForEachPiece(refiner, level + 1, last, child, sign * along, visit);
    }
}

}  // namespace

std::vector<EdgeCirculation> FindCirculations(Model const& model, std::span<double const> form,
                                              std::span<EdgeValue const> edges, Job& job,
                                              eval::TableEvaluator* evaluator) {
    int const last = FindSettledLevel(model.GetCage());
    auto const refiner = MakeUniformRefiner(model.GetCage(), model.GetPath(), last + 1);
    std::vector<double> values(form.begin(), form.end());
    for (int level = 1; level <= last; ++level) {
        values = eval::ApplyRows(evaluator, far_ext::FormStencils::kS1,
                                 far_ext::BuildFormStencils(*refiner, level).s1, values);
    }
    far_ext::EdgeLimits limits(*refiner, last);
    std::vector<EdgeCirculation> circulations;
    for (auto const& [edge, from, to, value, line, kind] : edges) {
        job.CheckStopped();
        double sum = 0.0;
        double const along = far_ext::GetSignFrom(model.GetLevel(), edge, from);
        ForEachPiece(*refiner, 0, last, edge, along, [&](Index piece, double sign) {
            auto const row = limits.Find(piece);
            for (auto const& [part, weight] : row.GetEntries()) sum += sign * weight * values[part];
        });
        circulations.push_back({from, to, sum});
    }
    return circulations;
}

}  // namespace limn::engine
