// SPDX-License-Identifier: Apache-2.0
//
// What affects pixels is told in the file.

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/bake/maps/map_table.h"
#include "engine/bake/output_names.h"
#include "engine/images/exr_writer.h"
#include "engine/io/mesh_writer.h"
#include "support/exr_level.h"
#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

enum class Effect {
    Pixels,  ///< the file has other pixels, or has them in another form
    Mesh,    ///< on some meshes
    None     ///< the file stays the same to the byte
};

/// An option of `limn bake`, and words that set it apart from `without`.
struct Row {
    std::string option;
    Words with;
    Words without{};
    std::string mesh = "plain";
    Effect effect = Effect::Pixels;
};

Words const kBands{"--maps", "bands"}, kNoise{"--maps", "noise"};
Words const kDisplacement{"--maps", "displacement", "--against", "MOVED"};
Words const kFrom{"--maps", "bands", "--from", "MOVED", "--bands", "1-"};
Words const kField{"--maps", "field", "--field", "FIELD"};

/// The words MOVED, FIELD, ... stand for files of the test.
std::vector<Row> const kRows{
    {"--maps", {"--maps", "k1"}},
    {"--size", {"--size", "32"}},
    {"--samples", {"--samples", "2"}},
    {"--padding", {"--padding", "2"}},
    {"--half", {"--half"}},
    {"--half", {"--maps", "mean,k1", "--half=k1"}, {"--maps", "mean,k1", "--half=mean"}},
    {"--compression", {"--compression", "piz"}},
    {"--mip", {"--mip"}},
    {"--coverage", {"--coverage"}},
    {"--encode", {"--encode", "2,0.5"}},
    {"--against", {"--maps", "displacement", "--against", "MESH"}, kDisplacement},
    {"--rest", {"--maps", "tension", "--rest", "MESH"}, {"--maps", "tension", "--rest", "MOVED"}},
    {"--origin", {"--maps", "position", "--origin", "1,-2.5,1e3"}, {"--maps", "position"}},
    {"--origin",
     {"--maps", "position", "--origin", "auto"},
     {"--maps", "position"},
     "plain",
     Effect::None},  // of a mesh round the origin
    {"--bands", kBands + Words{"--bands", "2"}, kBands},
    {"--gain", kBands + Words{"--gain", "1,1,1,2"}, kBands},
    {"--gain", kBands + Words{"--gain", "1,1,1,2,1"}, kBands + Words{"--gain", "1,1,1,2,2"}},
    {"--from", kFrom, kBands},
    {"--bands", kFrom, {"--maps", "bands", "--from", "MOVED", "--bands", "1-2"}},
    {"--carry", kFrom + Words{"--carry", "object"}, kFrom},
    {"--vector", kBands + Words{"--vector"}, kBands},
    {"--vector", kDisplacement + Words{"--vector"}, kDisplacement},
    {"--space", kDisplacement + Words{"--vector", "--space", "tangent"},
     kDisplacement + Words{"--vector"}},
    {"--space", kField + Words{"--space", "uv"}, kField},
    {"--field", {"--maps", "field", "--field", "OTHER_FIELD"}, kField},
    {"--normalize", kField + Words{"--normalize"}, kField},
    {"--normalize", kNoise + Words{"--normalize"}, kNoise},
    {"--noise-octaves", kNoise + Words{"--noise-octaves", "2"}, kNoise},
    {"--noise-frequency", kNoise + Words{"--noise-frequency", "3"}, kNoise},
    {"--noise-gain", kNoise + Words{"--noise-gain", "0.9"}, kNoise},
    {"--noise-seed", kNoise + Words{"--noise-seed", "7"}, kNoise},
    {"--noise-at", kNoise + Words{"--noise-at", "vertex"}, kNoise},
    {"--noise-ramp", kNoise + Words{"--noise-ramp", "#000000,#ff8000"}, kNoise},
    {"--evaluator", kNoise + Words{"--evaluator", "simd"}, kNoise},
    {"--evaluator", kField + Words{"--evaluator", "osd-cpu"}, kField},
    {"--evaluator", kBands + Words{"--evaluator", "osd-cpu"}, kBands},
    {"--groups", {"--groups", "red"}},
    {"--scheme", {"--scheme", "bilinear", "--maps", "position"}, {"--maps", "position"}},
    {"--orientation", {"--orientation", "left"}},
    {"--fvar", {"--fvar", "all"}, {"--fvar", "none"}},
    {"--boundary", {"--boundary", "edge-only"}, {}, "open", Effect::Mesh},
    {"--creases", {"--creases", "chaikin"}, {}, "creased", Effect::Mesh},
    {"--triangles", {"--triangles", "smooth"}, {}, "triangles", Effect::Mesh},
    {"--weld", {"--weld", "0"}, {}, "cut"},
    {"--tiles", {"--tiles", "1001"}, {}, "plain", Effect::None},
    {"--preview", {"--preview"}, {}, "plain", Effect::None},
    {"--preview-legend", {"--preview", "--preview-legend"}, {}, "plain", Effect::None},
    {"--preview-range", {"--preview", "--preview-range", "full"}, {}, "plain", Effect::None},
    {"--picture", {"--picture"}, {}, "plain", Effect::None},
    {"--view", {"--picture", "--view", "0,0,1"}, {}, "plain", Effect::None},
    {"--audit", {"--audit"}, {}, "plain", Effect::None},
    {"--audit-bound", {"--audit", "--audit-bound", "9"}, {}, "plain", Effect::None},
    {"--seam-bound", {"--audit", "--seam-bound", "1e9"}, {}, "plain", Effect::None},
    {"--limit-stencils", {"--limit-stencils", "far"}, {}, "plain", Effect::None},
    {"--far-level", {"--limit-stencils", "far", "--far-level", "2"}, {}, "plain", Effect::None},
    {"--far-end-cap",
     {"--limit-stencils", "far", "--far-end-cap", "bspline"},
     {},
     "plain",
     Effect::None},
    {"--far-inf-sharp", {"--limit-stencils", "far", "--far-inf-sharp"}, {}, "plain", Effect::None},
    {"--weld", {"--weld", "0"}, {}, "plain", Effect::Mesh},
    {"--skip-existing", {"--skip-existing"}, {}, "plain", Effect::None},
    {"--threads", {"--threads", "3"}, {}, "plain", Effect::None},
    {"--precision", {"--precision", "double"}, {}, "plain", Effect::None},
    {"--report", {"--report", "REPORT"}, {}, "plain", Effect::None},
    {"--verbose", {"--verbose"}, {}, "plain", Effect::None},
    {"--progress", {"--progress", "lines"}, {}, "plain", Effect::None},
    {"--quiet", {"--quiet"}, {}, "plain", Effect::None}};

