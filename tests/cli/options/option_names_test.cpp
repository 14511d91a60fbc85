// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/option_names.h"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/files.h"

namespace limn::cli {
namespace {

namespace fs = std::filesystem;

fs::path const kRoot = LIMN_SOURCE_DIR;

struct Literal {
    fs::path file;
    std::string text;  ///< with that of the literals it continues
};

/// String literals of a source, in order.
std::vector<Literal> FindLiterals(fs::path const& file) {
    static std::regex const token(
        R"~(//[^\n]*|/\*[^*]*\*/|'(?:\\.|[^'\\\n])'|"((?:\\.|[^"\\\n])*)"|\S)~");
    std::string const text = test::ReadText(file.string());
    std::vector<Literal> literals;
    bool continues = false;
    for (std::sregex_iterator at(text.begin(), text.end(), token), end; at != end; ++at) {
        std::string const word = at->str();
        if (word.starts_with("//") || word.starts_with("/*")) continue;
        bool const isLiteral = word.starts_with('"');
        if (isLiteral && !continues) literals.push_back({fs::relative(file, kRoot), {}});
        if (isLiteral) literals.back().text += (*at)[1].str();
        continues = isLiteral;
    }
    return literals;
}

std::vector<Literal> FindAllLiterals(std::vector<std::string> const& folders) {
    std::vector<Literal> all;
    for (std::string const& folder : folders) {
        for (auto const& entry : fs::recursive_directory_iterator(kRoot / folder)) {
            auto const extension = entry.path().extension();
            if (extension != ".cpp" && extension != ".h" && extension != ".inc") continue;
            auto const found = FindLiterals(entry.path());
            all.insert(all.end(), found.begin(), found.end());
        }
    }
    return all;
}

bool IsCommandLine(Literal const& literal) {
    return literal.file.string().starts_with("engine/cli/");
}

std::vector<Literal> FindLiteralsBelow() {
    auto literals = FindAllLiterals({"far_ext", "eval", "engine"});
    std::erase_if(literals, IsCommandLine);
    return literals;
}

/// Members in backquotes.
std::set<std::string> FindMembers(Literal const& literal) {
    static std::regex const member("`(\\w+)`");
    std::set<std::string> members;
    for (std::sregex_iterator at(literal.text.begin(), literal.text.end(), member), end; at != end;
         ++at)
        members.insert((*at)[1]);
    return members;
}

bool IsMember(std::string const& word) {
    return std::ranges::any_of(GetOptionNames(),
                               [&](OptionName const& row) { return row.member == word; });
}

TEST(OptionNames, NoMessageBelowTheCommandLineNamesAFlag) {
    std::regex const flag("(^|[ (,'])--?[a-z]");
    for (Literal const& literal : FindLiteralsBelow())
        EXPECT_FALSE(std::regex_search(literal.text, flag)) << literal.file << ": " << literal.text;
}

TEST(OptionNames, EveryMemberInAMessageHasAFlag) {
    for (Literal const& literal : FindLiteralsBelow()) {
        for (std::string const& member : FindMembers(literal))
            EXPECT_TRUE(IsMember(member)) << literal.file << ": " << literal.text;
    }
}

TEST(OptionNames, EveryMemberOfTheTableIsInAMessage) {
    std::set<std::string> used;
    for (Literal const& literal : FindLiteralsBelow()) {
        used.insert(literal.text);  // as it is handed to what words the message
        used.merge(FindMembers(literal));
    }
    for (OptionName const& row : GetOptionNames())
        EXPECT_TRUE(used.contains(std::string(row.member))) << row.member;
}

TEST(OptionNames, EveryFlagOfTheTableIsAnOption) {
    std::set<std::string> options;
    for (Literal const& literal : FindAllLiterals({"engine/cli"})) options.insert(literal.text);
    options.insert("-o");
    for (OptionName const& row : GetOptionNames()) {
        std::string const flag(row.flag.substr(0, row.flag.find(' ')));
        EXPECT_TRUE(options.contains(flag)) << row.flag;
    }
}

TEST(OptionNames, MembersInBackquotesBecomeFlags) {
    EXPECT_EQ(NameFlags("`levels`: 11 is not from 0 to 10"), "--levels: 11 is not from 0 to 10");
    EXPECT_EQ(NameFlags("use `precision` double or `PaintedWidths`"),
              "use --precision double or --width-texture");
}

TEST(OptionNames, OtherBackquotesStay) {
    for (std::string const text : {"", "a.obj: fine", "`", "a`b.obj", "`no member`", "``"})
        EXPECT_EQ(NameFlags(text), text);
    EXPECT_EQ(NameFlags("a`b.obj: `levels`"), "a`b.obj: --levels");
}

}  // namespace
}  // namespace limn::cli
