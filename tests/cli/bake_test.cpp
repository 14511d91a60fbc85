// SPDX-License-Identifier: Apache-2.0
//
// The files of a bake: their names, previews, and those that are up to date.

#include <chrono>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "engine/images/exr_lookup.h"
#include "engine/io/file.h"
#include "support/cli.h"
#include "support/pictures.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using namespace test::cli;

/// Two quads, one in tile 1001 and one in 1012.
std::string const kTwoTiles =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 3 1 0\nv 2 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 1 1\nvt 2 1\nvt 2 2\nvt 1 2\nusemtl a\nf 1/1 2/2 3/3 "
    "4/4\nusemtl b\nf 5/5 6/6 7/7 8/8\n";

TEST_F(Cli, EveryTileGetsItsFile) {
    std::string const mesh = folder.Write("two.obj", kTwoTiles);
    ASSERT_EQ(Bake(mesh, "{mesh}.{map}.<UDIM>.exr", {"--maps", "mean,position"}).status, 0);
    EXPECT_EQ(folder.List(), (Words{"two.mean.1001.exr", "two.mean.1012.exr", "two.obj",
                                    "two.position.1001.exr", "two.position.1012.exr"}));
}

TEST_F(Cli, TilesAndGroupsChooseWhatIsBaked) {
    std::string const mesh = folder.Write("two.obj", kTwoTiles);
    ASSERT_EQ(Bake(mesh, "t.{udim}.exr", {"--tiles", "1002-1012"}).status, 0);
    ASSERT_EQ(Bake(mesh, "g.{udim}.exr", {"--groups", "a"}).status, 0);
    EXPECT_EQ(folder.List(), (Words{"g.1001.exr", "t.1012.exr", "two.obj"}));
}

