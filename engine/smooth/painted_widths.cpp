// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/painted_widths.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "engine/scene/udim.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

/// Per face the tile of its middle; -1 outside of all.
std::vector<int> FindTiles(Model const& model) {
    auto const& uvs = model.GetUVs();
    auto const& values = model.GetCage().fvarChannels[0].valueIndices;
    std::vector<int> tiles;
    size_t corner = 0;
    for (int size : model.GetCage().faceSizes) {
        double u = 0.0, v = 0.0;
        for (int k = 0; k < size; ++k, ++corner) {
            u += uvs[2 * values[corner]] / size;
            v += uvs[2 * values[corner] + 1] / size;
        }
        auto const tile = FindUdimTile(u, v);
        tiles.push_back(tile ? tile->GetNumber() : -1);
    }
    return tiles;
}

}  // namespace

PaintedWidths PaintedWidths::Read(std::string const& path, double white, Model const& model) {
    if (!model.HasUVs()) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: the mesh has no texture coordinates; `PaintedWidths` needs "
                                "them ('vt' in OBJ, s,t in PLY)",
                                model.GetPath()));
    }
    auto const& lacksUVs = model.GetFacesLackingUVs();
    if (auto const bare = std::ranges::find(lacksUVs, 1); bare != lacksUVs.end()) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: {} of {} faces have no texture coordinates, first {}; "
                                "`PaintedWidths` needs them",
                                model.GetPath(), std::ranges::count(lacksUVs, 1), lacksUVs.size(),
                                model.NameFace(static_cast<Index>(bare - lacksUVs.begin()))));
    }
    PaintedWidths widths;
    widths._white = white;
    widths._tileOfFace = FindTiles(model);
    bool const hasTiles = HasUdimToken(path);
    std::set<int> numbers(widths._tileOfFace.begin(), widths._tileOfFace.end());
    numbers.erase(-1);
    for (int number : numbers) {
        std::string const file = ReplaceUdimToken(path, number);
        bool const isWanted = hasTiles ? std::filesystem::exists(file) : number == 1001;
        if (isWanted) widths.ReadTile(file, number);
    }
    if (widths._tiles.empty()) {
        // Images of tiles may be missing; the one of tile 1001 cannot help a mesh that lies
        // elsewhere.
        bool const isFileMissing = hasTiles && !numbers.empty();
        throw Error(isFileMissing ? ErrorCode::Io : ErrorCode::BadMesh,
                    fmt::format("{}: no face lies in tile 1001{}", path,
                                hasTiles ? " or in a tile that has an image"
                                         : "; name the others' images with <UDIM>"));
    }
    return widths;
}

void PaintedWidths::ReadTile(std::string const& path, int number) {
    GreyImage image = ReadFirstChannel(path);
    for (size_t i = 0; i < image.values.size(); ++i) {
        float const value = image.values[i];
        if (std::isfinite(value) && value >= 0.0f) {
            _largest = std::max(_largest, _white * static_cast<double>(value));
            continue;
        }
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: pixel {},{} is {}; a painted width is a number from 0 up",
                                path, i % image.width, i / image.width, value));
    }
    _tiles.push_back({number, std::move(image)});
}

/// Bilinear between the middles of pixels; v points upwards, and pixels at the border reach beyond
/// it.
double PaintedWidths::Tile::Sample(double u, double v) const {
    auto const [column, row] = ToUdimTile(number);
    int const width = image.width, height = image.height;
    double const x = std::clamp((u - column) * width - 0.5, 0.0, width - 1.0),
                 y = std::clamp((1.0 - (v - row)) * height - 0.5, 0.0, height - 1.0);
    int const x0 = static_cast<int>(x), y0 = static_cast<int>(y), x1 = std::min(x0 + 1, width - 1),
              y1 = std::min(y0 + 1, height - 1);
    auto const at = [&](int i, int j) {
        return static_cast<double>(image.values[static_cast<size_t>(j) * width + i]);
    };
    double const fx = x - x0, fy = y - y0;
    return (1.0 - fy) * ((1.0 - fx) * at(x0, y0) + fx * at(x1, y0)) +
           fy * ((1.0 - fx) * at(x0, y1) + fx * at(x1, y1));
}

/// At a vertex with several texture coordinates, the mean over its faces' corners.
std::vector<double> PaintedWidths::Sample(SmoothLevels& levels) const {
    auto const& mesh = levels.GetMesh();
    auto const uvs = levels.FindCornerUVs();
    auto const baseFaces = levels.FindBaseFaces();
    std::vector<double> widths(mesh.numVertices, 0.0);
    std::vector<int> counts(widths.size(), 0);
    for (size_t corner = 0; corner < mesh.faces.size(); ++corner) {
        int const number = _tileOfFace[baseFaces[corner / mesh.faceSize]];
        auto const tile = std::find_if(_tiles.begin(), _tiles.end(),
                                       [&](Tile const& t) { return t.number == number; });
        ++counts[mesh.faces[corner]];
        if (tile != _tiles.end())
            widths[mesh.faces[corner]] +=
                _white * tile->Sample(uvs[2 * corner], uvs[2 * corner + 1]);
    }
    for (size_t vertex = 0; vertex < widths.size(); ++vertex)
        widths[vertex] /= std::max(1, counts[vertex]);
    return widths;
}

}  // namespace limn::engine
