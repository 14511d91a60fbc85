// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/maps/portable_math.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace limn {
namespace {

using engine::PortableAtan2;
using engine::PortableLog2;

TEST(PortableFunctions, AgreeWithTheLibrary) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> value(-3.0f, 3.0f);
    for (int i = 0; i < 20000; ++i) {
        float const y = value(random), x = value(random);
        ASSERT_NEAR(PortableAtan2(y, x), std::atan2(y, x), 4e-7);
        float const positive = std::exp2(10.0f * y);
        ASSERT_NEAR(PortableLog2(positive), std::log2(positive),
                    2e-6 * (1.0 + std::abs(10.0 * static_cast<double>(y))));
    }
    EXPECT_EQ(PortableAtan2(0.0f, 0.0f), 0.0f);
}

}  // namespace
}  // namespace limn
