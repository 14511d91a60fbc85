// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/pinned_function.h"

#include "eval/forms/laplace_solver.h"
#include "far_ext/topology/face_components.h"

namespace limn::eval {

std::vector<double> MakeHarmonicFunction(Far::TopologyLevel const& level,
                                         std::span<double const> edgeStars,
                                         std::span<Pin const> pins) {
    auto const components = far_ext::FaceComponents::Find(level);
    auto const findComponent = [&](Index vertex) {
        auto const faces = level.GetVertexFaces(vertex);
        return faces.size() > 0 ? components.ofFace[faces[0]] : -1;
    };
    auto const count = static_cast<size_t>(level.GetNumVertices());
    std::vector<double> values(count, 0.0), right(count, 0.0);
    std::vector<char> isFixed(count, 0), hasPin(components.count, 0);
    for (Pin const& pin : pins) {
        values[pin.vertex] = pin.value;
        isFixed[pin.vertex] = 1;
        if (findComponent(pin.vertex) >= 0) hasPin[findComponent(pin.vertex)] = 1;
    }
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        int const component = findComponent(vertex);
        if (component < 0 || !hasPin[component]) isFixed[vertex] = 1;
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        AddEdge(ends[0], ends[1], edgeStars[edge], entries);
        double const flow = edgeStars[edge] * (values[ends[1]] - values[ends[0]]);
        right[ends[0]] += flow;
        right[ends[1]] -= flow;
    }
    LaplaceSolver solver(isFixed, entries);
    auto const between = solver.Solve(right);
    for (size_t i = 0; i < count; ++i) {
        if (!isFixed[i]) values[i] = between[i];
    }
    return values;
}

}  // namespace limn::eval
