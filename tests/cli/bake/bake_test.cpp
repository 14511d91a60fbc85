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
#include "support/pictures.h"
#include "support/program/cli.h"

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

TEST_F(Cli, WithoutUdimTokenFacesElsewhereAreNamedAndNothingIsBaked) {
    std::string const mesh = folder.Write("two.obj", kTwoTiles);
    std::string const error = ExpectError(Bake(mesh, "{map}.exr"), 2, "face 1 (line 20)");
    EXPECT_TRUE(Contains(error, "<UDIM>")) << error;
    EXPECT_EQ(folder.List(), (Words{"two.obj"}));
    EXPECT_EQ(Bake(mesh, "{map}.exr", {"--tiles", "1012"}).status, 0);
    EXPECT_EQ(folder.List(), (Words{"mean.exr", "two.obj"}));
}

TEST_F(Cli, TileWithoutTexelsIsStatus3) {
    ExpectError(Bake(folder.Write("two.obj", kTwoTiles), "a.<UDIM>.exr", {"--tiles", "1005"}), 3,
                "no texel is covered in the tiles asked for; there are: 1001, 1012");
    EXPECT_EQ(folder.List(), (Words{"two.obj"}));
}

TEST_F(Cli, SeveralMeshesAreBakedToTheirNames) {
    Outcome const outcome =
        Limn({"bake", Shape("catmark_cube"), Shape("catmark_torus"), "-o", folder / "{mesh}.exr",
              "--maps", "mean", "--size", "32", "--quiet"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(folder.List(), (Words{"catmark_cube.exr", "catmark_torus.exr"}));
}

// -------- previews

class Previews : public Cli {
protected:
    std::string const mesh = Shape("catmark_nonquads");
};

// Texels of one value have one colour, the least and the largest differ, what has none is dark.
TEST_F(Previews, HaveAPixelPerTexel) {
    Words const more{"--preview", "--coverage",      "--padding", "2",      "--maps",
                     "gaussian",  "--preview-range", "full",      "--size", "70x50"};
    ASSERT_EQ(Bake(mesh, "a.exr", more).status, 0);
    auto const picture = test::ReadPng(folder / "a.png");
    ASSERT_EQ(picture.width, 70);
    ASSERT_EQ(picture.height, 50);
    using Colour = test::Picture::Colour;
    Colour const dark{38, 38, 38};
    engine::ExrLookup lookup;
    std::map<double, Colour> colours;
    int numDark = 0, numPadded = 0;
    for (int y = 0; y < 50; ++y) {
        for (int x = 0; x < 70; ++x) {
            auto const texel = lookup.Look(folder / "a.exr", {"Y", "coverage"}, x, y);
            bool const isDark = picture.At(x, y) == dark, isCovered = texel[1] > 0.0;
            EXPECT_FALSE(isDark && isCovered) << x << " " << y;
            numDark += isDark;
            numPadded += !isDark && !isCovered;
            if (isDark) continue;
            auto const [found, isNew] = colours.try_emplace(texel[0], picture.At(x, y));
            EXPECT_EQ(found->second, picture.At(x, y)) << x << " " << y;
        }
    }
    EXPECT_GT(numDark, 50);
    EXPECT_GT(numPadded, 50);
    EXPECT_GT(picture.ListColours(0, 0, 70, 50).size(), 20u);
    EXPECT_NE(colours.begin()->second, colours.rbegin()->second);
    EXPECT_EQ(folder.List(), (Words{"a.exr", "a.png"}));
}

TEST_F(Previews, HaveTheirLegendInAFileOfItsOwnWhereAskedFor) {
    ASSERT_EQ(
        Bake(mesh, "a.exr", {"--preview", "--preview-legend", "--maps", "mean,normal"}).status, 0);
    EXPECT_EQ(folder.List(), (Words{"a.exr", "a.mean.legend.png", "a.mean.png",
                                    "a.normal.legend.png", "a.normal.png"}));
    auto const mean = test::ReadPng(folder / "a.mean.legend.png");
    EXPECT_GT(mean.height, test::ReadPng(folder / "a.normal.legend.png").height);  // the bar
    EXPECT_GT(mean.ListColours(0, 0, mean.width, mean.height).size(), 100u);
}

TEST_F(Previews, OfAFileThatIsReplacedGo) {
    ASSERT_EQ(
        Bake(mesh, "{map}.exr", {"--preview", "--preview-legend", "--maps", "mean,k1"}).status, 0);
    folder.Write("k1.note.png", "not limn's");
    ASSERT_EQ(Bake(mesh, "{map}.exr", {"--maps", "mean"}).status, 0);
    EXPECT_EQ(folder.List(),
              (Words{"k1.exr", "k1.legend.png", "k1.note.png", "k1.png", "mean.exr"}));
    // Layers of a file have previews of their own, which go with the file they were made of.
    ASSERT_EQ(Bake(mesh, "k1.exr", {"--preview", "--maps", "mean,normal"}).status, 0);
    EXPECT_EQ(folder.List(),
              (Words{"k1.exr", "k1.mean.png", "k1.normal.png", "k1.note.png", "mean.exr"}));
    ASSERT_EQ(Bake(mesh, "k1.exr", {"--preview", "--maps", "k1"}).status, 0);
    EXPECT_EQ(folder.List(), (Words{"k1.exr", "k1.note.png", "k1.png", "mean.exr"}));
}

TEST_F(Previews, ThatLimnHasNotMadeStay) {
    folder.Write("a.png", "somebody's");
    fs::copy(folder / "a.png", folder / "a.mean.png");
    ASSERT_EQ(Bake(mesh, "a.exr").status, 0);
    EXPECT_EQ(folder.List(), (Words{"a.exr", "a.mean.png", "a.png"}));
}

TEST_F(Previews, AreTheSameForAnyNumberOfThreads) {
    std::map<std::string, std::string> bytes;
    for (char const* threads : {"1", "3"}) {
        ASSERT_EQ(Bake(mesh, "{map}.exr",
                       {"--preview", "--preview-legend", "--maps", "mean,position,normal",
                        "--threads", threads})
                      .status,
                  0);
        for (std::string const& name : folder.List()) {
            auto const [found, isNew] = bytes.try_emplace(name, test::ReadText(folder / name));
            EXPECT_TRUE(found->second == test::ReadText(folder / name)) << name;
        }
    }
    EXPECT_EQ(bytes.size(), 9u);
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

TEST_F(SkipExisting, BakesAnewWhereAByteChanged) {
    std::string const whole = test::ReadText(folder / "a.exr");
    for (size_t at : {whole.size() / 2, whole.size() - 3}) {
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 1);
        test::WriteText(folder / "a.exr", changed);
        EXPECT_TRUE(Rebakes({})) << at;
        EXPECT_TRUE(test::ReadText(folder / "a.exr") == whole) << at;
    }
}

TEST_F(SkipExisting, BakesAnewWhereAnotherTileHasTheName) {
    // Two tiles with one and the same picture.
    std::string const mesh = folder.Write(
        "m.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 3 1 0\nv 2 1 0\n"
        "vt .1 .1\nvt .9 .1\nvt .9 .9\nvt .1 .9\nvt 1.1 .1\nvt 1.9 .1\nvt 1.9 .9\nvt 1.1 .9\n"
        "f 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n");
    Words const more{"--skip-existing", "--maps", "normal", "--report", folder / "r.json"};
    ASSERT_EQ(Bake(mesh, "<UDIM>.exr", more).status, 0);
    fs::copy_file(folder / "1001.exr", folder / "1002.exr", fs::copy_options::overwrite_existing);
    ASSERT_EQ(Bake(mesh, "<UDIM>.exr", more).status, 0);
    EXPECT_EQ(Report()["outputs"][0]["skipped"], true);
    EXPECT_EQ(Report()["outputs"][1]["skipped"], false);
}

TEST_F(SkipExisting, TellsTheRangesOfWhatItSkips) {
    for (Words const& more : {Words{"--maps", "mean"}, {"--maps", "mean,k1", "--half", "--mip"}}) {
        ASSERT_EQ(Bake(Shape("catmark_cube"), "b.exr", more + Words{"--report", folder / "r.json"})
                      .status,
                  0);
        json first = Report()["outputs"];
        ASSERT_EQ(Bake(Shape("catmark_cube"), "b.exr",
                       more + Words{"--skip-existing", "--report", folder / "r.json"})
                      .status,
                  0);
        EXPECT_EQ(first[0]["skipped"], false);
        first[0]["skipped"] = true;
        EXPECT_EQ(Report()["outputs"], first);
    }
}

TEST_F(SkipExisting, AuditsWhatItSkipsAsIfItHadBeenBaked) {
    Words const more{"--audit",         "--audit-bound", "0",
                     "--skip-existing", "--report",      folder / "r.json"};
    ASSERT_EQ(Bake(Shape("catmark_cube"), "b.exr", more).status, 4);
    json const first = Report();
    EXPECT_TRUE(first["audit"]["gauss_bonnet"][0]["audited"]);
    EXPECT_EQ(Bake(Shape("catmark_cube"), "b.exr", more).status, 4);
    json const again = Report();
    EXPECT_TRUE(again["outputs"][0]["skipped"]);
    for (char const* key : {"audit", "audits", "error", "texels_covered", "overlaps", "warnings"})
        EXPECT_EQ(again[key], first[key]) << key;
}

TEST_F(SkipExisting, MakesThePreviewThatIsMissing) {
    EXPECT_FALSE(fs::exists(folder / "a.png"));
    ASSERT_EQ(BakeAgain({"--preview"}).status, 0);
    EXPECT_EQ(test::ReadPng(folder / "a.png").height, 64);
}

TEST_F(SkipExisting, MakesThePreviewAnewThatLooksOtherwise) {
    ASSERT_EQ(BakeAgain({"--preview"}).status, 0);
    EXPECT_FALSE(Rebakes({"--preview"}));
    EXPECT_TRUE(Rebakes({"--preview", "--preview-range", "-1,1"}));
    EXPECT_FALSE(Rebakes({"--preview", "--preview-range", "-1,1"}));
    EXPECT_TRUE(Rebakes({"--preview", "--preview-range", "-1,1", "--preview-legend"}));
    EXPECT_FALSE(Rebakes({}));  // the file is as it should be
}

}  // namespace
}  // namespace limn
