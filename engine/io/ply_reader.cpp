// SPDX-License-Identifier: Apache-2.0
#include "engine/io/ply_reader.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <tuple>

#include "engine/io/text_scanner.h"

namespace limn::engine {

namespace {

enum class Type { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

std::optional<Type> ParseType(std::string_view name) {
    struct Row {
        char const *one, *other;
        Type type;
    };
    constexpr Row kTypes[] = {
        {"char", "int8", Type::Int8},        {"uchar", "uint8", Type::Uint8},
        {"short", "int16", Type::Int16},     {"ushort", "uint16", Type::Uint16},
        {"int", "int32", Type::Int32},       {"uint", "uint32", Type::Uint32},
        {"float", "float32", Type::Float32}, {"double", "float64", Type::Float64}};
    for (Row const& row : kTypes) {
        if (name == row.one || name == row.other) return row.type;
    }
    return std::nullopt;
}

constexpr size_t SizeOf(Type type) {
    constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<int>(type)];
}

struct Property {
    std::string name;
    Type type = Type::Float32;
    std::optional<Type> countType;  // of a list
};

struct Element {
    std::string name;
    size_t count = 0;
    std::vector<Property> properties;
};

/// Where values come from: words of text, or bytes.
class PlyReader {
public:
    PlyReader(std::string_view bytes, Scene& scene)
        : _bytes(bytes), _scene(scene), _scan(bytes, scene.path) {}

    void Read() {
        ReadHeader();
        for (Element const& element : _elements) {
            if (element.name == "vertex")
                ReadVertices(element);
            else if (element.name == "face")
                ReadFaces(element);
            else
                SkipElement(element);
        }
        Finish();
    }

private:
    enum class Format { Text, LittleEndian, BigEndian };

    [[noreturn]] void Refuse(std::string const& message) const {
        if (_isInBody && _format != Format::Text) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: {} {}: {}", _scene.path, _element, _index, message));
        }
        _scan.Refuse(message);
    }

    void ReadHeader() {
        if (!_scan.NextLine() || _scan.Word() != "ply")
            Refuse("the file does not start with 'ply'");
        bool hasFormat = false;
        for (;;) {
            if (!_scan.NextLine()) Refuse("the header has no 'end_header'");
            std::string_view const word = _scan.Word();
            if (word == "end_header") break;
            if (word == "format")
                hasFormat = ReadFormat();
            else if (word == "element")
                ReadElement();
            else if (word == "property")
                ReadProperty();
            else if (word != "comment" && word != "obj_info" && !word.empty()) {
                Refuse(fmt::format("{} has no place in a PLY header", TextScanner::Quote(word)));
            }
        }
        if (!hasFormat) Refuse("the header has no 'format' line");
        _isInBody = true;
        if (_format != Format::Text) _at = _bytes.size() - _scan.GetRest().size();
    }

    bool ReadFormat() {
        std::string_view const word = _scan.Word();
        if (word == "ascii")
            _format = Format::Text;
        else if (word == "binary_little_endian")
            _format = Format::LittleEndian;
        else if (word == "binary_big_endian")
            _format = Format::BigEndian;
        else
            Refuse(fmt::format("format {} is not ascii, binary_little_endian or binary_big_endian",
                               TextScanner::Quote(word)));
        return true;
    }

    void ReadElement() {
        Element element;
        element.name = std::string(_scan.Word());
        double const count = _scan.Number("an element's count");
        if (count < 0 || count != std::floor(count) ||
            count > std::numeric_limits<Index>::max() / 4) {
            Refuse(fmt::format("element {} has count {}; 0 to {} are possible",
                               TextScanner::Quote(element.name), count,
                               std::numeric_limits<Index>::max() / 4));
        }
        element.count = static_cast<size_t>(count);
        _elements.push_back(std::move(element));
    }

    void ReadProperty() {
        if (_elements.empty()) Refuse("a property stands before the first element");
        Property property;
        std::string_view word = _scan.Word();
        auto const type = [&](std::string_view name) {
            auto const found = ParseType(name);
            if (!found)
                Refuse(fmt::format("property type {} is not known", TextScanner::Quote(name)));
            return *found;
        };
        if (word == "list") {
            property.countType = type(_scan.Word());
            word = _scan.Word();
        }
        property.type = type(word);
        property.name = std::string(_scan.Word());
        _elements.back().properties.push_back(std::move(property));
    }

