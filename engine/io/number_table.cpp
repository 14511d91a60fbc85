// SPDX-License-Identifier: Apache-2.0
#include "engine/io/number_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/io/file.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

std::string_view Trim(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

std::vector<std::string_view> SplitAtCommas(std::string_view line) {
    std::vector<std::string_view> fields;
    for (size_t start = 0; start <= line.size();) {
        size_t const comma = std::min(line.find(',', start), line.size());
        fields.push_back(Trim(line.substr(start, comma - start)));
        start = comma + 1;
    }
    return fields;
}

/// Where a layout's columns stand in a header; nothing if one is missing.
std::optional<std::vector<size_t>> FindColumns(std::vector<std::string_view> const& header,
                                               std::vector<std::string> const& layout) {
    std::vector<size_t> columns;
    for (std::string const& name : layout) {
        auto const found = std::find(header.begin(), header.end(), name);
        if (found == header.end()) return {};
        columns.push_back(static_cast<size_t>(found - header.begin()));
    }
    return columns;
}

}  // namespace

NumberTable ReadNumberTable(std::string const& path,
                            std::vector<std::vector<std::string>> const& layouts) {
    InputFile const file(path);
    std::string_view rest = file.GetBytes();
    std::string wanted;
    for (auto const& layout : layouts)
        wanted += fmt::format("{}{}", wanted.empty() ? "" : " or ", fmt::join(layout, ","));
    NumberTable table;
    std::vector<size_t> columns;
    for (size_t line = 1; !rest.empty(); ++line) {
        size_t const end = std::min(rest.find('\n'), rest.size());
        std::string_view const text = Trim(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (text.empty()) continue;
        auto const fields = SplitAtCommas(text);
        if (columns.empty()) {
            for (size_t i = 0; i < layouts.size() && columns.empty(); ++i) {
                if (auto const found = FindColumns(fields, layouts[i])) {
                    columns = *found;
                    table.layout = i;
                }
            }
            if (columns.empty())
                throw Error(
                    ErrorCode::BadMesh,
                    fmt::format("{}:{}: the header needs the columns {}", path, line, wanted));
            table.numColumns = columns.size();
            continue;
        }
        for (size_t c = 0; c < columns.size(); ++c) {
            std::string_view const field =
                columns[c] < fields.size() ? fields[columns[c]] : std::string_view();
            double value = 0.0;
            auto const [stop, code] =
                std::from_chars(field.data(), field.data() + field.size(), value);
            if (code != std::errc() || stop != field.data() + field.size() ||
                !std::isfinite(value)) {
                throw Error(ErrorCode::BadMesh,
                            fmt::format("{}:{}: '{}' in column {} is no number", path, line, field,
                                        layouts[table.layout][c]));
            }
            table.values.push_back(value);
        }
        table.lines.push_back(line);
    }
    if (columns.empty())
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: the file is empty; a header {} is needed", path, wanted));
    return table;
}

int GetIndex(NumberTable const& table, std::string const& path, size_t row, size_t column,
             int count, char const* what) {
    double const value = table.Get(row, column);
    if (!(value >= 0.0 && value < count) || value != std::floor(value)) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}:{}: {} {} does not exist; there are 0 to {}", path,
                                table.lines[row], what, value, count - 1));
    }
    return static_cast<int>(value);
}

}  // namespace limn::engine
