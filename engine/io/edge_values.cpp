// SPDX-License-Identifier: Apache-2.0
#include "engine/io/edge_values.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "engine/io/number_table.h"
#include "far_ext/error.h"
#include "far_ext/forms/form_operators.h"

namespace limn::engine {

namespace {

/// Rows of a table whose first two columns are v0 and v1.
std::vector<EdgeValue> FindEdges(NumberTable const& table, std::string const& path,
                                 Far::TopologyLevel const& level) {
    std::vector<EdgeValue> values;
    std::vector<size_t> lineOfEdge(static_cast<size_t>(level.GetNumEdges()), 0);
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        int const count = level.GetNumVertices();
        Index const from = GetIndex(table, path, row, 0, count, "vertex"),
                    to = GetIndex(table, path, row, 1, count, "vertex");
        Index const edge = level.FindEdge(from, to);
        if (edge == Far::INDEX_INVALID) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}:{}: there is no edge from vertex {} to {}", path,
                                    table.lines[row], from, to));
        }
        if (lineOfEdge[edge] > 0) {
            throw Error(
                ErrorCode::BadMesh,
                fmt::format("{}:{}: the edge from vertex {} to {} comes twice, first in line {}",
                            path, table.lines[row], from, to, lineOfEdge[edge]));
        }
        lineOfEdge[edge] = table.lines[row];
        values.push_back({edge, from, to, 0.0, table.lines[row]});
    }
    return values;
}

}  // namespace

std::vector<EdgeValue> ReadEdgeList(std::string const& path, Far::TopologyLevel const& level) {
    return FindEdges(ReadNumberTable(path, {{"v0", "v1"}}), path, level);
}

std::vector<EdgeValue> ReadEdgeTable(std::string const& path, char const* column,
                                     Far::TopologyLevel const& level, char const* kinds) {
    std::vector<std::string> layout{"v0", "v1", column};
    if (kinds) layout.push_back(std::string("kind=") + kinds);
    NumberTable const table = ReadNumberTable(path, {layout});
    auto values = FindEdges(table, path, level);
    for (size_t row = 0; row < values.size(); ++row) {
        values[row].value = table.Get(row, 2);
        if (kinds) values[row].kind = static_cast<int>(table.Get(row, 3));
    }
    return values;
}

std::vector<double> ReadEdgeValues(std::string const& path, Far::TopologyLevel const& level) {
    std::vector<double> form(static_cast<size_t>(level.GetNumEdges()), 0.0);
    for (EdgeValue const& row : ReadEdgeTable(path, "value", level))
        form[row.edge] = far_ext::GetSignFrom(level, row.edge, row.from) * row.value;
    return form;
}

std::string FormatEdgeValues(Far::TopologyLevel const& level, std::span<double const> form) {
    std::string text = "v0,v1,value\n";
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        fmt::format_to(std::back_inserter(text), "{},{},{}\n", std::min(ends[0], ends[1]),
                       std::max(ends[0], ends[1]), form[edge]);
    }
    return text;
}

}  // namespace limn::engine
