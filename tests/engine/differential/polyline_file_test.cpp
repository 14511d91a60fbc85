// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/polyline_file.h"

#include <algorithm>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/files.h"

namespace limn {
namespace {

/// Ten points at x = 1 to 10, as vertices of the same number.
std::string MakePoints() {
    std::string text;
    for (int i = 1; i <= 10; ++i) text += fmt::format("v {} 0 0\n", i);
    return text;
}

class Polylines : public testing::Test {
protected:
    std::vector<eval::Curve> Read(std::string const& lines) const {
        return engine::ReadPolylines(folder.Write("a.obj", MakePoints() + lines)).curves;
    }
    /// Each curve as the numbers of its points; a closed one ends with a "+".
    std::vector<std::string> Describe(std::string const& lines) const {
        std::vector<std::string> curves;
        for (eval::Curve const& curve : Read(lines)) {
            std::string text;
            for (auto const& point : curve.points)
                text += fmt::format("{}{}", text.empty() ? "" : " ", point[0]);
            curves.push_back(text + (curve.isClosed ? "+" : ""));
        }
        return curves;
    }
    std::string Refuse(std::string const& lines) const {
        return test::RefusalOf([&] { Read(lines); }).substr((folder / "a.obj").size());
    }

    using Texts = std::vector<std::string>;
    test::TemporaryFolder const folder;
};

TEST_F(Polylines, OneLineIsOneCurve) {
    EXPECT_EQ(Describe("l 1 2 3 1\nl 4/1 -1 # open\n"), (Texts{"1 2 3+", "4 10"}));
}

TEST_F(Polylines, LinesOfAnEdgeEachAreChained) {
    EXPECT_EQ(Describe("l 1 2\nl 2 3\nl 3 4\n"), (Texts{"1 2 3 4"}));
    EXPECT_EQ(Describe("l 3 4\nl 2 1\nl 3 2\n"), (Texts{"1 2 3 4"}));  // as the first goes
    EXPECT_EQ(Describe("l 1 2 3\nl 6 5\nl 5 4 3\n"), (Texts{"1 2 3 4 5 6"}));
}

TEST_F(Polylines, LoopsOfEdgesAreFound) {
    EXPECT_EQ(Describe("l 2 3\nl 1 2\nl 1 3\n"), (Texts{"2 3 1+"}));
    EXPECT_EQ(Describe("l 1 2\nl 5 6\nl 3 1\nl 7 6\nl 2 3\n"), (Texts{"1 2 3+", "5 6 7"}));
}

// However its edges are shuffled and turned, a chain is the same up to its direction, and a loop up
// to its start.
TEST_F(Polylines, TheOrderOfEdgesMakesNoOtherCurves) {
    std::mt19937 random(3);
    for (int round = 0; round < 20; ++round) {
        for (bool isLoop : {false, true}) {
            std::vector<std::string> edges;
            for (int i = 1; i < 10 + isLoop; ++i) {
                int const a = i, b = i % 10 + 1;
                edges.push_back(random() % 2 ? fmt::format("l {} {}\n", a, b)
                                             : fmt::format("l {} {}\n", b, a));
            }
            std::shuffle(edges.begin(), edges.end(), random);
            std::string lines;
            for (auto const& edge : edges) lines += edge;
            auto const curves = Read(lines);
            ASSERT_EQ(curves.size(), 1u);
            ASSERT_EQ(curves[0].points.size(), 10u);
            EXPECT_EQ(curves[0].isClosed, isLoop);
            for (size_t i = 0; i < 9u + isLoop; ++i) {
                double const step =
                    std::abs(curves[0].points[i][0] - curves[0].points[(i + 1) % 10][0]);
                EXPECT_TRUE(step == 1.0 || (isLoop && step == 9.0)) << step;
            }
        }
    }
}

TEST_F(Polylines, LinesMayPassThroughEachOther) {
    EXPECT_EQ(Describe("l 1 2 3\nl 4 2 5\n"), (Texts{"1 2 3", "4 2 5"}));
}

TEST_F(Polylines, WhatBranchesIsRefusedByItsVertex) {
    EXPECT_EQ(Refuse("l 1 2\nl 2 3\nl 2 4\n"),
              ":13: polylines branch at vertex 2 (the first 'v' is 1); at most two may end there, "
              "and none on another");
    EXPECT_NE(Refuse("l 1 2 3\nl 4 2\n").find(":12: polylines branch at vertex 2"),
              std::string::npos);
    EXPECT_NE(Refuse("l 4 2\nl 1 2 3\n").find(":12: polylines branch at vertex 2"),
              std::string::npos);
    EXPECT_NE(Refuse("l 1 2 3 1\nl 4 1\n").find(":12: polylines branch at vertex 1"),
              std::string::npos);
    EXPECT_NE(Refuse("l 1 2 3 1 4\n").find(":11: polylines branch at vertex 1"), std::string::npos);
}

TEST_F(Polylines, TooFewPointsAreRefused) {
    EXPECT_EQ(Refuse("l 1\n"), ":11: a polyline has 1 points; at least 2 are needed");
    EXPECT_EQ(Refuse("l 1 2 1\n"), ":11: a closed polyline has 2 points; at least 3 are needed");
    EXPECT_EQ(Refuse("l 1 2\nl 2 1\n"),
              ":11: a closed polyline has 2 points; at least 3 are needed");
    EXPECT_EQ(Refuse("l 1 1\n"), ":11: a closed polyline has 1 points; at least 3 are needed");
}

TEST_F(Polylines, OtherFilesAndIndicesAreRefused) {
    EXPECT_NE(Refuse("l 1 11\n").find(":11: a polyline's vertex index is '11'"), std::string::npos);
    EXPECT_NE(Refuse("").find("no polylines"), std::string::npos);
    std::string const usd = folder.Write("usd.obj", "#usda 1.0\n");
    EXPECT_EQ(test::RefusalOf([&] { engine::ReadPolylines(usd); }),
              usd + ": looks like USD: OBJ is needed");
}

TEST_F(Polylines, JoinedLinesAndAnyLineEndAreRead) {
    std::string const path = folder.Write("b.obj", "v 0 0 0\rv 1 0 0\rv 2 0 0\rl 1 \\\r2 3\r");
    auto const curves = engine::ReadPolylines(path).curves;
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_EQ(curves[0].points.size(), 3u);
}

TEST_F(Polylines, WhatIsReadIsWritten) {
    auto const curves = Read("v 0.1 0.2 0.3\nl 1 2 11 1\nl 4 5\nl 5 6\n");
    ASSERT_EQ(curves.size(), 2u);
    engine::WritePolylines(folder / "out.obj", curves, Precision::Double);
    auto const again = engine::ReadPolylines(folder / "out.obj").curves;
    ASSERT_EQ(again.size(), 2u);
    EXPECT_TRUE(again[0].isClosed);
    EXPECT_FALSE(again[1].isClosed);
    EXPECT_EQ(again[0].points[2][2], 0.3);
    EXPECT_EQ(again[1].points.size(), 3u);
}

TEST_F(Polylines, ManyEdgesTakeTimeInProportion) {
    constexpr int kCount = 300000;
    std::string text;
    for (int i = 0; i < kCount; ++i) text += "v 0 0 0\n";
    for (int i = kCount - 1; i >= 1; --i) text += fmt::format("l {} {}\n", i, i + 1);
    auto const curves = engine::ReadPolylines(folder.Write("many.obj", text)).curves;
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_EQ(curves[0].points.size(), static_cast<size_t>(kCount));
}

}  // namespace
}  // namespace limn
