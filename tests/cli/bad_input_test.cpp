// SPDX-License-Identifier: Apache-2.0
//
// Inputs that cannot be used: malformed meshes, missing files.

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <regex>
#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/images/exr_lookup.h"
#include "support/program/cli.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using namespace test::cli;

std::string ExpectedOf(std::string const& name) {
    for (std::string const& line :
         Lines(test::ReadText(test::DataPath("malformed/EXPECTED.tsv")))) {
        if (line.starts_with(name + "\t")) return line.substr(line.rfind('\t') + 1);
    }
    throw std::runtime_error("EXPECTED.tsv lacks " + name);
}

/// True if faces name texture coordinates, which a bake needs.
bool HasTextureIndices(std::string const& path) {
    return std::regex_search(test::ReadText(path), std::regex("(^|\n)f +-?[0-9]+/-?[0-9]"));
}

class MalformedFile : public testing::TestWithParam<std::string> {};

TEST_P(MalformedFile, IsAcceptedOrRejectedAsTheTableSays) {
    std::string const expected = ExpectedOf(GetParam()),
                      path = test::DataPath("malformed/" + GetParam());
    bool const mayBeRead = expected.starts_with("ACCEPT") || expected.starts_with("REJECT, or");
    bool const mayBeRejected = !expected.starts_with("ACCEPT") || Contains(expected, "or REJECT");
    for (std::string const verb : {"info", "refine", "bake"}) {
        SCOPED_TRACE(verb);
        test::TemporaryFolder const folder;
        Words more;
        if (verb == "refine") more = {"-o", folder / "a.obj"};
        if (verb == "bake") more = {"-o", folder / "a.exr", "--maps", "mean", "--size", "32"};
        Outcome const outcome = Limn(Words{verb, path} + more);
        if (outcome.status == 0) {
            EXPECT_TRUE(mayBeRead);
            EXPECT_EQ(folder.List().size(), verb == "info" ? 0u : 1u);
            // "REJECT, or warn": what was read all the same is named.
            EXPECT_TRUE(!mayBeRejected || std::regex_search(outcome.err + outcome.out,
                                                            std::regex("line [0-9]+|:[0-9]+:")));
            continue;
        }
        std::string const error = ExpectError(outcome, 3, path);
        EXPECT_TRUE(folder.List().empty());
        EXPECT_TRUE(outcome.out.empty());
        bool const lacksUVs = verb == "bake" && mayBeRead && !HasTextureIndices(path);
        if (lacksUVs && Contains(error, "no texture coordinates")) continue;
        EXPECT_TRUE(mayBeRejected) << error;
        bool const isEmpty = fs::file_size(path) == 0;
        EXPECT_TRUE(isEmpty ||
                    std::regex_search(error, std::regex(R"(\.obj:[0-9]+: |\(line [0-9]+\))")))
            << error;
    }
}

INSTANTIATE_TEST_SUITE_P(Data, MalformedFile, testing::ValuesIn(test::ListData("malformed")),
                         [](auto const& file) { return test::NameInstance(file.param); });

TEST_F(Cli, CrlfFileRefinesToTheSameBytesAsItsLfTwin) {
    std::string const crlf = test::DataPath("malformed/spot_crlf.obj");
    std::string text = test::ReadText(crlf);
    std::erase(text, '\r');
    folder.Write("lf.obj", text);
    ASSERT_EQ(Limn({"refine", crlf, "-o", folder / "a.obj"}).status, 0);
    ASSERT_EQ(Limn({"refine", folder / "lf.obj", "-o", folder / "b.obj"}).status, 0);
    EXPECT_EQ(test::ReadText(folder / "a.obj"), test::ReadText(folder / "b.obj"));
}

TEST_F(Cli, LoopRefusesAQuadAndNamesIt) {
    ExpectError(Limn({"info", Shape("catmark_cube"), "--scheme", "loop"}), 3,
                "face 0 has 4 corners");
}

TEST_F(Cli, BakeWithoutTextureCoordinatesIsRefused) {
    ExpectError(Bake(Shape("catmark_pole8"), "a.exr"), 3, "no texture coordinates");
    EXPECT_TRUE(folder.List().empty());
}

