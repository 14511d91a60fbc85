// SPDX-License-Identifier: Apache-2.0
#include "engine/io/number_table.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/io/file.h"
#include "engine/io/file_kind.h"
#include "engine/io/text_scanner.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

using Layout = std::vector<std::string>;

std::string_view Trim(std::string_view text) {
    while (!text.empty() && TextScanner::IsSpace(text.front())) text.remove_prefix(1);
    while (!text.empty() && TextScanner::IsSpace(text.back())) text.remove_suffix(1);
    return text;
}

/// True for names that differ in capital letters at most.
bool AreAlike(std::string_view a, std::string_view b) {
    auto const lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return std::ranges::equal(a, b, {}, lower, lower);
}

/// A column without the words it may hold.
std::string GetName(std::string const& column) {
    return column.substr(0, column.find('='));
}

class TableReader {
public:
    TableReader(std::string_view text, std::string const& path, std::vector<Layout> const& layouts)
        : _text(text), _scan(text, path), _layouts(layouts) {}

    NumberTable Read() {
        ReadHeader();
        while (NextLine()) {
            Split();
            RefuseSurplusFields();
            for (size_t c = 0; c < _columns.size(); ++c) {
                std::string_view const field =
                    _columns[c] < _fields.size() ? _fields[_columns[c]] : std::string_view();
                _table.values.push_back(ToNumber(field, _layouts[_table.layout][c]));
            }
            _table.lines.push_back(_scan.GetLineNumber());
        }
        return std::move(_table);
    }

private:
    /// Moves to the next line that is not empty; false at the end.
    bool NextLine() {
        do {
            if (!_scan.NextLine()) return false;
            _line = _scan.RestOfLine();
        } while (_line.empty());
        return true;
    }

    /// The line into its fields.
    void Split() {
        std::string_view const line = _line;
        _fields.clear();
        size_t start = 0;
        do {
            while (start < line.size() && TextScanner::IsSpace(line[start])) ++start;
            bool const isQuoted = start < line.size() && line[start] == '"';
            size_t const closing = isQuoted ? FindClosingQuote(line, start) : start;
            size_t const end = std::min(line.find(_separator, closing), line.size());
            if (isQuoted && !Trim(line.substr(closing + 1, end - closing - 1)).empty())
                _scan.Refuse("text stands behind the quote that ends a field");
            _fields.push_back(isQuoted ? Trim(line.substr(start + 1, closing - start - 1))
                                       : Trim(line.substr(start, end - start)));
            start = end + 1;
        } while (start <= line.size());
    }

    /// Of a field that begins at `start`; two quotes side by side stand for one.
    size_t FindClosingQuote(std::string_view line, size_t start) const {
        for (size_t at = start + 1; at < line.size(); ++at) {
            if (line[at] != '"') continue;
            if (at + 1 == line.size() || line[at + 1] != '"') return at;
            ++at;
        }
        _scan.Refuse("a quoted field does not end on its line");
    }

