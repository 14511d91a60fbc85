// SPDX-License-Identifier: Apache-2.0
//
// Bakes of what limn smooth makes.

#include <algorithm>
#include <cmath>

#include "engine/images/exr_lookup.h"
#include "support/program/cli_smooth.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

class CliSmoothBake : public CliSmooth {
protected:
    engine::ExrLookup lookup;
};

// A mesh that only was refined has the same limit: no displacement, on quads and polygons as on
// triangles.
TEST_F(CliSmoothBake, ARefinedMeshIsNotDisplaced) {
    struct Case {
        std::string mesh;
        Words scheme;
    };
    for (auto const& [mesh, scheme] :
         {Case{spot, {}}, Case{WriteCube(), {}}, Case{spot, {"--scheme", "bilinear"}}}) {
        ASSERT_EQ(Limn(Words{"refine", mesh, "-o", folder / "fine.obj", "--levels", "2",
                             "--precision", "double"} +
                       scheme)
                      .status,
                  0);
        ASSERT_EQ(
            Limn(Words{"bake", mesh, "-o", folder / "d.exr", "--maps", "displacement", "--against",
                       folder / "fine.obj", "--size", "128", "--report", folder / "r.json"} +
                 scheme)
                .status,
            0);
        EXPECT_GT(Report()["texels_covered"], 1000);
        EXPECT_GT(Report()["outputs"][0]["min"], -1e-6);
        EXPECT_LT(Report()["outputs"][0]["max"], 1e-6);
    }
    ASSERT_EQ(
        Limn({"refine", spot, "-o", folder / "other.obj", "--levels", "1", "--scheme", "bilinear"})
            .status,
        0);
    std::string text = test::ReadText(folder / "other.obj");
    text.replace(text.rfind("\nf "), std::string::npos, "\n");
    ExpectError(Limn({"bake", spot, "-o", folder / "d.exr", "--maps", "displacement", "--against",
                      folder.Write("other.obj", text), "--size", "64"}),
                3, "its faces differ");
}

// The displacement towards the smoothed surface is what leads from the original limit to the
// smoothed mesh' limit: both baked as positions on their own.
TEST_F(CliSmoothBake, DisplacementLeadsToTheSmoothedSurface) {
    Smooth(spot, {"--levels", "2", "--width-factor", "0.3"}, "smooth.ply");
    for (auto const& [mesh, output] :
         {std::pair{spot, "a.exr"}, {folder / "smooth.ply", "b.exr"}}) {
        ASSERT_EQ(Limn({"bake", mesh, "-o", folder / output, "--maps", "position", "--size", "256",
                        "--coverage"})
                      .status,
                  0);
    }
    ASSERT_EQ(Limn({"bake", spot, "-o", folder / "d.exr", "--maps", "displacement", "--vector",
                    "--against", folder / "smooth.ply", "--size", "256"})
                  .status,
              0);
    int count = 0, numOther = 0;
    double largest = 0.0;
    for (int y = 0; y < 256; y += 3) {
        for (int x = 0; x < 256; x += 3) {
            auto const look = [&](char const* file, std::vector<std::string> const& channels) {
                return lookup.Look(folder / file, channels, x, y);
            };
            if (look("a.exr", {"coverage"})[0] < 1.0 || look("b.exr", {"coverage"})[0] < 1.0)
                continue;
            auto const a = look("a.exr", {"R", "G", "B"}), b = look("b.exr", {"R", "G", "B"}),
                       d = look("d.exr", {"R", "G", "B"});
            double difference = 0.0, length = 0.0;
            for (size_t c = 0; c < 3; ++c) {
                difference = test::Worse(difference, std::abs(b[c] - a[c] - d[c]));
                length = test::Worse(length, std::abs(d[c]));
            }
            ++count;
            largest = std::max(largest, length);
            // The same texture coordinates: refined by the same rule. Where charts overlap, either
            // may be seen.
            numOther += difference > 1e-4;
        }
    }
    EXPECT_GT(count, 2000);
    EXPECT_LT(numOther, count / 50);
    EXPECT_GT(largest, 0.02);
}

// Curvature motion's law on a bake of the result: a (k1 + k2) n leads back to the start surface, up
// to the constant that keeps the volume. On the side z = 1 of a cube, so that (1 - z) / n_z + c = 2
// a mean. And the width is baked as it was asked for.
TEST_F(CliSmoothBake, MeanCurvatureAndWidthOfTheResult) {
    std::string const cube = WriteCube();
    Smooth(cube, {"--levels", "6", "--width", "0.5", "--preserve-volume"}, "round.ply");
    ASSERT_EQ(Limn({"bake", folder / "round.ply", "-o", folder / "{map}.exr", "--maps",
                    "mean,position,normal,primvar:width", "--size", "384x64", "--report",
                    folder / "r.json"})
                  .status,
              0);
    json const report = Report();
    json const& width = report["outputs"].back();
    ASSERT_EQ(width["map"], "primvar:width");
    EXPECT_NEAR(width["min"].get<double>(), 0.5, 1e-6);
    EXPECT_NEAR(width["max"].get<double>(), 0.5, 1e-6);
    double const a = 0.5 * 0.5 / 2;
    auto const look = [&](char const* file, char const* channel, double x) {
        return lookup.Look(folder / file, {channel}, x, 31.5)[0];
    };
    auto const wayBack = [&](double x) {
        return (1.0 - look("position.exr", "B", x)) / look("normal.exr", "B", x);
    };
    double const middle = 95.5;  // of the second side
    for (double aside : {4.0, 8.0, 12.0, 16.0}) {
        double const curved =
            2 * a * (look("mean.exr", "Y", middle + aside) - look("mean.exr", "Y", middle));
        EXPECT_NEAR(curved, wayBack(middle + aside) - wayBack(middle), 0.05 * curved) << aside;
        EXPECT_GT(curved, 0.001);
    }
}

}  // namespace
}  // namespace limn
