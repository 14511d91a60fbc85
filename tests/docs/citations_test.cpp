// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/source_tree.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using test::ListFiles;

fs::path const& kRoot = test::kSourceRoot;

std::set<fs::path> ListSources() {
    return ListFiles({"far_ext", "eval", "engine", "tests", "bench", "examples"},
                     {".h", ".cpp", ".inc"});
}

std::set<fs::path> ListDocuments() {
    std::set<fs::path> documents = ListFiles({"docs"}, {".md"});
    documents.insert(kRoot / "README.md");
    documents.insert(kRoot / "bench/README.md");
    return documents;
}

/// Comes round to every match of a pattern, with its groups.
template <class Visit>
void ForEachMatch(std::string const& text, std::string const& pattern, Visit visit) {
    std::regex const regex(pattern);
    for (std::sregex_iterator at(text.begin(), text.end(), regex), end; at != end; ++at) visit(*at);
}

/// What docs/papers.md lists: keys of papers, and per key of a page the numbers of its sections.
struct Keys {
    std::set<std::string> papers;
    std::map<std::string, std::set<std::string>> sections;
};

std::set<std::string> FindSections(fs::path const& page) {
    std::set<std::string> numbers;
    ForEachMatch(test::ReadText(page), R"(\n##+ ([0-9]+(\.[0-9]+)?)\.? )",
                 [&](std::smatch const& heading) { numbers.insert(heading[1]); });
    return numbers;
}

Keys ReadKeys() {
    std::string const text = test::ReadText(kRoot / "docs/papers.md");
    Keys keys;
    ForEachMatch(text, R"(\n\| \[([A-Z][A-Za-z]*[0-9]{2}|Pixar)\] \|)",
                 [&](std::smatch const& row) { keys.papers.insert(row[1]); });
    ForEachMatch(text, R"(\n\| \[([A-Z][a-z]+) n\] \| \[([a-z/]+\.md)\])",
                 [&](std::smatch const& row) {
                     keys.sections[row[1]] = FindSections(kRoot / "docs" / row[2].str());
                 });
    return keys;
}

/// Text with the comment marks between two lines of a comment taken out: a citation may be broken.
std::string JoinComments(std::string const& text) {
    return std::regex_replace(text, std::regex(R"(\n[ \t]*//[/<]*[ \t]*)"), " ");
}

/// Citations that are of no paper listed, or of no section that exists.
std::vector<std::string> FindWrongCitations(std::string const& text, Keys const& keys) {
    std::vector<std::string> wrong;
    ForEachMatch(text, R"(\[([A-Z][A-Za-z]+[0-9]{2})\])", [&](std::smatch const& citation) {
        if (!keys.papers.count(citation[1])) wrong.push_back(citation[0]);
    });
    ForEachMatch(text, R"(\[([A-Z][a-z]+) ([0-9]+(\.[0-9]+)?)\])",
                 [&](std::smatch const& citation) {
                     auto const page = keys.sections.find(citation[1]);
                     if (page == keys.sections.end() || !page->second.count(citation[2]))
                         wrong.push_back(citation[0]);
                 });
    return wrong;
}

bool IsUnit(std::string const& path) {
    for (char const* ending : {"", ".h", ".cpp", ".inc"}) {
        if (fs::exists(kRoot / (path + ending))) return true;
    }
    return false;
}

TEST(Citations, AreOfKeysThatPapersListsAndOfSectionsThatExist) {
    Keys const keys = ReadKeys();
    ASSERT_EQ(keys.sections.size(), 5u);
    auto files = ListSources();
    files.merge(ListDocuments());
    for (fs::path const& file : files) {
        auto const wrong = FindWrongCitations(JoinComments(test::ReadText(file)), keys);
        EXPECT_TRUE(wrong.empty()) << file << " cites " << (wrong.empty() ? "" : wrong[0]);
    }
}

TEST(Citations, OfUnknownKeysAndMissingSectionsAreFoundAlsoWhereALineBreaksThem) {
    Keys const keys = ReadKeys();
    std::string const open = "/// Source  [", forms = open + "Forms";
    EXPECT_TRUE(FindWrongCitations(JoinComments(forms + "\n/// 3.4], [Wang06]"), keys).empty());
    EXPECT_EQ(FindWrongCitations(JoinComments(forms + "\n/// 3.9]"), keys).size(), 1u);
    EXPECT_EQ(FindWrongCitations(open + "Nobody" + "99]", keys).size(), 1u);
    EXPECT_EQ(FindWrongCitations(open + "Surface" + " 1]", keys).size(), 1u);
}

TEST(Citations, OfDocumentsAreOfDocumentsInTheRepository) {
    for (fs::path const& file : ListSources()) {
        ForEachMatch(
            test::ReadText(file), R"([A-Za-z0-9_/-]+\.md\b)", [&](std::smatch const& name) {
                bool const exists =
                    fs::exists(kRoot / name.str()) || fs::exists(kRoot / "docs" / name.str());
                EXPECT_TRUE(exists) << file << " names " << name.str();
            });
    }
}

TEST(Documents, NameUnitsThatExist) {
    for (fs::path const& document : ListDocuments()) {
        ForEachMatch(test::ReadText(document),
                     R"(`((far_ext|eval|engine|tests|bench)/[a-z0-9_/]+(\.[a-z]+)?)`)",
                     [&](std::smatch const& unit) {
                         EXPECT_TRUE(IsUnit(unit[1])) << document << " names " << unit[1];
                     });
    }
}

TEST(Documents, NameTestsThatExist) {
    std::set<std::string> tests;
    for (fs::path const& source : ListFiles({"tests"}, {".cpp"})) {
        ForEachMatch(
            test::ReadText(source), R"(\nTEST(_F|_P)?\((\w+),\s*(\w+)\))",
            [&](std::smatch const& test) { tests.insert(test[2].str() + "." + test[3].str()); });
    }
    size_t numNamed = 0;
    ForEachMatch(test::ReadText(kRoot / "docs/papers.md"), R"(`([A-Z]\w+\.[A-Z]\w+)`)",
                 [&](std::smatch const& name) {
                     ++numNamed;
                     EXPECT_TRUE(tests.contains(name[1])) << name[1];
                 });
    EXPECT_GT(numNamed, 40u);
}

TEST(TheoryPages, SayInEachSectionWhichCodeStandsOnIt) {
    for (fs::path const& page : ListFiles({"docs/theory"}, {".md"})) {
        std::string const text = test::ReadText(page);
        ForEachMatch(text, R"(\n## ([^\n]+)\n)", [&](std::smatch const& heading) {
            size_t const begin = static_cast<size_t>(heading.position(0)) + 1;
            std::string const section = text.substr(begin, text.find("\n## ", begin) - begin);
            EXPECT_NE(section.find("\nCode: `"), std::string::npos) << page << ": " << heading[1];
        });
    }
}

}  // namespace
}  // namespace limn
