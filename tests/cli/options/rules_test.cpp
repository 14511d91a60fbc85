// SPDX-License-Identifier: Apache-2.0
//
// limn refine --rule from outside: the rules that keep vertices.

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "engine/io/mesh_reader.h"
#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

class CliRules : public Cli {
protected:
    static std::string Triangles() { return test::DataPath("differential/gridholetri.obj"); }
    static std::string Quads() { return test::AssetPath("tri/torus_quad.off"); }

    Outcome Refine(std::string const& mesh, Words const& more,
                   std::string const& output = "out.obj") const {
        return Limn(Words{"refine", mesh, "-o", folder / output, "--levels", "2", "--precision",
                          "double", "--report", folder / "r.json"} +
                    more);
    }
};

TEST_F(CliRules, InterpolatingRulesKeepWhatIsWritten) {
    for (auto const& [mesh, rule] :
         std::vector<std::pair<std::string, std::string>>{{Triangles(), "butterfly"},
                                                          {Triangles(), "butterfly-original"},
                                                          {Triangles(), "interpolating-loop"},
                                                          {Quads(), "interpolating-catmark"},
                                                          {Triangles(), "interpolating-catmark"},
                                                          {Quads(), "kobbelt"}}) {
        auto const outcome = Refine(mesh, {"--rule", rule, "--limit"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        auto const before = engine::ReadMesh(mesh).positions,
                   after = engine::ReadMesh(folder / "out.obj").positions;
        EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin())) << rule;
    }
}

TEST_F(CliRules, InterpolatingRulesServeInDifferentialSpace) {
    for (auto const& [mesh, rule] :
         std::vector<std::pair<std::string, std::string>>{{Triangles(), "butterfly-original"},
                                                          {Triangles(), "interpolating-loop"},
                                                          {Quads(), "interpolating-catmark"},
                                                          {Quads(), "kobbelt"}}) {
        auto const outcome = Refine(mesh, {"--rule", rule, "--space", "differential"});
        ASSERT_EQ(outcome.status, 0) << rule << outcome.err;
        EXPECT_TRUE(Report()["converged"]) << rule;
        EXPECT_NEAR(Report()["size_ratio"].get<double>(), 1.0, 0.2) << rule;
    }
}

// Without --tension it is the one in the help.
TEST_F(CliRules, TensionsHaveTheirDefaultsAndAct) {
    struct Row {
        std::string mesh, rule, standard, other;
    };
    for (Row const& row : {Row{Triangles(), "butterfly-original", "0.0625", "0.03"},
                           Row{Quads(), "kobbelt", "1", "1.5"}}) {
        ASSERT_EQ(Refine(row.mesh, {"--rule", row.rule}, "plain.obj").status, 0);
        for (std::string const& tension : {row.standard, row.other})
            ASSERT_EQ(Refine(row.mesh, {"--rule", row.rule, "--tension", tension}, tension + ".obj")
                          .status,
                      0);
        auto const plain = test::ReadText(folder / "plain.obj");
        EXPECT_EQ(plain, test::ReadText(folder / row.standard + ".obj"));
        EXPECT_NE(plain, test::ReadText(folder / row.other + ".obj"));
    }
}

TEST_F(CliRules, TensionsThatDoNotFitAreStatus2) {
    for (auto const& [words, says] : std::vector<std::pair<Words, std::string>>{
             {{"--tension", "0.05"}, "--tension: only --rule butterfly-original and kobbelt"},
             {{"--rule", "butterfly", "--tension", "0.05"}, "--tension: only --rule"},
             {{"--rule", "interpolating-loop", "--tension", "0"}, "--tension: only --rule"},
             {{"--rule", "butterfly-original", "--tension", "0.2"}, "0.2 is not from 0 to 0.125"},
             {{"--rule", "kobbelt", "--tension", "2.5"}, "--tension"},
             {{"--rule", "kobbelt", "--tension", "nan"}, "--tension"},
             {{"--rule", "kobbelt", "--scheme", "loop"},
              "--rule kobbelt contradicts --scheme loop"},
             {{"--curve", "--rule", "kobbelt", "--tension", "1"},
              "--tension means nothing with --curve"}}) {
        ExpectError(Refine(Triangles(), words), 2, says);
        EXPECT_FALSE(std::filesystem::exists(folder / "out.obj"));
    }
}

TEST_F(CliRules, FacesThatDoNotFitAreStatus3) {
    ExpectError(Refine(Triangles(), {"--rule", "kobbelt"}), 3,
                "has 3 corners; --rule kobbelt takes quads only; make them by one level of --rule "
                "catmark first");
    for (char const* rule : {"butterfly-original", "interpolating-loop"})
        ExpectError(Refine(Quads(), {"--rule", rule}), 3, "takes triangles only");
}

// Side by side, the one listed clockwise, the other counter-clockwise.
TEST_F(CliRules, EdgesThatDoNotFitAreNamedByTheirVertices) {
    std::string const mesh = folder.Write("against.obj",
                                          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
                                          "f 1 2 3 4\nf 2 3 6 5\n");
    ExpectError(Refine(mesh, {"--rule", "kobbelt"}), 3,
                "the edge from vertex 1 to 2 joins faces wound in opposite directions");
}

TEST_F(CliRules, RoughVerticesAreNamed) {
    // A pole of valence 8, and others of valence 4; the tetrahedron's valences are 3.
    for (char const* space : {"spatial", "differential"}) {
        Words const inSpace{"--space", space};
        auto const pole =
            Refine(Shape("loop_pole8"), inSpace + Words{"--rule", "butterfly-original"});
        EXPECT_EQ(pole.status, 0) << pole.err;
        EXPECT_TRUE(Contains(pole.err, "is not smooth at valence 3 and from 8 on: vert"))
            << pole.err;
        auto const tetrahedron =
            Refine(Shape("loop_tetrahedron"), inSpace + Words{"--rule", "interpolating-loop"});
        EXPECT_TRUE(Contains(tetrahedron.err, "at valence 3: vertices 0, 1, 2, 3;"))
            << tetrahedron.err;
        auto const quiet =
            Refine(Shape("loop_icosahedron"), inSpace + Words{"--rule", "butterfly-original"});
        EXPECT_FALSE(Contains(quiet.err, "is not smooth")) << quiet.err;
    }
}

// The rule of boundaries is that of curves.
TEST_F(CliRules, CurvesOfInterpolatingRulesHaveFourPoints) {
    std::string const square =
        folder.Write("square.obj", "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nl 1 2 3 4 1\n");
    ASSERT_EQ(Refine(square, {"--curve", "--rule", "butterfly"}, "butterfly.obj").status, 0);
    auto const expected = test::ReadText(folder / "butterfly.obj");
    for (char const* rule :
         {"butterfly-original", "kobbelt", "interpolating-loop", "interpolating-catmark"}) {
        ASSERT_EQ(Refine(square, {"--curve", "--rule", rule}).status, 0);
        EXPECT_EQ(test::ReadText(folder / "out.obj"), expected) << rule;
    }
}

}  // namespace
}  // namespace limn
