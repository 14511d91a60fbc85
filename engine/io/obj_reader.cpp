// SPDX-License-Identifier: Apache-2.0
#include "engine/io/obj_reader.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "engine/io/text_scanner.h"

namespace limn::engine {

namespace {

constexpr size_t kMaxElements = std::numeric_limits<Index>::max() / 4;

/// Accumulates one OBJ file; one method per statement.
class ObjReader {
public:
    ObjReader(std::string_view text, Scene& scene)
        : _scan(WithoutByteOrderMark(text), scene.path), _scene(scene) {
        ReserveFor(text);
    }

    void Read() {
        while (_scan.NextLine()) {
            std::string_view const keyword = _scan.Word();
            if (keyword.empty() || keyword.front() == '#') continue;
            if (keyword == "v")
                ReadPosition();
            else if (keyword == "vt")
                ReadUV();
            else if (keyword == "f")
                ReadFace();
            else if (keyword == "t")
                ReadTag();
            else if (keyword == "usemtl")
                ReadGroup(GroupKind::Material);
            else if (keyword == "g")
                ReadGroup(GroupKind::Group);
            else if (keyword == "o")
                ReadGroup(GroupKind::Object);
            else
                CheckIsText(keyword);
        }
        Finish();
    }

private:
    static std::string_view WithoutByteOrderMark(std::string_view text) {
        return text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text;
    }

    /// Room for what the lines begin with, so that no array has to move while it grows.
    void ReserveFor(std::string_view text) {
        size_t numPositions = 0, numUVs = 0, numFaces = 0;
        for (size_t at = 0; at + 2 < text.size(); ++at) {
            bool const isBlank = text[at + 1] == ' ';
            numPositions += text[at] == 'v' && isBlank;
            numUVs += text[at] == 'v' && text[at + 1] == 't';
            numFaces += text[at] == 'f' && isBlank;
            at = text.find('\n', at);
            if (at == std::string_view::npos) break;
        }
        _scene.positions.reserve(3 * numPositions);
        _scene.uvs.reserve(2 * numUVs);
        _scene.cage.faceSizes.reserve(numFaces);
        _scene.faceLines.reserve(numFaces);
        _scene.cage.faceVertices.reserve(4 * numFaces);  // most are quads
        if (numUVs > 0) _faceUVs.reserve(4 * numFaces);
    }

    Index NumVertices() const { return static_cast<Index>(_scene.positions.size() / 3); }
    Index NumUVs() const { return static_cast<Index>(_scene.uvs.size() / 2); }

    void ReadPosition() {
        if (_scene.positions.size() / 3 >= kMaxElements) _scan.Refuse("too many vertices");
        double const x = _scan.Number("x"), y = _scan.Number("y"), z = _scan.Number("z");
        _scene.positions.insert(_scene.positions.end(), {x, y, z});
    }

    void ReadUV() {
        if (_scene.uvs.size() / 2 >= kMaxElements) _scan.Refuse("too many texture vertices");
        _scan.DropComment();
        double const u = _scan.Number("u");
        double const v = _scan.AtEndOfLine() ? 0.0 : _scan.Number("v");  // v may be left out
        _scene.uvs.insert(_scene.uvs.end(), {u, v});
    }

    /// One part of a corner ("7", "-1") to a 0-based index below `count`.
    Index ResolveIndex(char const*& at, char const* end, Index count, char const* what) {
        long long value = 0;
        auto const [stop, code] = std::from_chars(at, end, value);
        if (code == std::errc::invalid_argument) {
            _scan.Refuse(fmt::format("a corner's {} index is {}; an integer is needed", what,
                                     TextScanner::Quote({at, static_cast<size_t>(end - at)})));
        }
        long long const index = value > 0 ? value - 1 : count + value;
        if (code != std::errc() || value == 0 || index < 0 || index >= count) {
            _scan.Refuse(fmt::format(
                "a corner's {} index is {}; {}", what,
                TextScanner::Quote({at, static_cast<size_t>(stop - at)}),
                count == 0 ? fmt::format("no {} stands before this line", what)
                           : fmt::format("1 to {} or -{} to -1 are possible here", count, count)));
        }
        at = stop;
        return static_cast<Index>(index);
    }

