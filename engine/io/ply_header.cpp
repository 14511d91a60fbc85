// SPDX-License-Identifier: Apache-2.0
#include "engine/io/ply_header.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "far_ext/types.h"

namespace limn::engine {

namespace {

/// Properties are looked up by name among those of their element.
constexpr size_t kMaxProperties = 4096;

std::optional<PlyType> ParseType(std::string_view name) {
    struct Row {
        char const *one, *other;
        PlyType type;
    };
    constexpr Row kTypes[] = {
        {"char", "int8", PlyType::Int8},        {"uchar", "uint8", PlyType::Uint8},
        {"short", "int16", PlyType::Int16},     {"ushort", "uint16", PlyType::Uint16},
        {"int", "int32", PlyType::Int32},       {"uint", "uint32", PlyType::Uint32},
        {"float", "float32", PlyType::Float32}, {"double", "float64", PlyType::Float64}};
    for (Row const& row : kTypes) {
        if (name == row.one || name == row.other) return row.type;
    }
    return std::nullopt;
}

class HeaderReader {
public:
    explicit HeaderReader(TextScanner& scan) : _scan(scan) {}

    PlyHeader Read() {
        if (!_scan.NextLine() || _scan.Word() != "ply")
            _scan.Refuse("the file does not start with 'ply'");
        for (;;) {
            if (!_scan.NextLine()) _scan.Refuse("the header has no 'end_header'");
            std::string_view const word = _scan.Word();
            if (word == "end_header") break;
            ReadLine(word);
        }
        if (!_hasFormat) _scan.Refuse("the header has no 'format' line");
        return std::move(_header);
    }

private:
    void ReadLine(std::string_view word) {
        if (word == "format")
            ReadFormat();
        else if (word == "element")
            ReadElement();
        else if (word == "property")
            ReadProperty();
        else if (word == "comment")
            ReadComment();
        else if (word != "obj_info" && !word.empty())
            _scan.Refuse(fmt::format("{} has no place in a PLY header", TextScanner::Quote(word)));
    }

    void ReadFormat() {
        std::string_view const word = _scan.Word();
        if (word == "ascii")
            _header.format = PlyHeader::Format::Text;
        else if (word == "binary_little_endian")
            _header.format = PlyHeader::Format::LittleEndian;
        else if (word == "binary_big_endian")
            _header.format = PlyHeader::Format::BigEndian;
        else
            _scan.Refuse(
                fmt::format("format {} is not ascii, binary_little_endian or binary_big_endian",
                            TextScanner::Quote(word)));
        _hasFormat = true;
    }

    void ReadElement() {
        std::string const name(_scan.Word());
        double const count = _scan.Number("an element's count");
        if (count < 0 || count != std::floor(count) ||
            count > std::numeric_limits<Index>::max() / 4) {
            _scan.Refuse(fmt::format("element {} has count {}; 0 to {} are possible",
                                     TextScanner::Quote(name), count,
                                     std::numeric_limits<Index>::max() / 4));
        }
        // Values of unknown elements are read over, so what matters is that those looked for by
        // name are there once.
        if (_header.elements.size() == kMaxElements)
            _scan.Refuse(fmt::format("there are more than {} elements", kMaxElements));
        if (_header.Find(name))
            _scan.Refuse(fmt::format("element {} comes twice", TextScanner::Quote(name)));
        _header.elements.push_back({name, static_cast<size_t>(count)});
    }

    PlyType ToType(std::string_view name) const {
        auto const found = ParseType(name);
        if (!found)
            _scan.Refuse(fmt::format("property type {} is not known", TextScanner::Quote(name)));
        return *found;
    }

    void ReadProperty() {
        if (_header.elements.empty()) _scan.Refuse("a property stands before the first element");
        PlyElement& element = _header.elements.back();
        PlyProperty property;
        std::string_view word = _scan.Word();
        if (word == "list") {
            property.countType = ToType(_scan.Word());
            word = _scan.Word();
        }
        property.type = ToType(word);
        property.name = std::string(_scan.Word());
        if (std::ranges::any_of(property.name, [](unsigned char c) { return std::iscntrl(c); })) {
            _scan.Refuse(fmt::format("property name {} holds a control character",
                                     TextScanner::Quote(property.name)));
        }
        if (element.properties.size() == kMaxProperties) {
            _scan.Refuse(fmt::format("element {} has more than {} properties",
                                     TextScanner::Quote(element.name), kMaxProperties));
        }
        if (element.Has(property.name)) {
            _scan.Refuse(fmt::format("property {} of element {} comes twice",
                                     TextScanner::Quote(property.name),
                                     TextScanner::Quote(element.name)));
        }
        element.properties.push_back(std::move(property));
    }

    void ReadComment() {
        if (_scan.Word() == "TextureFile") _header.textureFiles.emplace_back(_scan.RestOfLine());
    }

    static constexpr size_t kMaxElements = 4096;

    TextScanner& _scan;
    PlyHeader _header;
    bool _hasFormat = false;
};

}  // namespace

bool PlyElement::Has(std::string_view property) const {
    return std::ranges::find(properties, property, &PlyProperty::name) != properties.end();
}

PlyElement const* PlyHeader::Find(std::string_view element) const {
    auto const found = std::ranges::find(elements, element, &PlyElement::name);
    return found == elements.end() ? nullptr : &*found;
}

PlyHeader ReadPlyHeader(TextScanner& scan) {
    return HeaderReader(scan).Read();
}

}  // namespace limn::engine
