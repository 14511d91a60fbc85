// SPDX-License-Identifier: Apache-2.0
//
// limn eval from outside.

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

class Eval : public Cli {
protected:
    Outcome At(std::string const& mesh, std::string const& rows, Words const& more = {}) const {
        return Limn(Words{"eval", mesh, "--at", folder.Write("p.csv", "face,s,t\n" + rows)} + more);
    }
};

std::vector<std::string> Fields(std::string const& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
}

TEST_F(Eval, RowsComeInInputOrderWithTheSpecifiedColumns) {
    Outcome const outcome = At(Shape("catmark_cube"), "5,0.25,0.5\n0,0.5,0.5\n5,0.75,0.125\n");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    auto const lines = Lines(outcome.out);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0], "face,s,t,px,py,pz,nx,ny,nz,mean,gaussian,k1,k2,d1x,d1y,d1z");
    EXPECT_TRUE(lines[1].starts_with("5,0.25,0.5,"));
    EXPECT_TRUE(lines[2].starts_with("0,0.5,0.5,"));
    EXPECT_TRUE(lines[3].starts_with("5,0.75,0.125,"));
    for (size_t i = 1; i < 4; ++i) EXPECT_EQ(Fields(lines[i]).size(), 16u);
}

TEST_F(Eval, FlatSheetIsFlat) {
    // The inner quad of a regular 3 x 3 sheet is the identity: x = 1 + s, y = 1 + t, no curvature.
    std::string text;
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) text += fmt::format("v {} {} 0\n", i, j);
    }
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i)
            text += fmt::format("f {} {} {} {}\n", 4 * j + i + 1, 4 * j + i + 2, 4 * j + i + 6,
                                4 * j + i + 5);
    }
    std::string const mesh = folder.Write("sheet.obj", text);
    std::vector<double> row;
    for (std::string const& field : Fields(Lines(At(mesh, "4,0.25,0.75\n").out).at(1)))
        row.push_back(std::stod(field));
    double const expected[] = {4, 0.25, 0.75, 1.25, 1.75, 0, 0, 0, 1,
                               0, 0,    0,    0,    1,    0, 0};  // a1 is the direction at umbilics
    for (size_t i = 0; i < 16; ++i) EXPECT_NEAR(row[i], expected[i], 1e-12) << i;
    row.clear();
    for (std::string const& field :
         Fields(Lines(At(mesh, "4,0.25,0.75\n", {"--orientation", "left"}).out).at(1)))
        row.push_back(std::stod(field));
    EXPECT_NEAR(row[8], -1.0, 1e-12);
}

TEST_F(Eval, DoublePrecisionWritesSeventeenDigits) {
    auto const digits = [](std::string const& field) {
        std::string const mantissa = field.substr(0, field.find('e'));
        return std::count_if(mantissa.begin(), mantissa.end(),
                             [](char c) { return c >= '1' && c <= '9'; });
    };
    std::string const row = "0,0.3,0.7\n";
    EXPECT_LE(digits(Fields(Lines(At(Shape("catmark_bishop"), row).out).at(1)).at(3)), 9);
    EXPECT_GT(
        digits(Fields(Lines(At(Shape("catmark_bishop"), row, {"--precision", "double"}).out).at(1))
                   .at(3)),
        9);
}

