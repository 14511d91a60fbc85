// SPDX-License-Identifier: Apache-2.0
//
// Eight texels at a time as one value of the compiler's vector type; what a kernel may do, see
// eval/kernels/dispatch.h.

#include "eval/surface/inversion_kernel.h"

namespace limn::eval {

namespace {

// Eight lanes of double; the compiler cuts them to the width of the instruction set.
typedef double Lanes __attribute__((vector_size(8 * kInversionLanes)));
typedef long long Mask __attribute__((vector_size(8 * kInversionLanes)));

constexpr int kMaxNewtonSteps = 12;
constexpr double kMargin = 0.25;  // iterates may leave the domain this far on their way

inline Lanes Load(double const* from) {
    Lanes lanes;
    __builtin_memcpy(&lanes, from, sizeof lanes);
    return lanes;
}
inline void Store(double* to, Lanes lanes) {
    __builtin_memcpy(to, &lanes, sizeof lanes);
}
inline Lanes Larger(Lanes a, Lanes b) {
    return a > b ? a : b;
}
inline Lanes Clamp(Lanes x, double low, double high) {
    Lanes const a = x < low ? Lanes{} + low : x;
    return a > high ? Lanes{} + high : a;
}
inline Lanes Magnitude(Lanes x) {
    return x < 0.0 ? -x : x;
}
inline bool IsAny(Mask mask) {
    long long any = 0;
    for (int l = 0; l < kInversionLanes; ++l) any |= mask[l];
    return any != 0;
}

/// Value and first derivatives of one coordinate of the map.
inline void QuadMap(double const* c, Lanes x, Lanes y, Lanes& f, Lanes& fx, Lanes& fy) {
    Lanes r[4], rx[4];
#pragma GCC unroll 4
    for (int j = 0; j < 4; ++j) {
        Lanes const b2 = c[4 * j + 3] * x + c[4 * j + 2], b1 = b2 * x + c[4 * j + 1];
        r[j] = b1 * x + c[4 * j];
        rx[j] = (c[4 * j + 3] * x + b2) * x + b1;
    }
    Lanes const b2 = r[3] * y + r[2], b1 = b2 * y + r[1];
    f = b1 * y + r[0];
    fy = (r[3] * y + b2) * y + b1;
    fx = ((rx[3] * y + rx[2]) * y + rx[1]) * y + rx[0];
}

inline void TriangleMap(double const* c, Lanes x, Lanes y, Lanes& f, Lanes& fx, Lanes& fy) {
    constexpr int kFirst[5] = {0, 5, 9, 12, 14};
    Lanes q0{}, q1{}, qx{};
#pragma GCC unroll 5
    for (int j = 4; j >= 0; --j) {
        Lanes a{}, ax{};
#pragma GCC unroll 5
        for (int i = 4 - j; i >= 0; --i) {
            ax = ax * x + a;
            a = a * x + c[kFirst[j] + i];
        }
        q1 = q1 * y + q0;
        qx = qx * y + ax;
        q0 = q0 * y + a;
    }
    f = q0;
    fx = qx;
    fy = q1;
}

template <bool IsTriangle>
inline void MapOf(double const* c, Lanes x, Lanes y, Lanes& f, Lanes& fx, Lanes& fy) {
    if constexpr (IsTriangle)
        TriangleMap(c, x, y, f, fx, fy);
    else
        QuadMap(c, x, y, f, fx, fy);
}

/// A Newton step towards the target: how far off (x, y) is, squared, and where to go. Without an
/// inverse Jacobian it stays, and the texel is left to a search that needs none [Bake 2].
struct NewtonStep {
    Lanes residual, dx, dy;
    Mask isRegular;
};

template <bool IsTriangle>
inline NewtonStep FindStep(double const* c, Lanes targetX, Lanes targetY, Lanes x, Lanes y) {
    Lanes u, us, ut, v, vs, vt;
    MapOf<IsTriangle>(c, x, y, u, us, ut);
    MapOf<IsTriangle>(c + 16, x, y, v, vs, vt);
    Lanes const ru = targetX - u, rv = targetY - v;
    Lanes const det = us * vt - ut * vs, size = (us * us + vt * vt) + (ut * ut + vs * vs);
    NewtonStep step;
    step.residual = ru * ru + rv * rv;
    step.isRegular = Magnitude(det) > 1e-12 * size;
    Lanes const inverse = 1.0 / (step.isRegular ? det : Lanes{} + 1.0);
    step.dx = step.isRegular ? (vt * ru - ut * rv) * inverse : Lanes{};
    step.dy = step.isRegular ? (us * rv - vs * ru) * inverse : Lanes{};
    return step;
}

// T_i at Chebyshev's points of order 4, which T_1 lists: on their grid the products T_i T_j are
// orthogonal.
constexpr double kChebyshev[4][4] = {
    {1.0, 1.0, 1.0, 1.0},
    {-0.92387953251128674, -0.38268343236508977, 0.38268343236508977, 0.92387953251128674},
    {0.70710678118654752, -0.70710678118654752, -0.70710678118654752, 0.70710678118654752},
    {-0.38268343236508977, 0.92387953251128674, -0.92387953251128674, 0.38268343236508977}};

/// From sums over T_0 .. T_3 to powers, `stride` apart: fitted once, evaluated for every texel.
inline void ToPowers(double* c, int stride) {
    double const c0 = c[0], c1 = c[stride], c2 = c[2 * stride], c3 = c[3 * stride];
    c[0] = c0 - c2;
    c[stride] = c1 - 3.0 * c3;
    c[2 * stride] = 2.0 * c2;
    c[3 * stride] = 4.0 * c3;
}

/// The cubic polynomial nearest to values on the grid of nodes, values[4 * j + i] at (node i, node
/// j): powers a^i b^j, i + j <= 3, ordered by j, then i.
inline void FitCubic(double const* values, double* cubic) {
    double half[4][4], c[4][4];  // [j][i]
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            double sum = 0.0;
            for (int k = 0; k < 4; ++k) sum += values[4 * j + k] * kChebyshev[i][k];
            half[j][i] = sum;
        }
    }
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            double sum = 0.0;
            for (int k = 0; k < 4; ++k) sum += half[k][i] * kChebyshev[j][k];
            double const norm = (i ? 0.5 : 0.25) * (j ? 0.5 : 0.25);
            c[j][i] = i + j <= 3 ? sum * norm : 0.0;
        }
    }
    for (int j = 0; j < 4; ++j) ToPowers(c[j], 1);
    for (int i = 0; i < 4; ++i) ToPowers(&c[0][i], 4);
    for (int j = 0, at = 0; j < 4; ++j) {
        for (int i = 0; i < 4 - j; ++i) cubic[at++] = c[j][i];
    }
}

