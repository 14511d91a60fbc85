// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace limn::engine {

/// How to look at a mesh: from far away along a direction, with y (or z, looking along y) upwards.
struct PictureView {
    std::array<double, 3> from{1.0, 0.6, 0.8};  ///< the side that is seen
    int size = 800;                             ///< pixels, width and height
};

/// The orthographic projection of a view to a square of pixels.
class PictureCamera {
public:
    /// \param size    of the square
    /// \throws Error  BadOption: a view without a direction
    PictureCamera(PictureView const& view, int size);

    /// Adds a point that the picture is to show; all of them before any is projected.
    void Include(Eigen::Vector3d const& point);
    /// Lets what was included fill the picture but for a margin.
    void Fit();

    /// Pixel coordinates, and height towards the eye.
    Eigen::Vector3d Project(Eigen::Vector3d const& point) const {
        double const x = point.dot(_right) - _centre.x(), y = point.dot(_up) - _centre.y();
        return {0.5 * _size + _scale * x, 0.5 * _size - _scale * y, point.dot(_toEye)};
    }

    /// From 0.25 to 0.95: a light above the eye's right shoulder; what it does not reach is not
    /// black.
    ///
    /// \param normal  a unit vector, of either side
    double Shade(Eigen::Vector3d const& normal) const;

    Eigen::Vector3d const& GetDirectionToEye() const { return _toEye; }
    Eigen::Vector3d const& GetUp() const { return _up; }
    Eigen::Vector3d const& GetRight() const { return _right; }
    double GetScale() const { return _scale; }  ///< pixels per unit of length
    int GetSize() const { return _size; }

private:
    int _size;
    Eigen::Vector3d _toEye, _up, _right, _light;
    Eigen::AlignedBox2d _box;
    Eigen::Vector2d _centre = Eigen::Vector2d::Zero();
    double _scale = 1.0;
};

/// Calls visit(x, y, weights of the corners) for the pixels of a square whose centres a triangle
/// covers.
///
/// \param size     of the square
/// \param corners  in pixel coordinates
template <class Visit>
void ForEachPixel(int size, std::array<Eigen::Vector3d, 3> const& corners, Visit visit) {
    auto const& [a, b, c] = corners;
    double const area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (!(std::abs(area) > 0.0)) return;
    auto const first = [&](double low) {
        return std::max(0, static_cast<int>(std::ceil(low - 0.5)));
    };
    auto const last = [&](double high) {
        return std::min(size - 1, static_cast<int>(std::floor(high - 0.5)));
    };
    int const left = first(std::min({a.x(), b.x(), c.x()})),
              right = last(std::max({a.x(), b.x(), c.x()})),
              bottom = last(std::max({a.y(), b.y(), c.y()}));
    for (int y = first(std::min({a.y(), b.y(), c.y()})); y <= bottom; ++y) {
        for (int x = left; x <= right; ++x) {
            double const px = x + 0.5 - a.x(), py = y + 0.5 - a.y();
            double const wb = (px * (c.y() - a.y()) - py * (c.x() - a.x())) / area;
            double const wc = ((b.x() - a.x()) * py - (b.y() - a.y()) * px) / area;
            Eigen::Vector3d const weights(1.0 - wb - wc, wb, wc);
            if (weights.minCoeff() >= -1e-9) visit(x, y, weights);
        }
    }
}

}  // namespace limn::engine
