// SPDX-License-Identifier: Apache-2.0
//
// Sheets that only touch: named by every verb that subdivides, joined by --weld.

#include <algorithm>

#include <gtest/gtest.h>

#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

constexpr char const* kWarning =
    "24 boundary vertices coincide with others, first vertex 0 with 8: sheets that only touch come "
    "apart as they are subdivided; --weld 0 joins them";

class CutCube : public Cli {
protected:
    /// A cube as exporters write it that have one index for positions and texture coordinates.
    std::string MakeCutCube() const {
        return folder.Write("cut.ply",
                            "ply\nformat ascii 1.0\nelement vertex 24\nproperty float x\nproperty "
                            "float y\nproperty float z\nproperty float s\nproperty float t\n"
                            "element face 6\nproperty list uchar int vertex_indices\nend_header\n"
                            "-1 -1 -1 0 0\n-1 1 -1 .3 0\n1 1 -1 .3 .5\n1 -1 -1 0 .5\n"
                            "-1 -1 1 .3 0\n1 -1 1 .6 0\n1 1 1 .6 .5\n-1 1 1 .3 .5\n"
                            "-1 -1 -1 .6 0\n1 -1 -1 1 0\n1 -1 1 1 .5\n-1 -1 1 .6 .5\n"
                            "1 -1 -1 0 .5\n1 1 -1 .3 .5\n1 1 1 .3 1\n1 -1 1 0 1\n"
                            "1 1 -1 .3 .5\n-1 1 -1 .6 .5\n-1 1 1 .6 1\n1 1 1 .3 1\n"
                            "-1 1 -1 .6 .5\n-1 -1 -1 1 .5\n-1 -1 1 1 1\n-1 1 1 .6 1\n"
                            "4 0 1 2 3\n4 4 5 6 7\n4 8 9 10 11\n4 12 13 14 15\n4 16 17 18 19\n"
                            "4 20 21 22 23\n");
    }
    /// Every verb that subdivides, with small work.
    std::vector<Words> ListRuns(std::string const& mesh) const {
        std::string const places = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
        return {{"bake", mesh, "-o", folder / "a.exr", "--maps", "mean", "--size", "32"},
                {"eval", mesh, "--at", places},
                {"refine", mesh, "-o", folder / "a.obj"},
                {"measure", mesh},
                {"fit", mesh, "-o", folder / "b.obj"},
                {"bands", mesh, "-o", folder / "c", "--count", "2"},
                {"combine", mesh, "-o", folder / "i.obj"},
                {"denoise", mesh, "-o", folder / "d.obj"},
                {"sharpen", mesh, "-o", folder / "e.obj"},
                {"morph", mesh, mesh, "-o", folder / "f", "--steps", "1"},
                {"smooth", mesh, "-o", folder / "g.obj", "--levels", "1"},
                {"field", mesh, "-o", folder / "h.obj", "--levels", "1", "--source", "0", "--sink",
                 "6"}};
    }
};

TEST_F(CutCube, IsToldOfByInfoInTextAndJson) {
    std::string const mesh = MakeCutCube();
    EXPECT_TRUE(Contains(Limn({"info", mesh}).out, kWarning));
    json const defects = ParseJson(Limn({"info", mesh, "--json"}).out)["defects"];
    ASSERT_EQ(defects.size(), 1u);
    EXPECT_EQ(defects[0]["kind"], "coincident_vertices");
    EXPECT_EQ(defects[0]["count"], 24);
    EXPECT_EQ(defects[0]["message"], kWarning);
}

TEST_F(CutCube, IsWarnedOfOnceByEveryVerbThatSubdivides) {
    for (Words const& run : ListRuns(MakeCutCube())) {
        SCOPED_TRACE(run[0]);
        auto const lines = Lines(Limn(run).err);
        auto const count = std::count_if(lines.begin(), lines.end(), [](std::string const& line) {
            return Contains(line, kWarning);
        });
        EXPECT_EQ(count, run[0] == "morph" ? 2 : 1);  // one per mesh
    }
}

TEST_F(CutCube, IsWholeWithWeldInEveryVerb) {
    for (Words const& run : ListRuns(MakeCutCube())) {
        SCOPED_TRACE(run[0]);
        Outcome const outcome = Limn(run + Words{"--weld", "0", "--report", folder / "r.json"});
        EXPECT_FALSE(Contains(outcome.err, "coincide")) << outcome.err;
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        json const report = Report();
        for (json const& input : report["inputs"]) {
            EXPECT_EQ(input["vertices"], 8);
            EXPECT_EQ(input["weld"], json({{"tolerance", 0.0}, {"joined", 16}, {"left_apart", 0}}));
        }
    }
}

