// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "eval/fit/limit_operator.h"

namespace limn::eval {

/// Generalised Catmull-Clark, level by level: what alpha adds to the children of smooth vertices,
/// (alpha/n) V - (alpha/n^2) sum E, over what Catmull-Clark makes of them.
///
/// A vertex beside a crease that fades keeps the plain rule on all levels: so its limit is the one
/// that rows of A have for it on the base level.
///
/// Source   [LaiCheng11] Appendix A; [Limit 4]
class AlphaSteps {
public:
    /// \param refiner    uniformly refined, the last level with its full topology; kept by
    /// reference
    /// \param lastLevel  of those whose vertices are looked at, from 0
    /// \throws Error     as LimitOperator::Build
    AlphaSteps(Far::TopologyRefiner const& refiner, int lastLevel, double alpha);

    /// Adds to the children of values of a level. Children have their vertices' numbers
    /// (OpenSubdiv's order).
    void Add(int level, std::span<double const> values, int length,
             std::span<double> children) const;

    /// The limits of the last level's values, with alpha in all steps to come.
    std::vector<double> FindLimits(std::span<double const> values, int length) const;

private:
    struct Level {
        LimitOperator rows;
        std::vector<char> takesAlpha;  // per vertex
    };

    Far::TopologyRefiner const& _refiner;
    double _alpha;
    std::vector<Level> _levels;
};

}  // namespace limn::eval