using Flags = std::set<Words>;  // each with what follows it

/// A map, and the flags that concern it beside those of all maps.
struct MapRow {
    std::string map;
    Flags own{};
};

Flags const kOfAllMaps{{"--samples", "2"}, {"--mip"}, {"--coverage"}, {"--encode", "2,0.5"}};

std::vector<MapRow> const kMapRows{
    {"mean"},
    {"gaussian"},
    {"k1"},
    {"k2"},
    {"curvedness"},
    {"shape-index"},
    {"curvature"},
    {"principal-direction"},
    {"position", {{"--origin", "0.1,0.2,0.3"}}},
    {"normal", {{"--half=normal"}}},
    {"displacement", {{"--against", "MOVED"}, {"--vector"}}},
    {"stretch"},
    {"tension", {{"--rest", "MOVED"}}},
    {"bands", {{"--bands", "3"}, {"--vector"}, {"--evaluator", "osd-cpu"}}},
    {"noise",
     {{"--noise-octaves", "2"},
      {"--noise-seed", "7"},
      {"--noise-ramp", "#000000,#ff8000"},
      {"--evaluator", "osd-cpu"}}},
    {"field", {{"--field", "FIELD"}, {"--normalize"}, {"--evaluator", "osd-cpu"}}},
    {"overlap"},
    {"primvar:color"}};

