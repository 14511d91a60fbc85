// SPDX-License-Identifier: Apache-2.0
//
// The plan of the house (docs/architecture.md) as laws: floors stand on each other, rooms do not
// need each other in a circle, and nothing grows beyond what a person can hold in mind.

#include <algorithm>
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

std::vector<std::string> const kFloors{"far_ext", "eval", "engine"};  // from the ground up
std::set<std::string> const kCode{".h", ".cpp", ".inc"};

size_t FindFloor(std::string const& path) {
    auto const floor = std::find(kFloors.begin(), kFloors.end(), path.substr(0, path.find('/')));
    return static_cast<size_t>(floor - kFloors.begin());
}

struct Include {
    std::string from, to;  // files, from the root
};

/// What the floors include of each other. Headers that only forward to a new place are left out.
std::vector<Include> ListIncludes() {
    std::vector<Include> includes;
    std::regex const pattern("#include \"((?:far_ext|eval|engine)/[^\"]+)\"");
    for (fs::path const& path : test::ListFiles(kFloors, kCode)) {
        std::string const from = fs::relative(path, test::kSourceRoot).string();
        std::string const text = test::ReadText(path);
        if (text.find("Where programs found this header") != std::string::npos) continue;
        for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) {
            includes.push_back({from, (*at)[1].str()});
        }
    }
    return includes;
}

std::string GetFolder(std::string const& file) {
    return fs::path(file).parent_path().string();
}

TEST(House, IncludesPointDown) {
    auto const includes = ListIncludes();
    ASSERT_GT(includes.size(), 500u);
    for (Include const& include : includes) {
        EXPECT_GE(FindFloor(include.from), FindFloor(include.to))
            << include.from << " includes " << include.to;
    }
}

/// Folders that a folder needs, by the includes of its files.
using Graph = std::map<std::string, std::set<std::string>>;

/// A way from `folder` back to itself, or nothing.
std::vector<std::string> FindCircle(Graph const& graph, std::string const& folder) {
    std::map<std::string, std::string> cameFrom;
    std::vector<std::string> open{folder};
    while (!open.empty()) {
        std::string const at = open.back();
        open.pop_back();
        auto const needs = graph.find(at);
        if (needs == graph.end()) continue;
        for (std::string const& next : needs->second) {
            if (next == folder) {
                std::vector<std::string> circle{folder, at};
                while (circle.back() != folder) circle.push_back(cameFrom.at(circle.back()));
                return circle;
            }
            if (cameFrom.emplace(next, at).second) open.push_back(next);
        }
    }
    return {};
}

TEST(House, RoomsDoNotNeedEachOtherInACircle) {
    Graph graph;
    for (Include const& include : ListIncludes()) {
        std::string const from = GetFolder(include.from), to = GetFolder(include.to);
        if (from != to) graph[from].insert(to);
    }
    ASSERT_GT(graph.size(), 15u);
    for (auto const& [folder, needs] : graph) {
        std::string way;
        for (std::string const& step : FindCircle(graph, folder)) way += " <- " + step;
        EXPECT_EQ(way, "") << folder;
    }
}

TEST(House, NoFileIsLongerThanFiveHundredLines) {
    for (fs::path const& path : test::ListFiles(kFloors, kCode)) {
        std::string const text = test::ReadText(path);
        EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 500) << path;
    }
}

TEST(House, NoFolderHasMoreThanTwentyFiveUnits) {
    std::map<std::string, std::set<std::string>> units;  // a header and its sources are one
    for (fs::path const& path : test::ListFiles(kFloors, kCode)) {
        units[path.parent_path().string()].insert(path.stem().string());
    }
    for (auto const& [folder, stems] : units) EXPECT_LE(stems.size(), 25u) << folder;
}

TEST(House, EverySourceSaysItsLicence) {
    std::string const line = "// SPDX-License-Identifier: Apache-2.0\n";
    for (fs::path const& path :
         test::ListFiles({"far_ext", "eval", "engine", "tests", "bench", "examples"}, kCode)) {
        EXPECT_EQ(test::ReadText(path).substr(0, line.size()), line) << path;
    }
}

}  // namespace
}  // namespace limn
