// SPDX-License-Identifier: Apache-2.0
//
// Outputs that cannot be written.

#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/program/cli.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using namespace test::cli;

TEST_F(Cli, MissingFoldersAreMade) {
    EXPECT_EQ(Bake(Shape("catmark_cube"), "new/{map}/<UDIM>/a.exr",
                   {"--maps", "mean,normal", "--report", folder / "reports/1/r.json"})
                  .status,
              0);
    for (char const* path : {"new/mean/1001/a.exr", "new/normal/1001/a.exr", "reports/1/r.json"})
        EXPECT_TRUE(fs::exists(folder / path)) << path;
}

TEST_F(Cli, FoldersMadeForABakeThatFailsGoAgain) {
    std::string const mesh = folder.Write(
        "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt .5 .5\nvt .5001 .5\nvt .5 .5001\nf 1/1 2/2 3/3\n");
    Words const two{"--maps", "mean,normal", "--size", "8"};
    ExpectError(Bake(mesh, "new/er/{map}.exr", two), 3, "no texel is covered");
    EXPECT_EQ(folder.List(), (Words{"m.obj"}));
    fs::create_directory(folder / "old");
    ExpectError(Bake(mesh, "old/{map}.exr", two), 3, "no texel is covered");
    EXPECT_EQ(folder.List(), (Words{"m.obj", "old"}));
}

TEST_F(Cli, FileWhereAFolderShouldBeIsStatus5) {
    folder.Write("file", "x");
    ExpectError(Bake(Shape("catmark_cube"), "file/a.exr"), 5, "Not a directory");
    ExpectError(Limn({"refine", Shape("catmark_cube"), "-o", folder / "file/a.obj"}), 5,
                "Not a directory");
    EXPECT_EQ(folder.List(), (Words{"file"}));
}

TEST_F(Cli, FolderThatCannotBeWrittenIsStatus5) {
    // Nobody, root neither, can make files in /proc.
    ExpectError(Limn({"bake", Shape("catmark_cube"), "-o", "/proc/limn.exr", "--maps", "mean",
                      "--size", "16"}),
                5, "'/proc/limn.exr' cannot be written");
    ExpectError(Limn({"refine", Shape("catmark_cube"), "-o", "/proc/limn.obj"}), 5,
                "'/proc/limn.obj' cannot be written");
}

TEST_F(Cli, OutputThatIsAFolderIsStatus5AndLeavesNoTemporary) {
    fs::create_directory(folder / "a.exr");
    ExpectError(Bake(Shape("catmark_cube"), "a.exr"), 5, "Is a directory");
    EXPECT_EQ(folder.List(), (Words{"a.exr"}));
}

/// Writing fails after 64 KiB: no file may become larger.
class FullDisk : public Cli {
protected:
    test::RunOptions const kFull{.maxFileBytes = 64u << 10};
    std::string const kReason = "File too large";
};

TEST_F(FullDisk, BakeIsStatus5AndLeavesNothing) {
    // 128 x 128 texels of 3 floats are 192 KiB. One way of writing is the engine's own, one
    // OpenEXR's.
    for (std::string const compression : {"none", "zip", "piz"}) {
        Words const more{"--size",        compression == "none" ? "128" : "512",
                         "--maps",        "position",
                         "--compression", compression};
        ExpectError(Bake(Shape("catmark_cube"), "a.exr", more, kFull), 5, kReason);
        EXPECT_TRUE(folder.List().empty()) << compression;
    }
}

TEST_F(FullDisk, MipsArePartOfTheFile) {
    // The first level has 48 KiB; all levels and the header are more than 64.
    Words const level{"--size", "128x96", "--compression", "none"};
    EXPECT_EQ(Bake(Shape("catmark_cube"), "a.exr", level, kFull).status, 0);
    ExpectError(Bake(Shape("catmark_cube"), "b.exr", level + Words{"--mip"}, kFull), 5, kReason);
    EXPECT_EQ(folder.List(), (Words{"a.exr"}));
}

TEST_F(FullDisk, RefineIsStatus5AndLeavesNothing) {
    for (std::string const name : {"a.obj", "a.ply"}) {
        // 6 * 4^5 faces: far more than 64 KiB
        ExpectError(
            Limn({"refine", Shape("catmark_cube"), "-o", folder / name, "--levels", "5"}, kFull), 5,
            kReason);
        EXPECT_TRUE(folder.List().empty()) << name;
    }
}

TEST_F(FullDisk, EvalIsStatus5AndLeavesNothing) {
    std::string places = "face,s,t\n";
    for (int i = 0; i < 1000; ++i) places += fmt::format("{},0.3,0.{:03}\n", i % 6, i);
    std::string const csv = folder.Write("p.csv", places);
    ExpectError(Limn({"eval", Shape("catmark_cube"), "--at", csv, "-o", folder / "a.csv"}, kFull),
                5, kReason);
    EXPECT_EQ(folder.List(), (Words{"p.csv"}));
}

TEST_F(Cli, FullStdoutIsStatus5) {
    test::RunOptions const full{.stdoutPath = "/dev/full"};
    std::string const cube = Shape("catmark_cube"),
                      csv = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
    for (Words const& words :
         {Words{"info", cube}, Words{"info", cube, "--json"}, Words{"eval", cube, "--at", csv},
          Words{"measure", cube}, Words{"refine", cube, "-o", folder / "a.obj", "--report", "-"}})
        ExpectError(Limn(words, full), 5, "'stdout' cannot be written: No space left on device");
}

TEST_F(Cli, MeasureWritesNoFilesWhereStdoutTakesNothing) {
    ExpectError(Limn({"measure", Shape("catmark_cube"), "-o", folder / "new/a", "--picture"},
                     {.stdoutPath = "/dev/full"}),
                5, "'stdout' cannot be written");
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(Cli, ReportThatCannotBeWrittenIsStatus5WithoutOutput) {
    folder.Write("file", "x");
    ExpectError(Bake(Shape("catmark_cube"), "a.exr", {"--report", folder / "file/r.json"}), 5,
                "Not a directory");
    EXPECT_EQ(folder.List(), (Words{"file"}));
}

TEST_F(Cli, NameOf255BytesIsWrittenAndALongerOneRefused) {
    std::string const longest = std::string(251, 'n') + ".exr";
    EXPECT_EQ(Bake(Shape("catmark_cube"), longest).status, 0);
    EXPECT_EQ(folder.List(), (Words{longest}));
    ExpectError(Bake(Shape("catmark_cube"), "n" + longest), 5, "File name too long");
    EXPECT_EQ(folder.List(), (Words{longest}));
}

}  // namespace
}  // namespace limn
