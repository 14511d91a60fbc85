// SPDX-License-Identifier: Apache-2.0
#include "engine/io/obj_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <span>
#include <unordered_map>

#include "engine/io/colour_range.h"
#include "engine/io/obj_tags.h"
#include "engine/io/skipped_lines.h"
#include "engine/io/text_scanner.h"

namespace limn::engine {

namespace {

constexpr size_t kMaxElements = std::numeric_limits<Index>::max() / 4;

/// Statements of curves and surfaces in free form, which make no polygons.
constexpr std::string_view kFreeForm[] = {
    "vp",   "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim",  "hole",
    "scrv", "sp",     "end", "con",  "bzp",  "bsp",  "cdc",   "cdp",  "res",  "stech", "ctech"};

/// Statements that take in what stands elsewhere: other files, what commands print.
constexpr std::string_view kElsewhere[] = {"call", "csh"};

/// Statements that say nothing of a subdivision surface: normals, points and lines, how things
/// look.
constexpr std::string_view kWithoutEffect[] = {
    "vn",     "p",        "l",        "s",   "mtllib",     "mg",        "bevel",
    "maplib", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "usemap"};

bool IsAmong(std::span<std::string_view const> words, std::string_view word) {
    return std::ranges::find(words, word) != words.end();
}

/// Accumulates one OBJ file; one method per statement.
class ObjReader {
public:
    ObjReader(std::string_view text, Scene& scene)
        : _scan(text, scene.path, TextScanner::Backslash::JoinsLines),
          _scene(scene),
          _tags(_scan, scene) {
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
                _tags.ReadLine();
            else if (keyword == "usemtl")
                ReadGroup(GroupKind::Material);
            else if (keyword == "g")
                ReadGroup(GroupKind::Group);
            else if (keyword == "o")
                ReadGroup(GroupKind::Object);
            else
                Skip(keyword);
        }
        Finish();
    }

private:
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
        if (!_scan.AtEndOfLine()) ReadColour();
    }

