// SPDX-License-Identifier: Apache-2.0
//
// limn field --streamlines, from outside.

#include <map>

#include <Eigen/Core>
#include <fmt/format.h>

#include "engine/io/number_table.h"
#include "support/pictures.h"
#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

std::vector<std::string> const kColumns{"line", "face", "s", "t", "x", "y", "z", "length"};

class CliStreamlines : public Cli {
protected:
    std::string spot = test::ScenePath("spot/spot.obj"),
                cube = test::DataPath("golden_surface/cube.obj");

    /// A source and a sink on spot, and further words.
    Outcome Field(Words const& more) const {
        return Limn(Words{"field", spot, "-o", folder / "f.edges.csv", "--source", "0", "--sink",
                          "100", "--report", folder / "r.json"} +
                    more);
    }

    std::string WriteSeeds(std::string const& rows) const {
        return folder.Write("seeds.csv", "face,s,t\n" + rows);
    }
};

// The lines' places, evaluated: two roads to their points.
TEST_F(CliStreamlines, PlacesOfTheTableAreItsPoints) {
    ASSERT_EQ(Field({"--streamlines", folder / "l.csv", "--separation", "0.15"}).status, 0);
    auto const table = engine::ReadNumberTable(folder / "l.csv", {kColumns});
    ASSERT_GT(table.GetNumRows(), 100u);
    ASSERT_EQ(Limn({"eval", spot, "--at", folder / "l.csv", "-o", folder / "p.csv"}).status, 0);
    auto const points = engine::ReadNumberTable(folder / "p.csv", {{"px", "py", "pz"}});
    ASSERT_EQ(points.GetNumRows(), table.GetNumRows());
    std::map<int, double> lengths;
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(points.Get(row, c), table.Get(row, 4 + c), 1e-8);
        lengths[static_cast<int>(table.Get(row, 0))] = table.Get(row, 7);
    }
    json const report = Report()["streamlines"];
    EXPECT_EQ(report["lines"], lengths.size());
    double total = 0.0;
    for (auto const& [line, length] : lengths) {
        EXPECT_GE(length, 0.15);
        total += length;
    }
    EXPECT_NEAR(report["total_length"].get<double>(), total, 1e-6 * total);
    EXPECT_LT(report["farthest"].get<double>(), 0.3);
    json const& stopped = report["stopped"];
    EXPECT_EQ(stopped["boundary"], 0);  // spot is closed
    EXPECT_GT(stopped["near"].get<int>() + stopped["singular"].get<int>(), 0);
}

TEST_F(CliStreamlines, LineElementsAreTheSameLines) {
    ASSERT_EQ(Field({"--streamlines", folder / "l.csv", "--separation", "0.2"}).status, 0);
    ASSERT_EQ(Field({"--streamlines", folder / "l.obj", "--separation", "0.2"}).status, 0);
    size_t numPoints = 0, numLines = 0;
    for (std::string const& line : Lines(test::ReadText(folder / "l.obj"))) {
        numPoints += line.starts_with("v ");
        numLines += line.starts_with("l ");
    }
    EXPECT_EQ(Report()["streamlines"]["lines"], numLines);
    EXPECT_EQ(Report()["streamlines"]["points"], numPoints);
    auto const table = engine::ReadNumberTable(folder / "l.csv", {kColumns});
    EXPECT_EQ(table.GetNumRows(), numPoints + Report()["streamlines"]["closed"].get<size_t>());
}

TEST_F(CliStreamlines, EverySeedHasItsLine) {
    std::string const seeds = WriteSeeds("5,0.5,0.5\n90,0.25,0.75\n150,0,0\n");
    ASSERT_EQ(Field({"--streamlines", folder / "l.csv", "--seeds", seeds, "--max-length", "0.3",
                     "--direction", "forward"})
                  .status,
              0);
    auto const table = engine::ReadNumberTable(folder / "l.csv", {kColumns});
    EXPECT_EQ(table.Get(0, 1), 5.0);
    EXPECT_EQ(table.Get(0, 2), 0.5);
    EXPECT_EQ(table.Get(table.GetNumRows() - 1, 0), 2.0);
    for (size_t row = 0; row < table.GetNumRows(); ++row) EXPECT_LE(table.Get(row, 7), 0.3 + 1e-9);
    EXPECT_EQ(Report()["streamlines"]["lines"], 3);
    EXPECT_TRUE(Report()["streamlines"]["farthest"].is_null());
}

TEST_F(CliStreamlines, DoNotDependOnThreads) {
    for (std::string const threads : {"1", "4"}) {
        ASSERT_EQ(Field({"--streamlines", folder / ("l" + threads + ".obj"), "--separation", "0.1",
                         "--threads", threads})
                      .status,
                  0);
    }
    EXPECT_EQ(test::ReadText(folder / "l1.obj"), test::ReadText(folder / "l4.obj"));
}

TEST_F(CliStreamlines, ArePictured) {
    ASSERT_EQ(Field({"--streamlines", folder / "l.obj", "--separation", "0.1", "--levels", "2",
                     "--picture", folder / "l.png"})
                  .status,
              0);
    auto const picture = test::ReadPng(folder / "l.png");
    int numBlack = 0;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) numBlack += picture.At(x, y)[0] == 0;
    }
    EXPECT_GT(numBlack, 2000);
}

TEST_F(CliStreamlines, WhatCannotBeIsRefused) {
    auto const expect = [&](Words const& words, int status, std::string const& part) {
        ExpectError(Field(words), status, part);
    };
    expect({"--separation", "0.1"}, 2, "--separation needs --streamlines");
    expect({"--streamlines", folder / "l.obj"}, 2, "--separation or --seeds");
    expect({"--streamlines", folder / "l.txt", "--separation", "0.1"}, 2, ".obj or .csv");
    expect({"--streamlines", folder / "l.obj", "--separation", "0"}, 2, "--separation is 0");
    expect({"--streamlines", folder / "l.obj", "--separation", "0.1", "--step", "0.05"}, 2,
           "--step");
    expect({"--streamlines", folder / "l.obj", "--separation", "100"}, 2,
           "--separation is 100; no two lines are that far apart");
    expect({"--streamlines", folder / "l.obj", "--separation", "nan"}, 2, "--separation");
    expect({"--streamlines", folder / "l.obj", "--seeds", WriteSeeds("0,0.5,2\n")}, 3, "line 2");
    expect({"--streamlines", folder / "l.obj", "--seeds", WriteSeeds("99999,0,0\n")}, 3, "99999");
    expect({"--streamlines", folder / "l.obj", "--seeds", folder.Write("empty.csv", "")}, 3,
           "empty");
    expect({"--streamlines", folder / "l.obj", "--seeds", folder / "missing.csv"}, 5, "missing");
}

}  // namespace
}  // namespace limn
