// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "far_ext/types.h"

namespace limn::far_ext {

/// The surroundings of a vertex, as far as they decide how forms are subdivided there: its k faces
/// f_0 .. f_{k-1} counter- clockwise with a spoke (v -> w_i) before each; at a boundary one more
/// spoke after the last.
///
/// Source  [Forms 1] (wheels), [Forms 3.1] and [Forms 4] (weights), [Forms 5] (sharp features).
struct Wheel {
    bool isInterior = true;
    std::vector<int> sizes;           ///< corners of the k faces
    std::vector<double> faceShares;   ///< per spoke: p (Loop: weight of an opposite vertex in the
                                      ///< edge's rule) or q (of a face point)
    std::vector<double> edgeWeights;  ///< a: weights of the w_i in the vertex' rule
    double faceWeight = 0.0;          ///< b: of each face point in the vertex' rule (Catmull-Clark)

    /// One of the two rules between which a vertex of fading sharpness is blended.
    struct Rule {
        double share = 0.0;         ///< t or 1 - t
        std::vector<char> isSharp;  ///< per spoke
        bool isCrease = false;
    };
    Rule parent, child;

    int GetNumFaces() const { return static_cast<int>(sizes.size()); }
    int GetNumSpokes() const { return GetNumFaces() + (isInterior ? 0 : 1); }
};

/// What the forms around a vertex become: rows over the wheel's own edges (1-forms: spokes outwards
/// first, then the other sides of each face, counter-clockwise) and faces (2-forms).
struct WheelRows {
    using Row = std::vector<std::pair<int, double>>;

    std::vector<Row> even;  ///< per spoke: v' -> the middle of the spoke
    std::vector<Row>
        odd;  ///< per face, Loop: from the middle of its first spoke to that of the next
    std::vector<Row> children;  ///< per face: the child face at v
    std::vector<double> mu;     ///< per face, Loop: sum of the child's row
    std::vector<std::vector<double>>
        flow;  ///< x: per spoke, the 2-chain whose boundary was added to `even`
    std::vector<std::vector<double>> share;  ///< s: per face, the child's row as a dense one
};

/// Solves the local problem at a vertex: even and odd edges by star flow (Loop) or paths to face
/// points (Catmull-Clark), plus the boundary of the chains x and y that make S1 commute with S2.
///
/// \pre scheme is Loop (all sizes 3) or Catmull-Clark
/// Source  [Wang06] Sec. 3; [Forms 3], [Forms 4], [Forms 5], [Forms 6]
WheelRows MakeWheelRows(Sdc::SchemeType scheme, Wheel const& wheel);

/// The smooth interior wheel of k triangles (Loop) or quads.
Wheel MakeSmoothWheel(Sdc::SchemeType scheme, int k);

/// Loop's weight of a neighbour in the rule of a smooth vertex: (5/8 - (3/8 + cos(2 pi/k)/4)^2) /
/// k.
double GetLoopWeight(int k);

}  // namespace limn::far_ext
