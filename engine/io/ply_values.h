// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "engine/io/ply_header.h"
#include "engine/io/skipped_lines.h"
#include "engine/io/text_scanner.h"
#include "far_ext/error.h"

namespace limn::engine {

/// The values of a PLY file behind its header, one after another: words of text, or bytes.
class PlyValues {
public:
    /// \param scan  stands on the header's last line; kept by reference
    PlyValues(TextScanner& scan, PlyHeader::Format format) : _scan(scan), _format(format) {
        if (!IsText()) _bytes = scan.GetBytesBehind();
    }

    bool IsText() const { return _format == PlyHeader::Format::Text; }

    /// A count in a header is a claim: what its rows take at least must be in the file.
    /// \throws Error BadMesh
    void CheckRoom(PlyElement const& element) const {
        size_t rowSize = 0;  // a digit and a space per word, or the sizes of the types
        for (PlyProperty const& property : element.properties)
            rowSize += IsText() ? 2 : SizeOf(property.countType.value_or(property.type));
        size_t const rest = IsText() ? _scan.GetRest().size() + 1 : _bytes.size();
        if (rowSize == 0 ? element.count > 0 : rest / rowSize < element.count) {
            throw Error(
                ErrorCode::BadMesh,
                fmt::format("{}:{}: the file is too short for {} of element '{}'", _scan.GetPath(),
                            _scan.GetLineNumber(), element.count, element.name));
        }
    }

    /// Begins a row of an element. \throws Error BadMesh: the text ends before
    void BeginRow(PlyElement const& element, size_t index) {
        _element = element.name.c_str();
        _index = index;
        if (!IsText()) return;
        do {
            if (!_scan.NextLine()) {
                _scan.Refuse(fmt::format("the file ends before {} {} of {}", element.name, index,
                                         element.count));
            }
        } while (_scan.AtEndOfLine());
    }

    /// Ends a row. \throws Error BadMesh: its line of text has more than the header names
    void EndRow() const {
        if (!IsText() || _scan.AtEndOfLine()) return;
        Refuse(fmt::format("{} {} has more values than the header names, {} the first of them",
                           _element, _index, TextScanner::Quote(_scan.Word())));
    }

    /// What follows the last row, for a warning: "7 bytes"; empty where it is white space.
    std::string DescribeRest() {
        if (IsText()) {
            SkippedLines lines;
            while (_scan.NextLine()) {
                if (!_scan.AtEndOfLine()) lines.Add(_scan.Word(), _scan.GetLineNumber());
            }
            return lines.GetCount() == 0 ? "" : lines.DescribeCount();
        }
        size_t const last = _bytes.find_last_not_of(" \t\r\n");
        return last == _bytes.npos ? "" : fmt::format("{} byte{}", last + 1, last == 0 ? "" : "s");
    }

    /// \param what    its name, for messages
    /// \throws Error  BadMesh
    double Read(PlyType type, char const* what) {
        if (IsText()) return _scan.Number(what);
        switch (type) {
            case PlyType::Int8:
                return Take<int8_t>();
            case PlyType::Uint8:
                return Take<uint8_t>();
            case PlyType::Int16:
                return Take<int16_t>();
            case PlyType::Uint16:
                return Take<uint16_t>();
            case PlyType::Int32:
                return Take<int32_t>();
            case PlyType::Uint32:
                return Take<uint32_t>();
            case PlyType::Float32:
                return static_cast<double>(Take<float>());
            case PlyType::Float64:
                return Take<double>();
        }
        return 0.0;
    }

    /// How many values of a property come next: a list's length, else 1. \throws Error BadMesh
    size_t ReadCount(PlyProperty const& property) {
        if (!property.countType) return 1;
        double const count = Read(*property.countType, "a list's length");
        if (!(count >= 0) || count != std::floor(count) || count > 1e9)
            Refuse(fmt::format("list '{}' has length {}", property.name, count));
        if (!IsText() && count * static_cast<double>(SizeOf(property.type)) >
                             static_cast<double>(_bytes.size())) {
            Refuse(fmt::format("list '{}' of length {} goes beyond the end of the file",
                               property.name, count));
        }
        return static_cast<size_t>(count);
    }

    /// Names the line, or the row where there are no lines.
    [[noreturn]] void Refuse(std::string const& message) const {
        if (IsText()) _scan.Refuse(message);
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: {} {}: {}", _scan.GetPath(), _element, _index, message));
    }

    /// Of the row, in text.
    uint32_t GetLineNumber() const { return _scan.GetLineNumber(); }

private:
    template <class T>
    T Take() {
        if (_bytes.size() < sizeof(T)) Refuse("the file ends here; it seems cut short");
        char raw[sizeof(T)];
        std::copy_n(_bytes.begin(), sizeof raw, raw);
        _bytes.remove_prefix(sizeof raw);
        if (_format == PlyHeader::Format::BigEndian) std::reverse(raw, raw + sizeof raw);
        T value;
        std::memcpy(&value, raw, sizeof value);
        return value;
    }

    TextScanner& _scan;
    PlyHeader::Format _format;
    std::string_view _bytes;  // what is left of them
    char const* _element = "header";
    size_t _index = 0;
};

}  // namespace limn::engine