/// The same without the map field, of which there are no vectors in tangent space.
std::vector<MapRow> const kTangentRows{
    {"normal"},
    {"displacement", {{"--against", "MOVED"}, {"--vector"}, {"--space", "tangent"}}},
    {"bands",
     {{"--from", "MOVED"},
      {"--bands", "1-"},
      {"--carry", "object"},
      {"--vector"},
      {"--space", "tangent"}}},
    {"noise",
     {{"--normalize"},
      {"--noise-frequency", "3"},
      {"--noise-gain", "0.9"},
      {"--noise-at", "vertex"}}}};

Words List(Flags const& flags) {
    Words words;
    for (Words const& flag : flags) words = words + flag;
    return words;
}

/// All that a reader of the file can see of its pixels.
struct Image {
    std::string form;
    std::vector<float> pixels;  ///< of all levels

    bool operator==(Image const&) const = default;
};

Image ReadImage(std::string const& path) {
    Imf::TiledInputFile input(path.c_str());
    Image image;
    image.form = fmt::format("compression {}", static_cast<int>(input.header().compression()));
    Words channels;
    auto const& list = input.header().channels();
    for (auto channel = list.begin(); channel != list.end(); ++channel) {
        channels.push_back(channel.name());
        image.form +=
            fmt::format(" {}:{}", channel.name(), static_cast<int>(channel.channel().type));
    }
    for (int level = 0; level < input.numLevels(); ++level) {
        image.form += fmt::format(" {}x{}", input.levelWidth(level), input.levelHeight(level));
        auto const pixels = test::ReadLevel(input, level, channels);
        image.pixels.insert(image.pixels.end(), pixels.begin(), pixels.end());
    }
    return image;
}

class BakeOptionsInTheFile : public Cli {
protected:
    std::map<std::string, std::string> MakeFiles() const {
        engine::Scene torus = test::MakeTorus(12, 8);
        for (double& uv : torus.uvs) uv = 0.1 + 0.8 * uv;
        auto& materials = torus.groups[static_cast<size_t>(engine::GroupKind::Material)];
        materials.names = {"red", "blue"};
        materials.faceGroup.assign(torus.cage.faceSizes.size(), 0);
        materials.faceGroup.back() = 1;
        std::string const mesh = folder / "m.obj", moved = folder / "moved.obj";
        torus.primvars = {{"color", 3, {torus.positions.begin(), torus.positions.end()}}};
        engine::WriteMesh(mesh, torus, Precision::Float);
        for (size_t i = 0; i < torus.positions.size(); i += 3) torus.positions[i] *= 1.25;
        engine::WriteMesh(moved, torus, Precision::Float);
        std::string const field = folder.Write("f.csv", "v0,v1,value\n");
        std::string const other = folder.Write("g.csv", "v0,v1,value\n");
        for (auto const& [strength, path] : {std::pair{"1", field}, {"2", other}}) {
            EXPECT_EQ(
                Limn({"field", mesh, "-o", folder / "x.edges.csv", "--levels", "0", "--source",
                      std::string("0:") + strength, "--sink", std::string("50:") + strength})
                    .status,
                0);
            folder.Write(path.substr(path.rfind('/') + 1), test::ReadText(folder / "x.edges.csv"));
        }
        // Two quads at an angle whose common edge each has for itself.
        std::string const cut =
            folder.Write("cut.obj",
                         "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 1\nv 2 1 1\nv 1 1 0\n"
                         "vt 0 0\nvt .4 0\nvt .4 1\nvt 0 1\nvt .6 0\nvt 1 0\nvt 1 1\nvt .6 1\n"
                         "f 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n");
        return {{"MESH", mesh},   {"CUT", cut},           {"MOVED", moved},
                {"FIELD", field}, {"OTHER_FIELD", other}, {"REPORT", folder / "r.json"}};
    }

