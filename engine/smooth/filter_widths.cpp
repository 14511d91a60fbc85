// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/filter_widths.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "engine/images/images_module.h"
#include "engine/io/edge_values.h"
#include "engine/io/number_table.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

using Vector = Eigen::Vector3d;

Vector At(std::vector<double> const& positions, Index vertex) {
    return Vector(&positions[3 * static_cast<size_t>(vertex)]);
}

double Length(Scene const& scene, Far::TopologyLevel const& level, Index edge) {
    auto const ends = level.GetEdgeVertices(edge);
    return (At(scene.positions, ends[0]) - At(scene.positions, ends[1])).norm();
}

void CheckWidth(double width, std::string const& path, size_t line) {
    if (width < 0.0)
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}:{}: width {} is negative; a filter width is 0 or more", path,
                                line, width));
}

double Distance(Vector const& point, std::array<std::array<double, 3>, 2> const& segment) {
    Vector const from(segment[0].data()), along = Vector(segment[1].data()) - from;
    double const square = along.squaredNorm(),
                 t = square > 0.0 ? std::clamp((point - from).dot(along) / square, 0.0, 1.0) : 0.0;
    return (point - from - t * along).norm();
}

constexpr double kReach = 3.0;  // widths from an edge to where its filter ends

/// Share of an edge's width at a distance of x widths: 1 up to x = 1, 0 from kReach on, two
/// derivatives continuous.
double FallOff(double x) {
    double const t = std::clamp((kReach - x) / (kReach - 1.0), 0.0, 1.0);
    return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

std::string ReplaceUdim(std::string path, int tile) {
    size_t const at = path.find("<UDIM>");
    return at == std::string::npos ? path : path.replace(at, 6, std::to_string(tile));
}

}  // namespace

FilterWidths FilterWidths::Constant(double width) {
    FilterWidths widths;
    widths._constant = widths._largest = width;
    return widths;
}

FilterWidths FilterWidths::AtVertices(std::vector<double> values) {
    FilterWidths widths;
    for (double value : values) widths._largest = std::max(widths._largest, value);
    widths._atVertices = std::move(values);
    return widths;
}

FilterWidths FilterWidths::LocalEdgeLengths(Scene const& scene, Far::TopologyLevel const& level,
                                            double scale) {
    std::vector<double> means(static_cast<size_t>(level.GetNumVertices()), 0.0);
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        auto const edges = level.GetVertexEdges(vertex);
        for (Index edge : edges) means[vertex] += scale * Length(scene, level, edge) / edges.size();
    }
    return AtVertices(std::move(means));
}

FilterWidths FilterWidths::ReadMap(std::string const& path, Scene const& scene) {
    auto const table = ReadNumberTable(path, {{"vertex", "width"}});
    std::vector<double> widths(static_cast<size_t>(scene.cage.numVertices), 0.0);
    std::vector<size_t> lines(widths.size(), 0);
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        Index const vertex = GetIndex(table, path, row, 0, scene.cage.numVertices, "vertex");
        if (lines[vertex] > 0) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}:{}: vertex {} comes twice, first in line {}", path,
                                    table.lines[row], vertex, lines[vertex]));
        }
        lines[vertex] = table.lines[row];
        widths[vertex] = table.Get(row, 1);
        CheckWidth(widths[vertex], path, table.lines[row]);
    }
    return AtVertices(std::move(widths));
}

FilterWidths FilterWidths::ReadEdges(std::string const& path, Scene const& scene,
                                     Far::TopologyLevel const& level) {
    FilterWidths widths;
    for (EdgeValue const& row : ReadEdgeTable(path, "width", level)) {
        CheckWidth(row.value, path, row.line);
        widths._largest = std::max(widths._largest, row.value);
        if (row.value > 0.0) widths._edges.push_back({{row.from, row.to}, row.value});
    }
    widths.ReachFaces(scene, level);
    return widths;
}

