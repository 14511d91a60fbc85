// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Tangent planes and curvature of samples side by side, for kernels alone: nothing here has a name
/// outside of the object that includes it (see eval/kernels/dispatch.h).
namespace limn::eval {
namespace {

inline float SquareRoot(float x) {
    return __builtin_sqrtf(x);
}
inline double SquareRoot(double x) {
    return __builtin_sqrt(x);
}

// Squares beyond these bounds may have under- or overflown.
template <class Real>
constexpr Real kTiny = sizeof(Real) == 4 ? Real(1e-30) : Real(1e-200);
template <class Real>
constexpr Real kHuge = 1 / kTiny<Real>;

/// Values and derivatives of W lanes, per coordinate.
template <class Real, int W>
struct Lanes {
    alignas(64) Real p[3][W], ps[3][W], pt[3][W], pss[3][W], pst[3][W], ptt[3][W];
};

template <class Real, int W>
inline Real Dot(Real const (&a)[3][W], Real const (&b)[3][W], int l) {
    return (a[0][l] * b[0][l] + a[1][l] * b[1][l]) + a[2][l] * b[2][l];
}

/// The tangent plane of a lane: its unit normal and the first fundamental form, made safe to divide
/// by.
template <class Real>
struct Frame {
    Real nx, ny, nz;
    Real nn, root;  ///< squared length of x_s x x_t, and its length
    Real ss, st;    ///< x_s.x_s, x_s.x_t
    bool isSafe;
};

template <class Real, int W>
inline Frame<Real> FindFrame(Lanes<Real, W> const& v, int l) {
    auto const& [p, ps, pt, pss, pst, ptt] = v;
    Frame<Real> frame;
    Real const nx = ps[1][l] * pt[2][l] - ps[2][l] * pt[1][l];
    Real const ny = ps[2][l] * pt[0][l] - ps[0][l] * pt[2][l];
    Real const nz = ps[0][l] * pt[1][l] - ps[1][l] * pt[0][l];
    Real const nn = (nx * nx + ny * ny) + nz * nz;
    Real const ss = Dot(ps, ps, l), tt = Dot(pt, pt, l);
    frame.st = Dot(ps, pt, l);
    // No plane, no normal: such a lane is done again in double [Bake 4]. Also where a square under-
    // or overflows, and for a lane that is no number.
    bool const isSafe =
        nn >= Real(1e-10) * ss * tt && nn > kTiny<Real> && nn < kHuge<Real> && ss > kTiny<Real>;
    frame.isSafe = isSafe;
    frame.nn = isSafe ? nn : Real(1);
    frame.ss = isSafe ? ss : Real(1);
    frame.root = SquareRoot(frame.nn);
    Real const toUnit = Real(1) / frame.root;
    frame.nx = isSafe ? nx * toUnit : Real(0);
    frame.ny = isSafe ? ny * toUnit : Real(0);
    frame.nz = isSafe ? nz * toUnit : Real(0);
    return frame;
}

/// The shape operator of a lane in the frame a1 along x_s, a2 = n x a1.
template <class Real>
struct Shape {
    Real w11, w12, w22;
    Real mean, half;  ///< (w11 + w22) / 2, (w11 - w22) / 2
    Real deviation;   ///< of the principal curvatures from their mean
};

template <class Real, int W>
inline Shape<Real> FindShape(Lanes<Real, W> const& v, Frame<Real> const& frame, Real orientation,
                             int l) {
    auto const& [p, ps, pt, pss, pst, ptt] = v;
    Shape<Real> shape;
    // The signs that make a sphere positive, seen from outside [Bake 3].
    Real const e = -((frame.nx * pss[0][l] + frame.ny * pss[1][l]) + frame.nz * pss[2][l]);
    Real const f = -((frame.nx * pst[0][l] + frame.ny * pst[1][l]) + frame.nz * pst[2][l]);
    Real const g = -((frame.nx * ptt[0][l] + frame.ny * ptt[1][l]) + frame.nz * ptt[2][l]);
    // With p = |x_s|, q = x_t.a1, r = x_t.a2: p p = ss, q p = st, r p = root.
    Real const qp = frame.st / frame.ss;  // q / p
    shape.w11 = orientation * (e / frame.ss);
    shape.w12 = orientation * ((f - e * qp) / frame.root);
    shape.w22 = orientation * (((g - Real(2) * f * qp) + e * (qp * qp)) * (frame.ss / frame.nn));
    shape.mean = Real(0.5) * (shape.w11 + shape.w22);
    shape.half = Real(0.5) * (shape.w11 - shape.w22);
    // Half of k1 - k2 as a length: the root of H^2 - K would lose half of the digits near umbilics.
    shape.deviation = SquareRoot(shape.half * shape.half + shape.w12 * shape.w12);
    return shape;
}

}  // namespace
}  // namespace limn::eval