    std::string FindMesh(std::string const& name) const {
        if (name == "open") return Shape("catmark_edgecorner");
        if (name == "creased") return Shape("catmark_torus_creases0");
        if (name == "triangles") return Shape("catmark_pyramid");
        return files.at(name == "cut" ? "CUT" : "MESH");
    }

    /// The file that a bake with these words makes.
    std::string BakeTo(std::string const& name, std::string const& mesh, Words words) const {
        for (std::string& word : words) {
            if (auto const file = files.find(word); file != files.end()) word = file->second;
        }
        Words all{"bake", mesh, "-o", folder / name};
        auto const add = [&](char const* option, char const* value) {
            if (std::ranges::find(words, option) == words.end()) all = all + Words{option, value};
        };
        add("--size", "48");
        add("--maps", "mean");
        Outcome const outcome = Limn(all + words);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return folder / name;
    }

    /// Each map's file is the same to the byte alone, with the flags that concern it, and beside
    /// all the others with all flags.
    void ExpectSameInCompany(std::vector<MapRow> const& rows) const {
        Flags all = kOfAllMaps;
        std::string maps;
        for (auto const& [map, own] : rows) {
            all.insert(own.begin(), own.end());
            maps += (maps.empty() ? "" : ",") + map;
        }
        BakeTo("all.{map}.exr", files.at("MESH"), Words{"--maps", maps} + List(all));
        for (auto const& [map, own] : rows) {
            Flags flags = kOfAllMaps;
            flags.insert(own.begin(), own.end());
            BakeTo("alone.{map}.exr", files.at("MESH"), Words{"--maps", map} + List(flags));
            std::string const ending = "." + engine::AsFileName(map) + ".exr";
            EXPECT_TRUE(test::ReadText(folder / ("alone" + ending)) ==
                        test::ReadText(folder / ("all" + ending)))
                << map;
        }
    }

    std::map<std::string, std::string> const files = MakeFiles();
};

TEST_F(BakeOptionsInTheFile, AreThoseThatAffectPixels) {
    std::map<std::pair<std::string, Words>, std::string> done;  // bakes without the option
    for (Row const& row : kRows) {
        SCOPED_TRACE(row.option);
        std::string const mesh = FindMesh(row.mesh);
        std::string const with = BakeTo("with.exr", mesh, row.with);
        auto const [known, isNew] = done.try_emplace(std::pair{mesh, row.without},
                                                     fmt::format("without{}.exr", done.size()));
        if (isNew) BakeTo(known->second, mesh, row.without);
        std::string const without = folder / known->second;
        if (row.effect == Effect::None) {
            EXPECT_TRUE(test::ReadText(with) == test::ReadText(without));
            continue;
        }
        bool const isSame = ReadImage(with) == ReadImage(without);
        EXPECT_FALSE(isSame && row.effect == Effect::Pixels) << "the row shows no effect";
        EXPECT_NE(engine::ReadExrAttributes(with, "limn:"),
                  engine::ReadExrAttributes(without, "limn:"));
    }
}

TEST_F(BakeOptionsInTheFile, AreThoseOfItsOwnMap) {
    ExpectSameInCompany(kMapRows);
    ExpectSameInCompany(kTangentRows);
}

// A new map has to be told of above.
TEST_F(BakeOptionsInTheFile, AreKnownOfEveryMap) {
    Words known;
    for (MapRow const& row : kMapRows) known.push_back(row.map);
    EXPECT_EQ(known, engine::ListFixedMapNames() + Words{"primvar:color"});
}

// A new option has to be told of above.
TEST_F(BakeOptionsInTheFile, AreAllOptionsOfTheVerb) {
    std::set<std::string> known{"--help", "--output", "--version"};
    for (Row const& row : kRows) known.insert(row.option);
    std::string const help = Limn({"bake", "--help"}).out;
    std::set<std::string> listed;
    std::regex const option("\n +(?:-[a-z],)?(--[a-z-]+)");
    for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at)
        listed.insert((*at)[1]);
    EXPECT_EQ(listed, known);
}

}  // namespace
}  // namespace limn
