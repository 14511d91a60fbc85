// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/forms/form_operators.h"
#include "far_ext/forms/form_stencils.h"
#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// The circulation of a subdivided 1-form along the limit of an edge: what the values of all its
/// pieces add up to, as weights over the edges of the level.
///
/// Laws       of a gradient d0 f it is the difference of the limits of f; limit(e) = limit(first
///            half) + limit(second half).
/// Features   boundaries, corners, infinitely sharp creases: each fan between sharp edges is a
///            boundary of its own. Darts, too. Semi-sharp features have to have faded.
/// How        an edge is refined once; its two halves (v -> m) have a regular end m, and the limit
///            along such a half solves L (I - A) = l A with A the subdivision near v and l the
///            regular limit one step out. L depends on v's fan and the spoke alone and is found
///            once for each.
/// Threads    one at a time.
/// Source     [Forms 7.1]
class EdgeLimits {
public:
    /// \param refiner  refined beyond `level`, with full topology
    /// \pre            CheckForms has passed
    EdgeLimits(Far::TopologyRefiner const& refiner, int level);

    /// \throws Error  BadOption: a semi-sharp feature near the edge.  TooLarge: more than 64 faces
    ///                between sharp edges at an end
    WeightRow Find(Index edge);

private:
    enum class Kind { Interior, Dart, Curve, Corner };
    /// The fan that holds a spoke: faces `first` .. `first` + `size` - 1 of a wheel, and the
    /// spoke's place in it.
    struct Fan {
        Kind kind;
        int first, size, spoke;
    };
    /// The limit along a half, over the wheel's fan from its first spoke (a dart: the sharp one;
    /// interior: the half's own), then the wheel of m from the spoke back to v.
    struct HalfLimit {
        std::vector<double> atVertex, atMiddle;
    };
    class HalfSolver;

    Fan FindFan(Index vertex, Index edge) const;
    HalfLimit const& FindHalf(Fan const& fan);
    void AddHalf(Index vertex, Index edge, double sign, WeightRow& row);
    void AddRefined(Index fineEdge, double weight, WeightRow& row) const;

    Far::TopologyRefiner const& _refiner;
    Far::TopologyLevel _coarse, _fine;
    SparseRows _s1;
    std::map<std::tuple<Kind, int, int>, HalfLimit> _halves;
};

}  // namespace limn::far_ext
