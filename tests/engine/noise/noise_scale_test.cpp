// SPDX-License-Identifier: Apache-2.0
#include "engine/noise/noise_scale.h"

#include <array>

#include <gtest/gtest.h>

namespace limn {
namespace {

using engine::ColourRamp;
using engine::NoiseScale;

double Convert(NoiseScale const& scale, double noise) {
    double out = 0.0;
    scale.Convert(noise, {&out, 1});
    return out;
}

TEST(NoiseScale, KeepsNoiseOrMakesItAShareOfItsRange) {
    EXPECT_EQ(Convert({-1.0, 3.0, false, {}}, 2.0), 2.0);
    EXPECT_EQ(Convert({-1.0, 3.0, true, {}}, 2.0), 0.75);
    EXPECT_EQ(Convert({-1.0, 3.0, true, {}}, 4.0), 1.0);
    EXPECT_EQ(Convert({2.0, 2.0, true, {}}, 2.0), 0.5);  // nothing to share
}

TEST(NoiseScale, ThroughARampIsTheColourOfTheShare) {
    auto const ramp = ColourRamp::Parse("#000000,#ff0080,#ffffff");
    NoiseScale const scale(-1.0, 3.0, false, ramp);
    ASSERT_EQ(scale.GetNumChannels(), 3);
    std::array<double, 3> out{};
    for (double noise : {-1.0, 0.3, 1.0, 3.0}) {
        scale.Convert(noise, out);
        EXPECT_EQ(out, ramp.Evaluate((noise + 1.0) / 4.0));
    }
}

}  // namespace
}  // namespace limn
