// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/curvature_disc.h"

#include <cmath>

#include "eval/surface/patch_polynomial.h"
#include "eval/surface/surface_sample.h"

namespace limn::eval {

namespace {

using Place = std::array<double, 2>;  // corner coordinates
constexpr double kPi = 3.14159265358979323846;
constexpr double kSqrt3 = 1.73205080756887729353;

// Gauss-Legendre on [0,1].
constexpr int kNumNodes = 6;
constexpr double kNodes[kNumNodes] = {0.033765242898423986, 0.16939530676686774,
                                      0.38069040695840155,  0.61930959304159845,
                                      0.83060469323313226,  0.96623475710157601};
constexpr double kWeights[kNumNodes] = {0.085662246189585173, 0.18038078652406930,
                                        0.23395696728634552,  0.23395696728634552,
                                        0.18038078652406930,  0.085662246189585173};

// A rule's result is taken where one of half the step agrees with it so well. What is taken is the
// finer one, of which the difference is no error but a wide bound.
constexpr double kTolerance = 1e-7;
constexpr int kMaxHalvings = 8;

bool IsLoop(FaceTree const& tree) {
    return tree.GetNumCoefficients() == kTriangleCoefficients;
}

/// From 1 at x <= 0 to 0 at x >= 1, twice continuously differentiable.
double StepDown(double x) {
    if (x <= 0.0) return 1.0;
    if (x >= 1.0) return 0.0;
    return 1.0 - x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

/// Integral of f over [low, high], by halving where the rule has not settled.
template <class Function>
double Integrate(Function const& f, double low, double high, double whole, int halvings) {
    double const middle = 0.5 * (low + high);
    auto const apply = [&](double from, double to) {
        double sum = 0.0;
        for (int i = 0; i < kNumNodes; ++i) sum += kWeights[i] * f(from + kNodes[i] * (to - from));
        return sum * (to - from);
    };
    double const left = apply(low, middle), right = apply(middle, high);
    if (!(std::abs(left + right - whole) > kTolerance) || halvings == 0) return left + right;
    return Integrate(f, low, middle, left, halvings - 1) +
           Integrate(f, middle, high, right, halvings - 1);
}

/// Integral of f over the square of side `size` at (x, y), by quartering where the rule has not
/// settled.
template <class Function>
double IntegrateSquare(Function const& f, double x, double y, double size, double whole,
                       int quarterings) {
    double const half = 0.5 * size;
    double parts[4], sum = 0.0;
    for (int part = 0; part < 4; ++part) {
        parts[part] = 0.0;
        for (int j = 0; j < kNumNodes; ++j) {
            for (int i = 0; i < kNumNodes; ++i) {
                parts[part] +=
                    kWeights[i] * kWeights[j] * half * half *
                    f(x + half * (part % 2 + kNodes[i]), y + half * (part / 2 + kNodes[j]));
            }
        }
        sum += parts[part];
    }
    if (!(std::abs(sum - whole) > kTolerance) || quarterings == 0) return sum;
    sum = 0.0;
    for (int part = 0; part < 4; ++part) {
        sum += IntegrateSquare(f, x + half * (part % 2), y + half * (part / 2), half, parts[part],
                               quarterings - 1);
    }
    return sum;
}

/// A straight line of the domain as a curve on the surface.
struct CurvePoint {
    Eigen::Vector3d normal;         // not of unit length
    Eigen::Vector3d first, second;  // derivatives
};

CurvePoint EvaluateCurve(FaceTree& tree, DiscSector const& sector, Place const& at,
                         Place const& direction) {
    bool const isLoop = IsLoop(tree);
    auto const [s, t] = FromCorner(isLoop, sector.corner, at[0], at[1]);
    auto const [s0, t0] = FromCorner(isLoop, sector.corner, 0.0, 0.0);
    auto const [s1, t1] = FromCorner(isLoop, sector.corner, direction[0], direction[1]);
    double const p = s1 - s0, q = t1 - t0;
    SurfaceDerivatives const d = EvaluateDerivatives(tree, sector.domain, s, t);
    return {d.ds.cross(d.dt), p * d.ds + q * d.dt,
            p * p * d.dss + 2.0 * p * q * d.dst + q * q * d.dtt};
}

/// The angle by which a curve turns to the left where it comes in along one tangent and leaves
/// along another.
double TurnAt(Eigen::Vector3d const& normal, Eigen::Vector3d const& in,
              Eigen::Vector3d const& out) {
    return std::atan2(normal.dot(in.cross(out)), normal.norm() * in.dot(out));
}

/// Ring between half of the radius and all of it, in its three polynomial pieces of side h: squares
/// or triangles, which are squares with one side collapsed.
double IntegrateRing(FaceTree& tree, DiscSector const& sector) {
    struct Piece {
        Place origin, x, y;
    };
    bool const isLoop = IsLoop(tree);
    double const h = 0.5 * sector.radius;
    Piece const squares[3] = {
        {{h, 0}, {h, 0}, {0, h}}, {{h, h}, {h, 0}, {0, h}}, {{0, h}, {h, 0}, {0, h}}};
    Piece const triangles[3] = {
        {{h, 0}, {h, 0}, {-h, h}}, {{h, h}, {-h, 0}, {h, -h}}, {{0, h}, {h, 0}, {-h, h}}};
    double sum = 0.0;
    for (Piece const& piece : isLoop ? triangles : squares) {
        auto const integrand = [&](double x, double y) {
            double const width = isLoop ? x : 1.0, across = y * width;
            double const a = piece.origin[0] + x * piece.x[0] + across * piece.y[0];
            double const b = piece.origin[1] + x * piece.x[1] + across * piece.y[1];
            auto const [s, t] = FromCorner(isLoop, sector.corner, a, b);
            SurfaceDerivatives const d = EvaluateDerivatives(tree, sector.domain, s, t);
            Eigen::Vector3d const N = d.ds.cross(d.dt);
            double const M = N.dot(d.dst), square = N.squaredNorm();
            double const curvatureArea =
                (N.dot(d.dss) * N.dot(d.dtt) - M * M) / (square * std::sqrt(square));
            return GetDiscWeight(isLoop, a, b, sector.radius) * curvatureArea * width * h * h;
        };
        sum += IntegrateSquare(integrand, 0.0, 0.0, 1.0, 0.0, kMaxHalvings);
    }
    return sum;
}

}  // namespace

std::array<double, 2> ToCorner(bool isLoop, int corner, double s, double t) {
    if (isLoop) {
        double const b[3] = {1.0 - s - t, s, t};
        return {b[(corner + 1) % 3], b[(corner + 2) % 3]};
    }
    switch (corner) {
        case 0:
            return {s, t};
        case 1:
            return {t, 1.0 - s};
        case 2:
            return {1.0 - s, 1.0 - t};
        default:
            return {1.0 - t, s};
    }
}

std::array<double, 2> FromCorner(bool isLoop, int corner, double a, double b) {
    if (isLoop) {
        double const barycentric[3] = {1.0 - a - b, a, b};
        return {barycentric[(4 - corner) % 3], barycentric[(5 - corner) % 3]};
    }
    switch (corner) {
        case 0:
            return {a, b};
        case 1:
            return {1.0 - b, a};
        case 2:
            return {1.0 - a, 1.0 - b};
        default:
            return {b, 1.0 - a};
    }
}

double GetDiscWeight(bool isLoop, double a, double b, double radius) {
    double const x = 2.0 * a / radius, y = 2.0 * b / radius;
    if (!isLoop) return StepDown(x - 1.0) * StepDown(y - 1.0);
    // Six triangles of a regular vertex make a hexagon; this is the distance in it, the same for
    // all of them.
    return StepDown((std::sqrt(x * x + x * y + y * y) - 1.0) / (kSqrt3 - 1.0));
}

double IntegrateInnerDisc(FaceTree& tree, std::span<DiscSector const> sectors) {
    double turned = 0.0;
    Eigen::Vector3d firstOut, lastIn, lastNormal;
    for (size_t i = 0; i < sectors.size(); ++i) {
        DiscSector const& sector = sectors[i];
        double const h = 0.5 * sector.radius;
        Place const square[3] = {{h, 0}, {h, h}, {0, h}}, triangle[2] = {{h, 0}, {0, h}};
        std::span<Place const> const border =
            IsLoop(tree) ? std::span<Place const>(triangle) : square;
        tree.Bind(sector.face);
        for (size_t k = 0; k + 1 < border.size(); ++k) {
            Place const from = border[k],
                        step{border[k + 1][0] - from[0], border[k + 1][1] - from[1]};
            auto const at = [&](double tau) {
                return EvaluateCurve(tree, sector,
                                     {from[0] + tau * step[0], from[1] + tau * step[1]}, step);
            };
            auto const geodesic = [&](double tau) {  // curvature times speed
                CurvePoint const c = at(tau);
                return c.normal.dot(c.first.cross(c.second)) /
                       (c.normal.norm() * c.first.squaredNorm());
            };
            turned += Integrate(geodesic, 0.0, 1.0, 0.0, kMaxHalvings);
            CurvePoint const begin = at(0.0), end = at(1.0);
            if (i == 0 && k == 0)
                firstOut = begin.first;
            else
                turned += TurnAt(lastNormal, lastIn, begin.first);
            lastIn = end.first;
            lastNormal = end.normal;
        }
    }
    return 2.0 * kPi - (turned + TurnAt(lastNormal, lastIn, firstOut));
}

double IntegrateDisc(FaceTree& tree, std::span<DiscSector const> sectors) {
    double sum = IntegrateInnerDisc(tree, sectors);
    for (DiscSector const& sector : sectors) {
        tree.Bind(sector.face);
        sum += IntegrateRing(tree, sector);
    }
    return sum;
}

}  // namespace limn::eval
