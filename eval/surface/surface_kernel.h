// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace limn::eval {

/// What a batch of surface samples is evaluated to; each includes what stands before it.
enum class Quantity { Position, Normal, Curvature, Direction, Tangents };

/// Channels of a batch, in planes of `stride` floats.
enum SurfaceChannel {
    kPositionX,
    kPositionY,
    kPositionZ,  ///< all quantities
    kNormalX,
    kNormalY,
    kNormalZ,  ///< Normal
    kMean,
    kGaussian,
    kK1,
    kK2,  ///< Curvature
    kDirectionX,
    kDirectionY,
    kDirectionZ,  ///< Direction: of k1
    kTangentSX,
    kTangentSY,
    kTangentSZ,  ///< Tangents: dP/ds, dP/dt of the domain
    kTangentTX,
    kTangentTY,
    kTangentTZ
};

/// Number of channels of a quantity.
constexpr int GetNumChannels(Quantity quantity) {
    constexpr int kNum[] = {3, 6, 10, 13, 19};
    return kNum[static_cast<int>(quantity)];
}

/// Samples of one polynomial piece, all lanes alike. `x`, `y` and every output plane must be
/// readable and writable up to the next multiple of kSurfaceLanes.
inline constexpr int kSurfaceLanes = 16;

/// Real is float, or double where float would lose the second derivatives' digits: in pieces deep
/// at an extraordinary vertex, where they shrink against the first ones, and on triangles'
/// quartics.
template <class Real>
struct SurfaceBatch {
    Real const* coefficients;  ///< [3][16] (Loop: [3][15]), see patch_polynomial.h
    Real const* x;             ///< about the piece's centre
    Real const* y;
    int count;
    float scale;        ///< d(x)/d(s), for Tangents
    float orientation;  ///< +1, or -1 to turn the normal round
    float* out;         ///< planes: out[channel * stride + i]
    size_t stride;
    unsigned* degenerate;  ///< one per sample: 1 where no safe tangent plane is found, see below
};

template <class Real>
struct SurfaceFunctions {
    /// Evaluates a batch, [Bake 3].
    ///
    /// A sample with |x_s x x_t|^2 < 1e-10 |x_s|^2 |x_t|^2 is flagged; its outputs are finite and
    /// to be replaced.
    void (*evaluate)(SurfaceBatch<Real> const& batch, Quantity quantity, bool isTriangle);
};

/// See eval/kernels/dispatch.h: the same bits on every CPU.
struct SurfaceKernel : SurfaceFunctions<float>, SurfaceFunctions<double> {
    static SurfaceKernel const sse2, avx2, avx512;
};

}  // namespace limn::eval
