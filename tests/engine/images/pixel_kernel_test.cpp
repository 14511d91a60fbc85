// SPDX-License-Identifier: Apache-2.0
#include "engine/images/pixel_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <Imath/half.h>
#include <gtest/gtest.h>

#include "eval/kernels/dispatch.h"
#include "support/instruction_sets.h"

namespace limn {
namespace {

template <class... Arguments>
size_t ConvertToHalf(Arguments... arguments) {
    return eval::GetKernel<engine::PixelKernel>().convertToHalf(arguments...);
}

// Imath's own conversion is the reference, over a stride of all floats in the range of half.
TEST(ConvertToHalf, RoundsLikeImath) {
    std::vector<float> values;
    for (uint64_t bits = 0; bits < (1ull << 32); bits += 40503) {
        auto const word = static_cast<uint32_t>(bits);
        float value;
        std::memcpy(&value, &word, sizeof value);
        if (std::isfinite(value) && std::abs(value) <= 65504.0f) values.push_back(value);
    }
    std::vector<uint16_t> halves(values.size());
    test::ForEachInstructionSet([&](eval::InstructionSet) {
        std::fill(halves.begin(), halves.end(), uint16_t{0xffff});
        EXPECT_EQ(ConvertToHalf(values.data(), values.size(), halves.data(), values.size(),
                                values.size(), 1),
                  0u);
        for (size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(halves[i], Imath::half(values[i]).bits()) << values[i];
    });
}

TEST(ConvertToHalf, ClampsAndCountsWhatIsBeyondRange) {
    float const values[4] = {1e6f, -7e4f, 65504.0f, 2.0f};
    uint16_t halves[4];
    EXPECT_EQ(ConvertToHalf(values, 4, halves, 4, 4, 1), 2u);
    EXPECT_EQ(halves[0], Imath::half(65504.0f).bits());
    EXPECT_EQ(halves[1], Imath::half(-65504.0f).bits());
    EXPECT_EQ(halves[2], Imath::half(65504.0f).bits());
    EXPECT_EQ(halves[3], Imath::half(2.0f).bits());
}

}  // namespace
}  // namespace limn
