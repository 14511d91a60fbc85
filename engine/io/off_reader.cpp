// SPDX-License-Identifier: Apache-2.0
#include "engine/io/off_reader.h"

#include <cmath>
#include <limits>

#include "engine/io/colour_range.h"
#include "engine/io/skipped_lines.h"
#include "engine/io/text_scanner.h"

namespace limn::engine {

namespace {

/// What the keyword [ST][C][N][4][n]OFF says that vertices have.
struct OffKeyword {
    bool hasTexture = false, hasColours = false, hasNormals = false;
    bool isHomogeneous = false, isOfAnyDimension = false, isOff = false;

    /// \param skip  skip(letters): true, and a move behind them, where they come next
    template <class Skip>
    static OffKeyword Read(Skip skip) {
        OffKeyword keyword;
        keyword.hasTexture = skip("ST");
        keyword.hasColours = skip("C");
        keyword.hasNormals = skip("N");
        keyword.isHomogeneous = skip("4");
        keyword.isOfAnyDimension = skip("n");
        keyword.isOff = skip("OFF");
        return keyword;
    }
};

/// OFF is a stream of words; lines matter only where a face's colour ends.
class OffReader {
public:
    OffReader(std::string_view text, Scene& scene)
        : _scan(text, scene.path, TextScanner::Backslash::JoinsLines), _scene(scene) {}

    void Read() {
        ReadKeyword();
        if (_scan.AtEndOfLine()) NextContentLine("the counts");
        size_t const numVertices = Count("the number of vertices"),
                     numFaces = Count("the number of faces");
        if (numFaces == 0) _scan.Refuse("the file has no faces; limn needs polygons");
        CheckRoom(numVertices, numFaces);
        ReadVertices(numVertices);
        ReadFaces(numFaces);
        NoteRest();
        if (_keyword.hasTexture) {
            auto& cage = _scene.cage;
            cage.fvarChannels.push_back({cage.numVertices, cage.faceVertices});
        }
    }

private:
    void NextContentLine(char const* what) {
        do {
            if (!_scan.NextLine()) _scan.Refuse(fmt::format("the file ends before {}", what));
            _scan.DropComment();
        } while (_scan.AtEndOfLine());
    }

    void ReadKeyword() {
        NextContentLine("the keyword OFF");
        TextScanner atStart = _scan;
        _keyword = OffKeyword::Read([&](char const* letters) { return _scan.Skip(letters); });
        if (!_keyword.isOff) {
            _scan.Refuse(
                fmt::format("the file starts with {}; OFF, COFF, NOFF, STOFF or CNOFF is "
                            "needed",
                            TextScanner::Quote(atStart.Word())));
        }
        if (_keyword.isHomogeneous)
            _scan.Refuse("4OFF has homogeneous coordinates; divide by the fourth and write OFF");
        if (_keyword.isOfAnyDimension)
            _scan.Refuse("nOFF has coordinates of any dimension; write OFF, which has three");
        if (_scan.Skip("BINARY"))
            _scan.Refuse("'BINARY': binary OFF is not read; write it as text");
    }

    size_t Count(char const* what) {
        double const count = _scan.Number(what);
        constexpr Index kMost = std::numeric_limits<Index>::max() / 4;
        if (count < 0 || count != std::floor(count) || count > kMost) {
            _scan.Refuse(fmt::format("{} is {}; 0 to {} are possible", what, count, kMost));
        }
        return static_cast<size_t>(count);
    }

    void CheckRoom(size_t numVertices, size_t numFaces) const {
        if (_scan.GetRest().size() < 2 * (numVertices + numFaces)) {
            _scan.Refuse(fmt::format("the file is too short for {} vertices and {} faces",
                                     numVertices, numFaces));
        }
    }

