// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace limn::engine {

/// How often floats occur, in 2^16 bins of equal upper 16 bits: some 0.8 % wide, finest near 0.
/// Counts are exact, and the same in whatever order values come.
class ValueHistogram {
public:
    void Add(float value);

    size_t GetCount() const { return _count; }
    float GetMin() const { return _min; }  ///< exact; min > max if there are none
    float GetMax() const { return _max; }

    /// The value that a share of all does not pass: the middle of its bin, but min and max as they
    /// are. 0 if there are none.
    float FindQuantile(double share) const;

private:
    std::vector<uint64_t> _bins = std::vector<uint64_t>(1 << 16, 0);
    size_t _count = 0;
    float _min = std::numeric_limits<float>::infinity(), _max = -_min;
};

}  // namespace limn::engine