    void ReadFace() {
        auto& cage = _scene.cage;
        if (cage.faceVertices.size() >= kMaxElements) _scan.Refuse("too many face corners");
        int size = 0, numWithUV = 0;
        for (std::string_view word = _scan.Word(); !word.empty(); word = _scan.Word()) {
            if (word.front() == '#') break;
            char const* at = word.data();
            char const* const end = at + word.size();
            cage.faceVertices.push_back(ResolveIndex(at, end, NumVertices(), "vertex"));
            Index uv = -1;
            if (at != end && *at == '/') {
                ++at;
                if (at != end && *at != '/') {
                    uv = ResolveIndex(at, end, NumUVs(), "texture");
                    ++numWithUV;
                }
                if (at != end && *at == '/') at = end;  // normals are not used
            }
            if (at != end) {
                _scan.Refuse(fmt::format("corner {} is not of the form v, v/vt, v//vn or v/vt/vn",
                                         TextScanner::Quote(word)));
            }
            _faceUVs.push_back(uv);
            ++size;
        }
        if (size < 3) {
            _scan.Refuse(fmt::format("a face has {} corner{}; at least 3 are needed", size,
                                     size == 1 ? "" : "s"));
        }
        if (numWithUV != 0 && numWithUV != size) {
            _scan.Refuse(
                fmt::format("{} of a face's {} corners have a texture index; all or none must",
                            numWithUV, size));
        }
        (numWithUV ? _numFacesWithUV : _numFacesWithoutUV) += 1;
        if (!numWithUV && _firstLineWithoutUV == 0) _firstLineWithoutUV = _scan.GetLineNumber();
        cage.faceSizes.push_back(size);
        _scene.faceLines.push_back(_scan.GetLineNumber());
        for (int kind = 0; kind < 3; ++kind) {
            FaceGroups& groups = _scene.groups[kind];
            if (_currentGroup[kind] >= 0 || !groups.faceGroup.empty()) {
                groups.faceGroup.resize(cage.faceSizes.size() - 1, -1);
                groups.faceGroup.push_back(_currentGroup[kind]);
            }
        }
    }

    void ReadGroup(GroupKind kind) {
        std::string const name(_scan.RestOfLine());
        int const k = static_cast<int>(kind);
        if (name.empty()) {
            _currentGroup[k] = -1;
            return;
        }
        auto const [found, isNew] =
            _groupIndex[k].try_emplace(name, static_cast<Index>(_scene.groups[k].names.size()));
        if (isNew) _scene.groups[k].names.push_back(name);
        _currentGroup[k] = found->second;
    }

    struct TagCounts {
        long ints, floats, strings;
    };

    TagCounts ReadTagCounts(std::string_view name) {
        std::string_view const word = _scan.Word();
        TagCounts counts{0, 0, 0};
        long* const parts[3] = {&counts.ints, &counts.floats, &counts.strings};
        char const* at = word.data();
        char const* const end = at + word.size();
        for (int i = 0; i < 3; ++i) {
            auto const [stop, code] = std::from_chars(at, end, *parts[i]);
            bool const isLast = i == 2;
            if (code != std::errc() || *parts[i] < 0 ||
                (isLast ? stop != end : stop == end || *stop != '/')) {
                _scan.Refuse(
                    fmt::format("tag {}: counts are {}; ints/floats/strings such as 2/1/0 are "
                                "needed",
                                TextScanner::Quote(name), TextScanner::Quote(word)));
            }
            at = isLast ? stop : stop + 1;
        }
        return counts;
    }

    Index TagIndex(std::string_view tag) {
        double const value = _scan.Number("a tag's integer");
        if (value != std::floor(value) || std::abs(value) > std::numeric_limits<Index>::max()) {
            _scan.Refuse(fmt::format("tag {}: {} is not an index", TextScanner::Quote(tag), value));
        }
        return static_cast<Index>(value);
    }

    float TagSharpness(std::string_view tag) {
        double const value = _scan.Number("a sharpness");
        if (value < 0.0) {
            _scan.Refuse(fmt::format("tag {}: sharpness is {}; 0 or more is needed",
                                     TextScanner::Quote(tag), value));
        }
        return static_cast<float>(std::min(value, 1e6));
    }

