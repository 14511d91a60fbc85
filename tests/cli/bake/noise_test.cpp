// SPDX-License-Identifier: Apache-2.0
//
// Noise without textures: at a mesh's vertices, at places, and the same in a bake.

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <fmt/format.h>

#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "support/exr_level.h"
#include "support/program/cli.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

using Table = std::map<std::string, std::vector<double>>;

/// Columns of a CSV by their names.
Table ReadTable(std::string const& text) {
    Table table;
    auto const lines = Lines(text);
    std::vector<std::string> names;
    std::istringstream head(lines.at(0));
    for (std::string name; std::getline(head, name, ',');) names.push_back(name);
    for (size_t i = 1; i < lines.size(); ++i) {
        std::istringstream row(lines[i]);
        std::string field;
        for (std::string const& name : names) {
            std::getline(row, field, ',');
            table[name].push_back(std::stod(field));
        }
    }
    return table;
}

constexpr int kFaces = 4;  // of the grid's side

class CliNoise : public Cli {
protected:
    std::string const mesh = WriteGrid(), cube = test::DataPath("golden_surface/cube.obj"),
                      field = WriteField();

    /// A bent grid of quads whose texture coordinates are its own: u = (i + s)/n, v = (j + t)/n in
    /// face n i + j. Its positions are its colours, too.
    std::string WriteGrid() const {
        std::vector<double> positions, uvs;
        std::vector<std::vector<Index>> faces;
        for (int i = 0; i <= kFaces; ++i) {
            for (int j = 0; j <= kFaces; ++j) {
                double const u = i / double{kFaces}, v = j / double{kFaces};
                positions.insert(positions.end(), {u, v, 0.3 * u * v + 0.2 * u * u});
                uvs.insert(uvs.end(), {u, v});
                if (i == kFaces || j == kFaces) continue;
                Index const corner = (kFaces + 1) * i + j;
                faces.push_back({corner, corner + kFaces + 1, corner + kFaces + 2, corner + 1});
            }
        }
        engine::Scene grid = test::MakeScene(positions, faces);
        grid.uvs = uvs;
        grid.AddUVChannel(grid.cage.faceVertices, {});
        grid.primvars = {{"color", 3, {positions.begin(), positions.end()}},
                         {"height", 1, std::vector<float>(positions.size() / 3)}};
        for (size_t i = 0; i < positions.size(); i += 3)
            grid.primvars[1].values[i / 3] = static_cast<float>(positions[i + 2]);
        engine::WriteMesh(folder / "grid.ply", grid, Precision::Double);
        return folder / "grid.ply";
    }

    std::string WriteField() const {
        std::string const text = "v0,v1,value\n0,1,1\n1,2,1\n5,6,0.5\n6,7,-1\n";
        return folder.Write("f.csv", text);
    }