TEST_F(CutCube, WeldedIsAClosedBodyForInfo) {
    std::string const mesh = MakeCutCube();
    json const info = ParseJson(Limn({"info", mesh, "--json", "--weld", "0"}).out);
    EXPECT_EQ(info["vertices"], 8);
    EXPECT_EQ(info["genus"], 0);
    EXPECT_EQ(info["boundary_loops"], 0);
    EXPECT_TRUE(info["defects"].empty());
    EXPECT_TRUE(info["uv"]["present"]);
    EXPECT_EQ(info["weld"]["joined"], 16);
    EXPECT_TRUE(ParseJson(Limn({"info", mesh, "--json"}).out)["weld"].is_null());
    EXPECT_TRUE(Contains(Limn({"info", mesh, "--weld", "0"}).out,
                         "within 0: 16 vertices joined to others, 0 left apart"));
}

// The limit of a cube of side 2 has mean curvatures of 0.986 to 1.644 at the texels of this size;
// six sheets have none.
TEST_F(CutCube, HasItsCurvatureOnlyWhenWelded) {
    std::string const mesh = MakeCutCube();
    auto const range = [&](Words const& more) {
        EXPECT_EQ(Bake(mesh, "a.exr", Words{"--size", "256", "--report", folder / "r.json"} + more)
                      .status,
                  0);
        json const output = Report()["outputs"][0];
        return std::pair(output["min"].get<double>(), output["max"].get<double>());
    };
    auto const [low, high] = range({});
    EXPECT_EQ(low, 0.0);
    EXPECT_EQ(high, 0.0);
    auto const [weldedLow, weldedHigh] = range({"--weld", "0"});
    EXPECT_NEAR(weldedLow, 0.986, 0.001);
    EXPECT_NEAR(weldedHigh, 1.644, 0.01);  // depends on how near a corner a texel lies
}

TEST_F(CutCube, AWeldedBakeIsNotTakenForOneThatIsNot) {
    std::string const mesh = MakeCutCube();
    ASSERT_EQ(Bake(mesh, "a.exr").status, 0);
    ASSERT_EQ(Bake(mesh, "a.exr", {"--weld", "0", "--skip-existing", "--report", folder / "r.json"})
                  .status,
              0);
    EXPECT_FALSE(Report()["outputs"][0]["skipped"]);
    ASSERT_EQ(Bake(mesh, "a.exr", {"--weld", "0", "--skip-existing", "--report", folder / "r.json"})
                  .status,
              0);
    EXPECT_TRUE(Report()["outputs"][0]["skipped"]);
}

TEST_F(CutCube, FramesAreWeldedWithTheirMesh) {
    std::string const mesh = MakeCutCube();
    folder.Write("f.1.ply", test::ReadText(mesh));
    std::string const places = folder.Write("p.csv", "face,s,t\n0,0,0\n");
    Words const words{"eval", mesh, "--at", places, "--weld", "0"};
    ASSERT_EQ(
        Limn(words + Words{"--frames", folder / "f.{frame}.ply", "-o", folder / "{frame}.csv"})
            .status,
        0);
    // A vertex of valence 3 moves to 5/9 of itself in one step, and to half of itself in the limit.
    std::string const row = Lines(test::ReadText(folder / "1.csv")).at(1);
    EXPECT_TRUE(row.starts_with("0,0,0,-0.5,-0.5,-0.5,")) << row;
}

TEST_F(CutCube, AToleranceAboveAnEdgeIsToldOf) {
    Outcome const outcome = Limn({"info", MakeCutCube(), "--weld", "5"});
    EXPECT_TRUE(Contains(outcome.out + outcome.err, "lie within 5 of others and stay apart"));
    EXPECT_TRUE(Contains(outcome.out + outcome.err, "use a --weld far below the length of edges"));
}

TEST_F(CutCube, ABadToleranceIsAUsageError) {
    std::string const mesh = MakeCutCube();
    ExpectError(Limn({"info", mesh, "--weld", "-1"}), 2, "--weld is -1");
    for (std::string const tolerance : {"nan", "inf", "near"})
        ExpectError(Limn({"info", mesh, "--weld", tolerance}), 2,
                    "--weld: '" + tolerance + "' is no number");
    ExpectError(Limn({"refine", folder.Write("l.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), "--curve", "-o",
                      folder / "a.obj", "--weld", "0"}),
                2, "--weld means nothing with --curve");
}

}  // namespace
}  // namespace limn
