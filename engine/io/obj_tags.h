// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/io/skipped_lines.h"
#include "engine/io/text_scanner.h"
#include "engine/scene/scene.h"

namespace limn::engine {

/// The `t` lines of an OBJ file, which OpenSubdiv's tools have added to the format: creases,
/// corners, holes and the rules to refine by go into the scene's cage.
class ObjTags {
public:
    /// Both are kept by reference.
    ObjTags(TextScanner& scan, Scene& scene) : _scan(scan), _scene(scene) {}

    /// Reads the rest of a line behind its `t`. \throws Error BadMesh
    void ReadLine();

    /// Checks the vertices and faces that lines have named, which may stand behind them, and warns
    /// of lines without an effect. \throws Error BadMesh
    void Finish();

private:
    struct Counts {
        long ints, floats, strings;
    };
    /// Lines of one name that have no effect, and why.
    struct Ignored {
        std::string name;
        char const* why;
        uint32_t firstLine;
        size_t count;
    };

    Counts ReadCounts(std::string_view name);
    Index ReadIndex(std::string_view name);
    float ReadSharpness(std::string_view name);
    void ReadCrease(Counts const& counts);
    void ReadCorner(Counts const& counts);
    void ReadHoles(Counts const& counts);
    void ReadBoundaryRule();
    void ReadFVarRule();
    bool ReadWord(std::string_view name, char const* off, char const* on);
    bool ReadRule(std::string_view name, Counts const& counts);
    void Need(std::string_view name, bool isRight, char const* form) const;
    void Ignore(std::string_view name, char const* why);
    void AddTagged(std::vector<Index>& indices, std::vector<uint32_t>& lines, Index index);
    void CheckIndices() const;

    TextScanner& _scan;
    Scene& _scene;
    std::vector<uint32_t> _creaseLines, _cornerLines, _holeLines;
    std::vector<Ignored> _ignored;
    SkippedLines _surplus;
};

}  // namespace limn::engine
