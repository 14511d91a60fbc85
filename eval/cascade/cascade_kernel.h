// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "far_ext/types.h"

namespace limn::far_ext {
struct CascadeLevel;
}

namespace limn::eval {

/// A level's rings as plain pointers, see far_ext::CascadeLevel.
struct CascadeRings {
    int const* offsets;
    Index const* neighbours;
    int faceSize;
    Index numClosed, numSurface;
};

CascadeRings GetRings(far_ext::CascadeLevel const& level);

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

/// The operator's rows begin..end-1.
///
/// The same bits on every CPU and whichever ranges the work is cut into: one source, compiled per
/// instruction set without contraction; rows lie side by side in registers and no sum crosses rows.
CascadeShapes<float> BuildCascadeRows(CascadeBuildJob<float> const& job, Index begin, Index end);
CascadeShapes<double> BuildCascadeRows(CascadeBuildJob<double> const& job, Index begin, Index end);

/// Rows begin..end-1 of a sweep; the same bits likewise. Entries of a ring are added as
/// FindResidual adds them.
void SweepCascadeRows(CascadeSweepJob<float> const& job, Index begin, Index end);
void SweepCascadeRows(CascadeSweepJob<double> const& job, Index begin, Index end);

}  // namespace limn::eval