    void ReadVertices(size_t count) {
        SkippedLines surplus;
        _scene.positions.reserve(3 * count);
        for (size_t i = 0; i < count; ++i) {
            NextContentLine(fmt::format("vertex {} of {}", i, count).c_str());
            for (char const* axis : {"x", "y", "z"}) _scene.positions.push_back(_scan.Number(axis));
            for (int c = 0; _keyword.hasNormals && c < 3; ++c) _scan.Number("a normal");
            if (_keyword.hasColours) ReadColour();
            for (char const* axis : {"u", "v"}) {
                if (_keyword.hasTexture) _scene.uvs.push_back(_scan.Number(axis));
            }
            if (!_scan.AtEndOfLine()) surplus.Add(_scan.Word(), _scan.GetLineNumber());
        }
        if (surplus.GetCount() > 0) {
            _scene.warnings.push_back(fmt::format(
                "{}:{}: {} of vertices with more than the keyword names, which is not read; "
                "vertices have colours in COFF, normals in NOFF, texture coordinates in STOFF",
                _scene.path, surplus.GetFirstLine(), surplus.DescribeCount()));
        }
        if (_keyword.hasColours && count > 0) {
            ScaleWholeColours(_colours);
            _scene.primvars.push_back({"color", _numColourChannels, std::move(_colours)});
        }
        _scene.cage.numVertices = static_cast<Index>(count);
    }

    /// Three or four numbers; which, the first vertex's line tells.
    void ReadColour() {
        int const numTexture = _keyword.hasTexture ? 2 : 0;
        if (_numColourChannels == 0)
            _numColourChannels = CountNumbersOfLine() - numTexture == 3 ? 3 : 4;
        for (int c = 0; c < _numColourChannels; ++c)
            _colours.push_back(static_cast<float>(_scan.Number("a colour")));
    }

    /// Of what is left of the line.
    int CountNumbersOfLine() const {
        TextScanner ahead = _scan;
        int count = 0;
        while (ahead.TryNumber()) ++count;
        return count;
    }

    void ReadFaces(size_t count) {
        auto& cage = _scene.cage;
        SkippedLines coloured;
        for (size_t i = 0; i < count; ++i) {
            NextContentLine(fmt::format("face {} of {}", i, count).c_str());
            size_t const size = Count("a face's number of corners");
            if (size < 3)
                _scan.Refuse(fmt::format("a face has {} corners; at least 3 are needed", size));
            for (size_t k = 0; k < size; ++k) {
                double const vertex = _scan.Number("a corner's vertex");
                if (!(vertex >= 0) || vertex >= cage.numVertices || vertex != std::floor(vertex)) {
                    _scan.Refuse(fmt::format("a face uses vertex {}; 0 to {} are possible", vertex,
                                             cage.numVertices - 1));
                }
                cage.faceVertices.push_back(static_cast<Index>(vertex));
            }
            cage.faceSizes.push_back(static_cast<int>(size));
            _scene.faceLines.push_back(_scan.GetLineNumber());
            if (!_scan.AtEndOfLine()) coloured.Add(_scan.Word(), _scan.GetLineNumber());
        }
        if (coloured.GetCount() == 0) return;
        _scene.warnings.push_back(
            fmt::format("{}:{}: {} of faces with more than their corners, as colours, which is not "
                        "read; colours of vertices are (COFF)",
                        _scene.path, coloured.GetFirstLine(), coloured.DescribeCount()));
    }

    void NoteRest() {
        SkippedLines rest;
        while (_scan.NextLine()) {
            _scan.DropComment();
            if (!_scan.AtEndOfLine()) rest.Add(_scan.Word(), _scan.GetLineNumber());
        }
        if (rest.GetCount() == 0) return;
        _scene.warnings.push_back(
            fmt::format("{}:{}: {} behind the last face that the file counts, not read",
                        _scene.path, rest.GetFirstLine(), rest.DescribeCount()));
    }

    TextScanner _scan;
    Scene& _scene;
    OffKeyword _keyword;
    int _numColourChannels = 0;
    std::vector<float> _colours;
};

}  // namespace

bool IsOff(std::string_view bytes) {
    std::string_view text = TextScanner::WithoutMark(bytes);
    auto const skip = [&](std::string_view letters) {
        bool const isNext = text.starts_with(letters);
        if (isNext) text.remove_prefix(letters.size());
        return isNext;
    };
    return OffKeyword::Read(skip).isOff;
}

void ReadOff(std::string_view text, Scene& scene) {
    OffReader(text, scene).Read();
}

}  // namespace limn::engine