/// Finds the faces near each edge, walking over shared vertices: a near face of another sheet is
/// none.
void FilterWidths::ReachFaces(Scene const& scene, Far::TopologyLevel const& level) {
    std::vector<Eigen::AlignedBox3d> boxes(static_cast<size_t>(level.GetNumFaces()));
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        for (Index vertex : level.GetFaceVertices(face))
            boxes[face].extend(At(scene.positions, vertex));
    }
    _edgesNearFace.resize(boxes.size());
    for (size_t i = 0; i < _edges.size(); ++i) {
        Vector const p = At(scene.positions, _edges[i].ends[0]),
                     q = At(scene.positions, _edges[i].ends[1]);
        _segments.push_back({std::array{p.x(), p.y(), p.z()}, std::array{q.x(), q.y(), q.z()}});
        Eigen::AlignedBox3d around(p.cwiseMin(q), p.cwiseMax(q));
        double const reach = kReach * _edges[i].width;
        around.extend(around.max() + Vector::Constant(reach));
        around.extend(around.min() - Vector::Constant(reach));
        std::vector<Index> front;
        std::set<Index> seen;
        auto const visit = [&](Index vertex) {
            for (Index face : level.GetVertexFaces(vertex)) {
                if (around.intersects(boxes[face]) && seen.insert(face).second)
                    front.push_back(face);
            }
        };
        for (Index end : _edges[i].ends) visit(end);
        while (!front.empty()) {
            Index const face = front.back();
            front.pop_back();
            _edgesNearFace[face].push_back(static_cast<int>(i));
            for (Index vertex : level.GetFaceVertices(face)) visit(vertex);
        }
    }
}

std::vector<double> FilterWidths::SampleEdges(SmoothLevels const& levels,
                                              std::vector<double> const& positions) const {
    auto const& mesh = levels.GetMesh();
    std::vector<double> widths(static_cast<size_t>(mesh.numVertices), 0.0);
    auto const baseFaces = levels.FindBaseFaces();
    for (size_t face = 0; face < baseFaces.size(); ++face) {
        for (int i : _edgesNearFace[baseFaces[face]]) {
            for (int k = 0; k < mesh.faceSize; ++k) {
                Index const vertex =
                    mesh.faces[face * static_cast<size_t>(mesh.faceSize) + static_cast<size_t>(k)];
                double const width = _edges[i].width;
                widths[vertex] = std::max(
                    widths[vertex],
                    width * FallOff(Distance(At(positions, vertex), _segments[i]) / width));
            }
        }
    }
    return widths;
}

FilterWidths FilterWidths::ReadTexture(std::string const& path, double width, Scene const& scene) {
    if (!scene.HasUVs()) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: the mesh has no texture coordinates; `widthTexture` needs "
                                "them ('vt' in OBJ, s,t in PLY)",
                                scene.path));
    }
    FilterWidths widths;
    widths._textureWidth = width;
    auto const& values = scene.cage.fvarChannels[0].valueIndices;
    size_t corner = 0;
    for (int size : scene.cage.faceSizes) {  // a face belongs to its middle's tile
        double u = 0.0, v = 0.0;
        for (int k = 0; k < size; ++k, ++corner) {
            u += scene.uvs[2 * static_cast<size_t>(values[corner])] / size;
            v += scene.uvs[2 * static_cast<size_t>(values[corner]) + 1] / size;
        }
        bool const isInRange = u >= 0.0 && u < 10.0 && v >= 0.0 && v < 100.0;
        widths._tileOfFace.push_back(
            isInRange ? 1001 + static_cast<int>(u) + 10 * static_cast<int>(v) : -1);
    }
    bool const hasTiles = path.find("<UDIM>") != std::string::npos;
    std::set<int> const tiles(widths._tileOfFace.begin(), widths._tileOfFace.end());
    for (int tile : tiles) {
        std::string const file = ReplaceUdim(path, tile);
        bool const isWanted =
            tile >= 0 && (hasTiles ? std::filesystem::exists(file) : tile == 1001);
        if (!isWanted) continue;
        Image image{tile, 0, 0, {}};
        image.values = ReadFirstChannel(file, image.width, image.height);
        for (size_t i = 0; i < image.values.size(); ++i) {
            float const value = image.values[i];
            if (std::isfinite(value) && value >= 0.0f) {
                widths._largest = std::max(widths._largest, width * static_cast<double>(value));
                continue;
            }
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: pixel {},{} is {}; a painted width is a number from 0 up",
                                    file, i % static_cast<size_t>(image.width),
                                    i / static_cast<size_t>(image.width), value));
        }
        widths._images.push_back(std::move(image));
    }
    if (widths._images.empty()) {
        throw Error(ErrorCode::Io, fmt::format("{}: no face lies in tile 1001{}", path,
                                               hasTiles ? " or in a tile that has an image"
                                                        : "; name the others' images with <UDIM>"));
    }
    return widths;
}

