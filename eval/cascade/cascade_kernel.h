// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "far_ext/types.h"

namespace limn::eval {

/// A level's rings as plain pointers, see far_ext::CascadeLevel.
struct CascadeRings {
    int const* offsets;
    Index const* neighbours;
    int faceSize;
    Index numClosed, numSurface;
};

/// Where the operator of a level goes and what it is made from, see CascadeOperator. Rows of a
/// metric are 4 Scalars.
template <class Scalar>
struct CascadeBuildJob {
    CascadeRings rings;
    Scalar const* metric;
    bool isLocal;      ///< widths come with the metric's rows
    Scalar diffusion;  ///< sigma^2 / 2 where they do not
    Scalar *edges, *masses, *diagonals;
};

/// Of triangles: the largest cotangent of their angles, and twice the smallest area.
template <class Scalar>
struct CascadeShapes {
    Scalar maxCotangent, minArea;
};

/// One damped Jacobi sweep. Rows are 4 Scalars.
template <class Scalar>
struct CascadeSweepJob {
    CascadeRings rings;
    Scalar const *edges, *masses, *diagonals;
    Scalar damping;
    Scalar const *x, *x0;
    Scalar* to;
};

template <class Scalar>
struct CascadeFunctions {
    /// The operator's rows begin..end-1.
    CascadeShapes<Scalar> (*buildRows)(CascadeBuildJob<Scalar> const& job, Index begin, Index end);

    /// Rows begin..end-1 of a sweep. Entries of a ring are added as FindResidual adds them.
    void (*sweepRows)(CascadeSweepJob<Scalar> const& job, Index begin, Index end);
};

/// The same bits on every CPU (see eval/kernels/dispatch.h) and whichever ranges the work is cut
/// into: no sum crosses rows.
struct CascadeKernel : CascadeFunctions<float>, CascadeFunctions<double> {
    static CascadeKernel const sse2, avx2, avx512;
};

}  // namespace limn::eval
