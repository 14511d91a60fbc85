// SPDX-License-Identifier: Apache-2.0
#include "engine/measure/mesh_picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "eval/differential/dirmag.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/refiner.h"

namespace limn::engine {

namespace {

using Vector = Eigen::Vector3d;

/// An orthographic picture of a mesh: which value is seen in each pixel.
class MeshPicture {
public:
    MeshPicture(Scene const& scene, PictureView const& view)
        : _scene(scene),
          _size(view.size),
          _camera(view, view.size),
          _depth(NumPixels(), -std::numeric_limits<double>::infinity()),
          _values(NumPixels(), 0.0f),
          _coverage(NumPixels(), 0.0f) {
        for (Index vertex : scene.cage.faceVertices) _camera.Include(PointOf(vertex));
        _camera.Fit();
    }

    /// Draws every face; shade(weights of three corners, their vertices) gives a pixel's value.
    using Shade = std::function<double(Vector const& weights, std::array<Index, 3> const& corners)>;
    void Draw(Shade const& shade) {
        size_t corner = 0;
        for (int size : _scene.cage.faceSizes) {
            auto const at = [&](int i) { return _scene.cage.faceVertices[corner + i]; };
            for (int i = 1; i + 1 < size; ++i) DrawTriangle({at(0), at(i), at(i + 1)}, shade);
            corner += size;
        }
    }

    /// Values in colours, with a legend below.
    Picture MakeColoured(MapColours& colours) const {
        for (size_t pixel = 0; pixel < NumPixels(); ++pixel) {
            if (_coverage[pixel] > 0.0f) colours.Add(0, _values[pixel]);
        }
        colours.Prepare();
        Picture picture(_size, _size);
        for (int y = 0; y < _size; ++y) {
            for (int x = 0; x < _size; ++x) {
                if (_coverage[At(x, y)] > 0.0f)
                    picture.Set(x, y, colours.FindColour({_values[At(x, y)]}));
            }
        }
        return Stack(picture, colours.DrawLegend(_scene.name, _size));
    }

    /// Draws an arrow round each of some vertices that are seen, no two nearer than `spacing`
    /// pixels.
    void DrawArrows(std::vector<std::array<double, 3>> const& vectors, double spacing) {
        double longest = 0.0;
        for (auto const& vector : vectors)
            longest = std::max(longest, Vector(vector.data()).norm());
        std::vector<char> isTaken(NumPixels(), 0);
        int const reach = static_cast<int>(spacing);
        for (Index vertex = 0; vertex < _scene.cage.numVertices; ++vertex) {
            Vector const direction(vectors[vertex].data()),
                place = _camera.Project(PointOf(vertex));
            int const x = static_cast<int>(place.x()), y = static_cast<int>(place.y());
            if (!(direction.norm() > 1e-6 * longest) || !IsSeen(place, 2.0 / _camera.GetScale()) ||
                isTaken[At(x, y)])
                continue;
            for (int dy = -reach; dy <= reach; ++dy) {
                for (int dx = -reach; dx <= reach; ++dx) {
                    if (IsInside(x + dx, y + dy) && dx * dx + dy * dy < spacing * spacing)
                        isTaken[At(x + dx, y + dy)] = 1;
                }
            }
            Vector const flat = direction.normalized();
            DrawArrow({place.x(), place.y()}, 0.8 * spacing *
                                                  Eigen::Vector2d(flat.dot(_camera.GetRight()),
                                                                  -flat.dot(_camera.GetUp())));
        }
    }

    /// Draws a line of points near the surface where it is seen.
    void DrawLineOnSurface(std::vector<Vector> const& points) {
        double const slack = kPixelsOff / _camera.GetScale();
        for (size_t i = 1; i < points.size(); ++i) {
            Vector const from = _camera.Project(points[i - 1]),
                         step = _camera.Project(points[i]) - from;
            int const count = static_cast<int>(std::ceil(2.0 * step.head<2>().norm()));
            for (int k = 0; k < count; ++k) {
                Vector const at = from + step * k / count;
                if (IsSeen(at, slack)) DrawDot(at.head<2>());
            }
        }
    }

    /// Values from 0 (black) to 1 as greys, without a legend: they measure nothing.
    Picture MakeGrey() const {
        Picture picture(_size, _size);
        for (size_t pixel = 0; pixel < NumPixels(); ++pixel) {
            if (!(_coverage[pixel] > 0.0f)) continue;
            float const grey = _values[pixel];
            picture.SetGrey(pixel, ToBytes({grey, grey, grey})[0]);
        }
        return picture;
    }

    PictureCamera const& GetCamera() const { return _camera; }

private:
    static constexpr double kPixelsOff = 4.0;  // as far as lines lie off the mesh, at most

    size_t NumPixels() const { return static_cast<size_t>(_size) * static_cast<size_t>(_size); }
    Vector PointOf(Index vertex) const { return far_ext::Points(_scene.positions)[vertex]; }

    bool IsInside(int x, int y) const { return x >= 0 && y >= 0 && x < _size && y < _size; }
    size_t At(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(_size) + static_cast<size_t>(x);
    }

    bool IsSeen(Vector const& place, double slack) const {
        int const x = static_cast<int>(place.x()), y = static_cast<int>(place.y());
        return IsInside(x, y) && place.z() > _depth[At(x, y)] - slack;
    }

    /// A black line, two pixels wide, over what is covered already.
    void DrawLine(Eigen::Vector2d const& from, Eigen::Vector2d const& step) {
        int const count = static_cast<int>(std::ceil(2.0 * step.norm()));
        for (int i = 0; i <= count; ++i) {
            DrawDot(from + step * i / std::max(1, count));
        }
    }

