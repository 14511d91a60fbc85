// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// Which rules make the points of a level from those before.
enum class SubdivisionRule {
    Scheme,             ///< the refiner's own scheme: OpenSubdiv's Loop or Catmull-Clark
    Butterfly,          ///< modified Butterfly on the refiner's Loop topology
    OriginalButterfly,  ///< one mask at every valence, on Loop topology; has a tension
    Kobbelt,            ///< on quads of Catmull-Clark topology; has a tension
    Interpolating       ///< deduced from the refiner's own scheme: DeduceInterpolatingRows
};

/// A rule, and how tight it pulls where that is to be chosen.
struct TunedRule {
    SubdivisionRule rule = SubdivisionRule::Scheme;
    /// Of OriginalButterfly from 0 to 1/8, 1/16 without a value; of Kobbelt from 0 to 2, 1 without;
    /// 0 are lines. Others have none.
    std::optional<double> tension{};

    TunedRule() = default;
    TunedRule(SubdivisionRule theRule, std::optional<double> theTension = {})
        : rule(theRule), tension(theTension) {}

    /// Vertices that stay are in the limit.
    bool IsInterpolating() const { return rule != SubdivisionRule::Scheme; }
};

/// \throws Error  BadOption: a tension that its rule does not have, or out of range
void CheckTension(TunedRule const& rule);

/// S of one step: vertices of `level` x vertices of `level` - 1. Rows add up to 1.
///
/// \throws Error  as BuildButterfly, BuildKobbelt, CheckTension
SparseRows BuildSubdivisionRows(Far::TopologyRefiner const& refiner, int level,
                                TunedRule const& rule);

/// The same of the scheme's rule for a face-varying channel: values of `level` x values of `level`
/// - 1.
SparseRows BuildFVarSubdivisionRows(Far::TopologyRefiner const& refiner, int level, int channel);

}  // namespace limn::far_ext