inline Lanes EvaluateCubic(double const* c, Lanes a, Lanes b) {
    Lanes const r0 = ((c[3] * a + c[2]) * a + c[1]) * a + c[0];
    Lanes const r1 = (c[6] * a + c[5]) * a + c[4];
    Lanes const r2 = c[8] * a + c[7];
    return ((c[9] * b + r2) * b + r1) * b + r0;
}

template <bool IsTriangle>
void Fit(InversionCell& cell) {
    // Without a fit: the linear part in the cell's own scale. A fit pays from some dozens of texels
    // on [Bake 2].
    for (int k = 0; k < 2; ++k) {
        for (double& c : cell.guess[k]) c = 0.0;
    }
    cell.guess[0][1] = cell.guess[1][4] = cell.reach;
    constexpr double kFewTexels = 64.0;
    if (cell.area < kFewTexels ||
        cell.inverse[0] * cell.inverse[3] == cell.inverse[1] * cell.inverse[2])
        return;

    // The Jacobian from its inverse, to place the nodes at the images of a grid under the linear
    // part.
    double const det = cell.inverse[0] * cell.inverse[3] - cell.inverse[1] * cell.inverse[2];
    double const us = cell.inverse[3] / det, ut = -cell.inverse[1] / det;
    double const vs = -cell.inverse[2] / det, vt = cell.inverse[0] / det;
    double offsetX[16], offsetY[16];
    constexpr int kFitSteps = 2;  // from 3 % of the cell to 1e-3 to 1e-6 of it
    for (int at = 0; at < 16; at += kInversionLanes) {
        Lanes a, b;
        for (int l = 0; l < kInversionLanes; ++l) {
            a[l] = kChebyshev[1][(at + l) % 4] * cell.reach;
            b[l] = kChebyshev[1][(at + l) / 4] * cell.reach;
        }
        Lanes const targetX = cell.value[0] + (us * a + ut * b),
                    targetY = cell.value[1] + (vs * a + vt * b);
        Lanes x = cell.x + a, y = cell.y + b;
        for (int step = 0; step < kFitSteps; ++step) {
            NewtonStep const next = FindStep<IsTriangle>(cell.coefficients, targetX, targetY, x, y);
            x = Clamp(x + next.dx, -2.0, 2.0);
            y = Clamp(y + next.dy, -2.0, 2.0);
        }
        Store(offsetX + at, x - cell.x);
        Store(offsetY + at, y - cell.y);
    }
    FitCubic(offsetX, cell.guess[0]);
    FitCubic(offsetY, cell.guess[1]);
}

