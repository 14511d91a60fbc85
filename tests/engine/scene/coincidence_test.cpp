// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/coincidence.h"

#include <gtest/gtest.h>

#include "support/errors.h"

namespace limn {
namespace {

std::vector<Index> Group(std::vector<double> const& x, double tolerance,
                         std::vector<char> isCandidate = {}) {
    std::vector<double> positions;
    for (double value : x) positions.insert(positions.end(), {value, 2.0, -0.5 * value});
    if (isCandidate.empty()) isCandidate.assign(x.size(), 1);
    return engine::GroupCoincident(positions, isCandidate, tolerance);
}

TEST(Coincidence, EqualPointsAreOneGroupByItsLowestNumber) {
    EXPECT_EQ(Group({3, 1, 3, 2, 1, 3}, 0.0), (std::vector<Index>{0, 1, 0, 3, 1, 0}));
    EXPECT_EQ(Group({0.0, -0.0}, 0.0), (std::vector<Index>{0, 0}));
    EXPECT_EQ(Group({1.0, 1.0 + 1e-15}, 0.0), (std::vector<Index>{0, 1}));
}

TEST(Coincidence, OthersThanCandidatesCoincideWithNothing) {
    EXPECT_EQ(Group({1, 1, 1}, 0.0, {1, 0, 1}), (std::vector<Index>{0, 1, 0}));
    EXPECT_EQ(Group({1, 1.5, 2}, 0.6, {1, 0, 1}), (std::vector<Index>{0, 1, 2}));
}

// Points lie along (1, 0, -1/2): steps of 1 in x are sqrt(5)/2 = 1.118 long.
TEST(Coincidence, StepsWithinTheToleranceLeadOn) {
    EXPECT_EQ(Group({0, 3, 1, 7, 2}, 1.2), (std::vector<Index>{0, 0, 0, 3, 0}));
    EXPECT_EQ(Group({0, 3, 1, 7, 2}, 1.1), (std::vector<Index>{0, 1, 2, 3, 4}));
    EXPECT_EQ(Group({0, 1, 1, 0}, 1e-9), (std::vector<Index>{0, 1, 1, 0}));
}

TEST(Coincidence, AnyNumberOfEqualPointsIsOnePlace) {
    EXPECT_EQ(Group(std::vector<double>(100, 4.0), 0.5), std::vector<Index>(100, 0));
}

TEST(Coincidence, AToleranceThatTellsNothingApartIsRefused) {
    std::vector<double> x;
    for (int i = 0; i < 257; ++i) x.push_back(0.001 * i);
    auto const error = test::CatchError([&] { Group(x, 1.0); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->GetCode(), ErrorCode::BadOption);
    EXPECT_NE(std::string(error->what()).find("`weld`: 1 reaches 256 other places"),
              std::string::npos)
        << error->what();
    x.pop_back();
    EXPECT_EQ(Group(x, 1.0), std::vector<Index>(256, 0));
}

// All points of a plane in one place along two axes, which a sweep along one of them would not
// like.
TEST(Coincidence, ManyPointsTakeLittleTime) {
    std::vector<double> positions;
    constexpr size_t kCount = 200000;
    for (size_t i = 0; i < kCount; ++i)
        positions.insert(positions.end(), {0.0, 0.0, static_cast<double>(i * 7919 % kCount)});
    auto const groups = engine::GroupCoincident(positions, std::vector<char>(kCount, 1), 1e-3);
    for (size_t i = 0; i < kCount; ++i) ASSERT_EQ(static_cast<size_t>(groups[i]), i);
}

}  // namespace
}  // namespace limn
