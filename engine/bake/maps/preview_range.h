// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace limn::engine {

/// Between which values the colours of a preview lie. Signed maps have zero in the middle of all
/// but a given range.
struct PreviewRange {
    enum class Rule {
        Percentiles,  ///< the 1st to the 99th
        Full,         ///< the least to the largest
        Asinh,  ///< as Full, stretched round zero: linear up to the median, logarithmic beyond
        Given   ///< low to high
    };
    Rule rule = Rule::Percentiles;
    double low = 0.0, high = 0.0;

    /// "p1", "full", "asinh" or "A,B" with A < B. \throws Error BadOption
    static PreviewRange Parse(std::string const& text);

    /// What Parse takes.
    std::string GetText() const;
};

}  // namespace limn::engine
