// SPDX-License-Identifier: Apache-2.0
//
// limn field --match-texture: fields back from baked maps.

#include <cmath>
#include <limits>
#include <sstream>

#include <fmt/format.h>

#include "engine/io/number_table.h"
#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

class CliFieldTexture : public Cli {
protected:
    std::string spot = test::ScenePath("spot/spot.obj");

    Outcome Field(std::string const& mesh, std::string const& output, Words const& more) const {
        return Limn(Words{"field", mesh, "-o", folder / output, "--report", folder / "r.json"} +
                    more);
    }

    /// Sources, sinks and vortices on a mesh as spot, in given.edges.csv.
    void Design(std::string const& mesh) const {
        ASSERT_EQ(
            Field(mesh, "given.edges.csv",
                  {"--source", "0", "--sink", "100", "--vortex", "40:2", "--vortex", "150:-2"})
                .status,
            0);
    }

    void BakeField(std::string const& mesh, std::string const& pattern, Words const& more) const {
        ASSERT_EQ(Limn(Words{"bake", mesh, "-o", folder / pattern, "--maps", "field", "--field",
                             folder / "given.edges.csv"} +
                       more)
                      .status,
                  0);
    }

    std::vector<double> ReadEdges(std::string const& name) const {
        auto const table = engine::ReadNumberTable(folder / name, {{"v0", "v1", "value"}});
        std::vector<double> values;
        for (size_t row = 0; row < table.GetNumRows(); ++row) values.push_back(table.Get(row, 2));
        return values;
    }

    /// Root mean square of what two files differ by, over that of the first.
    double FindRelativeError(std::string const& a, std::string const& b) const {
        auto const given = ReadEdges(a), found = ReadEdges(b);
        EXPECT_EQ(given.size(), found.size());
        double difference = 0.0, sum = 0.0;
        for (size_t i = 0; i < given.size(); ++i) {
            difference += std::pow(found[i] - given[i], 2);
            sum += std::pow(given[i], 2);
        }
        return std::sqrt(difference / sum);
    }

    /// Spot with its texture in another tile.
    std::string WriteSpotInTile(int column) const {
        std::istringstream lines(test::ReadText(spot));
        std::string text;
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            std::string key;
            double u = 0.0, v = 0.0;
            if (words >> key && key == "vt" && words >> u >> v)
                line = fmt::format("vt {} {}", u + column, v);
            text += line + "\n";
        }
        return folder.Write("moved.obj", text);
    }
};

// 96 x 96 texels are 16 a face and more.
TEST_F(CliFieldTexture, ABakedFieldComesBack) {
    Design(spot);
    for (std::string const space : {"object", "uv"}) {
        BakeField(spot, "flow.exr", {"--size", "96", "--space", space});
        auto const matched =
            Field(spot, "back.edges.csv",
                  {"--match-texture", folder / "flow.exr", "--match-space", space});
        ASSERT_EQ(matched.status, 0) << matched.err;
        EXPECT_LT(FindRelativeError("given.edges.csv", "back.edges.csv"), 1e-3) << space;
    }
}

TEST_F(CliFieldTexture, OneOfManyLayersInHalfComesBackNearly) {
    Design(spot);
    ASSERT_EQ(Limn({"bake", spot, "-o", folder / "flow.exr", "--maps", "normal,field", "--field",
                    folder / "given.edges.csv", "--size", "128", "--half"})
                  .status,
              0);
    ASSERT_EQ(Field(spot, "back.edges.csv", {"--match-texture", folder / "flow.exr"}).status, 0);
    EXPECT_LT(FindRelativeError("given.edges.csv", "back.edges.csv"), 1e-3);
}

TEST_F(CliFieldTexture, TilesAreReadByTheirNumbers) {
    std::string const mesh = WriteSpotInTile(1);
    Design(mesh);
    BakeField(mesh, "flow.<UDIM>.exr", {"--size", "96"});
    ASSERT_EQ(Field(mesh, "back.edges.csv", {"--match-texture", folder / "flow.<UDIM>.exr"}).status,
              0);
    EXPECT_LT(FindRelativeError("given.edges.csv", "back.edges.csv"), 1e-3);
    // Without a token it is tile 1001 that is read, where nothing of this mesh lies.
    ExpectError(Field(mesh, "x.edges.csv", {"--match-texture", folder / "flow.1002.exr"}), 3,
                "no texel of");
}

TEST_F(CliFieldTexture, FacesWithoutTexelsAreCounted) {
    Design(spot);
    BakeField(spot, "flow.exr", {"--size", "12"});
    auto const matched = Field(spot, "back.edges.csv", {"--match-texture", folder / "flow.exr"});
    EXPECT_EQ(matched.status, 0);
    EXPECT_TRUE(Contains(matched.err, "of 180 faces have no texel")) << matched.err;
}

TEST_F(CliFieldTexture, WhatCannotBeReadIsRefused) {
    std::string const bare = folder.Write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                      grey = folder.Write("grey.pgm", "P2 2 2 255\n0 0 0 0\n"),
                      colour = folder.Write("colour.ppm", "P3 1 1 255\n0 0 0\n");
    auto const match = [&](std::string const& mesh, Words const& more) {
        return Field(mesh, "x.edges.csv", more);
    };
    ExpectError(match(spot, {"--match-texture", folder / "none.exr"}), 5, "none.exr");
    ExpectError(match(spot, {"--match-texture", folder / "none.<UDIM>.exr"}), 5,
                "there is no image of a tile");
    ExpectError(match(spot, {"--match-texture", grey}), 5, "no channel R");
    ExpectError(match(bare, {"--match-texture", colour}), 3, "no texture coordinates");
    ExpectError(match(spot, {"--match-space", "uv", "--source", "0", "--sink", "1"}), 2,
                "--match-texture");
    ExpectError(match(spot, {"--match-texture", colour, "--match", folder.Write("v.csv", "")}), 2,
                "exclude each other");
}

TEST_F(CliFieldTexture, NoNumberOnTheSurfaceIsRefusedByItsPixel) {
    std::vector<float> const pixels(3, std::numeric_limits<float>::quiet_NaN());
    std::string bytes = "PF\n1 1\n-1.0\n";
    bytes.append(reinterpret_cast<char const*>(pixels.data()), pixels.size() * sizeof(float));
    std::string const quad =
        folder.Write("quad.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                     "vt 0 1\nf 1/1 2/2 3/3 4/4\n");
    ExpectError(Field(quad, "x.edges.csv", {"--match-texture", folder.Write("nan.pfm", bytes)}), 3,
                "pixel 0,0 is nan");
}

}  // namespace
}  // namespace limn
