// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "far_ext/rings/face_ring.h"
#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// A piece of the face's parameter domain: (s,t) of the piece in [0,1]^2 (or the triangle
/// s + t <= 1) lies at origin + scale * (s,t) of the face. Scale is 1/2, or -1/2 for the middle
/// child of a triangle.
struct SubDomain {
    std::array<double, 2> origin{0.0, 0.0};
    double scale = 1.0;
};

/// One refinement step of a ring: its children's rings and the matrices that make their points.
///
/// Far's own rules do the weights: the ring becomes a small Far refiner, refined once, through
/// which the identity is pushed in double.
/// Source  [Limit 9]; [Stam98] for the idea of stationary rings.
struct RingSubdivision {
    struct Child {
        FaceRing ring;
        SparseRows weights;  ///< child's points x this ring's points
        SubDomain domain;    ///< within this face; on an n-gon, of the sub-quad (scale 1)
    };

    /// The control points of the one polynomial patch the face is, as rows over the ring's points:
    /// 16 of a uniform bicubic B-spline, row t, column s (Loop: 12 of the quartic box spline, in
    /// the order of kBoxSplineLattice); empty if the face is not regular.
    ///
    /// A boundary, an infinitely sharp crease or a linear face is regular too: points beyond it are
    /// extrapolated so that the spline obeys the boundary rule.
    SparseRows patch;
    std::vector<Child> children;  ///< per corner; Loop has the middle child last. Empty if regular

    /// The points that shape the face's surface, which lies in their convex hull. With face-varying
    /// topology the ring also has values of other charts, which do not.
    std::vector<Index> support;

    bool IsRegular() const { return patch.GetNumRows() != 0; }
    size_t GetNumBytes() const;

    /// What a ring is subdivided for: its limit; or its refined points, vertex by vertex or with
    /// OpenSubdiv's varying (linear) rule, where every ring has children and no patch.
    enum class Use { Limit, Refinement, VaryingRefinement };

    static RingSubdivision Build(FaceRing const& ring, Sdc::SchemeType scheme, Sdc::Options options,
                                 Use use = Use::Limit);
};

/// Positions of the box spline's 12 control points; the triangle is (0,0), (1,0), (0,1), lattice
/// neighbours are (+-1,0), (0,+-1), (1,-1), (-1,1).
inline constexpr std::array<std::array<int, 2>, 12> kBoxSplineLattice{{{0, -1},
                                                                       {1, -1},
                                                                       {2, -1},
                                                                       {-1, 0},
                                                                       {0, 0},
                                                                       {1, 0},
                                                                       {2, 0},
                                                                       {-1, 1},
                                                                       {0, 1},
                                                                       {1, 1},
                                                                       {-1, 2},
                                                                       {0, 2}}};

}  // namespace limn::far_ext
