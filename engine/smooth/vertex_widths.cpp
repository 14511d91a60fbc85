// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/vertex_widths.h"

#include <fmt/format.h>

#include "engine/io/number_table.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

VertexWidths MakeLocalWidths(Model const& model, double scale) {
    auto const& level = model.GetLevel();
    far_ext::Points const points(model.GetPositions());
    std::vector<double> means(level.GetNumVertices(), 0.0);
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        auto const edges = level.GetVertexEdges(vertex);
        for (Index edge : edges) {
            auto const ends = level.GetEdgeVertices(edge);
            means[vertex] += scale * (points[ends[0]] - points[ends[1]]).norm() / edges.size();
        }
    }
    return {std::move(means)};
}

VertexWidths ReadVertexWidths(std::string const& path, Model const& model) {
    auto const table = ReadNumberTable(path, {{"vertex", "width"}});
    Index const numVertices = model.GetCage().numVertices;
    std::vector<double> widths(numVertices, 0.0);
    std::vector<size_t> lines(widths.size(), 0);
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        Index const vertex = GetIndex(table, path, row, 0, numVertices, "vertex");
        if (lines[vertex] > 0) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}:{}: vertex {} comes twice, first in line {}", path,
                                    table.lines[row], vertex, lines[vertex]));
        }
        lines[vertex] = table.lines[row];
        widths[vertex] = table.Get(row, 1);
        CheckWidth(widths[vertex], path, table.lines[row]);
    }
    return {std::move(widths)};
}

void CheckWidth(double width, std::string const& path, size_t line) {
    if (width >= 0.0) return;
    throw Error(
        ErrorCode::BadMesh,
        fmt::format("{}:{}: width {} is negative; a filter width is 0 or more", path, line, width));
}

}  // namespace limn::engine
