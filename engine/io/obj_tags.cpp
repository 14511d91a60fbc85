// SPDX-License-Identifier: Apache-2.0
#include "engine/io/obj_tags.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

namespace {

constexpr char const* kIsUnknown = "is not known";
constexpr size_t kMaxIgnoredNames = 16;

bool IsHierarchicalEdit(std::string_view name) {
    return name == "vertexedit" || name == "edgeedit" || name == "faceedit";
}

}  // namespace

void ObjTags::ReadLine() {
    std::string_view const name = _scan.Word();
    if (IsHierarchicalEdit(name)) return Ignore(name, "(a hierarchical edit) is not supported");
    Counts const counts = ReadCounts(name);
    if (name == "crease")
        ReadCrease(counts);
    else if (name == "corner")
        ReadCorner(counts);
    else if (name == "hole")
        ReadHoles(counts);
    else if (!ReadRule(name, counts))
        return Ignore(name, kIsUnknown);
    _scan.DropComment();
    if (!_scan.AtEndOfLine()) _surplus.Add(name, _scan.GetLineNumber());
}

/// True if the tag is a rule of refinement.
bool ObjTags::ReadRule(std::string_view name, Counts const& counts) {
    auto& options = _scene.cage.options;
    if (name == "interpolateboundary") {
        Need(name, counts.ints >= 1, "one integer (1/0/0)");
        ReadBoundaryRule();
    } else if (name == "facevaryinginterpolateboundary") {
        Need(name, counts.ints >= 1, "one integer (1/0/0)");
        ReadFVarRule();
    } else if (name == "creasemethod") {
        Need(name, counts.strings >= 1, "one word (0/0/1)");
        options.SetCreasingMethod(ReadWord(name, "normal", "chaikin")
                                      ? Sdc::Options::CREASE_CHAIKIN
                                      : Sdc::Options::CREASE_UNIFORM);
    } else if (name == "smoothtriangles") {
        Need(name, counts.strings >= 1, "one word (0/0/1)");
        options.SetTriangleSubdivision(ReadWord(name, "catmark", "smooth")
                                           ? Sdc::Options::TRI_SUB_SMOOTH
                                           : Sdc::Options::TRI_SUB_CATMARK);
    } else {
        return false;
    }
    return true;
}

ObjTags::Counts ObjTags::ReadCounts(std::string_view name) {
    std::string_view const word = _scan.Word();
    Counts counts{0, 0, 0};
    long* const parts[3] = {&counts.ints, &counts.floats, &counts.strings};
    char const* at = word.data();
    char const* const end = at + word.size();
    for (int i = 0; i < 3; ++i) {
        auto const [stop, code] = std::from_chars(at, end, *parts[i]);
        bool const isLast = i == 2;
        if (code != std::errc() || *parts[i] < 0 ||
            (isLast ? stop != end : stop == end || *stop != '/')) {
            _scan.Refuse(
                fmt::format("tag {}: counts are {}; ints/floats/strings such as 2/1/0 are needed",
                            TextScanner::Quote(name), TextScanner::Quote(word)));
        }
        at = isLast ? stop : stop + 1;
    }
    return counts;
}

void ObjTags::Need(std::string_view name, bool isRight, char const* form) const {
    if (!isRight)
        _scan.Refuse(fmt::format("tag '{}' has the wrong counts; {} is needed", name, form));
}

Index ObjTags::ReadIndex(std::string_view name) {
    double const value = _scan.Number("a tag's integer");
    if (value != std::floor(value) || std::abs(value) > std::numeric_limits<Index>::max()) {
        _scan.Refuse(fmt::format("tag {}: {} is not an index", TextScanner::Quote(name), value));
    }
    return static_cast<Index>(value);
}

float ObjTags::ReadSharpness(std::string_view name) {
    double const value = _scan.Number("a sharpness");
    if (value < 0.0) {
        _scan.Refuse(fmt::format("tag {}: sharpness is {}; 0 or more is needed",
                                 TextScanner::Quote(name), value));
    }
    return static_cast<float>(std::min(value, 1e6));
}

void ObjTags::AddTagged(std::vector<Index>& indices, std::vector<uint32_t>& lines, Index index) {
    indices.push_back(index);
    lines.push_back(_scan.GetLineNumber());
}

void ObjTags::ReadCrease(Counts const& counts) {
    Need("crease", counts.ints >= 2 && (counts.floats == 1 || counts.floats == counts.ints - 1),
         "vertices of a chain and one sharpness (2/1/0), or one per edge");
    std::vector<Index> chain;
    for (long i = 0; i < counts.ints; ++i) chain.push_back(ReadIndex("crease"));
    float sharpness = 0.0f;
    for (size_t i = 0; i + 1 < chain.size(); ++i) {
        if (static_cast<long>(i) < counts.floats) sharpness = ReadSharpness("crease");
        AddTagged(_scene.cage.creaseVertexPairs, _creaseLines, chain[i]);
        _scene.cage.creaseVertexPairs.push_back(chain[i + 1]);
        _scene.cage.creaseSharpness.push_back(sharpness);
    }
}