    void ReadTag() {
        std::string const name(_scan.Word());
        if (name == "vertexedit" || name == "edgeedit" || name == "faceedit") {
            _scene.warnings.push_back(fmt::format(
                "{}:{}: tag '{}' (a hierarchical edit) is not supported and has no effect",
                _scene.path, _scan.GetLineNumber(), name));
            return;
        }
        TagCounts const counts = ReadTagCounts(name);
        auto const need = [&](bool ok, char const* form) {
            if (!ok)
                _scan.Refuse(
                    fmt::format("tag '{}' has the wrong counts; {} is needed", name, form));
        };
        if (name == "crease") {
            need(counts.ints >= 2 && (counts.floats == 1 || counts.floats == counts.ints - 1),
                 "vertices of a chain and one sharpness (2/1/0), or one per edge");
            ReadCrease(counts);
        } else if (name == "corner") {
            need(counts.ints >= 1 && (counts.floats == 1 || counts.floats == counts.ints),
                 "vertices and one sharpness (1/1/0), or one per vertex");
            ReadCorner(counts);
        } else if (name == "hole") {
            need(counts.ints >= 1, "faces (1/0/0)");
            for (long i = 0; i < counts.ints; ++i)
                AddTagged(_scene.cage.holes, _holeLines, TagIndex(name));
        } else if (name == "interpolateboundary") {
            need(counts.ints >= 1, "one integer (1/0/0)");
            SetBoundary(TagIndex(name));
        } else if (name == "facevaryinginterpolateboundary") {
            need(counts.ints >= 1, "one integer (1/0/0)");
            SetFVar(TagIndex(name));
        } else if (name == "creasemethod") {
            need(counts.strings >= 1, "one word (0/0/1)");
            SetByWord(name, "normal", "chaikin", [&](bool chaikin) {
                _scene.cage.options.SetCreasingMethod(chaikin ? Sdc::Options::CREASE_CHAIKIN
                                                              : Sdc::Options::CREASE_UNIFORM);
            });
        } else if (name == "smoothtriangles") {
            need(counts.strings >= 1, "one word (0/0/1)");
            SetByWord(name, "catmark", "smooth", [&](bool smooth) {
                _scene.cage.options.SetTriangleSubdivision(smooth ? Sdc::Options::TRI_SUB_SMOOTH
                                                                  : Sdc::Options::TRI_SUB_CATMARK);
            });
        } else {
            _scene.warnings.push_back(fmt::format("{}:{}: tag {} is not known and has no effect",
                                                  _scene.path, _scan.GetLineNumber(),
                                                  TextScanner::Quote(name)));
        }
    }

    void AddTagged(std::vector<Index>& indices, std::vector<uint32_t>& lines, Index index) {
        indices.push_back(index);
        lines.push_back(_scan.GetLineNumber());
    }

    void ReadCrease(TagCounts const& counts) {
        std::vector<Index> chain;
        for (long i = 0; i < counts.ints; ++i) chain.push_back(TagIndex("crease"));
        float sharpness = 0.0f;
        for (size_t i = 0; i + 1 < chain.size(); ++i) {
            if (static_cast<long>(i) < counts.floats) sharpness = TagSharpness("crease");
            AddTagged(_scene.cage.creaseVertexPairs, _creaseLines, chain[i]);
            _scene.cage.creaseVertexPairs.push_back(chain[i + 1]);
            _scene.cage.creaseSharpness.push_back(sharpness);
        }
    }

    void ReadCorner(TagCounts const& counts) {
        auto& cage = _scene.cage;
        size_t const first = cage.cornerVertices.size();
        for (long i = 0; i < counts.ints; ++i) {
            AddTagged(cage.cornerVertices, _cornerLines, TagIndex("corner"));
        }
        float sharpness = 0.0f;
        for (size_t i = first; i < cage.cornerVertices.size(); ++i) {
            if (static_cast<long>(i - first) < counts.floats) sharpness = TagSharpness("corner");
            cage.cornerSharpness.push_back(sharpness);
        }
    }

    void SetBoundary(Index value) {
        if (value < 0 || value > 2) {
            _scan.Refuse(
                fmt::format("interpolateboundary is {}; 0 (none), 1 (edge and corner) or 2 "
                            "(edge only) are possible",
                            value));
        }
        constexpr Sdc::Options::VtxBoundaryInterpolation kRules[] = {
            Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER,
            Sdc::Options::VTX_BOUNDARY_EDGE_ONLY};
        _scene.cage.options.SetVtxBoundaryInterpolation(kRules[value]);
        _scene.hasBoundaryTag = true;
    }