    // -------- values

    void BeginRow(Element const& element, size_t index) {
        _element = element.name.c_str();
        _index = index;
        if (_format == Format::Text) {
            do {
                if (!_scan.NextLine()) {
                    Refuse(fmt::format("the file ends before {} {} of {}", element.name, index,
                                       element.count));
                }
            } while (_scan.AtEndOfLine());
        }
    }

    double ReadValue(Type type, char const* what) {
        if (_format == Format::Text) return _scan.Number(what);
        size_t const size = SizeOf(type);
        if (_bytes.size() - _at < size) Refuse("the file ends here; it seems cut short");
        unsigned char raw[8];
        std::memcpy(raw, _bytes.data() + _at, size);
        _at += size;
        if (_format == Format::BigEndian) std::reverse(raw, raw + size);
        switch (type) {
            case Type::Int8:
                return As<int8_t>(raw);
            case Type::Uint8:
                return As<uint8_t>(raw);
            case Type::Int16:
                return As<int16_t>(raw);
            case Type::Uint16:
                return As<uint16_t>(raw);
            case Type::Int32:
                return As<int32_t>(raw);
            case Type::Uint32:
                return As<uint32_t>(raw);
            case Type::Float32:
                return As<float>(raw);
            case Type::Float64:
                return As<double>(raw);
        }
        return 0.0;
    }

    template <class T>
    static double As(unsigned char const* raw) {
        T value;
        std::memcpy(&value, raw, sizeof value);
        return static_cast<double>(value);
    }

    size_t ReadCount(Property const& property) {
        double const count = ReadValue(*property.countType, "a list's length");
        if (!(count >= 0) || count != std::floor(count) || count > 1e9) {
            Refuse(fmt::format("list '{}' has length {}", property.name, count));
        }
        if (_format != Format::Text && count * static_cast<double>(SizeOf(property.type)) >
                                           static_cast<double>(_bytes.size() - _at)) {
            Refuse(fmt::format("list '{}' of length {} goes beyond the end of the file",
                               property.name, count));
        }
        return static_cast<size_t>(count);
    }

    void SkipElement(Element const& element) {
        CheckRoom(element);
        for (size_t i = 0; i < element.count; ++i) {
            BeginRow(element, i);
            for (Property const& property : element.properties) {
                size_t const count = property.countType ? ReadCount(property) : 1;
                for (size_t k = 0; k < count; ++k) ReadValue(property.type, property.name.c_str());
            }
        }
    }

    /// Where a vertex property goes: position 0-2, texture 3-4, primvar channel, or nowhere.
    struct Target {
        enum { Nowhere, Position, Texture, Value } kind = Nowhere;
        int channel = 0;
        size_t primvar = 0;
        double scale = 1.0;
    };

    Target FindTarget(Element const& element, Property const& property) {
        std::string const& name = property.name;
        auto const has = [&](char const* other) {
            return std::any_of(element.properties.begin(), element.properties.end(),
                               [&](Property const& p) { return p.name == other; });
        };
        if (property.countType || name == "nx" || name == "ny" || name == "nz") return {};
        for (int c = 0; c < 3; ++c) {
            if (name == std::string(1, "xyz"[c])) return {Target::Position, c};
        }
        for (auto const& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
            if (has(u) && has(v) && (name == u || name == v)) {
                _hasVertexUVs = true;
                return {Target::Texture, name == v};
            }
        }
        static char const* const kColours[] = {"red", "green", "blue", "alpha"};
        for (int c = 0; c < 4; ++c) {
            if (name != kColours[c] || !(has("red") && has("green") && has("blue"))) continue;
            size_t const primvar = FindPrimvar("color", has("alpha") ? 4 : 3);
            double const scale = property.type == Type::Uint8    ? 1.0 / 255
                                 : property.type == Type::Uint16 ? 1.0 / 65535
                                                                 : 1.0;
            return {Target::Value, c, primvar, scale};
        }
        return {Target::Value, 0, FindPrimvar(name, 1)};
    }

