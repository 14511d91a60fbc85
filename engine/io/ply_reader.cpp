// SPDX-License-Identifier: Apache-2.0
#include "engine/io/ply_reader.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <unordered_map>

#include "engine/io/ply_header.h"
#include "engine/io/ply_values.h"

namespace limn::engine {

namespace {

bool IsIndexList(PlyProperty const& property) {
    return property.countType &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// The names of an element's properties, for messages.
std::string ListProperties(PlyElement const& element) {
    constexpr size_t kMaxListed = 8;
    std::string names;
    for (size_t i = 0; i < std::min(kMaxListed, element.properties.size()); ++i)
        names += (i ? ", " : "") + TextScanner::Quote(element.properties[i].name);
    if (element.properties.size() > kMaxListed) names += ", ...";
    return names.empty() ? "none" : names;
}

class PlyReader {
public:
    PlyReader(std::string_view bytes, Scene& scene)
        : _scene(scene),
          _scan(bytes, scene.path),
          _header(ReadPlyHeader(_scan)),
          _values(_scan, _header.format) {}

    void Read() {
        CheckElements();
        for (PlyElement const& element : _header.elements) {
            _values.CheckRoom(element);
            if (element.name == "vertex")
                ReadVertices(element);
            else if (element.name == "face")
                ReadFaces(element);
            else if (element.name == "tristrips")
                ReadStrips(element);
            else
                SkipElement(element);
        }
        if (std::string const rest = _values.DescribeRest(); !rest.empty()) {
            _scene.warnings.push_back(fmt::format(
                "{}: {} behind the last row that the header counts, not read", _scene.path, rest));
        }
        Finish();
    }

private:
    /// What is needed is in the header, in any order.
    void CheckElements() {
        PlyElement const* const vertices = _header.Find("vertex");
        if (!vertices || vertices->count == 0)
            _scan.Refuse("the header has no element 'vertex', or says that there are none");
        for (char const* axis : {"x", "y", "z"}) {
            if (!vertices->Has(axis)) {
                _scan.Refuse(fmt::format("element vertex lacks '{}'; its properties are {}", axis,
                                         ListProperties(*vertices)));
            }
        }
        if (!_header.Find("face") && !_header.Find("tristrips")) {
            _scan.Refuse(
                "the header has no element 'face' or 'tristrips': these are points; limn needs "
                "polygons");
        }
        for (char const* name : {"face", "tristrips"}) {
            PlyElement const* const faces = _header.Find(name);
            if (!faces) continue;
            auto const numLists =
                std::count_if(faces->properties.begin(), faces->properties.end(), IsIndexList);
            if (numLists == 1) continue;
            _scan.Refuse(
                fmt::format("element {} has {} lists 'vertex_indices'; one is needed; its "
                            "properties are {}",
                            name, numLists, ListProperties(*faces)));
        }
        _scene.cage.numVertices = static_cast<Index>(vertices->count);
    }

    void SkipElement(PlyElement const& element) {
        for (size_t i = 0; i < element.count; ++i) {
            _values.BeginRow(element, i);
            for (PlyProperty const& property : element.properties) SkipProperty(property);
            _values.EndRow();
        }
    }

    void SkipProperty(PlyProperty const& property) {
        size_t const count = _values.ReadCount(property);
        for (size_t k = 0; k < count; ++k) _values.Read(property.type, property.name.c_str());
    }

    // -------- vertices

    /// Where a vertex property goes: position 0-2, texture 3-4, primvar channel, or nowhere.
    struct Target {
        enum class Kind { Nowhere, Position, Texture, Value } kind = Kind::Nowhere;
        int channel = 0;
        size_t primvar = 0;
        double scale = 1.0;
    };

    Target FindTarget(PlyElement const& element, PlyProperty const& property) {
        std::string const& name = property.name;
        if (property.countType || name == "nx" || name == "ny" || name == "nz") return {};
        for (int c = 0; c < 3; ++c) {
            if (name == std::string(1, "xyz"[c])) return {Target::Kind::Position, c};
        }
        for (auto const& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
            if (element.Has(u) && element.Has(v) && (name == u || name == v)) {
                _hasVertexUVs = true;
                return {Target::Kind::Texture, name == v};
            }
        }
        static char const* const kColours[] = {"red", "green", "blue", "alpha"};
        bool const hasColour = element.Has("red") && element.Has("green") && element.Has("blue");
        for (int c = 0; c < 4; ++c) {
            if (name != kColours[c] || !hasColour) continue;
            size_t const primvar = FindPrimvar("color", element.Has("alpha") ? 4 : 3);
            double const scale = property.type == PlyType::Uint8    ? 1.0 / 255
                                 : property.type == PlyType::Uint16 ? 1.0 / 65535
                                                                    : 1.0;
            return {Target::Kind::Value, c, primvar, scale};
        }
        return {Target::Kind::Value, 0, FindPrimvar(name, 1)};
    }

    size_t FindPrimvar(std::string const& name, int numChannels) {
        for (size_t i = 0; i < _scene.primvars.size(); ++i) {
            if (_scene.primvars[i].name != name) continue;
            if (_scene.primvars[i].numChannels == numChannels) return i;
            _scan.Refuse(
                fmt::format("two vertex properties both make the primvar '{}'; rename one", name));
        }
        _scene.primvars.push_back({name, numChannels, {}});
        return _scene.primvars.size() - 1;
    }

    void ReadVertices(PlyElement const& element) {
        std::vector<Target> targets;
        for (PlyProperty const& property : element.properties)
            targets.push_back(FindTarget(element, property));
        _scene.positions.resize(3 * element.count);
        if (_hasVertexUVs) _scene.uvs.resize(2 * element.count);
        for (Primvar& primvar : _scene.primvars) {
            primvar.values.resize(element.count * static_cast<size_t>(primvar.numChannels));
        }
        for (size_t i = 0; i < element.count; ++i) {
            _values.BeginRow(element, i);
            for (size_t p = 0; p < targets.size(); ++p)
                ReadVertexValue(element.properties[p], targets[p], i);
            _values.EndRow();
        }
    }

    void ReadVertexValue(PlyProperty const& property, Target const& target, size_t vertex) {
        if (target.kind == Target::Kind::Nowhere) return SkipProperty(property);
        double const value = _values.Read(property.type, property.name.c_str());
        size_t const channel = static_cast<size_t>(target.channel);
        if (!(std::abs(value) <= TextScanner::kLargest)) {
            _values.Refuse(fmt::format("property '{}' is {}; a number up to {:g} is needed",
                                       property.name, value, TextScanner::kLargest));
        }
        if (target.kind == Target::Kind::Position) {
            _scene.positions[3 * vertex + channel] = value;
        } else if (target.kind == Target::Kind::Texture) {
            _scene.uvs[2 * vertex + channel] = value;
        } else {
            Primvar& primvar = _scene.primvars[target.primvar];
            primvar.values[vertex * static_cast<size_t>(primvar.numChannels) + channel] =
                static_cast<float>(value * target.scale);
        }
    }

    // -------- faces

    enum class FaceProperty { Indices, Texcoord, TextureNumber, Other };

    static FaceProperty Classify(PlyProperty const& property) {
        if (IsIndexList(property)) return FaceProperty::Indices;
        if (property.countType && property.name == "texcoord") return FaceProperty::Texcoord;
        if (!property.countType && property.name == "texnumber") return FaceProperty::TextureNumber;
        return FaceProperty::Other;
    }

    static std::vector<FaceProperty> ClassifyAll(PlyElement const& element) {
        std::vector<FaceProperty> kinds;
        for (PlyProperty const& property : element.properties) kinds.push_back(Classify(property));
        return kinds;
    }

    void ReadFaces(PlyElement const& element) {
        auto const kinds = ClassifyAll(element);
        for (size_t i = 0; i < element.count; ++i) {
            _values.BeginRow(element, i);
            size_t size = 0;
            std::vector<double> texcoords;
            for (size_t p = 0; p < kinds.size(); ++p) {
                PlyProperty const& property = element.properties[p];
                switch (kinds[p]) {
                    case FaceProperty::Indices:
                        size = ReadCorners(property);
                        break;
                    case FaceProperty::Texcoord:
                        texcoords = ReadTexcoords(property);
                        break;
                    case FaceProperty::TextureNumber:
                        AddToMaterial(_values.Read(property.type, property.name.c_str()));
                        break;
                    case FaceProperty::Other:
                        SkipProperty(property);
                }
            }
            _values.EndRow();
            if (size < 3)
                _values.Refuse(fmt::format("a face has {} corners; at least 3 are needed", size));
            AddFace(size);
            AddTexcoords(texcoords, size);
        }
    }

    size_t ReadCorners(PlyProperty const& property) {
        size_t const size = _values.ReadCount(property);
        for (size_t k = 0; k < size; ++k) {
            _scene.cage.faceVertices.push_back(
                CheckIndex(_values.Read(property.type, property.name.c_str())));
        }
        return size;
    }

    std::vector<double> ReadTexcoords(PlyProperty const& property) {
        std::vector<double> texcoords;
        for (size_t k = _values.ReadCount(property); k > 0; --k)
            texcoords.push_back(CheckFinite(_values.Read(property.type, property.name.c_str())));
        return texcoords;
    }

    /// Of a face whose corners are there.
    void AddFace(size_t size) {
        _scene.cage.faceSizes.push_back(static_cast<int>(size));
        if (_values.IsText()) _scene.faceLines.push_back(_values.GetLineNumber());
    }

    Index CheckIndex(double value) const {
        if (!(value >= 0) || value >= _scene.cage.numVertices || value != std::floor(value)) {
            _values.Refuse(fmt::format("a face uses vertex {}; 0 to {} are possible", value,
                                       _scene.cage.numVertices - 1));
        }
        return static_cast<Index>(value);
    }

    double CheckFinite(double value) const {
        if (!(std::abs(value) <= TextScanner::kLargest)) {
            _values.Refuse(fmt::format("a texture coordinate is {}; a number up to {:g} is needed",
                                       value, TextScanner::kLargest));
        }
        return value;
    }

    /// Puts the next face into the material of a texture's number; a negative one is none.
    void AddToMaterial(double number) {
        if (number != std::floor(number) ||
            std::abs(number) > static_cast<double>(std::numeric_limits<Index>::max())) {
            _values.Refuse(fmt::format("texnumber is {}; a whole number is needed", number));
        }
        FaceGroups& materials = _scene.groups[static_cast<size_t>(GroupKind::Material)];
        materials.faceGroup.resize(_scene.cage.faceSizes.size(), -1);
        Index group = -1;
        if (number >= 0) {
            auto const [found, isNew] = _materialOfTexture.try_emplace(
                static_cast<Index>(number), static_cast<Index>(materials.names.size()));
            if (isNew) materials.names.push_back(NameTexture(static_cast<size_t>(number)));
            group = found->second;
        }
        materials.faceGroup.push_back(group);
    }

    std::string NameTexture(size_t number) const {
        return number < _header.textureFiles.size() ? _header.textureFiles[number]
                                                    : fmt::format("texture{}", number);
    }

    /// Corner coordinates become values, one for each distinct (vertex, u, v).
    void AddTexcoords(std::vector<double> const& texcoords, size_t size) {
        _lacksUVs.push_back(texcoords.empty());
        if (texcoords.empty()) return;
        if (texcoords.size() != 2 * size) {
            _values.Refuse(fmt::format("list 'texcoord' has {} numbers; {} are needed",
                                       texcoords.size(), 2 * size));
        }
        _cornerUVs.insert(_cornerUVs.end(), texcoords.begin(), texcoords.end());
    }

    // -------- triangle strips

    void ReadStrips(PlyElement const& element) {
        for (size_t i = 0; i < element.count; ++i) {
            _values.BeginRow(element, i);
            for (PlyProperty const& property : element.properties) {
                if (IsIndexList(property))
                    ReadStrip(property);
                else
                    SkipProperty(property);
            }
            _values.EndRow();
        }
    }

    /// Each vertex makes a triangle with the two before it; every other one is turned round. A
    /// negative index begins anew; a triangle that repeats a vertex only leads on to the next.
    void ReadStrip(PlyProperty const& property) {
        Index before[2] = {-1, -1};
        bool isTurned = false;
        for (size_t k = _values.ReadCount(property); k > 0; --k) {
            double const value = _values.Read(property.type, property.name.c_str());
            if (value < 0.0) {
                before[0] = before[1] = -1;
                isTurned = false;
                continue;
            }
            Index const vertex = CheckIndex(value);
            if (before[0] >= 0) {
                AddTriangle(before[isTurned], before[!isTurned], vertex);
                isTurned = !isTurned;
            }
            before[0] = before[1];
            before[1] = vertex;
        }
    }

    void AddTriangle(Index a, Index b, Index c) {
        if (a == b || b == c || c == a) return;
        _scene.cage.faceVertices.insert(_scene.cage.faceVertices.end(), {a, b, c});
        AddFace(3);
        _lacksUVs.push_back(1);
    }

    // -------- the whole

    void Finish() {
        auto& cage = _scene.cage;
        if (cage.faceSizes.empty()) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: the file has no faces; limn needs polygons", _scene.path));
        }
        FinishMaterials();
        auto const numBare = std::ranges::count(_lacksUVs, 1);
        bool const hasCornerUVs = static_cast<size_t>(numBare) < _lacksUVs.size();
        if (hasCornerUVs && numBare != 0 && _hasVertexUVs) {
            _scene.warnings.push_back(fmt::format(
                "{}: {} of {} faces have no 'texcoord', so those of the vertices are used",
                _scene.path, numBare, cage.faceSizes.size()));
        }
        if (hasCornerUVs && (numBare == 0 || !_hasVertexUVs)) {
            MergeCornerUVs();
        } else if (_hasVertexUVs) {
            cage.fvarChannels.push_back({cage.numVertices, cage.faceVertices});
        }
    }

    /// Strips have no texture numbers, and follow faces that may have.
    void FinishMaterials() {
        auto& ofFace = _scene.groups[static_cast<size_t>(GroupKind::Material)].faceGroup;
        if (!ofFace.empty()) ofFace.resize(_scene.cage.faceSizes.size(), -1);
    }

    void MergeCornerUVs() {
        auto& cage = _scene.cage;
        std::vector<Index> corners;  // those with UVs
        Index next = 0;
        for (size_t face = 0; face < cage.faceSizes.size(); ++face) {
            for (int k = 0; k < cage.faceSizes[face]; ++k, ++next) {
                if (!_lacksUVs[face]) corners.push_back(next);
            }
        }
        std::vector<Index> order(corners.size());
        for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
        auto const key = [&](Index i) {
            return std::tuple(cage.faceVertices[corners[i]], _cornerUVs[2 * i],
                              _cornerUVs[2 * i + 1], i);
        };
        std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
        std::vector<Index> values(cage.faceVertices.size(), -1);
        _scene.uvs.clear();
        for (size_t i = 0; i < order.size(); ++i) {
            auto const same = [&](Index a, Index b) {
                return cage.faceVertices[corners[a]] == cage.faceVertices[corners[b]] &&
                       _cornerUVs[2 * a] == _cornerUVs[2 * b] &&
                       _cornerUVs[2 * a + 1] == _cornerUVs[2 * b + 1];
            };
            if (i == 0 || !same(order[i - 1], order[i])) {
                _scene.uvs.push_back(_cornerUVs[2 * order[i]]);
                _scene.uvs.push_back(_cornerUVs[2 * order[i] + 1]);
            }
            values[corners[order[i]]] = static_cast<Index>(_scene.uvs.size() / 2) - 1;
        }
        _scene.AddUVChannel(std::move(values), std::move(_lacksUVs));
    }

    Scene& _scene;
    TextScanner _scan;
    PlyHeader _header;
    PlyValues _values;
    bool _hasVertexUVs = false;
    std::vector<double> _cornerUVs;  // 2 per corner of the faces that have some
    std::vector<char> _lacksUVs;     // per face
    std::unordered_map<Index, Index> _materialOfTexture;
};

}  // namespace

bool IsPly(std::string_view bytes) {
    std::string_view const text = TextScanner::WithoutMark(bytes);
    return text.starts_with("ply\n") || text.starts_with("ply\r") || text.starts_with("ply ");
}

void ReadPly(std::string_view bytes, Scene& scene) {
    PlyReader(bytes, scene).Read();
}

}  // namespace limn::engine
