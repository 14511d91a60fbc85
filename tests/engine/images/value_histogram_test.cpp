// SPDX-License-Identifier: Apache-2.0
#include "engine/images/value_histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/values.h"

namespace limn {
namespace {

using engine::ValueHistogram;

ValueHistogram Count(std::vector<float> const& values) {
    ValueHistogram histogram;
    for (float value : values) histogram.Add(value);
    return histogram;
}

TEST(ValueHistogram, QuantilesAreThoseOfTheSortedValuesToABin) {
    auto values = test::MakeRandomValues(9999, 7);
    for (float& value : values) value = value * value * value * 1e3f;
    auto const histogram = Count(values);
    std::ranges::sort(values);
    EXPECT_EQ(histogram.GetMin(), values.front());
    EXPECT_EQ(histogram.GetMax(), values.back());
    EXPECT_EQ(histogram.GetCount(), values.size());
    for (double share : {0.01, 0.3, 0.5, 0.9, 0.99}) {
        float const exact = values[static_cast<size_t>(share * 9998)];
        EXPECT_NEAR(histogram.FindQuantile(share), exact, 0.008 * std::abs(exact)) << share;
    }
}

TEST(ValueHistogram, TheOrderOfValuesDoesNotMatter) {
    auto values = test::MakeRandomValues(1000, 3);
    auto const one = Count(values);
    std::ranges::reverse(values);
    auto const other = Count(values);
    for (double share : {0.0, 0.25, 1.0})
        EXPECT_EQ(one.FindQuantile(share), other.FindQuantile(share));
}

TEST(ValueHistogram, OneValueIsAllItsQuantiles) {
    for (float value : {0.0f, 1.5f, -3e-39f, 1e30f}) {
        auto const histogram = Count({value, value});
        for (double share : {0.0, 0.5, 1.0}) EXPECT_EQ(histogram.FindQuantile(share), value);
    }
}

TEST(ValueHistogram, KeepsTheOrderOfAllFloats) {
    float const inf = std::numeric_limits<float>::max();
    auto const histogram = Count({inf, -1.0f, 0.0f, 1e-40f, -inf});
    EXPECT_EQ(histogram.FindQuantile(0.0), -inf);
    EXPECT_NEAR(histogram.FindQuantile(0.25), -1.0f, 0.008f);
    EXPECT_NEAR(histogram.FindQuantile(0.5), 0.0f, 1e-38f);
    EXPECT_EQ(histogram.FindQuantile(1.0), inf);
}

TEST(ValueHistogram, WithoutValuesIsZero) {
    EXPECT_EQ(ValueHistogram().FindQuantile(0.5), 0.0f);
    EXPECT_GT(ValueHistogram().GetMin(), ValueHistogram().GetMax());
}

}  // namespace
}  // namespace limn
