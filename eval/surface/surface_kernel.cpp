// SPDX-License-Identifier: Apache-2.0
//
// Plain loops over lanes that the compiler vectorises; what a kernel may do, see
// eval/kernels/dispatch.h.

#include "eval/surface/surface_kernel.h"

#include "eval/kernels/lanes.h"
#include "eval/surface/surface_lanes.h"

namespace limn::eval {

namespace {

constexpr int W = kSurfaceLanes;

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
inline void PutDirection(Lanes<Real, W> const& v, Frame<Real> const& frame,
                         Shape<Real> const& shape, float* out, size_t stride, int l) {
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
inline void PutLane(Lanes<Real, W> const& v, Real orientation, Real scale, float* out,
                    size_t stride, unsigned* degenerate, int l) {
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
    Lanes<Real, W> v;
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