    Table Eval(std::string const& places, Words const& more) const {
        Outcome const outcome =
            Limn(Words{"eval", mesh, "--at", folder.Write("p.csv", places), "--precision", "double",
                       "--quiet", "--report", folder / "r.json"} +
                 more + Words{"-o", folder / "e.csv"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return ReadTable(test::ReadText(folder / "e.csv"));
    }

    engine::Primvar Refine(Words const& more) const {
        Outcome const outcome =
            Limn(Words{"refine", mesh, "-o", folder / "n.ply", "--quiet", "--noise"} + more);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return engine::ReadMesh(folder / "n.ply").primvars.back();
    }
};

Words const kThreeOctaves{"--noise-octaves", "3", "--noise-seed", "5", "--noise-gain", "0.7"};

// Texel centres of a bake of 2 x 2 texels a face, and the vertices of the mesh refined twice, are
// places of faces with s and t known.
TEST_F(CliNoise, AtTheSamePlaceIsTheSameInABakeATableAndAMesh) {
    for (Words const& look : {Words{},
                              {"--normalize"},
                              {"--noise-ramp", "#ff0000,#00ff40,#0000ff"},
                              {"--noise-at", "vertex"}}) {
        SCOPED_TRACE(fmt::format("{}", look.empty() ? "" : look[0]));
        bool const isRamp = !look.empty() && look[0] == "--noise-ramp";
        std::vector<std::string> const columns =
            isRamp ? Words{"noise_r", "noise_g", "noise_b"} : Words{"noise"};
        int const size = 2 * kFaces;
        ASSERT_EQ(Bake(mesh, "x.exr",
                       Words{"--maps", "noise", "--fvar", "all", "--size", std::to_string(size)} +
                           kThreeOctaves + look)
                      .status,
                  0);
        Imf::TiledInputFile input((folder / "x.exr").c_str());
        bool const isGrey = input.header().channels().findChannel("Y") != nullptr;
        auto const pixels = test::ReadLevel(input, 0, isGrey ? Words{"Y"} : Words{"R", "G", "B"});
        std::string places = "face,s,t\n";
        for (int y = 0; y < size; ++y) {  // from above
            for (int x = 0; x < size; ++x) {
                int const i = x / 2, j = (size - 1 - y) / 2;
                places += fmt::format("{},{},{}\n", kFaces * i + j, 0.25 + 0.5 * (x % 2),
                                      0.25 + 0.5 * ((size - 1 - y) % 2));
            }
        }
        for (int vertex = 0; vertex < kFaces; ++vertex)  // first corners of the first faces
            places += fmt::format("{},0,0\n", vertex);
        auto const table = Eval(places, Words{"--maps", "noise"} + kThreeOctaves + look);
        auto const primvar = Refine(Words{"--levels", "2"} + kThreeOctaves + look);
        EXPECT_EQ(primvar.name, isRamp ? "color" : "noise");
        size_t const numTexels = static_cast<size_t>(size) * static_cast<size_t>(size);
        for (size_t c = 0; c < columns.size(); ++c) {
            auto const& values = table.at(columns[c]);
            for (size_t k = 0; k < numTexels; ++k)
                ASSERT_NEAR(values[k], pixels[k * columns.size() + c], 1e-6) << k;
            for (size_t vertex = 0; vertex < kFaces; ++vertex) {
                EXPECT_NEAR(values[numTexels + vertex], primvar.values[vertex * columns.size() + c],
                            2e-6);
            }
        }
    }
}

// The positions' own coordinates as a primvar are the limit's position; a field is tangent to it.
TEST_F(CliNoise, OtherMapsOfPlacesAreThoseOfTheSurface) {
    std::string const places = "face,s,t\n0,0.3,0.4\n9,0,1\n5,0.5,0.5\n0,0.9,0.1\n";
    auto const table =
        Eval(places, {"--maps", "primvar:height,field,primvar:color", "--field", field});
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(table.at("color_r")[i], table.at("px")[i], 1e-6);
        EXPECT_NEAR(table.at("color_g")[i], table.at("py")[i], 1e-6);
        EXPECT_NEAR(table.at("height")[i], table.at("pz")[i], 1e-6);
        double along = 0.0, length = 0.0;
        for (char const* axis : {"x", "y", "z"}) {
            double const f = table.at(std::string("f") + axis)[i];
            along += f * table.at(std::string("n") + axis)[i];
            length += f * f;
        }
        EXPECT_NEAR(along, 0.0, 1e-9);
        EXPECT_GT(length, 1e-4);
    }
    auto const unit = Eval(places, {"--field", field, "--normalize"});
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(std::hypot(unit.at("fx")[i], unit.at("fy")[i], unit.at("fz")[i]), 1.0, 1e-12);
    }
}

TEST_F(CliNoise, WherePlacesHaveNoLimitColumnsHaveNone) {
    auto const table = Eval("face,s,t\n0,0.5,0.5\n5,0.5,0.5\n",
                            {"--boundary", "none", "--maps", "noise,primvar:height"});
    for (char const* column : {"px", "noise", "height"}) {
        EXPECT_TRUE(std::isnan(table.at(column)[0])) << column;
        EXPECT_FALSE(std::isnan(table.at(column)[1])) << column;
    }
}