void ObjTags::ReadCorner(Counts const& counts) {
    Need("corner", counts.ints >= 1 && (counts.floats == 1 || counts.floats == counts.ints),
         "vertices and one sharpness (1/1/0), or one per vertex");
    auto& cage = _scene.cage;
    size_t const first = cage.cornerVertices.size();
    for (long i = 0; i < counts.ints; ++i) {
        AddTagged(cage.cornerVertices, _cornerLines, ReadIndex("corner"));
    }
    float sharpness = 0.0f;
    for (size_t i = first; i < cage.cornerVertices.size(); ++i) {
        if (static_cast<long>(i - first) < counts.floats) sharpness = ReadSharpness("corner");
        cage.cornerSharpness.push_back(sharpness);
    }
}

void ObjTags::ReadHoles(Counts const& counts) {
    Need("hole", counts.ints >= 1, "faces (1/0/0)");
    for (long i = 0; i < counts.ints; ++i)
        AddTagged(_scene.cage.holes, _holeLines, ReadIndex("hole"));
}

void ObjTags::ReadBoundaryRule() {
    Index const value = ReadIndex("interpolateboundary");
    if (value < 0 || value > 2) {
        _scan.Refuse(
            fmt::format("interpolateboundary is {}; 0 (none), 1 (edge and corner) or 2 (edge only) "
                        "are possible",
                        value));
    }
    constexpr Sdc::Options::VtxBoundaryInterpolation kRules[] = {
        Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER,
        Sdc::Options::VTX_BOUNDARY_EDGE_ONLY};
    _scene.cage.options.SetVtxBoundaryInterpolation(kRules[value]);
    _scene.hasBoundaryTag = true;
}

void ObjTags::ReadFVarRule() {
    Index const value = ReadIndex("facevaryinginterpolateboundary");
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

/// True for the second of two words.
bool ObjTags::ReadWord(std::string_view name, char const* off, char const* on) {
    std::string_view const word = _scan.Word();
    if (word != off && word != on) {
        _scan.Refuse(fmt::format("tag '{}' is {}; '{}' or '{}' are possible", name,
                                 TextScanner::Quote(word), off, on));
    }
    return word == on;
}

/// Names beyond the first few are counted with the last of them, so that a file of nothing else
/// makes few warnings.
void ObjTags::Ignore(std::string_view name, char const* why) {
    auto found = std::find_if(_ignored.begin(), _ignored.end(),
                              [&](Ignored const& ignored) { return ignored.name == name; });
    if (found == _ignored.end() && _ignored.size() == kMaxIgnoredNames) --found;
    if (found == _ignored.end())
        _ignored.push_back({std::string(name), why, _scan.GetLineNumber(), 1});
    else
        ++found->count;
}

void ObjTags::Finish() {
    CheckIndices();
    for (Ignored const& ignored : _ignored) {
        std::string const more =
            ignored.count > 1 ? fmt::format(", nor have {} more", ignored.count - 1) : "";
        _scene.warnings.push_back(fmt::format("{}:{}: tag {} {} and has no effect{}", _scene.path,
                                              ignored.firstLine, TextScanner::Quote(ignored.name),
                                              ignored.why, more));
    }
    if (_surplus.GetCount() == 0) return;
    _scene.warnings.push_back(
        fmt::format("{}:{}: {} of tags with more values than they take, which are not read",
                    _scene.path, _surplus.GetFirstLine(), _surplus.Describe()));
}

void ObjTags::CheckIndices() const {
    auto const& cage = _scene.cage;
    auto const check = [&](Index index, Index count, uint32_t line, char const* tag,
                           char const* what) {
        if (index >= 0 && index < count) return;
        _scan.RefuseAt(line, fmt::format("tag '{}' names {} {}; 0 to {} are possible (tag indices "
                                         "are 0-based)",
                                         tag, what, index, count - 1));
    };
    for (size_t i = 0; i < cage.creaseVertexPairs.size(); ++i) {
        check(cage.creaseVertexPairs[i], cage.numVertices, _creaseLines[i / 2], "crease", "vertex");
    }
    for (size_t i = 0; i < cage.cornerVertices.size(); ++i) {
        check(cage.cornerVertices[i], cage.numVertices, _cornerLines[i], "corner", "vertex");
    }
    for (size_t i = 0; i < cage.holes.size(); ++i) {
        check(cage.holes[i], cage.GetNumFaces(), _holeLines[i], "hole", "face");
    }
}

}  // namespace limn::engine