TEST_F(Eval, WritesTheSameToAFile) {
    std::string const rows = "0,0.5,0.5\n1,0.25,0.125\n";
    Outcome const outcome = At(Shape("catmark_cube"), rows, {"-o", folder / "out.csv"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(outcome.out.empty());
    EXPECT_EQ(test::ReadText(folder / "out.csv"), At(Shape("catmark_cube"), rows).out);
}

TEST_F(Eval, HoleGivesNanInItsRowAndACount) {
    // catmark_hole_test1: face 1 is a hole.
    Outcome const outcome = At(Shape("catmark_hole_test1"), "0,0.5,0.5\n1,0.5,0.5\n2,0.5,0.5\n",
                               {"--report", folder / "r.json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    auto const lines = Lines(outcome.out);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[2], "1,0.5,0.5,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan");
    EXPECT_FALSE(Contains(lines[1], "nan"));
    EXPECT_EQ(Report()["places_without_limit"], 1);
}

TEST_F(Eval, CornersOfAPolygonAreItsUnitTiles) {
    // A pentagon's five corners lie in the unit tiles (0,0) (1,0) (2,0) (0,1) (1,1), each [0,1/2]
    // squared.
    std::string const mesh =
        folder.Write("m.obj", "v 0 0 0\nv 2 0 0\nv 3 2 0\nv 1 3 0\nv -1 2 0\nf 1 2 3 4 5\n");
    EXPECT_EQ(At(mesh, "0,0,0\n0,1.25,0.5\n0,2.5,0\n0,0.25,1.25\n0,1.5,1.5\n").status, 0);
    for (std::string const row : {"0,0.6,0", "0,0,0.6", "0,3,0", "0,3.2,0.1", "0,2.1,1.1",
                                  "0,0.1,2.1", "0,-0.1,0", "0,1e300,0"}) {
        SCOPED_TRACE(row);
        ExpectError(At(mesh, row + "\n"), 3, "row 0");
    }
    ExpectError(At(mesh, "0,nan,0\n"), 3, ":2: 'nan' in column s is no number");
}

struct BadPlace {
    std::string name, shape, row;
    Words more;
};

void PrintTo(BadPlace const& place, std::ostream* out) {
    *out << place.name;
}

class EvalRefusal : public testing::TestWithParam<BadPlace> {};

TEST_P(EvalRefusal, NamesTheRowAndWritesNothing) {
    test::TemporaryFolder const folder;
    std::string const csv =
        folder.Write("p.csv", "face,s,t\n0,0.25,0.25\n0,0,1\n" + GetParam().row + "\n0,0,0\n");
    Words const words{"eval", Shape(GetParam().shape), "--at", csv, "-o", folder / "out.csv"};
    std::string const error = ExpectError(Limn(words + GetParam().more), 3, "p.csv");
    EXPECT_TRUE(Contains(error, "row 2 (line 4)") || Contains(error, "p.csv:4: ")) << error;
    EXPECT_EQ(folder.List(), (Words{"p.csv"}));
}

INSTANTIATE_TEST_SUITE_P(
    Of, EvalRefusal,
    testing::Values(
        BadPlace{"SAboveOne", "catmark_cube", "0,1.001,0.5", {}},
        BadPlace{"TBelowZero", "catmark_cube", "0,0.5,-0.001", {}},
        BadPlace{"Nan", "catmark_cube", "0,nan,0.5", {}},
        BadPlace{"Infinity", "catmark_cube", "0,0.5,inf", {}},
        BadPlace{"OutsideTheTriangle", "loop_icosahedron", "0,0.6,0.6", {"--scheme", "loop"}},
        BadPlace{"FaceTooLarge", "catmark_cube", "6,0.5,0.5", {}},
        BadPlace{"FaceNegative", "catmark_cube", "-1,0.5,0.5", {}},
        BadPlace{"FaceBeyond32Bits", "catmark_cube", "4294967296,0.5,0.5", {}},
        BadPlace{"FaceAWord", "catmark_cube", "top,0.5,0.5", {}},
        BadPlace{"MissingColumn", "catmark_cube", "0,0.5", {}},
        BadPlace{"NumberWithATail", "catmark_cube", "0,0.5x,0.5", {}}),
    [](testing::TestParamInfo<BadPlace> const& instance) { return instance.param.name; });

// Chaikin's creases of sharpness 4 and 1.5 meet at the vertex; by OpenSubdiv's uniform refinement,
// in double, it is at z = -0.0957291014 after 7 levels, whose limit rule then gives -0.0957259623.
TEST_F(Eval, FacesAtAVertexOfUnequalCreasesHaveOnePoint) {
    Outcome const outcome =
        At(test::DataPath("cases/chaikin_4_15.obj"), "9,1,0\n5,1,1\n6,0,1\n10,0,0\n");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    auto const lines = Lines(outcome.out);
    ASSERT_EQ(lines.size(), 5u);
    for (size_t i = 1; i < lines.size(); ++i)
        EXPECT_NEAR(std::stod(Fields(lines[i])[5]), -0.0957259623, 1e-10) << lines[i];
}

TEST_F(Eval, EmptyLinesDoNotShiftTheLineThatIsNamed) {
    ExpectError(At(Shape("catmark_cube"), "0,0.5,0.5\n\n0,9,9\n"), 3, "line 4");
}

TEST_F(Eval, ColumnsGoByNameAndFurtherOnesAreIgnored) {
    std::string const csv = folder.Write("q.csv", "t,note,face,s\r\n0.125,x,1,0.25\r\n");
    Outcome const outcome = Limn({"eval", Shape("catmark_cube"), "--at", csv});
    EXPECT_EQ(outcome.out, At(Shape("catmark_cube"), "1,0.25,0.125\n").out);
}

TEST_F(Eval, HeaderThatLacksAColumnIsRefused) {
    for (std::string const text : {"", "face,s\n0,0\n", "0,0.5,0.5\n"}) {
        ExpectError(Limn({"eval", Shape("catmark_cube"), "--at", folder.Write("q.csv", text)}), 3,
                    text.empty() ? "a header face,s,t is needed"
                                 : "q.csv:1: the header needs the columns face,s,t");
    }
}

TEST_F(Eval, FramesGoToFilesOfTheirOwn) {
    std::string const cube = Shape("catmark_cube"),
                      csv = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n5,0.1,0.2\n");
    for (char const* name : {"cube.9.obj", "cube.10.obj"}) folder.Write(name, test::ReadText(cube));
    Words const words{"eval",     cube,
                      "--at",     csv,
                      "--frames", folder / "cube.{frame}.obj",
                      "-o",       folder / "{frame}.csv"};
    std::string const alone = Limn({"eval", cube, "--at", csv}).out;
    for (Words const& more : {Words{},
                              {"--evaluator", "simd"},
                              {"--evaluator", "osd-cpu"},
                              {"--evaluator", "osd-omp"}}) {
        Outcome const outcome = Limn(words + more, {.environment = {"OMP_NUM_THREADS=2"}});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(outcome.out, "");
        for (char const* name : {"9.csv", "10.csv"}) {
            auto const lines = Lines(test::ReadText(folder / name)), expected = Lines(alone);
            ASSERT_EQ(lines.size(), 3u);
            EXPECT_EQ(lines[0], expected[0]);
            for (int column : {3, 4, 5, 6, 7, 8}) {
                EXPECT_NEAR(std::stod(Fields(lines[2])[column]),
                            std::stod(Fields(expected[2])[column]), 1e-6);
            }
        }
    }
    ASSERT_EQ(Limn(words + Words{"--report", folder / "r.json"}).status, 0);
    json const report = Report();
    EXPECT_EQ(report["frames"], 2);
    EXPECT_EQ(report["places"], 2);
    EXPECT_EQ(report["evaluator"], "double");
    EXPECT_EQ(report["outputs"][0], folder / "9.csv");
}

TEST_F(Eval, FramesThatCannotBeAreRefused) {
    std::string const cube = Shape("catmark_cube"),
                      csv = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
    auto const run = [&](std::string const& frames, std::string const& output) {
        return Limn(
            {"eval", cube, "--at", csv, "--frames", folder / frames, "-o", folder / output});
    };
    folder.Write("a.1.obj", test::ReadText(cube));
    ExpectError(run("a.{frame}.obj", "a.csv"), 2, "{frame} is missing");
    ExpectError(run("b.{frame}.obj", "{frame}.csv"), 5, "no frames found");
    folder.Write("a.2.obj", test::ReadText(Shape("catmark_pyramid")));
    ExpectError(run("a.{frame}.obj", "{frame}.csv"), 3, "a.2.obj");
    EXPECT_EQ(folder.List(), (Words{"a.1.obj", "a.2.obj", "p.csv"}));
}

TEST_F(Eval, AnEvaluatorIsNearTheDoublesAndCountsItsTable) {
    std::string const rows = "0,0.5,0.5\n3,0.25,0.75\n5,0.1,0.2\n";
    auto const expected = Lines(At(Shape("catmark_bishop"), rows).out);
    for (char const* kind : {"simd", "osd-cpu", "osd-omp"}) {
        Outcome const outcome =
            At(Shape("catmark_bishop"), rows, {"--evaluator", kind, "--report", folder / "r.json"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        auto const lines = Lines(outcome.out);
        ASSERT_EQ(lines.size(), expected.size());
        for (size_t row = 1; row < lines.size(); ++row) {
            for (int column = 3; column < 9; ++column) {
                EXPECT_NEAR(std::stod(Fields(lines[row])[column]),
                            std::stod(Fields(expected[row])[column]), 2e-5);
            }
        }
        json const report = Report()["evaluator"];
        EXPECT_EQ(report["name"], kind);
        ASSERT_EQ(report["tables"].size(), 1u);
        EXPECT_EQ(report["tables"][0]["what"], "places");
        EXPECT_EQ(report["tables"][0]["rows"], 3);
        EXPECT_EQ(report["tables"][0]["applications"], 1);
    }
}

TEST_F(Eval, OpenSubdivsLimitIsWrittenAndComparedWithTheExactOne) {
    std::string const rows = "0,0.5,0.5\n0,0,0\n";
    Outcome const far = At(Shape("catmark_cube"), rows,
                           {"--limit-stencils", "far", "--far-level", "3", "--far-end-cap",
                            "bspline", "--evaluator", "simd", "--report", folder / "r.json"});
    ASSERT_EQ(far.status, 0) << far.err;
    json const report = Report()["far"];
    EXPECT_EQ(report["level"], 3);
    EXPECT_EQ(report["end_cap"], "bspline");
    EXPECT_EQ(report["inf_sharp"], false);
    EXPECT_EQ(report["places"], 2);
    EXPECT_GT(report["table_bytes"], 0);
    EXPECT_LT(report["position"]["max"], 1e-3);
    for (char const* key : {"face", "s", "t"})
        EXPECT_TRUE(report["mean_curvature"].contains(key)) << key;
    Outcome const exact = At(Shape("catmark_cube"), rows);
    double const farX = std::stod(Fields(Lines(far.out).at(1)).at(3));
    double const x = std::stod(Fields(Lines(exact.out).at(1)).at(3));
    EXPECT_NEAR(farX, x, 2e-3);
    EXPECT_NE(far.out, exact.out);
}

TEST_F(Eval, FlagsOfOpenSubdivsLimitNeedIt) {
    ExpectError(At(Shape("catmark_cube"), "0,0,0\n", {"--far-level", "3"}), 2,
                "--far-level needs --limit-stencils far");
    ExpectError(At(Shape("catmark_cube"), "0,0,0\n",
                   {"--limit-stencils", "far", "--frames", "x.{frame}.obj", "-o", "y.{frame}.csv"}),
                2, "--limit-stencils and --frames");
}

}  // namespace
}  // namespace limn
