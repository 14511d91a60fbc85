// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace limn::engine {

/// What displacements that are written along the normal leave out, over all samples of an output.
struct TangentialPart {
    size_t count = 0;      ///< samples; 0 where whole vectors are written, or none at all
    double squares = 0.0;  ///< sum of the squared lengths of what is left out
    double max = 0.0;      ///< the longest of these
    double longest = 0.0;  ///< displacement, as a whole

    double GetRms() const { return count ? std::sqrt(squares / static_cast<double>(count)) : 0.0; }

    void Add(TangentialPart const& other) {
        count += other.count;
        squares += other.squares;
        max = std::max(max, other.max);
        longest = std::max(longest, other.longest);
    }
};

}  // namespace limn::engine
