// SPDX-License-Identifier: Apache-2.0
//
// No verb overwrites what it reads, or one of its files with another: it refuses before any work.

#include <filesystem>

#include <gtest/gtest.h>

#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

/// A command line in a folder that has mesh.obj, other.obj, table.csv and link.obj, which leads to
/// mesh.obj.
struct Clash {
    char const* name;
    Words words;
    char const* message;
};

class Clashes : public testing::TestWithParam<Clash> {};

TEST_P(Clashes, AreRefusedAndNothingIsTouched) {
    test::TemporaryFolder const folder;
    std::string const cube = test::ReadText(Shape("catmark_cube"));
    for (char const* name : {"mesh.obj", "other.obj", "mesh.ply", "x.band1.obj", "x.0002.obj"})
        folder.Write(name, cube);
    folder.Write("table.csv", "face,s,t\n0,0.5,0.5\n");
    std::filesystem::create_symlink("mesh.obj", folder / "link.obj");
    auto const before = folder.List();
    ExpectError(Limn(GetParam().words, {.folder = folder / "."}), 2, GetParam().message);
    EXPECT_EQ(folder.List(), before);
    for (char const* name : {"mesh.obj", "other.obj", "mesh.ply", "x.band1.obj", "x.0002.obj"})
        EXPECT_EQ(test::ReadText(folder / name), cube);
    EXPECT_EQ(test::ReadText(folder / "table.csv"), "face,s,t\n0,0.5,0.5\n");
}

constexpr char const *kInput = "is an input", *kTwice = "would be written twice";

INSTANTIATE_TEST_SUITE_P(
    Of, Clashes,
    testing::Values(
        Clash{"Refine", {"refine", "mesh.obj", "-o", "mesh.obj"}, kInput},
        Clash{"RefineByDetour", {"refine", "mesh.obj", "-o", "./new/../mesh.obj"}, kInput},
        Clash{"RefineThroughLink", {"refine", "mesh.obj", "-o", "link.obj"}, kInput},
        Clash{"Curve", {"refine", "mesh.obj", "-o", "mesh.obj", "--curve"}, kInput},
        Clash{"Fit", {"fit", "mesh.obj", "-o", "mesh.obj"}, kInput},
        Clash{"Denoise", {"denoise", "mesh.obj", "-o", "mesh.obj"}, kInput},
        Clash{"Sharpen", {"sharpen", "mesh.obj", "-o", "mesh.obj"}, kInput},
        Clash{"Smooth", {"smooth", "mesh.obj", "-o", "mesh.obj"}, kInput},
        Clash{"SmoothWidths",
              {"smooth", "mesh.obj", "-o", "other.obj", "--width-map", "other.obj"},
              kInput},
        Clash{"Bands", {"bands", "x.band1.obj", "-o", "x", "--count", "2"}, kInput},
        Clash{"BandsFrom",
              {"bands", "mesh.obj", "-o", "other.obj", "--from", "other.obj", "--bands", "1"},
              kInput},
        Clash{"CombineAdd",
              {"combine", "mesh.obj", "-o", "other.obj", "--add", "other.obj:2"},
              kInput},
        Clash{"CombineOffset",
              {"combine", "mesh.obj", "-o", "other.obj", "--offset", "mesh.obj,other.obj"},
              kInput},
        Clash{"Morph", {"morph", "mesh.obj", "x.0002.obj", "-o", "x", "--steps", "2"}, kInput},
        Clash{"Measure", {"measure", "mesh.ply", "-o", "mesh"}, kInput},
        Clash{"Eval", {"eval", "mesh.obj", "--at", "table.csv", "-o", "table.csv"}, kInput},
        Clash{"Field", {"field", "mesh.obj", "-o", "mesh.obj", "--source", "0"}, kInput},
        Clash{"FieldVectors",
              {"field", "mesh.obj", "-o", "new.obj", "--match", "new.vectors.csv"},
              kInput},
        Clash{"ReportIsOutput",
              {"refine", "mesh.obj", "-o", "new.obj", "--report", "new.obj"},
              kTwice},
        Clash{"ReportIsInput",
              {"refine", "mesh.obj", "-o", "new.obj", "--report", "mesh.obj"},
              kInput},
        Clash{"ReportOfInfoIsInput", {"info", "mesh.obj", "--report", "mesh.obj"}, kInput},
        Clash{"ReportOfBakeIsInput",
              {"bake", "mesh.obj", "-o", "new.exr", "--maps", "mean", "--report", "mesh.obj"},
              kInput},
        Clash{"ReportIsPreview",
              {"bake", "mesh.obj", "-o", "new.exr", "--maps", "mean", "--preview", "--report",
               "new.png"},
              "is the report, and an output, too"},
        Clash{"ReportIsLegendOfLayer",
              {"bake", "mesh.obj", "-o", "new.exr", "--maps", "mean,k1", "--preview",
               "--preview-legend", "--report", "new.k1.legend.png"},
              "is the report, and an output, too"}),
    [](auto const& instance) { return instance.param.name; });

TEST_F(Cli, NullDeviceMayStandForSeveralOutputs) {
    EXPECT_EQ(
        Limn({"eval", Shape("catmark_cube"), "--at", folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n"),
              "-o", "/dev/null", "--report", "/dev/null"})
            .status,
        0);
}

}  // namespace
}  // namespace limn
