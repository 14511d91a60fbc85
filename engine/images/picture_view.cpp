// SPDX-License-Identifier: Apache-2.0
#include "engine/images/picture_view.h"

#include "far_ext/error.h"

namespace limn::engine {

using Vector = Eigen::Vector3d;

PictureCamera::PictureCamera(PictureView const& view, int size) : _size(size) {
    Vector const from(view.from[0], view.from[1], view.from[2]);
    if (!(from.norm() > 0.0)) throw Error(ErrorCode::BadOption, "`view` 0,0,0 is no direction");
    _toEye = from.normalized();
    Vector const up = std::abs(_toEye.y()) < 0.9 ? Vector::UnitY() : Vector::UnitZ();
    _right = up.cross(_toEye).normalized();
    _up = _toEye.cross(_right);
    _light = (_toEye + 0.5 * _up + 0.4 * _right).normalized();
}

void PictureCamera::Include(Vector const& point) {
    _box.extend(Eigen::Vector2d(point.dot(_right), point.dot(_up)));
}

void PictureCamera::Fit() {
    if (_box.isEmpty()) return;
    double const extent = _box.sizes().maxCoeff();
    if (extent > 0.0) _scale = 0.94 * _size / extent;
    _centre = _box.center();
}

double PictureCamera::Shade(Vector const& normal) const {
    double const side = normal.dot(_toEye) < 0.0 ? -1.0 : 1.0;
    return 0.25 + 0.7 * std::max(0.0, side * normal.dot(_light));
}

}  // namespace limn::engine