    /// What may stand behind a position: nothing but a comment, a weight for curves, or a colour of
    /// three or four channels, which the first vertex that has one decides.
    void ReadColour() {
        _scan.DropComment();
        std::array<float, 5> values{};
        size_t count = 0;
        while (count < values.size() && !_scan.AtEndOfLine()) {
            auto const value = _scan.TryNumber();
            values[count++] = static_cast<float>(value.value_or(0.0));
            if (!value) count = values.size();
        }
        if (count <= 1) return;
        if (_numColourChannels == 0 && (count == 3 || count == 4)) _numColourChannels = count;
        if (count == _numColourChannels) {
            _colours.insert(_colours.end(), values.begin(), values.begin() + count);
        } else if (_numUnclearPositions++ == 0) {
            _firstUnclearPosition = _scan.GetLineNumber();
        }
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

    /// Appends one corner: v, v/vt, v//vn or v/vt/vn. True if it has a texture index.
    bool ReadCorner(std::string_view word) {
        char const* at = word.data();
        char const* const end = at + word.size();
        _scene.cage.faceVertices.push_back(ResolveIndex(at, end, NumVertices(), "vertex"));
        Index uv = -1;
        if (at != end && *at == '/') {
            ++at;
            if (at != end && *at != '/') uv = ResolveIndex(at, end, NumUVs(), "texture");
            if (at != end && *at == '/') at = end;  // normals are not used
        }
        if (at != end) {
            _scan.Refuse(fmt::format("corner {} is not of the form v, v/vt, v//vn or v/vt/vn",
                                     TextScanner::Quote(word)));
        }
        _faceUVs.push_back(uv);
        return uv >= 0;
    }

    void ReadFace() {
        auto& cage = _scene.cage;
        if (cage.faceVertices.size() >= kMaxElements) _scan.Refuse("too many face corners");
        int size = 0, numWithUV = 0;
        for (std::string_view word = _scan.Word(); !word.empty(); word = _scan.Word()) {
            if (word.front() == '#') break;
            numWithUV += ReadCorner(word);
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
        _hasUVs |= numWithUV > 0;
        cage.faceSizes.push_back(size);
        _scene.faceLines.push_back(_scan.GetLineNumber());
        AddToGroups();
    }

    /// Puts the face that was read last into the groups of its line.
    void AddToGroups() {
        for (size_t kind = 0; kind < _currentGroup.size(); ++kind) {
            FaceGroups& groups = _scene.groups[kind];
            if (_currentGroup[kind] < 0 && groups.faceGroup.empty()) continue;
            groups.faceGroup.resize(_scene.cage.faceSizes.size() - 1, -1);
            groups.faceGroup.push_back(_currentGroup[kind]);
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

    /// Statements limn does not use are skipped, bytes that are no text are not.
    void Skip(std::string_view keyword) {
        CheckIsText(keyword);
        if (IsAmong(kWithoutEffect, keyword)) return;
        SkippedLines& lines = IsAmong(kFreeForm, keyword)    ? _freeForm
                              : IsAmong(kElsewhere, keyword) ? _elsewhere
                                                             : _unknown;
        lines.Add(keyword, _scan.GetLineNumber());
    }

    void CheckIsText(std::string_view keyword) const {
        for (char c : keyword.substr(0, 64)) {
            auto const byte = static_cast<unsigned char>(c);
            if (byte < 32 || byte == 127)
                _scan.Refuse("this is not text; an OBJ file in ASCII or UTF-8 is needed");
        }
    }

    void Finish() {
        auto& cage = _scene.cage;
        cage.numVertices = NumVertices();
        if (cage.faceSizes.empty()) RefuseToHaveNoFaces();
        _tags.Finish();
        CheckNotCutShort();
        WarnOfSkippedLines();
        FinishColours();
        FinishUVs();
    }

    [[noreturn]] void RefuseToHaveNoFaces() const {
        std::string const other = _freeForm.GetCount() > 0
                                      ? "; it has surfaces in free form, to be exported as polygons"
                                      : "";
        _scan.Refuse(
            fmt::format("the file has no faces{}; limn needs polygons ('f' lines)", other));
    }

    void Warn(uint32_t line, std::string const& message) {
        _scene.warnings.push_back(fmt::format("{}:{}: {}", _scene.path, line, message));
    }

    void WarnOfSkippedLines() {
        if (_freeForm.GetCount() > 0) {
            Warn(
                _freeForm.GetFirstLine(),
                fmt::format("curves and surfaces in free form have no effect (export polygons): {}",
                            _freeForm.Describe()));
        }
        if (_elsewhere.GetCount() > 0) {
            Warn(_elsewhere.GetFirstLine(),
                 fmt::format("what stands in other files is not read: {}", _elsewhere.Describe()));
        }
        if (_unknown.GetCount() > 0) {
            Warn(_unknown.GetFirstLine(),
                 fmt::format("OBJ has no such statement, so it has no effect: {}",
                             _unknown.Describe()));
        }
        if (_numUnclearPositions > 0) {
            Warn(_firstUnclearPosition,
                 fmt::format(
                     "what stands behind x, y and z of {} vertices is neither a weight nor a "
                     "colour like the others' and has no effect",
                     _numUnclearPositions));
        }
    }

    void FinishColours() {
        if (_numColourChannels == 0) return;
        size_t const numVertices = static_cast<size_t>(NumVertices()),
                     numColours = _colours.size() / _numColourChannels;
        if (numColours != numVertices) {
            _scene.warnings.push_back(fmt::format(
                "{}: {} of {} vertices have no colour, so the mesh has none; give every "
                "vertex one or none",
                _scene.path, numVertices - numColours, numVertices));
            return;
        }
        ScaleWholeColours(_colours);
        _scene.primvars.push_back(
            {"color", static_cast<int>(_numColourChannels), std::move(_colours)});
    }

    void FinishUVs() {
        if (!_hasUVs) return _scene.uvs.clear();
        std::vector<char> lacksUVs;
        size_t corner = 0;
        for (int size : _scene.cage.faceSizes) {
            lacksUVs.push_back(_faceUVs[corner] < 0);
            corner += static_cast<size_t>(size);
        }
        _scene.AddUVChannel(std::move(_faceUVs), std::move(lacksUVs));
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
    ObjTags _tags;
    SkippedLines _freeForm, _elsewhere, _unknown;
    std::vector<Index> _faceUVs;
    std::vector<float> _colours;
    size_t _numColourChannels = 0, _numUnclearPositions = 0;
    uint32_t _firstUnclearPosition = 0;
    std::array<std::unordered_map<std::string, Index>, 3> _groupIndex;
    std::array<Index, 3> _currentGroup{-1, -1, -1};
    bool _hasUVs = false;
};

}  // namespace

void ReadObj(std::string_view text, Scene& scene) {
    ObjReader(text, scene).Read();
}

}  // namespace limn::engine