/// Bilinear between the middles of pixels; v points upwards, and pixels at the border reach beyond
/// it.
double FilterWidths::Image::Sample(double u, double v) const {
    int const column = (tile - 1001) % 10, row = (tile - 1001) / 10;
    double const x = std::clamp((u - column) * width - 0.5, 0.0, width - 1.0),
                 y = std::clamp((1.0 - (v - row)) * height - 0.5, 0.0, height - 1.0);
    int const x0 = static_cast<int>(x), y0 = static_cast<int>(y), x1 = std::min(x0 + 1, width - 1),
              y1 = std::min(y0 + 1, height - 1);
    auto const at = [&](int i, int j) {
        return static_cast<double>(
            values[static_cast<size_t>(j) * static_cast<size_t>(width) + static_cast<size_t>(i)]);
    };
    double const fx = x - x0, fy = y - y0;
    return (1.0 - fy) * ((1.0 - fx) * at(x0, y0) + fx * at(x1, y0)) +
           fy * ((1.0 - fx) * at(x0, y1) + fx * at(x1, y1));
}

/// At a vertex with several texture coordinates, the mean over its faces' corners.
std::vector<double> FilterWidths::SampleTexture(SmoothLevels& levels) const {
    auto const& mesh = levels.GetMesh();
    auto const uvs = levels.FindCornerUVs();
    auto const baseFaces = levels.FindBaseFaces();
    std::vector<double> widths(static_cast<size_t>(mesh.numVertices), 0.0);
    std::vector<int> counts(widths.size(), 0);
    for (size_t corner = 0; corner < mesh.faces.size(); ++corner) {
        int const tile = _tileOfFace[baseFaces[corner / static_cast<size_t>(mesh.faceSize)]];
        auto const image = std::find_if(_images.begin(), _images.end(),
                                        [&](Image const& i) { return i.tile == tile; });
        ++counts[mesh.faces[corner]];
        if (image != _images.end())
            widths[mesh.faces[corner]] +=
                _textureWidth * image->Sample(uvs[2 * corner], uvs[2 * corner + 1]);
    }
    for (size_t vertex = 0; vertex < widths.size(); ++vertex)
        widths[vertex] /= std::max(1, counts[vertex]);
    return widths;
}

std::vector<double> FilterWidths::SampleLevel(SmoothLevels& levels,
                                              std::vector<double> const& positions) const {
    std::vector<double> widths;
    if (!_images.empty())
        widths = SampleTexture(levels);
    else if (!_edgesNearFace.empty())
        widths = SampleEdges(levels, positions);
    for (double& width : widths) width *= _factor;
    return widths;
}

FilterWidths FilterWidths::Scaled(double factor) const {
    FilterWidths scaled = *this;
    if (IsConstant()) scaled._constant *= factor;
    for (double& width : scaled._atVertices) width *= factor;
    scaled._largest *= factor;
    scaled._factor *= factor;
    return scaled;
}

}  // namespace limn::engine
