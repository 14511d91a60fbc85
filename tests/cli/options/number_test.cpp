// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/number.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/errors.h"

namespace limn::cli {
namespace {

TEST(Number, IsAllOfTheTextOrNone) {
    EXPECT_EQ(ParseNumber<int>("--levels", "3"), 3);
    EXPECT_EQ(ParseNumber<int>("--levels", "+3"), 3);
    EXPECT_EQ(ParseNumber<int>("--levels", "-3"), -3);
    EXPECT_EQ(ParseNumber<int>("--levels", "010"), 10);
    EXPECT_EQ(ParseNumber<uint64_t>("--noise-seed", "18446744073709551615"), UINT64_MAX);
    EXPECT_EQ(ParseNumber<double>("--width", ".5"), 0.5);
    EXPECT_EQ(ParseNumber<double>("--width", "1e-3"), 1e-3);
    for (char const* text : {"", "abc", "3x", " 3", "3 ", "3.5", "1e3", "0x3", "+-3", "++3", "--3",
                             "99999999999", "true"})
        EXPECT_THROW(ParseNumber<int>("--levels", text), Error) << text;
    for (char const* text : {"", "abc", "0.5x", "0,5", "nan", "inf", "-inf", "1e400", "1/2"})
        EXPECT_THROW(ParseNumber<double>("--width", text), Error) << text;
}

TEST(Number, MessageQuotesOptionAndTextAndSaysWhatWouldBeRight) {
    auto const message = [](auto parse) { return test::RefusalOf(parse); };
    EXPECT_EQ(message([] { ParseNumber<int>("--levels", "abc", {0, 10}); }),
              "--levels: 'abc' is no whole number from 0 to 10");
    EXPECT_EQ(message([] { ParseNumber<int>("--levels", "11", {0, 10}); }),
              "--levels: '11' is no whole number from 0 to 10");
    EXPECT_EQ(message([] { ParseNumber<double>("--rate", "2", {1e-6, 0.5}); }),
              "--rate: '2' is no number from 1e-06 to 0.5");
    EXPECT_EQ(message([] { ParseNumber<double>("--width", "-1", {.low = 0.0}); }),
              "--width: '-1' is no number from 0 up");
    EXPECT_EQ(message([] { ParseNumber<uint64_t>("--noise-seed", "-1"); }),
              "--noise-seed: '-1' is no whole number from 0 up");
    EXPECT_EQ(message([] { ParseNumber<double>("--weld", "x"); }), "--weld: 'x' is no number");
}

TEST(Number, TooLargeOrTooSmallIsToldAsSuchWhereTheRangeHasNoEndThere) {
    auto const refusal = [](std::string const& text, NumberRange<double> const& range = {}) {
        return test::RefusalOf([&] { ParseNumber("--width", text, range); });
    };
    std::string const large =
        "is too large a number; at most 1.79769e+308 in magnitude is possible";
    std::string const small =
        "is too small a number; 0, or at least 4.94066e-324 in magnitude, is possible";
    std::string const zeros(400, '0');
    for (std::string const text : {"1e400", "-1e400", "1e+400", "0.1e99999999999999999999"})
        EXPECT_EQ(refusal(text), "--width: '" + text + "' " + large);
    for (std::string const text : {"1e-400", "-1e-400", "+1e-400", "1e-99999999999999999999"})
        EXPECT_EQ(refusal(text), "--width: '" + text + "' " + small);
    EXPECT_EQ(refusal("1" + zeros + "e-1"), "--width: '1" + zeros + "e-1' " + large);
    EXPECT_EQ(refusal("0." + zeros + "1e+1"), "--width: '0." + zeros + "1e+1' " + small);
    EXPECT_EQ(refusal("1e-400", {.low = 0.0}), "--width: '1e-400' " + small);
    EXPECT_EQ(refusal("-1e400", {.low = 0.0}), "--width: '-1e400' is no number from 0 up");
    EXPECT_EQ(refusal("1e-400", {1e-6, 0.5}), "--width: '1e-400' is no number from 1e-06 to 0.5");
    EXPECT_EQ(refusal("1e400x"), "--width: '1e400x' is no number");
    EXPECT_EQ(
        test::RefusalOf([] { ParseNumber<uint64_t>("--noise-seed", "18446744073709551616"); }),
        "--noise-seed: '18446744073709551616' is too large a number; at most "
        "18446744073709551615 in magnitude is possible");
}

TEST(TexelSize, HasOneNumberOrTwoAndKIs1024) {
    struct Case {
        char const* text;
        int width, height;
    };
    for (auto const& [text, width, height] : std::vector<Case>{{"2048", 2048, 2048},
                                                               {"2k", 2048, 2048},
                                                               {"4K", 4096, 4096},
                                                               {"4kx2k", 4096, 2048},
                                                               {"1Kx100", 1024, 100},
                                                               {"100X1k", 100, 1024},
                                                               {"64k", 65536, 65536},
                                                               {"1", 1, 1}}) {
        auto const size = ParseTexelSize("--size", text, {1, 65536});
        EXPECT_EQ(size.width, width) << text;
        EXPECT_EQ(size.height, height) << text;
    }
}

TEST(TexelSize, RefusalQuotesAllOfTheText) {
    for (std::string const text : {"", "abc", "0", "65537", "65k", "0k", "k", "2kk", "2m", "1.5k",
                                   "64x", "x64", "64x64x64", "64 x 64", "-1", "2kx", "4194304k"}) {
        std::string const message =
            test::RefusalOf([&] { ParseTexelSize("--size", text, {1, 65536}); });
        EXPECT_EQ(message,
                  "--size: '" + text +
                      "' is no number of texels from 1 to 65536, such as 2048 or 2k, and no two of "
                      "them, such as 4kx2k");
    }
}

}  // namespace
}  // namespace limn::cli