TEST_F(CliNoise, WithoutMapsATableIsAsItWas) {
    EXPECT_EQ(Eval("face,s,t\n0,0.5,0.5\n", {}).size(), 16u);
}

TEST_F(CliNoise, ReportsNameSingularLevels) {
    std::string const places = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
    for (Words const& words :
         {Words{"eval", cube, "--at", places, "-o", folder / "x.csv", "--maps", "noise"},
          {"refine", cube, "-o", folder / "x.ply", "--noise"}}) {
        Outcome const outcome = Limn(words + Words{"--report", folder / "r.json"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(Report()["noise"]["singular_levels"], json::array({0}));
        EXPECT_TRUE(Contains(outcome.err, "all vertices have valence 3")) << outcome.err;
    }
    std::string const textured = test::ScenePath("cube/cube.obj");
    ASSERT_EQ(Bake(textured, "x.exr", {"--maps", "noise", "--report", folder / "r.json"}).status,
              0);
    EXPECT_EQ(Report()["noise"]["singular_levels"], json::array({0}));
}

TEST_F(CliNoise, RampsAreWrittenToAnObjAndScalarsAreNot) {
    ASSERT_EQ(
        Limn({"refine", cube, "-o", folder / "c.obj", "--noise", "--noise-ramp", "#000000,#ffffff"})
            .status,
        0);
    EXPECT_EQ(engine::ReadMesh(folder / "c.obj").primvars.at(0).name, "color");
    ExpectError(Limn({"refine", cube, "-o", folder / "d.obj", "--noise"}), 2, "--noise");
}

TEST_F(CliNoise, OptionsThatDoNotFitAreStatus2) {
    std::string const places = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
    auto const eval = [&](Words const& more, std::string const& part) {
        ExpectError(Limn(Words{"eval", mesh, "--at", places} + more), 2, part);
    };
    eval({"--maps", "mean"}, "--maps: there is no map 'mean' of places");
    eval({"--maps", "noise,noise"}, "'noise' is asked for twice");
    eval({"--maps", "primvar:none"}, "has no primvar 'none'");
    eval({"--maps", "field"}, "--maps field needs --field");
    eval({"--noise-seed", "3"}, "--noise-seed needs --maps noise");
    eval({"--maps", "primvar:height", "--normalize"}, "--normalize needs --maps noise or --field");
    eval({"--maps", "noise", "--normalize", "--noise-ramp", "#000000,#ffffff"},
         "--normalize has no effect with --noise-ramp");
    eval({"--maps", "noise", "--noise-ramp", "#00"}, "#00");
    eval({"--maps", "noise", "--frames", "x.{frame}.obj", "-o", "y.{frame}.csv"},
         "--maps and --frames exclude each other");
    auto const refine = [&](Words const& more, std::string const& part) {
        ExpectError(Limn(Words{"refine", mesh, "-o", folder / "x.ply"} + more), 2, part);
    };
    refine({"--noise-at", "vertex"}, "--noise-at needs --noise");
    refine({"--normalize"}, "--normalize needs --noise");
    refine({"--noise", "--normalize", "--noise-ramp", "#000000,#ffffff"}, "exclude each other");
    refine({"--noise", "--noise-octaves", "11"}, "--noise-octaves");
    ExpectError(Bake(mesh, "x.exr", {"--noise-at", "vertex"}), 2, "--noise-at has no effect");
}

TEST_F(CliNoise, AFieldsErrorsAreStatus3) {
    std::string const places = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
    for (char const* text : {"", "v0,v1,value\n0,1,nan\n", "v0,v1,value\n0,24,1\n"}) {
        std::string const broken = folder.Write("g.csv", text);
        ExpectError(Limn({"eval", mesh, "--at", places, "--maps", "field", "--field", broken}), 3,
                    "g.csv");
    }
}

}  // namespace
}  // namespace limn
