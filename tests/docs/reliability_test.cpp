// SPDX-License-Identifier: Apache-2.0
//
// docs/reliability.md names tests; they exist.

#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/source_tree.h"

namespace limn {
namespace {

namespace fs = std::filesystem;

/// The second column of a line of a table; empty for other lines and for heads.
std::string FindTestColumn(std::string const& line) {
    std::smatch column;
    if (!std::regex_match(line, column, std::regex(R"(\| ([^|]+) \| ([^|]*) \|.*)"))) return "";
    return column[2] == "test" || column[2] == "---" ? "" : column[2].str();
}

struct Row {
    std::string line, tests;
};

std::vector<Row> ListRows() {
    std::istringstream page(test::ReadText(test::kSourceRoot / "docs/reliability.md"));
    std::vector<Row> rows;
    for (std::string line; std::getline(page, line);) {
        if (auto const tests = FindTestColumn(line); !tests.empty()) rows.push_back({line, tests});
    }
    return rows;
}

/// The source of what ctest calls PATH; it is a test or a fuzzer.
fs::path FindSource(std::string const& path) {
    bool const isFuzzer = path.starts_with("fuzz/");
    return test::kSourceRoot / "tests" / (path + (isFuzzer ? "_fuzzer.cpp" : "_test.cpp"));
}

TEST(Reliability, EveryPromiseNamesATest) {
    auto const rows = ListRows();
    ASSERT_GT(rows.size(), 10u);
    for (auto const& [line, tests] : rows) EXPECT_EQ(tests[0], '`') << line;
}

// A column lists `PATH`, `PATH: NAME`, and `NAME` of the path before it.
TEST(Reliability, EveryTestThatIsNamedExists) {
    std::regex const entry(R"(`(?:([a-z_0-9]+(?:/[a-z_0-9]+)+)(?:: )?)?(\w+)?`)");
    for (auto const& [line, tests] : ListRows()) {
        std::string source;
        for (std::sregex_iterator at(tests.begin(), tests.end(), entry), end; at != end; ++at) {
            if ((*at)[1].matched) {
                fs::path const path = FindSource((*at)[1]);
                ASSERT_TRUE(fs::exists(path)) << path << "\n" << line;
                source = test::ReadText(path);
            }
            std::string const name = (*at)[2];
            EXPECT_TRUE(std::regex_search(source, std::regex("\\b" + name + "\\b"))) << name << "\n"
                                                                                     << line;
        }
    }
}

}  // namespace
}  // namespace limn