    size_t FindPrimvar(std::string const& name, int numChannels) {
        for (size_t i = 0; i < _scene.primvars.size(); ++i) {
            if (_scene.primvars[i].name != name) continue;
            if (_scene.primvars[i].numChannels == numChannels) return i;
            Refuse(
                fmt::format("two vertex properties both make the primvar '{}'; rename one", name));
        }
        _scene.primvars.push_back({name, numChannels, {}});
        return _scene.primvars.size() - 1;
    }

    void ReadVertices(Element const& element) {
        std::vector<Target> targets;
        bool hasAxis[3] = {false, false, false};
        for (Property const& property : element.properties) {
            targets.push_back(FindTarget(element, property));
            if (targets.back().kind == Target::Position) hasAxis[targets.back().channel] = true;
        }
        if (!hasAxis[0] || !hasAxis[1] || !hasAxis[2]) Refuse("element vertex lacks x, y or z");
        CheckRoom(element);
        _scene.positions.resize(3 * element.count);
        if (_hasVertexUVs) _scene.uvs.resize(2 * element.count);
        for (Primvar& primvar : _scene.primvars) {
            primvar.values.resize(element.count * static_cast<size_t>(primvar.numChannels));
        }
        for (size_t i = 0; i < element.count; ++i) {
            BeginRow(element, i);
            for (size_t p = 0; p < targets.size(); ++p)
                ReadVertexValue(element.properties[p], targets[p], i);
        }
        _scene.cage.numVertices = static_cast<Index>(element.count);
    }

    void ReadVertexValue(Property const& property, Target const& target, size_t vertex) {
        size_t const count = property.countType ? ReadCount(property) : 1;
        for (size_t k = 0; k < count; ++k) {
            double const value = ReadValue(property.type, property.name.c_str());
            size_t const channel = static_cast<size_t>(target.channel);
            if (target.kind != Target::Nowhere && !(std::abs(value) <= TextScanner::kLargest)) {
                Refuse(fmt::format("property '{}' is {}; a number up to {:g} is needed",
                                   property.name, value, TextScanner::kLargest));
            }
            if (target.kind == Target::Position) _scene.positions[3 * vertex + channel] = value;
            if (target.kind == Target::Texture) _scene.uvs[2 * vertex + channel] = value;
            if (target.kind == Target::Value) {
                Primvar& primvar = _scene.primvars[target.primvar];
                primvar.values[vertex * static_cast<size_t>(primvar.numChannels) + channel] =
                    static_cast<float>(value * target.scale);
            }
        }
    }

    static bool IsIndexList(Property const& property) {
        return property.countType &&
               (property.name == "vertex_indices" || property.name == "vertex_index");
    }

    /// A count in a header is a claim; what it needs at least must be in the file.
    void CheckRoom(Element const& element) const {
        size_t rowSize =
            0;  // least bytes of a row: a digit and a space per word, or the sizes of the types
        for (Property const& property : element.properties) {
            bool const isText = _format == Format::Text;
            rowSize +=
                isText ? 2 : SizeOf(property.countType ? *property.countType : property.type);
        }
        size_t const rest =
            _format == Format::Text ? _scan.GetRest().size() + 1 : _bytes.size() - _at;
        if (rowSize == 0 ? element.count > 0 : rest / rowSize < element.count) {
            Refuse(fmt::format("the file is too short for {} of element '{}'", element.count,
                               element.name));
        }
    }

    void ReadFaces(Element const& element) {
        auto const numLists =
            std::count_if(element.properties.begin(), element.properties.end(), IsIndexList);
        if (numLists != 1)
            Refuse(
                fmt::format("element face has {} lists 'vertex_indices'; one is needed", numLists));
        if (_scene.positions.empty())
            Refuse("the faces stand before the vertices, or there are no vertices");
        CheckRoom(element);
        auto& cage = _scene.cage;
        for (size_t i = 0; i < element.count; ++i) {
            BeginRow(element, i);
            size_t size = 0;
            std::vector<double> texcoords;
            for (Property const& property : element.properties) {
                bool const isIndices = IsIndexList(property);
                bool const isTexture = property.countType && property.name == "texcoord";
                size_t const count = property.countType ? ReadCount(property) : 1;
                if (isIndices) size = count;
                for (size_t k = 0; k < count; ++k) {
                    double const value = ReadValue(property.type, property.name.c_str());
                    if (isIndices) cage.faceVertices.push_back(CheckIndex(value));
                    if (isTexture) texcoords.push_back(CheckFinite(value));
                }
            }
            if (size < 3) Refuse(fmt::format("a face has {} corners; at least 3 are needed", size));
            cage.faceSizes.push_back(static_cast<int>(size));
            if (_format == Format::Text) _scene.faceLines.push_back(_scan.GetLineNumber());
            AddTexcoords(texcoords, size);
        }
    }