TEST_F(Cli, WithoutUdimTokenFacesElsewhereAreNamed) {
    std::string const mesh = folder.Write("two.obj", kTwoTiles);
    Outcome const outcome =
        Limn({"bake", mesh, "-o", folder / "{map}.exr", "--maps", "mean", "--size", "32"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(folder.List(), (Words{"mean.exr", "two.obj"}));
    EXPECT_TRUE(Contains(outcome.err, "face 1 (line 20)")) << outcome.err;
}

TEST_F(Cli, TileWithoutTexelsIsStatus3) {
    ExpectError(Bake(folder.Write("two.obj", kTwoTiles), "a.<UDIM>.exr", {"--tiles", "1005"}), 3,
                "no texel is covered in the tiles asked for");
    EXPECT_EQ(folder.List(), (Words{"two.obj"}));
}

TEST_F(Cli, SeveralMeshesAreBakedToTheirNames) {
    Outcome const outcome =
        Limn({"bake", Shape("catmark_cube"), Shape("catmark_torus"), "-o", folder / "{mesh}.exr",
              "--maps", "mean", "--size", "32", "--quiet"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(folder.List(), (Words{"catmark_cube.exr", "catmark_torus.exr"}));
}

// Texels of one value have one colour, the least and the largest differ, what is not covered is
// dark; the legend is a strip of white figures and a ramp below.
TEST_F(Cli, PreviewIsAPngBesideTheMap) {
    Words const more{"--preview", "--coverage", "--padding", "0", "--maps", "gaussian"};
    ASSERT_EQ(Bake(Shape("catmark_nonquads"), "a.exr", more).status, 0);
    auto const picture = test::ReadPng(folder / "a.png");
    ASSERT_EQ(picture.width, 128);  // room for the legend
    ASSERT_EQ(picture.height, 64 + 28);
    using Colour = test::Picture::Colour;
    Colour const dark{38, 38, 38}, white{255, 255, 255};
    engine::ExrLookup lookup;
    std::map<double, Colour> colours;
    int numDark = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            auto const texel = lookup.Look(folder / "a.exr", {"Y", "coverage"}, x, y);
            bool const isCovered = texel[1] > 0.0;
            EXPECT_EQ(picture.At(x, y) != dark, isCovered) << x << " " << y;
            numDark += !isCovered;
            if (!isCovered) continue;
            auto const [found, isNew] = colours.try_emplace(texel[0], picture.At(x, y));
            EXPECT_EQ(found->second, picture.At(x, y)) << x << " " << y;
        }
    }
    EXPECT_GT(numDark, 100);
    EXPECT_GT(picture.ListColours(0, 0, 64, 64).size(), 20u);
    EXPECT_NE(colours.begin()->second, colours.rbegin()->second);
    auto const legend = picture.ListColours(0, 64, 128, 28);
    EXPECT_TRUE(legend.contains(white));
    EXPECT_TRUE(legend.contains(dark));
    EXPECT_GT(legend.size(), 20u);
}

class SkipExisting : public Cli {
protected:
    void SetUp() override { ASSERT_EQ(BakeAgain({}).status, 0); }

    Outcome BakeAgain(Words const& more) const {
        return Bake(Shape("catmark_cube"), "a.exr",
                    more + Words{"--skip-existing", "--report", folder / "r.json"});
    }

    /// True if a bake with these options writes the file anew.
    bool Rebakes(Words const& more) const {
        auto const old = fs::file_time_type::clock::now() - std::chrono::hours(24);
        fs::last_write_time(folder / "a.exr", old);
        auto const before = fs::last_write_time(folder / "a.exr");
        Outcome const outcome = BakeAgain(more);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        bool const isRewritten = fs::last_write_time(folder / "a.exr") != before;
        EXPECT_EQ(Report()["outputs"][0]["skipped"], !isRewritten);
        return isRewritten;
    }
};

TEST_F(SkipExisting, LeavesAFileOfTheSameOptionsAlone) {
    EXPECT_FALSE(Rebakes({}));
    EXPECT_FALSE(Rebakes({"--threads", "1"}));  // no option that affects pixels
    EXPECT_EQ(Report()["outputs"][0]["sha256"], engine::Sha256OfFile(folder / "a.exr"));
}

TEST_F(SkipExisting, BakesAnewWhereAnOptionChanged) {
    for (Words const& more : {Words{"--size", "32"},
                              {"--maps", "k1"},
                              {"--padding", "3"},
                              {"--half"},
                              {"--samples", "2"},
                              {"--mip"},
                              {"--coverage"},
                              {"--compression", "zips"},
                              {"--orientation", "left"},
                              {"--encode", "2,1"},
                              {"--creases", "chaikin"},
                              {"--fvar", "all"}}) {
        EXPECT_TRUE(Rebakes(more)) << fmt::format("{}", fmt::join(more, " "));
        EXPECT_FALSE(Rebakes(more)) << fmt::format("{}", fmt::join(more, " "));
    }
}

TEST_F(SkipExisting, BakesAnewWhereTheInputChanged) {
    std::string const mesh = folder.Write("m.obj", test::ReadText(Shape("catmark_cube")));
    Words const more{"--skip-existing", "--report", folder / "r.json"};
    ASSERT_EQ(Bake(mesh, "b.exr", more).status, 0);
    ASSERT_EQ(Bake(mesh, "b.exr", more).status, 0);
    EXPECT_EQ(Report()["outputs"][0]["skipped"], true);
    folder.Write("m.obj", "# a comment is a change\n" + test::ReadText(mesh));
    ASSERT_EQ(Bake(mesh, "b.exr", more).status, 0);
    EXPECT_EQ(Report()["outputs"][0]["skipped"], false);
}

TEST_F(SkipExisting, BakesAnewWhereTheFileIsNotComplete) {
    std::string const whole = test::ReadText(folder / "a.exr");
    for (size_t size : {whole.size() - 1, whole.size() / 2, size_t{10}, size_t{0}}) {
        test::WriteText(folder / "a.exr", whole.substr(0, size));
        EXPECT_TRUE(Rebakes({})) << size;
        EXPECT_TRUE(test::ReadText(folder / "a.exr") == whole) << size;
        test::WriteText(folder / "a.exr", whole);
    }
}

TEST_F(SkipExisting, MakesThePreviewThatIsMissing) {
    EXPECT_FALSE(fs::exists(folder / "a.png"));
    ASSERT_EQ(BakeAgain({"--preview"}).status, 0);
    EXPECT_EQ(test::ReadPng(folder / "a.png").height, 64 + 28);
}

}  // namespace
}  // namespace limn
