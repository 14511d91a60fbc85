// SPDX-License-Identifier: Apache-2.0
#include "engine/measure/mesh_picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "engine/images/colour_scale.h"
#include "eval/differential/dirmag.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/refiner.h"

namespace limn::engine {

namespace {

using Vector = Eigen::Vector3d;

/// The value that a share of them does not pass; reorders them.
float FindQuantile(std::vector<float>& values, double share) {
    if (values.empty()) return 0.0f;
    auto const at =
        values.begin() + static_cast<ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// An orthographic picture of a mesh: which value is seen in each pixel.
class MeshPicture {
public:
    MeshPicture(Scene const& scene, PictureView const& view)
        : _scene(scene),
          _size(view.size),
          _depth(NumPixels(), -std::numeric_limits<double>::infinity()),
          _values(NumPixels(), 0.0f),
          _coverage(NumPixels(), 0.0f) {
        Vector const from(view.from[0], view.from[1], view.from[2]);
        if (!(from.norm() > 0.0)) throw Error(ErrorCode::BadOption, "`view` 0,0,0 is no direction");
        _toEye = from.normalized();
        Vector const up = std::abs(_toEye.y()) < 0.9 ? Vector::UnitY() : Vector::UnitZ();
        _right = up.cross(_toEye).normalized();
        _up = _toEye.cross(_right);
        FitToPicture();
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

    Picture MakeColoured(bool isSigned) const {
        ColourScale const scale = FindScale(isSigned);
        Picture picture(std::max(_size, 128), _size + ColourScale::kBarHeight);
        for (int y = 0; y < _size; ++y) {
            for (int x = 0; x < _size; ++x) {
                if (_coverage[At(x, y)] > 0.0f)
                    picture.Set(x, y, scale.ToColour(_values[At(x, y)]));
            }
        }
        scale.DrawBar(_size, picture);
        return picture;
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
            Vector const direction(vectors[vertex].data()), place = Project(vertex);
            int const x = static_cast<int>(place.x()), y = static_cast<int>(place.y());
            if (!(direction.norm() > 1e-6 * longest) || !IsSeen(place, 2.0 / _scale) ||
                isTaken[At(x, y)])
                continue;
            for (int dy = -reach; dy <= reach; ++dy) {
                for (int dx = -reach; dx <= reach; ++dx) {
                    if (IsInside(x + dx, y + dy) && dx * dx + dy * dy < spacing * spacing)
                        isTaken[At(x + dx, y + dy)] = 1;
                }
            }
            Vector const flat = direction.normalized();
            DrawArrow({place.x(), place.y()},
                      0.8 * spacing * Eigen::Vector2d(flat.dot(_right), -flat.dot(_up)));
        }
    }

    /// Values from 0 (black) to 1 as greys, without a legend: they measure nothing.
    Picture MakeGrey() const {
        Picture picture(_size, _size);
        for (size_t pixel = 0; pixel < NumPixels(); ++pixel) {
            if (!(_coverage[pixel] > 0.0f)) continue;
            float const grey = std::clamp(_values[pixel], 0.0f, 1.0f);
            picture.SetGrey(pixel, static_cast<uint8_t>(255.0f * grey + 0.5f));
        }
        return picture;
    }

    Vector const& GetDirectionToEye() const { return _toEye; }
    double GetScale() const { return _scale; }  ///< pixels per unit of length
    Vector GetUp() const { return _up; }

private:
    /// Leaves out a few extremes, which would hide the rest.
    ColourScale FindScale(bool isSigned) const {
        std::vector<float> values;
        for (size_t pixel = 0; pixel < NumPixels(); ++pixel) {
            if (!(_coverage[pixel] > 0.0f)) continue;
            values.push_back(isSigned ? std::abs(_values[pixel]) : _values[pixel]);
        }
        ColourScale scale{.isSigned = isSigned, .high = FindQuantile(values, 0.98)};
        scale.low = isSigned ? -scale.high : FindQuantile(values, 0.02);
        return scale;
    }

    size_t NumPixels() const { return static_cast<size_t>(_size) * static_cast<size_t>(_size); }
    Vector PointOf(Index vertex) const { return far_ext::Points(_scene.positions)[vertex]; }

    void FitToPicture() {
        Eigen::AlignedBox2d box;
        for (Index vertex : _scene.cage.faceVertices) {
            box.extend(Eigen::Vector2d(PointOf(vertex).dot(_right), PointOf(vertex).dot(_up)));
        }
        double const extent = box.sizes().maxCoeff();
        _scale = extent > 0.0 ? 0.94 * _size / extent : 1.0;
        _centre = box.center();
    }

    /// Pixel coordinates, and height towards the eye.
    Vector Project(Index vertex) const {
        Vector const p = PointOf(vertex);
        double const x = p.dot(_right) - _centre.x(), y = p.dot(_up) - _centre.y();
        return {0.5 * _size + _scale * x, 0.5 * _size - _scale * y, p.dot(_toEye)};
    }

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
            Eigen::Vector2d const p = from + step * i / std::max(1, count);
            for (int corner = 0; corner < 4; ++corner) {
                int const x = static_cast<int>(std::floor(p.x() - 0.5)) + corner % 2,
                          y = static_cast<int>(std::floor(p.y() - 0.5)) + corner / 2;
                if (IsInside(x, y) && _coverage[At(x, y)] > 0.0f) _values[At(x, y)] = 0.0f;
            }
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
        Vector const a = Project(corners[0]), b = Project(corners[1]), c = Project(corners[2]);
        double const area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
        if (!(std::abs(area) > 0.0)) return;
        auto const first = [&](double low) {
            return std::max(0, static_cast<int>(std::ceil(low - 0.5)));
        };
        auto const last = [&](double high) {
            return std::min(_size - 1, static_cast<int>(std::floor(high - 0.5)));
        };
        for (int y = first(std::min({a.y(), b.y(), c.y()}));
             y <= last(std::max({a.y(), b.y(), c.y()})); ++y) {
            for (int x = first(std::min({a.x(), b.x(), c.x()}));
                 x <= last(std::max({a.x(), b.x(), c.x()})); ++x) {
                double const px = x + 0.5, py = y + 0.5;
                double const wb =
                    ((px - a.x()) * (c.y() - a.y()) - (py - a.y()) * (c.x() - a.x())) / area;
                double const wc =
                    ((b.x() - a.x()) * (py - a.y()) - (b.y() - a.y()) * (px - a.x())) / area;
                Vector const weights(1.0 - wb - wc, wb, wc);
                if (weights.minCoeff() < -1e-9) continue;
                double const depth = weights.dot(Vector(a.z(), b.z(), c.z()));
                size_t const pixel = At(x, y);
                if (!(depth > _depth[pixel])) continue;
                _depth[pixel] = depth;
                _coverage[pixel] = 1.0f;
                _values[pixel] = static_cast<float>(shade(weights, corners));
            }
        }
    }

    Scene const& _scene;
    int _size;
    std::vector<double> _depth;
    std::vector<float> _values, _coverage;
    Vector _toEye, _right, _up;
    Eigen::Vector2d _centre;
    double _scale = 1.0;
};

Vector BlendNormal(far_ext::Points normals, Vector const& weights,
                   std::array<Index, 3> const& corners) {
    Vector normal = Vector::Zero();
    for (int k = 0; k < 3; ++k) normal += weights[k] * normals[corners[k]];
    return normal.normalized();
}

}  // namespace

Picture DrawValues(Scene const& scene, std::string const& primvar, PictureView const& view) {
    auto const found =
        std::find_if(scene.primvars.begin(), scene.primvars.end(),
                     [&](Primvar const& p) { return p.name == primvar && p.numChannels == 1; });
    if (found == scene.primvars.end())
        throw Error(ErrorCode::BadOption, fmt::format("the mesh has no scalar '{}'", primvar));
    MeshPicture picture(scene, view);
    picture.Draw([&](Vector const& weights, std::array<Index, 3> const& corners) {
        double value = 0.0;
        for (int k = 0; k < 3; ++k)
            value += weights[k] * static_cast<double>(found->values[corners[k]]);
        return value;
    });
    return picture.MakeColoured(true);
}

Picture DrawShaded(Scene const& scene, PictureView const& view) {
    MeshPicture picture(scene, view);
    // A light above the eye's right shoulder; what it does not reach is not black.
    Vector const eye = picture.GetDirectionToEye(),
                 light =
                     (eye + 0.5 * picture.GetUp() + 0.4 * picture.GetUp().cross(eye)).normalized();
    far_ext::Points const points(scene.positions);
    picture.Draw([&](Vector const&, std::array<Index, 3> const& corners) {
        auto const origin = points[corners[0]];
        Vector normal =
            (points[corners[1]] - origin).cross(points[corners[2]] - origin).normalized();
        if (normal.dot(eye) < 0.0) normal = -normal;
        return 0.25 + 0.7 * std::max(0.0, normal.dot(light));
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
        Vector const ray =
            2.0 * normal.dot(picture.GetDirectionToEye()) * normal - picture.GetDirectionToEye();
        double const height =
            std::asin(std::clamp(ray.dot(picture.GetUp()), -1.0, 1.0)) / std::acos(-1.0);
        double const wave = std::cos(2.0 * std::acos(-1.0) * kStripes * height);
        return std::clamp(0.5 + 2.0 * wave, 0.0, 1.0);
    });
    return picture.MakeColoured(false);
}

Picture DrawArrows(Scene const& scene, std::vector<std::array<double, 3>> const& vectors,
                   PictureView const& view) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const normals = eval::FindAngleNormals(refiner->GetLevel(0), scene.positions);
    MeshPicture picture(scene, view);
    picture.Draw([&](Vector const& weights, std::array<Index, 3> const& corners) {
        return 0.4 +
               0.6 * std::abs(
                         BlendNormal(normals, weights, corners).dot(picture.GetDirectionToEye()));
    });
    picture.DrawArrows(vectors, view.size / 32.0);
    return picture.MakeGrey();
}

}  // namespace limn::engine
