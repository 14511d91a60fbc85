// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace limn::eval {

/// Inverting a texture map cell by cell: which (x, y) of a polynomial piece goes to which texel?
///
/// Cell     a square of the piece's domain on which the map is nearly linear.
/// Method   the inverse map is fitted to the cell as a cubic polynomial of the texel, once; each
///          texel takes its guess from it and goes on by Newton's method on the exact map, mostly
///          for one step: a step from r texels off ends within bend / 2 r^2, so that how good an
///          answer is is known without another look at the map.
/// Bits     the same on every CPU, see eval/kernels/dispatch.h. A texel's answer depends on its
///          cell, not on the texels beside it.
inline constexpr int kInversionLanes = 8;
inline constexpr double kInversionEnd =
    1e-6;  ///< texels: an answer is this near, or says that it is not

/// Where the answer for a texel lies.
enum class Whereabouts : uint8_t {
    Outside,  ///< so far outside the piece's domain that the texel is not covered
    Inside,   ///< in the domain
    Edge,     ///< at the domain's edge or outside of it: a closer look decides
    Unsolved  ///< no answer within `tolerance` was found
};

/// A piece of the map and a cell of it, in texels about a local origin.
struct InversionCell {
    double const* coefficients;  ///< [2][16] (Loop: 15 used), see patch_polynomial.h
    bool isTriangle;
    double x, y;        ///< the cell's centre, about the piece's
    double value[2];    ///< the map at (x, y)
    double inverse[4];  ///< inverse of the Jacobian d(u,v)/d(x,y) there, by rows; zero if singular
    double area;        ///< of the cell, in texels
    double reach;       ///< parameters of the texels asked for stay within this of (x, y)
    double bend;     ///< bound of the map's second derivatives per texel, squared inverse Jacobian
    double centre;   ///< (s, t) = (x, y) + centre
    double outside;  ///< farther than this outside the domain, in (s, t), is Outside
    double tolerance;     ///< texels
    double guess[2][10];  ///< the fitted inverse; filled by fitInverse
};

struct InversionKernel {
    /// Fits the cell's inverse; where the cell is too small for that to pay, its linear part will
    /// do.
    void (*fitInverse)(InversionCell& cell);

    /// Answers for `count` texels. All arrays reach to the next multiple of kInversionLanes.
    ///
    /// \param targetX, targetY  about the local origin
    /// \param x, y   about the piece's centre
    /// \param where  see Whereabouts
    void (*invertMap)(InversionCell const& cell, double const* targetX, double const* targetY,
                      int count, double* x, double* y, Whereabouts* where);

    static InversionKernel const sse2, avx2, avx512;
};

}  // namespace limn::eval
