// SPDX-License-Identifier: Apache-2.0
//
// Plain loops over lanes that the compiler vectorises; what a kernel may do, see
// eval/kernels/dispatch.h.

#include "eval/surface/surface_kernel.h"

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
#pragma GCC ivdep
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
#pragma GCC ivdep
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

template <Quantity Q, bool IsTriangle, class Real>
void EvaluateAs(SurfaceBatch<Real> const& batch) {
    constexpr int Order = Q == Quantity::Position ? 0 : Q == Quantity::Normal ? 1 : 2;
    alignas(64) Real p[3][W], ps[3][W], pt[3][W], pss[3][W], pst[3][W], ptt[3][W];
    size_t const stride = batch.stride;
    Real const orientation = batch.orientation, scale = batch.scale;
    for (int i = 0; i < batch.count; i += W) {
        if constexpr (IsTriangle) {
            EvaluateTriangles<Order>(batch.coefficients, batch.x + i, batch.y + i, p, ps, pt, pss,
                                     pst, ptt);
        } else {
            EvaluateQuads<Order>(batch.coefficients, batch.x + i, batch.y + i, p, ps, pt, pss, pst,
                                 ptt);
        }
        float* const out = batch.out + i;
        for (int d = 0; d < 3; ++d) {
            for (int l = 0; l < W; ++l) out[d * stride + l] = static_cast<float>(p[d][l]);
        }
        if constexpr (Order > 0) {
            unsigned* const degenerate = batch.degenerate + i;
#pragma GCC ivdep
            for (int l = 0; l < W; ++l) {
                Real nx = ps[1][l] * pt[2][l] - ps[2][l] * pt[1][l];
                Real ny = ps[2][l] * pt[0][l] - ps[0][l] * pt[2][l];
                Real nz = ps[0][l] * pt[1][l] - ps[1][l] * pt[0][l];
                Real const nn = (nx * nx + ny * ny) + nz * nz;
                Real const ss = (ps[0][l] * ps[0][l] + ps[1][l] * ps[1][l]) + ps[2][l] * ps[2][l];
                Real const st = (ps[0][l] * pt[0][l] + ps[1][l] * pt[1][l]) + ps[2][l] * pt[2][l];
                Real const tt = (pt[0][l] * pt[0][l] + pt[1][l] * pt[1][l]) + pt[2][l] * pt[2][l];
                // No plane, no normal: such a lane is done again in double [Bake 4]. Also where a
                // square under- or overflows, and for a lane that is no number.
                bool const isSafe = nn >= Real(1e-10) * ss * tt && nn > kTiny<Real> &&
                                    nn < kHuge<Real> && ss > kTiny<Real>;
                degenerate[l] = isSafe ? 0u : 1u;
                Real const nnSafe = isSafe ? nn : Real(1), ssSafe = isSafe ? ss : Real(1);
                Real const root = SquareRoot(nnSafe);
                Real const toUnit = Real(1) / root;
                nx = isSafe ? nx * toUnit : Real(0);
                ny = isSafe ? ny * toUnit : Real(0);
                nz = isSafe ? nz * toUnit : Real(0);
                out[kNormalX * stride + l] = static_cast<float>(nx * orientation);
                out[kNormalY * stride + l] = static_cast<float>(ny * orientation);
                out[kNormalZ * stride + l] = static_cast<float>(nz * orientation);
                if constexpr (Q == Quantity::Tangents) {
                    out[kTangentSX * stride + l] = static_cast<float>(ps[0][l] * scale);
                    out[kTangentSY * stride + l] = static_cast<float>(ps[1][l] * scale);
                    out[kTangentSZ * stride + l] = static_cast<float>(ps[2][l] * scale);
                    out[kTangentTX * stride + l] = static_cast<float>(pt[0][l] * scale);
                    out[kTangentTY * stride + l] = static_cast<float>(pt[1][l] * scale);
                    out[kTangentTZ * stride + l] = static_cast<float>(pt[2][l] * scale);
                }
                if constexpr (Order > 1) {
                    Real const e = -((nx * pss[0][l] + ny * pss[1][l]) + nz * pss[2][l]);
                    Real const f = -((nx * pst[0][l] + ny * pst[1][l]) + nz * pst[2][l]);
                    Real const g = -((nx * ptt[0][l] + ny * ptt[1][l]) + nz * ptt[2][l]);
                    // The signs that make a sphere positive, seen from outside [Bake 3].
                    // With p = |x_s|, q = x_t.a1, r = x_t.a2: p p = ss, q p = st, r p = root.
                    Real const qp = st / ssSafe;  // q / p
                    Real const w11 = orientation * (e / ssSafe);
                    Real const w12 = orientation * ((f - e * qp) / root);
                    Real const w22 = orientation *
                                     (((g - Real(2) * f * qp) + e * (qp * qp)) * (ssSafe / nnSafe));
                    Real const mean = Real(0.5) * (w11 + w22), half = Real(0.5) * (w11 - w22);
                    // Half of k1 - k2 as a length: the root of H^2 - K would lose half of the
                    // digits near umbilics.
                    Real const D = SquareRoot(half * half + w12 * w12);
                    out[kMean * stride + l] = static_cast<float>(mean);
                    out[kGaussian * stride + l] = static_cast<float>(w11 * w22 - w12 * w12);
                    out[kK1 * stride + l] = static_cast<float>(mean + D);
                    out[kK2 * stride + l] = static_cast<float>(mean - D);
                    if constexpr (Q >= Quantity::Direction) {
                        Real const m1 = w11 < Real(0) ? -w11 : w11, m2 = w22 < Real(0) ? -w22 : w22;
                        bool const isUmbilic = D <= Real(1e-5) * (m1 > m2 ? m1 : m2);
                        Real const Dsafe = isUmbilic ? Real(1) : D;
                        // Half of the angle with cosine c and sine s; the larger half first.
                        Real const c = half / Dsafe, s = w12 / Dsafe;
                        Real const ac = c < Real(0) ? -c : c, as = s < Real(0) ? -s : s;
                        Real const large = SquareRoot(Real(0.5) * (Real(1) + ac));
                        Real const small = Real(0.5) * as / large;
                        Real const cosine = c >= Real(0) ? large : small;
                        Real const sine = c >= Real(0) ? small : large;
                        Real const along = isUmbilic ? Real(1) : cosine;
                        Real const across = isUmbilic ? Real(0) : (s < Real(0) ? -sine : sine);
                        Real const ip = Real(1) / SquareRoot(ssSafe);
                        Real const ax = ps[0][l] * ip, ay = ps[1][l] * ip, az = ps[2][l] * ip;
                        Real const bx = ny * az - nz * ay, by = nz * ax - nx * az,
                                   bz = nx * ay - ny * ax;
                        out[kDirectionX * stride + l] =
                            static_cast<float>(along * ax + across * bx);
                        out[kDirectionY * stride + l] =
                            static_cast<float>(along * ay + across * by);
                        out[kDirectionZ * stride + l] =
                            static_cast<float>(along * az + across * bz);
                    }
                }
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
