// SPDX-License-Identifier: Apache-2.0
//
// The chains of docs/recipes.md run as they stand, and do what they are for.

#include <cstdlib>
#include <filesystem>

#include "engine/io/mesh_reader.h"
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
        std::string const large = "--size 1024";
        for (size_t at = 0; (at = commands.find(large, at)) != std::string::npos;)
            commands.replace(at, large.size(), "--size 128");
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
    EXPECT_EQ(titles,
              (std::vector<std::string>{"An equaliser", "Detail and an expression on another body",
                                        "From a scan to a cage"}));
}

}  // namespace
}  // namespace limn