/// A bent quad with sides of the given length, textured over the whole tile.
std::string MakeQuad(std::string const& length) {
    return fmt::format(
        "v 0 0 0\nv {0} 0 0\nv {0} {0} {0}\nv 0 {0} 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "f 1/1 2/2 3/3 4/4\n",
        length);
}

TEST_F(Cli, PositionsBeyondThePossibleAreRefused) {
    std::string const mesh = folder.Write("m.obj", MakeQuad("1e31"));
    ExpectError(Bake(mesh, "a.exr"), 3, "m.obj:2: x is '1e31'; at most 1e+30");
    EXPECT_EQ(folder.List(), (Words{"m.obj"}));
}

struct Extreme {
    std::string name, length;
    Words more;
    bool isClamped;  // values leave the range of half
};

void PrintTo(Extreme const& extreme, std::ostream* out) {
    *out << extreme.name;
}

class ExtremeSizes : public testing::TestWithParam<Extreme> {};

// [Bake 4]. Positions of the largest mesh and curvatures of a small one leave the range of half:
// they are clamped to its end, and counted.
TEST_P(ExtremeSizes, HaveNoPixelThatIsNanOrInfinite) {
    std::vector<std::pair<std::string, std::vector<std::string>>> const maps{
        {"position", {"R", "G", "B"}},
        {"normal", {"R", "G", "B"}},
        {"curvature", {"k1", "k2", "mean", "gaussian"}},
        {"principal-direction", {"R", "G", "B"}},
        {"curvedness", {"Y"}},
        {"shape-index", {"Y"}},
        {"stretch", {"Y"}}};
    std::string names;
    for (auto const& [map, channels] : maps) names += (names.empty() ? "" : ",") + map;
    test::TemporaryFolder const folder;
    Outcome const outcome = Limn(Words{"bake", folder.Write("m.obj", MakeQuad(GetParam().length)),
                                       "-o", folder / "{map}.exr", "--maps", names, "--size", "16",
                                       "--report", folder / "r.json", "--quiet"} +
                                 GetParam().more);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    engine::ExrLookup lookup;
    double largest = 0.0;
    for (auto const& [map, channels] : maps) {
        for (int texel = 0; texel < 16 * 16; ++texel) {
            for (double value :
                 lookup.Look(folder / (map + ".exr"), channels, texel % 16, texel / 16)) {
                ASSERT_TRUE(std::isfinite(value)) << map << ", texel " << texel;
                largest = std::max(largest, std::abs(value));
            }
        }
    }
    json const clamped = ReadJson(folder / "r.json")["clamped"];
    EXPECT_EQ(clamped > 0, GetParam().isClamped) << clamped;
    if (GetParam().isClamped)
        EXPECT_EQ(largest, 65504.0);
    else
        EXPECT_GT(largest, 1e29);
}

INSTANTIATE_TEST_SUITE_P(Of, ExtremeSizes,
                         testing::Values(Extreme{"Large", "1e30", {}, false},
                                         Extreme{"LargeInHalf", "1e30", {"--half"}, true},
                                         Extreme{"Small", "1e-18", {}, false},
                                         Extreme{"Smaller", "1e-25", {}, false},
                                         Extreme{"SmallInHalf", "1e-18", {"--half"}, true}),
                         [](auto const& instance) { return instance.param.name; });

