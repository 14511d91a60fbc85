// SPDX-License-Identifier: Apache-2.0
#include "far_ext/error.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace limn {
namespace {

TEST(Error, MessageIsOneLineWhateverNamesItHolds) {
    using namespace std::string_literals;
    std::vector<std::pair<std::string, std::string>> const cases{
        {"'a.obj': no faces", "'a.obj': no faces"},
        {"two\nlines", "two lines"},
        {"a\r\nb", "a  b"},
        {"zero\0byte"s, "zero byte"},
        {"grün", "grün"}};
    for (auto const& [text, line] : cases)
        EXPECT_EQ(Error(ErrorCode::Io, text).what(), line) << line;
}

}  // namespace
}  // namespace limn
