// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/terminal/progress_bar.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace limn::cli {
namespace {

bool HasPart(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

TEST(ProgressBar, IsNarrowerThanTheTerminalWhateverItSays) {
    std::string const phases[] = {"", "a", "baking spot", std::string(300, 'x')};
    for (std::string const& phase : phases) {
        for (int columns = 1; columns <= 200; ++columns) {
            for (double share : {0.0, 0.005, 0.5, 0.999, 1.0}) {
                for (char const* time : {"starting", "0.1 s", "119 min left", "100000.0 h left"}) {
                    std::string const bar = FormatBar(phase, share, time, columns);
                    EXPECT_LT(bar.size(), static_cast<size_t>(columns)) << bar;
                }
            }
        }
    }
}

TEST(ProgressBar, SaysShareAndTimeOnTwentyColumns) {
    std::string const bar = FormatBar("baking spot", 0.5, "12 s left", kLeastColumns);
    EXPECT_TRUE(HasPart(bar, "50 %  12 s left")) << bar;
}

TEST(ProgressBar, LosesTheBarBeforeThePhase) {
    EXPECT_EQ(FormatBar("baking spot", 0.5, "12 s left", 80),
              "baking spot [===============               ]  50 %  12 s left");
    EXPECT_EQ(FormatBar("baking spot", 0.5, "12 s left", 40),
              "baking spot [====    ]  50 %  12 s left");
    EXPECT_EQ(FormatBar("baking spot", 0.5, "12 s left", 36), "baking spot  50 %  12 s left");
    EXPECT_EQ(FormatBar("baking spot", 0.5, "12 s left", 26), "bakin...  50 %  12 s left");
}

TEST(ProgressBar, CountsIdeographsTwice) {
    std::string const phase = "\u7259\u7259\u7259\u7259\u7259\u7259";  // 18 bytes, 12 columns
    EXPECT_TRUE(HasPart(FormatBar(phase, 0.5, "1 s", 24), phase + " "));
    EXPECT_FALSE(HasPart(FormatBar(phase, 0.5, "1 s", 23), phase));
}

TEST(ProgressBar, ShowsNothingThatATerminalWouldObey) {
    std::string const bar = FormatBar("a\nb\rc\x1b[2Jd\x7f\xc2\x9b\xff", 0.5, "1 s", 80);
    EXPECT_TRUE(bar.starts_with("a?b?c?[2Jd????")) << bar;
    EXPECT_TRUE(FormatBar("\u00e9\u00a9", 0.5, "1 s", 80).starts_with("\u00e9\u00a9 ["));
}

TEST(FormatSeconds, IsShort) {
    EXPECT_EQ(FormatSeconds(0.04), "0.0 s");
    EXPECT_EQ(FormatSeconds(9.94), "9.9 s");
    EXPECT_EQ(FormatSeconds(61.0), "61 s");
    EXPECT_EQ(FormatSeconds(600.0), "10 min");
    EXPECT_EQ(FormatSeconds(9000.0), "2.5 h");
}

}  // namespace
}  // namespace limn::cli
