// SPDX-License-Identifier: Apache-2.0
//
// Plain loops over lanes that the compiler vectorises; what a kernel may do, see
// eval/kernels/dispatch.h.

#include "eval/surface/surface_kernel.h"

#include "eval/kernels/lanes.h"

namespace limn::eval {

namespace {

constexpr int W = kSurfaceLanes;

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

/// Values and derivatives of `length` bicubic polynomials for one block of lanes: Horner's scheme,
/// whose partial sums are the derivatives. Powers about the piece's centre keep the digits of
/// second derivatives, which sums of a B-spline lose [Limit 9].
template <int Order, class Real>
inline void EvaluateQuads(Real const* coefficients, Real const* x, Real const* y, Real (*p)[W],
                          Real (*ps)[W], Real (*pt)[W], Real (*pss)[W], Real (*pst)[W],
                          Real (*ptt)[W]) {
    for (int d = 0; d < 3; ++d) {
        Real const* const c = coefficients + 16 * d;
        LIMN_INDEPENDENT_LANES
        for (int l = 0; l < W; ++l) {
            Real const u = x[l], v = y[l];
            Real r[4], rs[4], rss[4];
#pragma GCC unroll 4
            for (int j = 0; j < 4; ++j) {
                Real const b2 = c[4 * j + 3] * u + c[4 * j + 2], b1 = b2 * u + c[4 * j + 1];
                r[j] = b1 * u + c[4 * j];
                if constexpr (Order > 0) {
                    Real const d2 = c[4 * j + 3] * u + b2;
                    rs[j] = d2 * u + b1;
                    rss[j] = c[4 * j + 3] * u + d2;
                }
            }
            Real const b2 = r[3] * v + r[2], b1 = b2 * v + r[1];
            p[d][l] = b1 * v + r[0];
            if constexpr (Order > 0) {
                Real const e2 = r[3] * v + b2;
                pt[d][l] = e2 * v + b1;
                Real const s2 = rs[3] * v + rs[2], s1 = s2 * v + rs[1];
                ps[d][l] = s1 * v + rs[0];
                if constexpr (Order > 1) {
                    Real const f2 = rs[3] * v + s2;
                    ptt[d][l] = Real(2) * (r[3] * v + e2);
                    pst[d][l] = f2 * v + s1;
                    pss[d][l] = Real(2) * (((rss[3] * v + rss[2]) * v + rss[1]) * v + rss[0]);
                }
            }
        }
    }
}

/// The same for quartics on a triangle, 15 coefficients each.
template <int Order, class Real>
inline void EvaluateTriangles(Real const* coefficients, Real const* x, Real const* y, Real (*p)[W],
                              Real (*ps)[W], Real (*pt)[W], Real (*pss)[W], Real (*pst)[W],
                              Real (*ptt)[W]) {
    constexpr int kFirst[5] = {0, 5, 9, 12, 14};
    for (int d = 0; d < 3; ++d) {
        Real const* const c = coefficients + 15 * d;
        LIMN_INDEPENDENT_LANES
        for (int l = 0; l < W; ++l) {
            Real const u = x[l], v = y[l];
            Real q0 = 0, q1 = 0, q2 = 0, qs0 = 0, qs1 = 0, qss = 0;
#pragma GCC unroll 5
            for (int j = 4; j >= 0; --j) {
                Real a = 0, as = 0, ass = 0;
#pragma GCC unroll 5
                for (int i = 4 - j; i >= 0; --i) {
                    if constexpr (Order > 1) ass = ass * u + as;
                    if constexpr (Order > 0) as = as * u + a;
                    a = a * u + c[kFirst[j] + i];
                }
                if constexpr (Order > 1) {
                    q2 = q2 * v + q1;
                    qs1 = qs1 * v + qs0;
                    qss = qss * v + ass;
                }
                if constexpr (Order > 0) {
                    q1 = q1 * v + q0;
                    qs0 = qs0 * v + as;
                }
                q0 = q0 * v + a;
            }
            p[d][l] = q0;
            if constexpr (Order > 0) {
                ps[d][l] = qs0;
                pt[d][l] = q1;
            }
            if constexpr (Order > 1) {
                pss[d][l] = Real(2) * qss;
                pst[d][l] = qs1;
                ptt[d][l] = Real(2) * q2;
            }
        }
    }
}

/// Values and derivatives of a block of lanes, per coordinate.
template <class Real>
struct Lanes {
    alignas(64) Real p[3][W], ps[3][W], pt[3][W], pss[3][W], pst[3][W], ptt[3][W];
};

template <class Real>
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

template <class Real>
inline Frame<Real> FindFrame(Lanes<Real> const& v, int l) {
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

template <class Real>
inline Shape<Real> FindShape(Lanes<Real> const& v, Frame<Real> const& frame, Real orientation,
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

/// As a float that is not infinite, whatever it was.
template <class Real>
inline float Narrow(Real x) {
    constexpr Real kLargest = Real(0x1.fffffep127);
    return static_cast<float>(x > kLargest ? kLargest : x < -kLargest ? -kLargest : x);
}

/// out[c * stride] = value of c for three channels.
template <class Real>
inline void PutThree(float* out, size_t stride, Real x, Real y, Real z) {
    out[0] = static_cast<float>(x);
    out[stride] = static_cast<float>(y);
    out[2 * stride] = static_cast<float>(z);
}

/// The direction of k1.
template <class Real>
inline void PutDirection(Lanes<Real> const& v, Frame<Real> const& frame, Shape<Real> const& shape,
                         float* out, size_t stride, int l) {
    Real const m1 = shape.w11 < Real(0) ? -shape.w11 : shape.w11,
               m2 = shape.w22 < Real(0) ? -shape.w22 : shape.w22;
    bool const isUmbilic = shape.deviation <= Real(1e-5) * (m1 > m2 ? m1 : m2);
    Real const safe = isUmbilic ? Real(1) : shape.deviation;
    // Half of the angle with cosine c and sine s; the larger half first.
    Real const c = shape.half / safe, s = shape.w12 / safe;
    Real const ac = c < Real(0) ? -c : c, as = s < Real(0) ? -s : s;
    Real const large = SquareRoot(Real(0.5) * (Real(1) + ac));
    Real const small = Real(0.5) * as / large;
    Real const cosine = c >= Real(0) ? large : small;
    Real const sine = c >= Real(0) ? small : large;
    Real const along = isUmbilic ? Real(1) : cosine;
    Real const across = isUmbilic ? Real(0) : (s < Real(0) ? -sine : sine);
    Real const ip = Real(1) / SquareRoot(frame.ss);
    Real const ax = v.ps[0][l] * ip, ay = v.ps[1][l] * ip, az = v.ps[2][l] * ip;
    Real const bx = frame.ny * az - frame.nz * ay, by = frame.nz * ax - frame.nx * az,
               bz = frame.nx * ay - frame.ny * ax;
    PutThree(out + kDirectionX * stride, stride, along * ax + across * bx, along * ay + across * by,
             along * az + across * bz);
}

/// All channels of the quantity but the position, of one lane.
template <Quantity Q, class Real>
inline void PutLane(Lanes<Real> const& v, Real orientation, Real scale, float* out, size_t stride,
                    unsigned* degenerate, int l) {
    Frame<Real> const frame = FindFrame(v, l);
    *degenerate = frame.isSafe ? 0u : 1u;
    PutThree(out + kNormalX * stride, stride, frame.nx * orientation, frame.ny * orientation,
             frame.nz * orientation);
    if constexpr (Q == Quantity::Tangents) {
        PutThree(out + kTangentSX * stride, stride, v.ps[0][l] * scale, v.ps[1][l] * scale,
                 v.ps[2][l] * scale);
        PutThree(out + kTangentTX * stride, stride, v.pt[0][l] * scale, v.pt[1][l] * scale,
                 v.pt[2][l] * scale);
    }
    if constexpr (Q >= Quantity::Curvature) {
        Shape<Real> const shape = FindShape(v, frame, orientation, l);
        out[kMean * stride] = Narrow(shape.mean);
        out[kGaussian * stride] = Narrow(shape.w11 * shape.w22 - shape.w12 * shape.w12);
        out[kK1 * stride] = Narrow(shape.mean + shape.deviation);
        out[kK2 * stride] = Narrow(shape.mean - shape.deviation);
        if constexpr (Q >= Quantity::Direction) PutDirection(v, frame, shape, out, stride, l);
    }
}

template <Quantity Q, bool IsTriangle, class Real>
void EvaluateAs(SurfaceBatch<Real> const& batch) {
    constexpr int kOrder = Q == Quantity::Position ? 0 : Q == Quantity::Normal ? 1 : 2;
    Lanes<Real> v;
    size_t const stride = batch.stride;
    Real const orientation = batch.orientation, scale = batch.scale;
    for (int i = 0; i < batch.count; i += W) {
        if constexpr (IsTriangle) {
            EvaluateTriangles<kOrder>(batch.coefficients, batch.x + i, batch.y + i, v.p, v.ps, v.pt,
                                      v.pss, v.pst, v.ptt);
        } else {
            EvaluateQuads<kOrder>(batch.coefficients, batch.x + i, batch.y + i, v.p, v.ps, v.pt,
                                  v.pss, v.pst, v.ptt);
        }
        float* const out = batch.out + i;
        for (int d = 0; d < 3; ++d) {
            for (int l = 0; l < W; ++l) out[d * stride + l] = static_cast<float>(v.p[d][l]);
        }
        if constexpr (kOrder > 0) {
            unsigned* const degenerate = batch.degenerate + i;
            LIMN_INDEPENDENT_LANES
            for (int l = 0; l < W; ++l) {
                PutLane<Q>(v, orientation, scale, out + l, stride, degenerate + l, l);
            }
        }
    }
}

template <bool IsTriangle, class Real>
void EvaluateAny(SurfaceBatch<Real> const& batch, Quantity quantity) {
    switch (quantity) {
        case Quantity::Position:
            return EvaluateAs<Quantity::Position, IsTriangle>(batch);
        case Quantity::Normal:
            return EvaluateAs<Quantity::Normal, IsTriangle>(batch);
        case Quantity::Tangents:
            return EvaluateAs<Quantity::Tangents, IsTriangle>(batch);
        case Quantity::Curvature:
            return EvaluateAs<Quantity::Curvature, IsTriangle>(batch);
        case Quantity::Direction:
            return EvaluateAs<Quantity::Direction, IsTriangle>(batch);
    }
}

template <class Real>
void Evaluate(SurfaceBatch<Real> const& batch, Quantity quantity, bool isTriangle) {
    isTriangle ? EvaluateAny<true>(batch, quantity) : EvaluateAny<false>(batch, quantity);
}

}  // namespace

constinit SurfaceKernel const SurfaceKernel::LIMN_KERNEL = {{Evaluate<float>}, {Evaluate<double>}};

}  // namespace limn::eval