    void ReadHeader() {
        std::string wanted;
        for (Layout const& layout : _layouts) {
            Layout names;
            for (std::string const& column : layout) names.push_back(GetName(column));
            wanted += fmt::format("{}{}", wanted.empty() ? "" : " or ", fmt::join(names, ","));
        }
        if (!NextLine()) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: the file is empty; a header {} is needed", _scan.GetPath(),
                                    wanted));
        }
        // Spreadsheets write semicolons where commas are decimal points.
        for (char separator : {',', ';'}) {
            _separator = separator;
            if (FindLayout()) return;
        }
        RefuseForeignFile(_text, _scan.GetPath(), "a table (CSV)");
        _scan.Refuse(fmt::format("the header needs the columns {}", wanted));
    }

    /// Where a row has more than the header names, a number may stand in the wrong column: 0,5 is
    /// two fields. Empty ones hold nothing; spreadsheets write them.
    void RefuseSurplusFields() const {
        auto const surplus = std::span(_fields).subspan(std::min(_numNames, _fields.size()));
        if (std::ranges::all_of(surplus, [](std::string_view field) { return field.empty(); }))
            return;
        _scan.Refuse(fmt::format("the row has {} fields; the header names {} columns",
                                 _fields.size(), _numNames));
    }

    /// True if the header, split at the separator, has all columns of one of the layouts.
    bool FindLayout() {
        Split();
        for (_table.layout = 0; _table.layout < _layouts.size(); ++_table.layout) {
            if (!FindColumns(_layouts[_table.layout])) continue;
            _table.numColumns = _columns.size();
            _numNames = _fields.size();
            return true;
        }
        return false;
    }

    /// True if the header has all of a layout's columns.
    bool FindColumns(Layout const& layout) {
        _columns.clear();
        for (std::string const& name : layout) {
            auto const column = FindColumn(GetName(name));
            if (!column) return false;
            _columns.push_back(*column);
        }
        return true;
    }

    /// A column by its very name, else by one that differs in capital letters.
    std::optional<size_t> FindColumn(std::string const& name) const {
        auto const isSame = [&](std::string_view field) { return field == name; };
        auto const isAlike = [&](std::string_view field) { return AreAlike(field, name); };
        auto const column = FindOnly(isSame, name);
        return column ? column : FindOnly(isAlike, name);
    }

    template <class Fits>
    std::optional<size_t> FindOnly(Fits fits, std::string const& name) const {
        auto const found = std::ranges::find_if(_fields, fits);
        if (found == _fields.end()) return std::nullopt;
        if (std::find_if(found + 1, _fields.end(), fits) != _fields.end())
            _scan.Refuse(fmt::format("the header has column '{}' twice", name));
        return static_cast<size_t>(found - _fields.begin());
    }

    double ToNumber(std::string_view field, std::string const& column) const {
        if (size_t const equals = column.find('='); equals != std::string::npos)
            return ToWord(field, column.substr(0, equals), column.substr(equals + 1));
        auto const parsed = TextScanner::ParseNumber(field);
        bool const isAll = parsed.length == field.size();
        if (parsed.IsNumber() && isAll) return parsed.value;
        if (parsed.IsUnheld() && isAll) {
            _scan.Refuse(fmt::format("{} in column {} is {}", TextScanner::Quote(field), column,
                                     DescribeUnheld(field)));
        }
        bool const hasComma = field.find(',') != std::string_view::npos;
        _scan.Refuse(fmt::format("{} in column {} is no number{}", TextScanner::Quote(field),
                                 column, hasComma ? "; write a decimal point, not a comma" : ""));
    }

    /// Which of the words, parted by bars, a field is.
    double ToWord(std::string_view field, std::string const& column, std::string_view words) const {
        double number = 0.0;
        for (size_t start = 0; start <= words.size(); number += 1.0) {
            size_t const end = std::min(words.find('|', start), words.size());
            if (AreAlike(field, words.substr(start, end - start))) return number;
            start = end + 1;
        }
        _scan.Refuse(
            fmt::format("{} in column {} is none of {}", TextScanner::Quote(field), column, words));
    }

    std::string_view _text;
    TextScanner _scan;
    std::vector<Layout> const& _layouts;
    NumberTable _table;
    char _separator = ',';
    std::string_view _line;
    std::vector<std::string_view> _fields;  // of the line
    std::vector<size_t> _columns;           // of the layout, among the fields
    size_t _numNames = 0;                   // in the header
};

}  // namespace

NumberTable ReadNumberTable(std::string const& path,
                            std::vector<std::vector<std::string>> const& layouts) {
    InputFile const file(path);
    return TableReader(file.GetBytes(), path, layouts).Read();
}

int GetIndex(NumberTable const& table, std::string const& path, size_t row, size_t column,
             int count, char const* what) {
    double const value = table.Get(row, column);
    if (value != std::floor(value)) {
        throw Error(ErrorCode::BadMesh, fmt::format("{}:{}: {} {} is no whole number", path,
                                                    table.lines[row], what, value));
    }
    if (!(value >= 0.0 && value < count)) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}:{}: {} {} does not exist; there are 0 to {}", path,
                                table.lines[row], what, value, count - 1));
    }
    return static_cast<int>(value);
}

}  // namespace limn::engine
