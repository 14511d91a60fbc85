// SPDX-License-Identifier: Apache-2.0
//
// docs/library.md and examples/library say the same. That the programs print what the page shows is
// for tests/install to see.

#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/source_tree.h"

namespace limn {
namespace {

namespace fs = std::filesystem;

fs::path const kPrograms = test::kSourceRoot / "examples/library";

std::string ReadPage() {
    return test::ReadText(test::kSourceRoot / "docs/library.md");
}

/// A file as the page shows it: without the line that names the licence.
std::string ReadWithoutLicence(fs::path const& path) {
    std::string const text = test::ReadText(path);
    return text.substr(text.find('\n') + 1);
}

/// What stands between the page's fences of a language.
std::set<std::string> ListBlocks(std::string const& language) {
    std::string const page = ReadPage(), open = "\n```" + language + "\n", close = "\n```\n";
    std::set<std::string> blocks;
    for (size_t at = page.find(open); at != std::string::npos; at = page.find(open, at + 1)) {
        size_t const begin = at + open.size();
        blocks.insert(page.substr(begin, page.find(close, begin) + 1 - begin));
    }
    return blocks;
}

/// The headers that the floors install, by their paths below limn/.
std::set<std::string> ListPublicHeaders() {
    std::set<std::string> headers;
    std::regex const header(R"(\n        ([a-z0-9_/]+\.h)\b)");
    for (std::string const floor : {"far_ext", "eval", "engine"}) {
        std::string const text = test::ReadText(test::kSourceRoot / floor / "CMakeLists.txt");
        for (std::sregex_iterator at(text.begin(), text.end(), header), end; at != end; ++at)
            headers.insert(floor + "/" + (*at)[1].str());
    }
    return headers;
}

TEST(LibraryPage, ShowsEveryProgramAsItIs) {
    auto const shown = ListBlocks("cpp");
    auto const programs = test::ListFiles({"examples/library"}, {".cpp"});
    EXPECT_EQ(shown.size(), programs.size());
    for (fs::path const& program : programs)
        EXPECT_TRUE(shown.contains(ReadWithoutLicence(program))) << program;
}

TEST(LibraryPage, ShowsHowTheProgramsAreBuilt) {
    EXPECT_EQ(ListBlocks("cmake"),
              std::set<std::string>{ReadWithoutLicence(kPrograms / "CMakeLists.txt")});
}

TEST(LibraryPage, ShowsACommandOfEveryProgram) {
    std::string commands;
    for (std::string const& block : ListBlocks("text")) commands += block;
    for (fs::path const& program : test::ListFiles({"examples/library"}, {".cpp"}))
        EXPECT_NE(commands.find("$ " + program.stem().string()), std::string::npos) << program;
}

TEST(LibraryPage, NamesPublicHeadersOnly) {
    auto const headers = ListPublicHeaders();
    ASSERT_GT(headers.size(), 100u);
    std::string const page = ReadPage();
    std::regex const header(R"(\b(far_ext|eval|engine)/[a-z0-9_/]+\.h\b)");
    for (std::sregex_iterator at(page.begin(), page.end(), header), end; at != end; ++at)
        EXPECT_TRUE(headers.contains((*at)[0].str())) << (*at)[0];
}

}  // namespace
}  // namespace limn
