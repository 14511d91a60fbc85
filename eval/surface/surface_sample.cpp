// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/surface_sample.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "eval/surface/patch_polynomial.h"

namespace limn::eval {

namespace {

/// Of pieces that are not too deep for second derivatives.
constexpr double kMostCurvatureScale = size_t{1} << FaceTree::kCurvatureDepth;

std::array<double, 6> EvaluatePolynomial(FaceTree const& tree, PatchPoint const& at, int channel) {
    double const* const c = at.coefficients + channel * tree.GetNumCoefficients();
    return tree.GetNumCoefficients() == kQuadCoefficients
               ? EvaluateQuadPolynomial(c, at.x, at.y)
               : EvaluateTrianglePolynomial(c, at.x, at.y);
}

}  // namespace

SurfaceDerivatives EvaluateDerivatives(FaceTree const& tree, PatchPoint const& at) {
    SurfaceDerivatives d;
    for (int c = 0; c < 3; ++c) {
        auto const v = EvaluateDerivatives(tree, at, c);
        d.position[c] = v[0];
        d.ds[c] = v[1];
        d.dt[c] = v[2];
        d.dss[c] = v[3];
        d.dst[c] = v[4];
        d.dtt[c] = v[5];
    }
    return d;
}

SurfaceDerivatives EvaluateDerivatives(FaceTree& tree, int domain, double s, double t) {
    return EvaluateDerivatives(tree, tree.Locate(domain, s, t, FaceTree::kLimitDepth));
}

bool HasTangentPlane(SurfaceDerivatives const& d, double leastSine) {
    double const ss = d.ds.squaredNorm(), tt = d.dt.squaredNorm();
    return d.ds.cross(d.dt).squaredNorm() > leastSine * leastSine * ss * tt && ss > 0.0 && tt > 0.0;
}

Curvature ComputeCurvature(Eigen::Vector3d const& ds, Eigen::Vector3d const& dt,
                           Eigen::Vector3d const& dss, Eigen::Vector3d const& dst,
                           Eigen::Vector3d const& dtt, Orientation orientation) {
    Eigen::Vector3d const n = ds.cross(dt).normalized();
    double const e = -n.dot(dss), f = -n.dot(dst), g = -n.dot(dtt);
    double const p = ds.norm();
    Eigen::Vector3d const a1 = ds / p, a2 = n.cross(a1);
    double const q = dt.dot(a1), r = dt.dot(a2);
    double const sign = GetSign(orientation);
    double const w11 = sign * e / (p * p);
    double const w12 = sign * (f - e * q / p) / (p * r);
    double const w22 = sign * (g - 2.0 * f * q / p + e * q * q / (p * p)) / (r * r);

    Curvature curvature;
    double const half = 0.5 * (w11 - w22), D = std::sqrt(half * half + w12 * w12);
    curvature.mean = 0.5 * (w11 + w22);
    curvature.gaussian = w11 * w22 - w12 * w12;
    curvature.k1 = curvature.mean + D;
    curvature.k2 = curvature.mean - D;
    curvature.direction = a1;
    if (D > 1e-5 * std::max(std::abs(w11), std::abs(w22))) {
        // Half of the angle with cosine c and sine s, by its larger part first; no libm.
        double const c = half / D, s = w12 / D;
        double const large = std::sqrt(0.5 * (1.0 + std::abs(c))),
                     small = 0.5 * std::abs(s) / large;
        double const along = c >= 0.0 ? large : small, across = c >= 0.0 ? small : large;
        curvature.direction = along * a1 + (s < 0.0 ? -across : across) * a2;
    }
    return curvature;
}

std::array<double, 6> EvaluateDerivatives(FaceTree const& tree, PatchPoint const& at, int channel) {
    tree.CheckChannel(channel);
    auto const v = EvaluatePolynomial(tree, at, channel);
    double const one = at.scale, two = one * one;
    return {at.origin[channel] + v[0], v[1] * one, v[2] * one, v[3] * two, v[4] * two, v[5] * two};
}

SurfaceSample MakeSample(SurfaceDerivatives const& d, Orientation orientation) {
    SurfaceSample sample;
    sample.position = d.position;
    sample.tangentS = d.ds;
    sample.tangentT = d.dt;
    sample.normal = GetSign(orientation) * d.ds.cross(d.dt).normalized();
    sample.curvature = ComputeCurvature(d.ds, d.dt, d.dss, d.dst, d.dtt, orientation);
    return sample;
}

SurfaceSample EvaluateSample(FaceTree& tree, int domain, double s, double t,
                             Orientation orientation) {
    PatchPoint at = tree.Locate(domain, s, t, FaceTree::kLimitDepth);
    SurfaceDerivatives const here = EvaluateDerivatives(tree, at);
    SurfaceSample sample;
    sample.position = here.position;
    sample.tangentS = here.ds;
    sample.tangentT = here.dt;

    SurfaceDerivatives shape = here;
    // No tangent plane: towards the domain's centre, first by 2^-10 of the way, then all of it.
    double const centre = tree.GetCentre();
    double stepped = 0x1p-10, placeS = s, placeT = t;
    while (!HasTangentPlane(shape) && stepped <= 1.0) {
        sample.isDegenerate = true;
        placeS = s + stepped * (centre - s);
        placeT = t + stepped * (centre - t);
        at = tree.Locate(domain, placeS, placeT, FaceTree::kLimitDepth);
        shape = EvaluateDerivatives(tree, at);
        stepped *= 32.0;
    }
    if (!HasTangentPlane(shape)) {  // the face has collapsed to a line or a point
        sample.normal = Eigen::Vector3d::UnitZ();
        sample.curvature.direction = Eigen::Vector3d::UnitX();
        return sample;
    }
    sample.normal = GetSign(orientation) * shape.ds.cross(shape.dt).normalized();

    SurfaceDerivatives second = shape;
    if (std::abs(at.scale) > kMostCurvatureScale) {  // elsewhere, `at` is the piece for both
        PatchPoint const apart = tree.Locate(domain, placeS, placeT, FaceTree::kCurvatureDepth);
        sample.isMoved = apart.isMoved;
        second = EvaluateDerivatives(tree, apart);
    }
    SurfaceDerivatives const& use = HasTangentPlane(second) ? second : shape;
    sample.curvature = ComputeCurvature(use.ds, use.dt, use.dss, use.dst, use.dtt, orientation);
    return sample;
}

double EvaluateChannel(FaceTree& tree, int domain, double s, double t, int channel, int maxDepth) {
    tree.CheckChannel(channel);
    PatchPoint const at = tree.Locate(domain, s, t, maxDepth);
    return at.origin[channel] + EvaluatePolynomial(tree, at, channel)[0];
}

}  // namespace limn::eval