    void SetFVar(Index value) {
        if (value < 0 || value > 5) {
            _scan.Refuse(
                fmt::format("facevaryinginterpolateboundary is {}; 0 to 5 are possible", value));
        }
        constexpr Sdc::Options::FVarLinearInterpolation kRules[] = {
            Sdc::Options::FVAR_LINEAR_NONE,          Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
            Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2,
            Sdc::Options::FVAR_LINEAR_BOUNDARIES,    Sdc::Options::FVAR_LINEAR_ALL};
        _scene.cage.options.SetFVarLinearInterpolation(kRules[value]);
        _scene.hasFVarTag = true;
    }

    template <class Setter>
    void SetByWord(std::string const& tag, char const* off, char const* on, Setter set) {
        std::string_view const word = _scan.Word();
        if (word != off && word != on) {
            _scan.Refuse(fmt::format("tag '{}' is {}; '{}' or '{}' are possible", tag,
                                     TextScanner::Quote(word), off, on));
        }
        set(word == on);
    }

    /// Statements limn does not use are skipped, bytes that are no text are not.
    void CheckIsText(std::string_view keyword) {
        for (char c : keyword.substr(0, 64)) {
            auto const byte = static_cast<unsigned char>(c);
            if (byte < 32 || byte == 127 || (_scan.GetLineNumber() == 1 && byte >= 0xfe)) {
                _scan.Refuse("this is not text; an OBJ file in ASCII or UTF-8 is needed");
            }
        }
    }

    void Finish() {
        auto& cage = _scene.cage;
        cage.numVertices = NumVertices();
        if (cage.faceSizes.empty())
            _scan.Refuse("the file has no faces; limn needs polygons ('f' lines)");
        CheckTagIndices();
        CheckNotCutShort();
        if (_numFacesWithUV == 0) {
            _scene.uvs.clear();
            return;
        }
        if (_numFacesWithoutUV != 0) {
            _scene.warnings.push_back(fmt::format(
                "{}:{}: {} of {} faces have no texture indices, so the mesh has no UVs; give every "
                "face some or none",
                _scene.path, _firstLineWithoutUV, _numFacesWithoutUV, cage.faceSizes.size()));
            _scene.uvs.clear();
            return;
        }
        cage.fvarChannels.push_back({NumUVs(), std::move(_faceUVs)});
    }

    /// Tag lines may stand before the elements they name, so they are checked at the end.
    void CheckTagIndices() {
        auto const& cage = _scene.cage;
        auto const check = [&](Index index, Index count, uint32_t line, char const* tag,
                               char const* what) {
            if (index >= 0 && index < count) return;
            throw Error(
                ErrorCode::BadMesh,
                fmt::format("{}:{}: tag '{}' names {} {}; 0 to {} are possible (tag indices are "
                            "0-based)",
                            _scene.path, line, tag, what, index, count - 1));
        };
        for (size_t i = 0; i < cage.creaseVertexPairs.size(); ++i) {
            check(cage.creaseVertexPairs[i], cage.numVertices, _creaseLines[i / 2], "crease",
                  "vertex");
        }
        for (size_t i = 0; i < cage.cornerVertices.size(); ++i) {
            check(cage.cornerVertices[i], cage.numVertices, _cornerLines[i], "corner", "vertex");
        }
        for (size_t i = 0; i < cage.holes.size(); ++i) {
            check(cage.holes[i], cage.GetNumFaces(), _holeLines[i], "hole", "face");
        }
    }

    void CheckNotCutShort() {
        if (_scan.EndsWithNewline()) return;
        std::vector<char> isUsed(static_cast<size_t>(_scene.cage.numVertices), 0);
        for (Index vertex : _scene.cage.faceVertices) isUsed[vertex] = 1;
        auto const numUnused = std::count(isUsed.begin(), isUsed.end(), 0);
        if (numUnused != 0) {
            _scan.Refuse(
                fmt::format("the file ends within this line and leaves {} vertices unused; it "
                            "seems cut short",
                            numUnused));
        }
    }

    TextScanner _scan;
    Scene& _scene;
    std::vector<Index> _faceUVs;
    std::vector<uint32_t> _creaseLines, _cornerLines, _holeLines;
    std::array<std::unordered_map<std::string, Index>, 3> _groupIndex;
    std::array<Index, 3> _currentGroup{-1, -1, -1};
    size_t _numFacesWithUV = 0, _numFacesWithoutUV = 0;
    uint32_t _firstLineWithoutUV = 0;
};

}  // namespace

void ReadObj(std::string_view text, Scene& scene) {
    ObjReader(text, scene).Read();
}

}  // namespace limn::engine
