// SPDX-License-Identifier: Apache-2.0
//
// Matrices that verbs write beside their results.

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "support/program/cli.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

struct Matrix {
    struct Entry {
        size_t row, column;
        double value;
    };
    size_t numRows = 0, numColumns = 0;
    std::vector<Entry> entries;

    std::vector<double> Apply(std::vector<double> const& x) const {
        std::vector<double> y(numRows, 0.0);
        for (auto const& [row, column, value] : entries) y[row] += value * x.at(column);
        return y;
    }
};

Matrix ReadMatrix(std::string const& path) {
    std::istringstream text(test::ReadText(path));
    std::string line;
    std::getline(text, line);
    std::getline(text, line);
    Matrix matrix;
    size_t count = 0;
    text >> matrix.numRows >> matrix.numColumns >> count;
    matrix.entries.resize(count);
    for (auto& [row, column, value] : matrix.entries) {
        text >> row >> column >> value;
        --row;
        --column;
    }
    EXPECT_TRUE(text) << path;
    return matrix;
}

/// One coordinate of an OBJ's vertices.
std::vector<double> ReadCoordinate(std::string const& path, int which) {
    std::vector<double> values;
    for (std::string const& line : Lines(test::ReadText(path))) {
        if (!line.starts_with("v ")) continue;
        std::istringstream fields(line.substr(2));
        double value = 0.0;
        for (int i = 0; i <= which; ++i) fields >> value;
        values.push_back(value);
    }
    return values;
}

/// The last column of a table.
std::vector<double> ReadLastColumn(std::string const& path) {
    std::vector<double> values;
    for (std::string const& line : Lines(test::ReadText(path))) {
        if (line.find_first_of("0123456789") == 0)
            values.push_back(std::stod(line.substr(line.rfind(',') + 1)));
    }
    return values;
}

class Matrices : public Cli {};

TEST_F(Matrices, ATakesTheFittedMeshToTheOneThatWasGiven) {
    std::string const mesh = test::ScenePath("spot/spot.obj");
    for (Words const& more : {Words{}, Words{"--alpha", "0.5", "--keep-topology"}}) {
        Words const words{"fit",   mesh,          "-o",     folder / "a.obj", "--tolerance",
                          "1e-10", "--precision", "double", "--write-matrix", folder / "A.mtx"};
        ASSERT_EQ(Limn(words + more).status, 0);
        Matrix const A = ReadMatrix(folder / "A.mtx");
        for (double sum : A.Apply(std::vector<double>(A.numColumns, 1.0)))
            EXPECT_NEAR(sum, 1.0, 1e-13);
        for (int i = 0; i < 3; ++i) {
            auto const limits = A.Apply(ReadCoordinate(folder / "a.obj", i));
            auto const wanted = ReadCoordinate(mesh, i);
            ASSERT_EQ(limits.size(), wanted.size());
            for (size_t v = 0; v < wanted.size(); ++v) EXPECT_NEAR(limits[v], wanted[v], 1e-9);
        }
    }
}

TEST_F(Matrices, S1TakesAFieldToTheRefinedOneAndS2KeepsIntegrals) {
    std::string const mesh = test::ScenePath("spot/spot.obj");
    auto const design = [&](std::string const& output, std::string const& levels,
                            Words const& more) {
        return Limn(Words{"field", mesh, "-o", folder / output, "--source", "0", "--sink", "100",
                          "--vortex", "7", "--vortex", "50:-1", "--levels", levels} +
                    more);
    };
    ASSERT_EQ(design("x.edges.csv", "0", {}).status, 0);
    Words const written{"--write-stencils", folder / "S1.mtx," + folder / "S2.mtx"};
    ASSERT_EQ(design("y.edges.csv", "2", written).status, 0);
    Matrix const s1 = ReadMatrix(folder / "S1.mtx"), s2 = ReadMatrix(folder / "S2.mtx");
    auto const coarse = ReadLastColumn(folder / "x.edges.csv");
    auto const fine = ReadLastColumn(folder / "y.edges.csv");
    ASSERT_EQ(s1.numColumns, coarse.size());
    ASSERT_EQ(s1.numRows, fine.size());
    auto const refined = s1.Apply(coarse);
    for (size_t edge = 0; edge < fine.size(); ++edge) EXPECT_NEAR(refined[edge], fine[edge], 1e-13);
    std::vector<double> sums(s2.numColumns, 0.0);
    for (auto const& entry : s2.entries) sums[entry.column] += entry.value;
    for (double sum : sums) EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_EQ(Lines(test::ReadText(folder / "S1.edges0.csv")).size(), coarse.size() + 1);
    EXPECT_EQ(Lines(test::ReadText(folder / "S1.edges2.csv")).size(), fine.size() + 1);
}

