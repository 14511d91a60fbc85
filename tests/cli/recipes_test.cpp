// SPDX-License-Identifier: Apache-2.0
//
// The chains of docs/recipes.md run as they stand, and do what they are for.

#include <cstdlib>
#include <filesystem>
#include <regex>

#include "engine/io/mesh_reader.h"
#include "engine/io/number_table.h"
#include "support/program/cli.h"
#include "support/source_tree.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

/// Sections of the page by their titles, each with its commands, joined at backslashes.
std::map<std::string, std::string> ReadRecipes() {
    std::map<std::string, std::string> recipes;
    std::string title;
    for (std::string const& line : Lines(test::ReadText(test::kSourceRoot / "docs/recipes.md"))) {
        if (line.starts_with("## ")) title = line.substr(3);
        if (line.starts_with("    ")) recipes[title] += line.substr(4) + "\n";
    }
    return recipes;
}

class Recipes : public Cli {
protected:
    /// Runs a recipe's commands in the folder, small.
    void Run(std::string const& title) const {
        std::string commands = ReadRecipes().at(title);
        commands = std::regex_replace(commands, std::regex("--size [0-9]+"), "--size 128");
        namespace fs = std::filesystem;
        fs::create_directory(folder / "out");
        fs::create_directory_symlink(test::kSourceRoot / "scenes", folder / "scenes");
        std::string const script = folder.Write(
            "recipe.sh", "set -eu\ncd '" + folder.GetPath() +
                             "'\nlimn() { '" LIMN_PROGRAM "' \"$@\" --quiet; }\n" + commands);
        EXPECT_EQ(std::system(("sh " + script).c_str()), 0) << title;
    }

    std::vector<double> Read(std::string const& name) const {
        return engine::ReadMesh(folder / ("out/" + name)).positions;
    }

    /// Of the vertices of two meshes, as a root of mean squares.
    double FindDistance(std::string const& a, std::string const& b) const {
        test::Rows const difference = test::ToRows(Read(a)) - test::ToRows(Read(b));
        return std::sqrt(difference.rowwise().squaredNorm().mean());
    }
};

// Scales came over: the other body's rough bands are as large as the sculpt's, and its nod moves
// heads by as much.
TEST_F(Recipes, DetailAndAnExpressionGoToAnotherBody) {
    Run("Detail and an expression on another body");
    double const scales = FindDistance("other.scaly.obj", "other.fit.obj"),
                 nod = FindDistance("other.nods.obj", "other.scaly.obj");
    EXPECT_GT(scales, 0.002);
    EXPECT_LT(scales, 0.05);
    EXPECT_NEAR(nod / FindDistance("nod.obj", "neutral.obj"), 1.0, 1e-5);  // turned, not stretched
}

TEST_F(Recipes, AnEqualiserMakesBandsLouder) {
    Run("An equaliser");
    EXPECT_GT(test::LargestDifference(Read("loud.obj"), Read("quiet.obj")), 1e-3);
    for (char const* map : {"bands", "displacement"})
        EXPECT_TRUE(std::filesystem::exists(folder / ("out/recipe2." + std::string(map) + ".exr")));
}

TEST_F(Recipes, AFieldComesBackFromItsTexture) {
    Run("A field there and back");
    auto const read = [&](char const* name) {
        return engine::ReadNumberTable(folder / name, {{"v0", "v1", "value"}});
    };
    auto const there = read("out/there.edges.csv"), back = read("out/back.edges.csv");
    ASSERT_EQ(back.GetNumRows(), there.GetNumRows());
    for (size_t row = 0; row < there.GetNumRows(); ++row)
        EXPECT_NEAR(back.Get(row, 2), there.Get(row, 2), 1e-5);
    EXPECT_TRUE(std::filesystem::exists(folder / "out/recipe3.lines.png"));
}

// Noise from 0 to 1 times 0.3, as the filter itself has smoothed it; what is exposed again gets
// smaller.
TEST_F(Recipes, NoiseDecidesWhereABlockWears) {
    Run("A block and the weather");
    engine::Scene const worn = engine::ReadMesh(folder / "out/worn.ply");
    auto const& widths = worn.primvars.at(0).values;
    auto const [least, largest] = std::ranges::minmax_element(widths);
    EXPECT_GE(*least, 0.0);
    EXPECT_LE(*largest, 0.3);
    EXPECT_GT(*largest, 3.0 * *least);
    EXPECT_LE(ReadJson(folder / "out/worn.json")["adaptive"]["estimated"], 1.2 * 4e-3);
    EXPECT_LT(test::BoxDiagonal(Read("older.ply")), test::BoxDiagonal(worn.positions));
}

// The patch bends as asked but at its border, and nothing goes sideways.
TEST_F(Recipes, APlateBendsByNumbers) {
    Run("A plate bent by numbers");
    json const edits = ReadJson(folder / "out/bent.json")["edits"];
    ASSERT_EQ(edits.size(), 81u);
    EXPECT_NEAR(edits[40]["reached"], 0.05, 0.002);  // in the middle
    auto const bent = Read("bent.obj");
    double height = 0.0, width = 0.0;
    for (size_t i = 0; i < bent.size(); i += 3) {
        height = std::max(height, std::abs(bent[i + 2]));
        width = std::max({width, std::abs(bent[i]), std::abs(bent[i + 1])});
    }
    EXPECT_GT(height, 0.5);
    EXPECT_NEAR(width, 6.0, 0.1);
}

TEST_F(Recipes, AScanBecomesACage) {
    Run("From a scan to a cage");
    EXPECT_LE(ReadJson(folder / "out/cage.json")["certificate"]["max"], 1.01e-6);
    json const measured = ReadJson(folder / "out/measured.json");
    EXPECT_EQ(measured["euler_characteristic"], 2);
    EXPECT_LT(FindDistance("clean.obj", "scanned.obj"), FindDistance("scan.obj", "scanned.obj"));
}

TEST_F(Recipes, OfThePageAreAllRunHere) {
    std::vector<std::string> titles;
    for (auto const& [title, commands] : ReadRecipes()) titles.push_back(title);
    EXPECT_EQ(titles, (std::vector<std::string>{"A block and the weather", "A field there and back",
                                                "A plate bent by numbers", "An equaliser",
                                                "Detail and an expression on another body",
                                                "From a scan to a cage"}));
}

}  // namespace
}  // namespace limn