    void DrawDot(Eigen::Vector2d const& p) {
        for (int corner = 0; corner < 4; ++corner) {
            int const x = static_cast<int>(std::floor(p.x() - 0.5)) + corner % 2,
                      y = static_cast<int>(std::floor(p.y() - 0.5)) + corner / 2;
            if (IsInside(x, y) && _coverage[At(x, y)] > 0.0f) _values[At(x, y)] = 0.0f;
        }
    }

    /// Round its middle, with a head of two barbs.
    void DrawArrow(Eigen::Vector2d const& middle, Eigen::Vector2d const& step) {
        Eigen::Vector2d const tip = middle + 0.5 * step, aside(-step.y(), step.x());
        DrawLine(middle - 0.5 * step, step);
        DrawLine(tip, -0.35 * step + 0.2 * aside);
        DrawLine(tip, -0.35 * step - 0.2 * aside);
    }

    void DrawTriangle(std::array<Index, 3> const& corners, Shade const& shade) {
        std::array<Vector, 3> projected;
        for (size_t k = 0; k < 3; ++k) projected[k] = _camera.Project(PointOf(corners[k]));
        Vector const heights(projected[0].z(), projected[1].z(), projected[2].z());
        ForEachPixel(_size, projected, [&](int x, int y, Vector const& weights) {
            double const depth = weights.dot(heights);
            size_t const pixel = At(x, y);
            if (!(depth > _depth[pixel])) return;
            _depth[pixel] = depth;
            _coverage[pixel] = 1.0f;
            _values[pixel] = static_cast<float>(shade(weights, corners));
        });
    }

    Scene const& _scene;
    int _size;
    PictureCamera _camera;
    std::vector<double> _depth;
    std::vector<float> _values, _coverage;
};

Vector BlendNormal(far_ext::Points normals, Vector const& weights,
                   std::array<Index, 3> const& corners) {
    Vector normal = Vector::Zero();
    for (int k = 0; k < 3; ++k) normal += weights[k] * normals[corners[k]];
    return normal.normalized();
}

/// A smooth mesh, brighter where it faces the eye.
MeshPicture DrawLit(Scene const& scene, PictureView const& view) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const normals = eval::FindAngleNormals(refiner->GetLevel(0), scene.positions);
    MeshPicture picture(scene, view);
    picture.Draw([&](Vector const& weights, std::array<Index, 3> const& corners) {
        return 0.4 + 0.6 * std::abs(BlendNormal(normals, weights, corners)
                                        .dot(picture.GetCamera().GetDirectionToEye()));
    });
    return picture;
}

}  // namespace

Picture DrawValues(Scene const& scene, MapTraits const& map, PictureView const& view,
                   std::optional<PreviewRange> const& range) {
    auto const found =
        std::find_if(scene.primvars.begin(), scene.primvars.end(),
                     [&](Primvar const& p) { return p.name == map.name && p.numChannels == 1; });
    if (found == scene.primvars.end())
        throw Error(ErrorCode::BadOption, fmt::format("the mesh has no scalar '{}'", map.name));
    MeshPicture picture(scene, view);
    picture.Draw([&](Vector const& weights, std::array<Index, 3> const& corners) {
        double value = 0.0;
        for (int k = 0; k < 3; ++k)
            value += weights[k] * static_cast<double>(found->values[corners[k]]);
        return value;
    });
    MapColours colours(map, range, {});
    return picture.MakeColoured(colours);
}

Picture DrawShaded(Scene const& scene, PictureView const& view) {
    MeshPicture picture(scene, view);
    far_ext::Points const points(scene.positions);
    picture.Draw([&](Vector const&, std::array<Index, 3> const& corners) {
        auto const origin = points[corners[0]];
        return picture.GetCamera().Shade(
            (points[corners[1]] - origin).cross(points[corners[2]] - origin).normalized());
    });
    return picture.MakeGrey();
}

Picture DrawHighlights(Scene const& scene, PictureView const& view) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const normals = eval::FindAngleNormals(refiner->GetLevel(0), scene.positions);
    MeshPicture picture(scene, view);
    constexpr double kStripes = 24.0;  // from one horizon to the other
    picture.Draw([&](Vector const& weights, std::array<Index, 3> const& corners) {
        Vector const normal = BlendNormal(normals, weights, corners);
        // Strip lights far away, side by side: the reflected ray's height tells which one is met.
        Vector const& eye = picture.GetCamera().GetDirectionToEye();
        Vector const ray = 2.0 * normal.dot(eye) * normal - eye;
        double const height =
            std::asin(std::clamp(ray.dot(picture.GetCamera().GetUp()), -1.0, 1.0)) /
            std::acos(-1.0);
        double const wave = std::cos(2.0 * std::acos(-1.0) * kStripes * height);
        return std::clamp(0.5 + 2.0 * wave, 0.0, 1.0);
    });
    return picture.MakeGrey();
}

Picture DrawArrows(Scene const& scene, std::vector<std::array<double, 3>> const& vectors,
                   PictureView const& view) {
    MeshPicture picture = DrawLit(scene, view);
    picture.DrawArrows(vectors, view.size / 32.0);
    return picture.MakeGrey();
}

Picture DrawLines(Scene const& scene, std::vector<std::vector<Eigen::Vector3d>> const& lines,
                  PictureView const& view) {
    MeshPicture picture = DrawLit(scene, view);
    for (auto const& line : lines) picture.DrawLineOnSurface(line);
    return picture.MakeGrey();
}

}  // namespace limn::engine
