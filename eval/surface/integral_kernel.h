// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limn::eval {

/// Faces that are integrated side by side, one per lane.
inline constexpr int kIntegralLanes = 8;
/// Numbers per point: x of all lanes, then y, then z.
inline constexpr int kIntegralRow = 3 * kIntegralLanes;

/// Sums over places of a surface, per lane; see SurfaceSums.
struct LaneSums {
    double area[kIntegralLanes], volume[kIntegralLanes], bending[kIntegralLanes];
    double mean[kIntegralLanes], meanSquares[kIntegralLanes];
    double gaussian[kIntegralLanes], gaussianSquares[kIntegralLanes];
    double gaussianMagnitude[kIntegralLanes];
    double minMean[kIntegralLanes], maxMean[kIntegralLanes];
    double minGaussian[kIntegralLanes], maxGaussian[kIntegralLanes];
    double count[kIntegralLanes];
};

/// Rows of weights, as in far_ext::SparseRows.
struct WeightRows {
    int numRows;
    int const* offsets;
    int const* indices;
    double const* weights;
};

/// Places in one polynomial piece of each lane's face.
struct IntegralPlaces {
    double const* coefficients;  ///< per power a row, see patch_polynomial.h
    double const* origin;        ///< a row, to be added to the value
    bool isTriangle;
    int count;
    double const* x;  ///< about the piece's centre
    double const* y;
    double const* weights;  ///< of the domain's area
    double scale;           ///< d(x)/d(s)
    double orientation;     ///< +1, or -1 to turn the normal round
};

struct IntegralKernel {
    /// to[row] = the row's weights applied to `from`.
    void (*apply)(WeightRows const& rows, double const* from, double* to);

    /// Adds what lies at the places. Where a lane has no safe tangent plane nothing is added, and
    /// isUnsafe[place * kIntegralLanes + lane] is set.
    void (*accumulate)(IntegralPlaces const& places, LaneSums& sums, unsigned char* isUnsafe);

    /// See eval/kernels/dispatch.h: the same bits on every CPU.
    static IntegralKernel const sse2, avx2, avx512;
};

}  // namespace limn::eval
