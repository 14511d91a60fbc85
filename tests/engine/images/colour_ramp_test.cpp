// SPDX-License-Identifier: Apache-2.0
#include "engine/images/colour_ramp.h"

#include <gtest/gtest.h>

#include "support/errors.h"

namespace limn {
namespace {

using engine::ColourRamp;

// The spline goes through every colour, and between two equal neighbours of a constant ramp stays
// there.
TEST(ColourRamp, InterpolatesItsColours) {
    std::vector<ColourRamp::Colour> const colours{
        {0, 0, 0}, {1, 0, 0.5}, {0.2, 0.9, 1}, {1, 1, 1}, {0.3, 0.1, 0}};
    ColourRamp const ramp(colours);
    for (size_t i = 0; i < colours.size(); ++i) {
        auto const colour = ramp.Evaluate(static_cast<double>(i) / 4.0);
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(colour[c], colours[i][c], 1e-12) << i;
    }
    ColourRamp const constant({{0.25, 0.5, 0.75}, {0.25, 0.5, 0.75}, {0.25, 0.5, 0.75}});
    for (double t : {-1.0, 0.1, 0.77, 2.0}) EXPECT_NEAR(constant.Evaluate(t)[1], 0.5, 1e-12);
    ColourRamp const line({{0, 0, 0}, {1, 1, 1}});  // two colours: the straight line between them
    EXPECT_NEAR(line.Evaluate(0.3)[0], 0.3, 1e-12);
}

TEST(ColourRamp, ReadsHexadecimalColoursAndNamesOthers) {
    EXPECT_EQ(ColourRamp::Parse("#000000,#FF8000").GetText(), "#000000,#ff8000");
    for (char const* text :
         {"", "#000000", "#000000,red", "#00000,#ffffff", "#000000,#fffffg", "#000000,"}) {
        EXPECT_EQ(test::CodeOf([&] { ColourRamp::Parse(text); }), ErrorCode::BadOption) << text;
    }
}

}  // namespace
}  // namespace limn