// Of a mesh as it is, which is its own start: after n sweeps, X = J (J (... X0 + load X0)) ...
TEST_F(Matrices, ASweepsPairSmoothsTheMeshThatWasGiven) {
    std::string const mesh = test::ScenePath("window_frame/window_frame.obj");
    Words const words{"smooth",    mesh,       "-o",          folder / "a.obj", "--levels",
                      "0",         "--solver", "jacobi",      "--iterations",   "3",
                      "--width",   "0.1",      "--precision", "double",         "--write-stencils",
                      folder / "m"};
    ASSERT_EQ(Limn(words).status, 0);
    Matrix const sweep = ReadMatrix(folder / "m.0.sweep.mtx"),
                 load = ReadMatrix(folder / "m.0.load.mtx");
    for (int axis = 0; axis < 3; ++axis) {
        auto const start = ReadCoordinate(mesh, axis),
                   expected = ReadCoordinate(folder / "a.obj", axis);
        auto const ofStart = load.Apply(start);
        auto points = start;
        for (int i = 0; i < 3; ++i) {
            points = sweep.Apply(points);
            for (size_t k = 0; k < points.size(); ++k) points[k] += ofStart[k];
        }
        EXPECT_LT(test::LargestDifference(points, expected), 1e-12);
        EXPECT_GT(test::LargestDifference(start, expected), 1e-3);
    }
}

TEST_F(Matrices, OfSweepsAreWrittenForEveryLevel) {
    ASSERT_EQ(Limn({"smooth", Shape("catmark_cube"), "-o", folder / "a.obj", "--levels", "2",
                    "--solver", "jacobi", "--write-stencils", folder / "m"})
                  .status,
              0);
    EXPECT_EQ(ReadMatrix(folder / "m.1.sweep.mtx").numRows, 26u);
    EXPECT_EQ(ReadMatrix(folder / "m.2.load.mtx").numColumns, 98u);
    EXPECT_EQ(folder.List().size(), 5u);
}

TEST_F(Matrices, OfSweepsNeedJacobiAndASolveALevel) {
    Words const smooth{"smooth", Shape("catmark_cube"), "-o", folder / "a.obj"};
    Words const written{"--write-stencils", folder / "m"};
    ExpectError(Limn(smooth + written), 2, "--write-stencils needs --solver jacobi");
    Words const jacobi = smooth + written + Words{"--solver", "jacobi"};
    ExpectError(Limn(jacobi + Words{"--steps", "2"}), 2, "--write-stencils and --steps");
    ExpectError(Limn(jacobi + Words{"--settle", "1e-3"}), 2, "--write-stencils and --settle");
    ExpectError(Limn(smooth + Words{"--solver", "jacobi", "--write-stencils", folder / ""}), 2,
                "--write-stencils");
    ExpectError(Limn(smooth + Words{"--evaluator", "simd"}), 2,
                "--evaluator needs --solver jacobi");
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(Matrices, AreRefusedUnderAnotherEndingAndWhereThereIsNothingToWrite) {
    std::string const mesh = Shape("catmark_cube");
    ExpectError(Limn({"fit", mesh, "-o", folder / "a.obj", "--write-matrix", folder / "A.csv"}), 2,
                "a matrix is written as .mtx");
    Words const field{"field", mesh, "-o", folder / "a.obj", "--vortex", "0", "--vortex", "1:-1"};
    ExpectError(Limn(field + Words{"--write-stencils", "a.mtx,b.mtx"}), 2, "--levels 0");
    ExpectError(Limn(field + Words{"--levels", "1", "--write-stencils",
                                   folder / "s.mtx," + folder / "s.mtx"}),
                2, "--write-stencils");
    EXPECT_TRUE(folder.List().empty());
}

}  // namespace
}  // namespace limn