TEST_F(Cli, TextureCoordinatesTooFarAwayAreRefusedByFace) {
    std::string const mesh = folder.Write(
        "m.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "vt 1e30 0\nusemtl near\nf 1/1 2/2 3/3 4/4\nusemtl far\nf 2/5 5/5 6/5 3/5\n");
    for (std::string const output : {"a.exr", "a.<UDIM>.exr"}) {
        ExpectError(Bake(mesh, output), 3,
                    "m.obj: face 1 (line 15) has a texture coordinate of 1e+30; up to 10000 in "
                    "magnitude can be baked");
        EXPECT_EQ(folder.List(), (Words{"m.obj"}));
    }
    EXPECT_EQ(Bake(mesh, "a.exr", {"--groups", "near"}).status, 0);
}

/// One face of many corners on a circle, with texture coordinates.
std::string MakePolygon(int numCorners) {
    std::string text, face = "f";
    for (int i = 1; i <= numCorners; ++i) {
        double const angle = 2.0 * std::acos(-1.0) * i / numCorners;
        text += fmt::format("v {0} {1} 0\nvt {0} {1}\n", 0.5 + 0.4 * std::cos(angle),
                            0.5 + 0.4 * std::sin(angle));
        face += fmt::format(" {0}/{0}", i);
    }
    return text + face + "\n";
}

/// Triangles round a vertex.
std::string MakeFan(int numFaces) {
    std::string text = MakePolygon(numFaces);
    text = text.substr(0, text.find("f ")) + "v 0.5 0.5 1\nvt 0.5 0.5\n";
    for (int i = 1; i <= numFaces; ++i)
        text += fmt::format("f {0}/{0} {1}/{1} {2}/{2}\n", numFaces + 1, i, i % numFaces + 1);
    return text;
}

TEST_F(Cli, LargePolygonsAndValencesAreRefusedByNameWhereALimitIsAskedFor) {
    std::string const polygon = folder.Write("polygon.obj", MakePolygon(1000)),
                      fan = folder.Write("fan.obj", MakeFan(1024)),
                      places = folder.Write("p.csv", "face,s,t\n0,0.25,0.25\n");
    for (auto const& [mesh, reason] :
         {std::pair<std::string, std::string>(
              polygon,
              "polygon.obj: face 0 (line 2001) has 1000 corners; a limit surface takes up to 256"),
          std::pair<std::string, std::string>(
              fan, "fan.obj: vertex 1024 has 1024 faces; a limit surface takes up to 512")}) {
        ExpectError(Bake(mesh, "a.exr"), 3, reason);
        ExpectError(Limn({"eval", mesh, "--at", places}), 3, reason);
        ExpectError(Limn({"measure", mesh}), 3, reason);
        ExpectError(Limn({"fit", mesh, "-o", folder / "a.obj"}), 3, reason);
        ExpectError(Limn({"refine", mesh, "-o", folder / "a.obj", "--limit", "--levels", "0"}), 3,
                    reason.substr(reason.find(" has ")));  // refined faces have no lines
        EXPECT_EQ(Limn({"info", mesh}).status, 0);
        EXPECT_EQ(Limn({"refine", mesh, "-o", folder / "b.obj"}).status, 0);
    }
}

TEST_F(Cli, DeepJsonIsRefusedInAShortLine) {
    std::string const edit = folder.Write(
        "e.json", "{\"filter\": " + std::string(60000, '[') + "1" + std::string(60000, ']') + "}");
    std::string const error =
        ExpectError(Limn({"refine", Shape("catmark_cube"), "-o", folder / "a.obj", "--space",
                          "differential", "--edit", edit}),
                    3, "e.json: values are nested more than 4 deep");
    EXPECT_LT(error.size(), 200u);
}

TEST_F(Cli, FilesOfOtherKindsAreNamed) {
    ExpectError(Limn({"info", folder.Write("a.obj", "#usda 1.0\n")}), 3,
                "a.obj: looks like USD: OBJ, PLY or OFF is needed");
    ExpectError(Limn({"eval", Shape("catmark_cube"), "--at", folder.Write("p.csv", "PK\x03\x04")}),
                3, "p.csv: looks like ZIP");
}

// -------- status 5

TEST_F(Cli, MissingInputIsStatus5) {
    std::string const none = folder / "none.obj";
    for (Words const& words : {Words{"info", none},
                               {"refine", none, "-o", folder / "a.obj"},
                               {"bake", none, "-o", folder / "a.exr", "--maps", "mean"},
                               {"eval", Shape("catmark_cube"), "--at", folder / "none.obj"}}) {
        ExpectError(Limn(words), 5, none);
    }
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(Cli, FolderAsInputIsStatus5) {
    ExpectError(Limn({"info", folder.GetPath()}), 5, "it is a folder");
}

TEST_F(Cli, ADeviceWithoutAnEndIsRefused) {
    ExpectError(Limn({"info", "/dev/zero"}), 5, "'/dev/zero' cannot be read: it is a device");
}

}  // namespace
}  // namespace limn
