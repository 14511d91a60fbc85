// SPDX-License-Identifier: Apache-2.0
#include "engine/io/off_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/io/text_scanner.h"

namespace limn::engine {

namespace {

/// OFF is a stream of words; lines matter only where a face's colour ends.
class OffReader {
public:
    OffReader(std::string_view text, Scene& scene) : _scan(text, scene.path), _scene(scene) {}

    void Read() {
        NextContentLine("the keyword OFF");
        std::string_view const keyword = _scan.Word();
        bool const hasColours = keyword == "COFF";
        if (keyword != "OFF" && !hasColours) {
            _scan.Refuse(fmt::format("the file starts with {}; OFF or COFF is needed",
                                     TextScanner::Quote(keyword)));
        }
        if (_scan.AtEndOfLine()) NextContentLine("the counts");
        size_t const numVertices = Count("the number of vertices"),
                     numFaces = Count("the number of faces");
        if (numFaces == 0) _scan.Refuse("the file has no faces; limn needs polygons");
        CheckRoom(numVertices, numFaces);
        ReadVertices(numVertices, hasColours);
        ReadFaces(numFaces);
    }

private:
    void NextContentLine(char const* what) {
        do {
            if (!_scan.NextLine()) _scan.Refuse(fmt::format("the file ends before {}", what));
            _scan.DropComment();
        } while (_scan.AtEndOfLine());
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

    void ReadVertices(size_t count, bool hasColours) {
        _scene.positions.reserve(3 * count);
        if (hasColours) _scene.primvars.push_back({"color", 4, {}});
        for (size_t i = 0; i < count; ++i) {
            NextContentLine(fmt::format("vertex {} of {}", i, count).c_str());
            for (char const* axis : {"x", "y", "z"}) _scene.positions.push_back(_scan.Number(axis));
            for (int c = 0; hasColours && c < 4; ++c) {
                _scene.primvars[0].values.push_back(static_cast<float>(_scan.Number("a colour")));
            }
        }
        if (hasColours) ScaleColours(_scene.primvars[0].values);
        _scene.cage.numVertices = static_cast<Index>(count);
    }

    /// Colours run from 0 to 1 or, as whole numbers, from 0 to 255; nothing but the numbers tells
    /// which. They come out from 0 to 1, as the bytes of a PLY do.
    static void ScaleColours(std::vector<float>& values) {
        bool const areBytes = std::all_of(values.begin(), values.end(), [](float value) {
            return value >= 0.0f && value <= 255.0f && value == std::floor(value);
        });
        bool const areShares =
            std::all_of(values.begin(), values.end(), [](float value) { return value <= 1.0f; });
        if (!areBytes || areShares) return;
        for (float& value : values) value = static_cast<float>(value * (1.0 / 255));
    }

    void ReadFaces(size_t count) {
        auto& cage = _scene.cage;
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
        }
    }

    TextScanner _scan;
    Scene& _scene;
};

}  // namespace

void ReadOff(std::string_view text, Scene& scene) {
    OffReader(text, scene).Read();
}

}  // namespace limn::engine
