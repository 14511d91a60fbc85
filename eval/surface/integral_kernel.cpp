// SPDX-License-Identifier: Apache-2.0
//
// Plain loops over lanes that the compiler vectorises; what a kernel may do, see
// eval/kernels/dispatch.h.

#include "eval/surface/integral_kernel.h"

#include "eval/kernels/lanes.h"
#include "eval/surface/surface_lanes.h"

namespace limn::eval {

namespace {

constexpr int W = kIntegralLanes;

void Apply(WeightRows const& rows, double const* from, double* to) {
    for (int row = 0; row < rows.numRows; ++row) {
        double sum[kIntegralRow] = {};
        for (int k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k) {
            double const* const point = from + static_cast<long>(rows.indices[k]) * kIntegralRow;
            double const weight = rows.weights[k];
            for (int i = 0; i < kIntegralRow; ++i) sum[i] += weight * point[i];
        }
        for (int i = 0; i < kIntegralRow; ++i) to[i] = sum[i];
        to += kIntegralRow;
    }
}

/// Horner's scheme in x, then in y; partial sums are the derivatives.
///
/// \param degree  of x beside y^j
template <int NumRows, class Degree>
inline void EvaluatePlace(double const* c, double u, double v, Degree degree,
                          Lanes<double, W>& at) {
    for (int d = 0; d < 3; ++d) {
        LIMN_INDEPENDENT_LANES
        for (int l = 0; l < W; ++l) {
            double q0 = 0, q1 = 0, q2 = 0, qs0 = 0, qs1 = 0, qss = 0;
            int first = 0;
#pragma GCC unroll 5
            for (int j = 0; j < NumRows; ++j) first += degree(j) + 1;
#pragma GCC unroll 5
            for (int j = NumRows - 1; j >= 0; --j) {
                first -= degree(j) + 1;
                double a = 0, as = 0, ass = 0;
#pragma GCC unroll 5
                for (int i = degree(j); i >= 0; --i) {
                    ass = ass * u + as;
                    as = as * u + a;
                    a = a * u + c[(first + i) * kIntegralRow + d * W + l];
                }
                q2 = q2 * v + q1;
                q1 = q1 * v + q0;
                q0 = q0 * v + a;
                qs1 = qs1 * v + qs0;
                qs0 = qs0 * v + as;
                qss = qss * v + ass;
            }
            at.p[d][l] = q0;
            at.ps[d][l] = qs0;
            at.pt[d][l] = q1;
            at.pss[d][l] = 2.0 * qss;
            at.pst[d][l] = qs1;
            at.ptt[d][l] = 2.0 * q2;
        }
    }
}

inline double Magnitude(double x) {
    return x < 0.0 ? -x : x;
}

/// Adds one place to lane l.
inline void AddPlace(Lanes<double, W> const& at, IntegralPlaces const& places, double weight,
                     LaneSums& sums, unsigned char* isUnsafe, int l) {
    Frame<double> const frame = FindFrame(at, l);
    Shape<double> const shape = FindShape(at, frame, places.orientation, l);
    bool const isSafe = frame.isSafe;
    isUnsafe[l] = isSafe ? 0 : 1;
    double const area = isSafe ? weight * (frame.root * (places.scale * places.scale)) : 0.0;
    double const height = ((places.origin[l] + at.p[0][l]) * frame.nx +
                           (places.origin[W + l] + at.p[1][l]) * frame.ny) +
                          (places.origin[2 * W + l] + at.p[2][l]) * frame.nz;
    double const k1 = shape.mean + shape.deviation, k2 = shape.mean - shape.deviation;
    double const h = isSafe ? 0.5 * (k1 + k2) : 0.0, k = isSafe ? k1 * k2 : 0.0;
    sums.area[l] += area;
    sums.volume[l] += area * (places.orientation * height) / 3.0;
    sums.bending[l] += isSafe ? area * (k1 * k1 + k2 * k2) : 0.0;
    sums.mean[l] += area * h;
    sums.meanSquares[l] += area * h * h;
    sums.gaussian[l] += area * k;
    sums.gaussianSquares[l] += area * k * k;
    sums.gaussianMagnitude[l] += area * Magnitude(k);
    sums.minMean[l] = isSafe && h < sums.minMean[l] ? h : sums.minMean[l];
    sums.maxMean[l] = isSafe && h > sums.maxMean[l] ? h : sums.maxMean[l];
    sums.minGaussian[l] = isSafe && k < sums.minGaussian[l] ? k : sums.minGaussian[l];
    sums.maxGaussian[l] = isSafe && k > sums.maxGaussian[l] ? k : sums.maxGaussian[l];
    sums.count[l] += isSafe ? 1.0 : 0.0;
}

void Accumulate(IntegralPlaces const& places, LaneSums& sums, unsigned char* isUnsafe) {
    Lanes<double, W> at;
    for (int i = 0; i < places.count; ++i) {
        if (places.isTriangle) {
            EvaluatePlace<5>(
                places.coefficients, places.x[i], places.y[i], [](int j) { return 4 - j; }, at);
        } else {
            EvaluatePlace<4>(
                places.coefficients, places.x[i], places.y[i], [](int) { return 3; }, at);
        }
        unsigned char* const flags = isUnsafe + i * W;
        double const weight = places.weights[i];
        LIMN_INDEPENDENT_LANES
        for (int l = 0; l < W; ++l) AddPlace(at, places, weight, sums, flags, l);
    }
}

}  // namespace

constinit IntegralKernel const IntegralKernel::LIMN_KERNEL = {Apply, Accumulate};

}  // namespace limn::eval