    Index CheckIndex(double value) const {
        if (!(value >= 0) || value >= _scene.cage.numVertices || value != std::floor(value)) {
            Refuse(fmt::format("a face uses vertex {}; 0 to {} are possible", value,
                               _scene.cage.numVertices - 1));
        }
        return static_cast<Index>(value);
    }

    double CheckFinite(double value) const {
        if (!(std::abs(value) <= TextScanner::kLargest)) {
            Refuse(fmt::format("a texture coordinate is {}; a number up to {:g} is needed", value,
                               TextScanner::kLargest));
        }
        return value;
    }

    /// Corner coordinates become values, one for each distinct (vertex, u, v).
    void AddTexcoords(std::vector<double> const& texcoords, size_t size) {
        if (texcoords.empty()) {
            ++_numFacesWithoutUVs;
            return;
        }
        if (texcoords.size() != 2 * size) {
            Refuse(fmt::format("list 'texcoord' has {} numbers; {} are needed", texcoords.size(),
                               2 * size));
        }
        _cornerUVs.insert(_cornerUVs.end(), texcoords.begin(), texcoords.end());
    }

    void Finish() {
        auto& cage = _scene.cage;
        if (cage.faceSizes.empty()) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: the file has no faces; limn needs polygons", _scene.path));
        }
        if (!_cornerUVs.empty() && _numFacesWithoutUVs != 0) {
            _scene.warnings.push_back(fmt::format(
                "{}: {} of {} faces have no 'texcoord', so those of the others are not used",
                _scene.path, _numFacesWithoutUVs, cage.faceSizes.size()));
        }
        if (!_cornerUVs.empty() && _numFacesWithoutUVs == 0) {
            MergeCornerUVs();
        } else if (_hasVertexUVs) {
            cage.fvarChannels.push_back({cage.numVertices, cage.faceVertices});
        }
    }

    void MergeCornerUVs() {
        auto& cage = _scene.cage;
        std::vector<Index> order(cage.faceVertices.size());
        for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
        auto const key = [&](Index corner) {
            return std::tuple(cage.faceVertices[corner], _cornerUVs[2 * corner],
                              _cornerUVs[2 * corner + 1], corner);
        };
        std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
        far_ext::FVarChannel channel;
        channel.valueIndices.resize(order.size());
        _scene.uvs.clear();
        for (size_t i = 0; i < order.size(); ++i) {
            auto const same = [&](Index a, Index b) {
                return cage.faceVertices[a] == cage.faceVertices[b] &&
                       _cornerUVs[2 * a] == _cornerUVs[2 * b] &&
                       _cornerUVs[2 * a + 1] == _cornerUVs[2 * b + 1];
            };
            if (i == 0 || !same(order[i - 1], order[i])) {
                _scene.uvs.push_back(_cornerUVs[2 * order[i]]);
                _scene.uvs.push_back(_cornerUVs[2 * order[i] + 1]);
                ++channel.numValues;
            }
            channel.valueIndices[order[i]] = channel.numValues - 1;
        }
        cage.fvarChannels.push_back(std::move(channel));
    }

    std::string_view _bytes;
    Scene& _scene;
    TextScanner _scan;
    Format _format = Format::Text;
    std::vector<Element> _elements;
    bool _isInBody = false, _hasVertexUVs = false;
    char const* _element = "header";
    size_t _index = 0, _at = 0, _numFacesWithoutUVs = 0;
    std::vector<double> _cornerUVs;
};

}  // namespace

void ReadPly(std::string_view bytes, Scene& scene) {
    PlyReader(bytes, scene).Read();
}

}  // namespace limn::engine