/// How far outside the domain (x, y) is, in the larger of both parameters; negative inside.
template <bool IsTriangle>
inline Lanes FindOutside(Lanes x, Lanes y, double centre) {
    Lanes const s = x + centre, t = y + centre;
    if constexpr (IsTriangle)
        return Larger(Larger(-s, -t), 0.5 * (s + t - 1.0));
    else
        return Larger(Larger(-s, s - 1.0), Larger(-t, t - 1.0));
}

/// Newton's method from the fitted guess, until a step from near enough is taken. A lane that is
/// done stays, so that its answer does not depend on its neighbours.
template <bool IsTriangle>
void Invert(InversionCell const& cell, double const* targetX, double const* targetY, int count,
            double* outX, double* outY, Whereabouts* where) {
    // A step from r texels off ends within bend / 2 r^2; the factor covers the Jacobian's change on
    // the way. So a step that begins near enough is the last, and its end need not be looked at
    // [Bake 2].
    constexpr double kSafety = 4.0;
    double const ofBend = 2.0 * kInversionEnd / (kSafety * cell.bend);
    double const lastStep = ofBend < 1e-2 ? (ofBend > 1e-8 ? ofBend : 1e-8) : 1e-2;  // squared
    double const low = -cell.centre - kMargin, high = 1.0 - cell.centre + kMargin;
    double const i11 = cell.inverse[0], i12 = cell.inverse[1], i21 = cell.inverse[2],
                 i22 = cell.inverse[3];
    double const toUnit = 1.0 / cell.reach, tolerance = cell.tolerance * cell.tolerance;
    for (int i = 0; i < count; i += kInversionLanes) {
        Lanes const wantX = Load(targetX + i), wantY = Load(targetY + i);
        Lanes const du = wantX - cell.value[0], dv = wantY - cell.value[1];
        Lanes const a = Clamp((i11 * du + i12 * dv) * toUnit, -1.0, 1.0);
        Lanes const b = Clamp((i21 * du + i22 * dv) * toUnit, -1.0, 1.0);
        Lanes x = Clamp(cell.x + EvaluateCubic(cell.guess[0], a, b), low, high);
        Lanes y = Clamp(cell.y + EvaluateCubic(cell.guess[1], a, b), low, high);
        Lanes residual{};
        Mask isOpen = x == x;
        for (int step = 0; step <= kMaxNewtonSteps; ++step) {
            NewtonStep const next = FindStep<IsTriangle>(cell.coefficients, wantX, wantY, x, y);
            Mask const isLast = (next.residual <= lastStep) & next.isRegular;
            x = isOpen ? Clamp(x + next.dx, low, high) : x;
            y = isOpen ? Clamp(y + next.dy, low, high) : y;
            residual = isOpen ? (isLast ? Lanes{} : next.residual) : residual;
            isOpen = isOpen & ~isLast;
            if (!IsAny(isOpen)) break;
        }
        Store(outX + i, x);
        Store(outY + i, y);
        Lanes const outside = FindOutside<IsTriangle>(x, y, cell.centre);
        Mask place = outside > 0.0 ? Mask{} + static_cast<long long>(Whereabouts::Edge)
                                   : Mask{} + static_cast<long long>(Whereabouts::Inside);
        place =
            outside > cell.outside ? Mask{} + static_cast<long long>(Whereabouts::Outside) : place;
        place =
            residual > tolerance ? Mask{} + static_cast<long long>(Whereabouts::Unsolved) : place;
        typedef uint8_t Bytes __attribute__((vector_size(kInversionLanes)));
        Bytes const bytes = __builtin_convertvector(place, Bytes);
        __builtin_memcpy(where + i, &bytes, sizeof bytes);
    }
}

void FitInverse(InversionCell& cell) {
    cell.isTriangle ? Fit<true>(cell) : Fit<false>(cell);
}

void InvertMap(InversionCell const& cell, double const* targetX, double const* targetY, int count,
               double* x, double* y, Whereabouts* where) {
    cell.isTriangle ? Invert<true>(cell, targetX, targetY, count, x, y, where)
                    : Invert<false>(cell, targetX, targetY, count, x, y, where);
}

}  // namespace

constinit InversionKernel const InversionKernel::LIMN_KERNEL = {FitInverse, InvertMap};

}  // namespace limn::eval
