// SPDX-License-Identifier: Apache-2.0
#include "engine/io/ply_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/readers.h"

namespace limn {
namespace {

using engine::Scene;
using test::kPlyTriangle;
using test::ParsePly;
using test::RefusalOfPly;

/// Binary values in either byte order.
class Bytes {
public:
    explicit Bytes(bool isBig) : _isBig(isBig) {}

    template <class T>
    Bytes& Add(T value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        if (_isBig) std::reverse(raw, raw + sizeof value);
        _text.append(raw, sizeof value);
        return *this;
    }
    std::string const& GetText() const { return _text; }

private:
    bool _isBig;
    std::string _text;
};

char const* FormatName(bool isBig) {
    return isBig ? "binary_big_endian" : "binary_little_endian";
}

/// A triangle with every type a property can have, and its header.
std::string MakeTyped(bool isBig) {
    Bytes body(isBig);
    for (int v = 0; v < 3; ++v) {
        body.Add(1.25 * v).Add(0.1f * static_cast<float>(v)).Add(static_cast<int16_t>(-7 * v));
        body.Add(static_cast<uint8_t>(51 * v))
            .Add(static_cast<uint8_t>(255))
            .Add(static_cast<uint8_t>(0));
        body.Add(static_cast<int8_t>(-v))
            .Add(static_cast<uint16_t>(65535 - v))
            .Add(static_cast<int32_t>(-100000 * v));
        body.Add(4000000000u + static_cast<uint32_t>(v));
    }
    body.Add(static_cast<uint8_t>(3))
        .Add(static_cast<int32_t>(2))
        .Add(static_cast<int32_t>(1))
        .Add(static_cast<int32_t>(0));
    body.Add(static_cast<uint16_t>(6));
    for (float x : {0.0f, 0.5f, 1.0f, 0.25f, 0.75f, 0.125f}) body.Add(x);
    return fmt::format(
               "ply\nformat {} 1.0\ncomment made by a test\nobj_info nothing\nelement vertex 3\n"
               "property double x\nproperty float32 y\nproperty short z\nproperty uchar "
               "red\nproperty uchar green\n"
               "property uint8 blue\nproperty char a\nproperty ushort b\nproperty int c\nproperty "
               "uint d\n"
               "element face 1\nproperty list uchar int vertex_index\nproperty list ushort float "
               "texcoord\nend_header\n",
               FormatName(isBig)) +
           body.GetText();
}

engine::Primvar const* FindPrimvar(Scene const& scene, std::string const& name) {
    for (auto const& primvar : scene.primvars) {
        if (primvar.name == name) return &primvar;
    }
    return nullptr;
}

TEST(PlyReader, ReadsText) {
    Scene const scene = ParsePly(kPlyTriangle);
    EXPECT_EQ(scene.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
    EXPECT_EQ(scene.cage.numVertices, 3);
    EXPECT_EQ(scene.cage.faceSizes, (std::vector<Index>{3}));
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{0, 1, 2}));
    EXPECT_EQ(scene.faceLines, (std::vector<uint32_t>{13}));  // 9 lines of header, 3 of vertices
    EXPECT_FALSE(scene.HasUVs());
    EXPECT_TRUE(scene.primvars.empty());
}

TEST(PlyReader, CrlfAndMissingLastLineEndChangeNothing) {
    for (std::string const& text :
         {test::WithCrlf(kPlyTriangle), kPlyTriangle.substr(0, kPlyTriangle.size() - 1)}) {
        EXPECT_EQ(ParsePly(text).positions, ParsePly(kPlyTriangle).positions);
        EXPECT_EQ(ParsePly(text).cage.faceVertices, ParsePly(kPlyTriangle).cage.faceVertices);
    }
}

TEST(PlyReader, WhatFollowsTheLastRowIsWarnedOfUnlessItIsWhiteSpace) {
    EXPECT_EQ(ParsePly(kPlyTriangle + "3 2 1 0\n\n3 0 2 1\n").warnings,
              (std::vector<std::string>{
                  "mesh.ply: 2 lines behind the last row that the header counts, not read"}));
    EXPECT_TRUE(ParsePly(kPlyTriangle + " \n\t\n").warnings.empty());
    for (bool isBig : {false, true}) {
        std::string const bytes = MakeTyped(isBig);
        EXPECT_EQ(ParsePly(bytes + "\n\1\2\n").warnings,
                  (std::vector<std::string>{
                      "mesh.ply: 3 bytes behind the last row that the header counts, not read"}));
        EXPECT_EQ(ParsePly(bytes + '\0').warnings.size(), 1u);
        EXPECT_TRUE(ParsePly(bytes + " \r\n").warnings.empty());
        EXPECT_TRUE(ParsePly(bytes).warnings.empty());
    }
}

TEST(PlyReader, AnyLineEndChangesNothing) {
    for (std::string const end : {"\r", "\n\r"}) {
        Scene const other = ParsePly(std::regex_replace(kPlyTriangle, std::regex("\n"), end));
        EXPECT_EQ(other.positions, ParsePly(kPlyTriangle).positions);
        EXPECT_EQ(other.faceLines, ParsePly(kPlyTriangle).faceLines);
    }
}

TEST(PlyReader, ElementsMayComeInAnyOrder) {
    Scene const scene = ParsePly(
        "ply\nformat ascii 1.0\nelement edge 1\nproperty int a\nelement face 1\nproperty list "
        "uchar "
        "int vertex_indices\nelement vertex 3\nproperty float z\nproperty float x\nproperty float "
        "y\nend_header\n5\n3 2 1 0\n9 0 0\n9 1 0\n9 0 1\n");
    EXPECT_EQ(scene.positions, (std::vector<double>{0, 0, 9, 1, 0, 9, 0, 1, 9}));
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{2, 1, 0}));
}

/// Two squares side by side as strips: of 4 and 4 vertices, parted by -1.
std::string MakeStrips(std::string const& strips) {
    return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty "
           "float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n" +
           strips + "\n";
}

TEST(PlyReader, TriangleStripsAreTurnedAlternately) {
    EXPECT_EQ(ParsePly(MakeStrips("6 0 1 2 3 4 5")).cage.faceVertices,
              (std::vector<Index>{0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5}));
}

TEST(PlyReader, ANegativeIndexBeginsAStripAnew) {
    Scene const scene = ParsePly(MakeStrips("9 0 1 2 3 -1 2 3 4 5"));
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5}));
    EXPECT_EQ(scene.faceLines, (std::vector<uint32_t>{16, 16, 16, 16}));
    EXPECT_EQ(ParsePly(MakeStrips("7 -1 0 -1 0 1 2 -1")).cage.faceVertices,
              (std::vector<Index>{0, 1, 2}));
}

TEST(PlyReader, TrianglesThatRepeatAVertexOnlyLeadOn) {
    // (0 1 2), four that lead on, and 4 3 5 as the sixth, which is turned.
    EXPECT_EQ(ParsePly(MakeStrips("8 0 1 2 2 4 4 3 5")).cage.faceVertices,
              (std::vector<Index>{0, 1, 2, 3, 4, 5}));
}

TEST(PlyReader, AStripsVertexThatIsNotIsRefused) {
    EXPECT_EQ(RefusalOfPly(MakeStrips("3 0 1 6")),
              "mesh.ply:16: a face uses vertex 6; 0 to 5 are possible");
}

/// Three triangles with texture numbers.
std::string MakeTextured(std::string const& comments) {
    return "ply\nformat ascii 1.0\n" + comments +
           "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
           "3\nproperty list uchar int vertex_indices\nproperty int texnumber\nend_header\n0 0 "
           "0\n1 "
           "0 0\n0 1 0\n3 0 1 2 1\n3 0 2 1 -1\n3 1 2 0 0\n";
}

TEST(PlyReader, TextureNumbersAreMaterials) {
    auto const materials =
        ParsePly(MakeTextured("comment TextureFile skin.png\ncomment TextureFile the eyes.png\n"))
            .groups[static_cast<size_t>(engine::GroupKind::Material)];
    EXPECT_EQ(materials.names, (std::vector<std::string>{"the eyes.png", "skin.png"}));
    EXPECT_EQ(materials.faceGroup, (std::vector<Index>{0, -1, 1}));
    EXPECT_EQ(ParsePly(MakeTextured("")).groups[0].names,
              (std::vector<std::string>{"texture1", "texture0"}));
}

class PlyByteOrder : public testing::TestWithParam<bool> {};

TEST_P(PlyByteOrder, EveryTypeIsRead) {
    Scene const scene = ParsePly(MakeTyped(GetParam()));
    EXPECT_EQ(scene.positions, (std::vector<double>{0, 0, 0, 1.25, 0.1f, -7, 2.5, 0.1f * 2, -14}));
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{2, 1, 0}));
    ASSERT_NE(FindPrimvar(scene, "a"), nullptr);
    EXPECT_EQ(FindPrimvar(scene, "a")->values, (std::vector<float>{0, -1, -2}));
    EXPECT_EQ(FindPrimvar(scene, "b")->values, (std::vector<float>{65535, 65534, 65533}));
    EXPECT_EQ(FindPrimvar(scene, "c")->values, (std::vector<float>{0, -100000, -200000}));
    EXPECT_EQ(FindPrimvar(scene, "d")->values[0], 4e9f);
}

TEST_P(PlyByteOrder, ByteColoursBecomeAPrimvarFromZeroToOne) {
    Scene const scene = ParsePly(MakeTyped(GetParam()));
    auto const* const colour = FindPrimvar(scene, "color");
    ASSERT_NE(colour, nullptr);
    EXPECT_EQ(colour->numChannels, 3);
    // 51/255 is a fifth
    EXPECT_EQ(colour->values, (std::vector<float>{0, 1, 0, 0.2f, 1, 0, 0.4f, 1, 0}));
}

TEST_P(PlyByteOrder, TexcoordListGivesEveryCornerItsUV) {
    Scene const scene = ParsePly(MakeTyped(GetParam()));
    auto const& indices = scene.cage.fvarChannels.at(0).valueIndices;
    ASSERT_EQ(indices.size(), 3u);
    double const expected[3][2] = {{0, 0.5}, {1, 0.25}, {0.75, 0.125}};
    for (size_t corner = 0; corner < 3; ++corner) {
        EXPECT_EQ(scene.uvs[2 * indices[corner]], expected[corner][0]) << corner;
        EXPECT_EQ(scene.uvs[2 * indices[corner] + 1], expected[corner][1]) << corner;
    }
}

// Data that begins with a byte that could belong to the header's line end is not eaten.
TEST_P(PlyByteOrder, HeadersEndAsTheirFirstLinesDo) {
    std::string const header = kPlyTriangle.substr(0, kPlyTriangle.find("end_header\n") + 11);
    for (std::string const end : {"\n", "\r\n", "\r", "\n\r"}) {
        for (char const first : {'\r', '\n'}) {
            Bytes body(GetParam());
            float const x = std::bit_cast<float>(0x01010101u * static_cast<unsigned char>(first));
            for (float value : {x, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}) body.Add(value);
            body.Add(static_cast<uint8_t>(3)).Add(0).Add(1).Add(2);
            std::string text = header;
            text.replace(text.find("ascii"), 5, FormatName(GetParam()));
            Scene const scene =
                ParsePly(std::regex_replace(text, std::regex("\n"), end) + body.GetText());
            EXPECT_EQ(scene.positions[0], x);
            EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{0, 1, 2}));
        }
    }
}

TEST_P(PlyByteOrder, FileCutAnywhereIsRefused) {
    std::string const whole = MakeTyped(GetParam());
    for (size_t size = 0; size < whole.size(); ++size) {
        std::string const message = RefusalOfPly(whole.substr(0, size));
        ASSERT_EQ(message.find("mesh.ply:"), 0u)
            << size << " of " << whole.size() << " bytes: " << message;
    }
}

TEST_P(PlyByteOrder, NanInAPositionIsRefusedAndItsVertexNamed) {
    Bytes body(GetParam());
    for (float x :
         {0.0f, 0.0f, 0.0f, 1.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f, 1.0f, 0.0f})
        body.Add(x);
    body.Add(static_cast<uint8_t>(3)).Add(0).Add(1).Add(2);
    std::string header = kPlyTriangle.substr(0, kPlyTriangle.find("end_header\n") + 11);
    header.replace(header.find("ascii"), 5, FormatName(GetParam()));
    std::string const message = RefusalOfPly(header + body.GetText());
    EXPECT_EQ(message.find("mesh.ply: vertex 1: "), 0u) << message;
    EXPECT_NE(message.find("'y' is nan; a number up to 1e+30 is needed"), std::string::npos)
        << message;
}

INSTANTIATE_TEST_SUITE_P(Order, PlyByteOrder, testing::Bool(),
                         [](testing::TestParamInfo<bool> const& instance) {
                             return instance.param ? "Big" : "Little";
                         });

TEST(PlyReader, VertexTextureCoordinatesGoByThreeNames) {
    for (auto const& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
        std::string text = kPlyTriangle;
        text.replace(text.find("element face"), 0,
                     fmt::format("property float {}\nproperty float {}\n", u, v));
        text.replace(text.find("0 0 0\n"), 18, "0 0 0 .25 .5\n1 0 0 1 0\n0 1 0 0 1\n");
        Scene const scene = ParsePly(text);
        EXPECT_EQ(scene.uvs, (std::vector<double>{0.25, 0.5, 1, 0, 0, 1})) << u;
        EXPECT_EQ(scene.cage.fvarChannels.at(0).valueIndices, scene.cage.faceVertices) << u;
        EXPECT_TRUE(scene.primvars.empty()) << u;
    }
}

/// Two triangles that share an edge, with the given texcoord lists.
std::string MakePair(std::string const& first, std::string const& second) {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
           "float z\n"
           "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float "
           "texcoord\nend_header\n"
           "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 " +
           first + "\n3 0 2 3 " + second + "\n";
}

TEST(PlyReader, CornersOfOneVertexShareAUVOnlyWhereItIsTheSame) {
    // Vertex 0 has (0,0) in both faces, vertex 2 has (1,1) in one and (.5,.5) in the other: 5
    // values.
    Scene const scene = ParsePly(MakePair("6 0 0 1 0 1 1", "6 0 0 .5 .5 0 1"));
    auto const& channel = scene.cage.fvarChannels.at(0);
    EXPECT_EQ(channel.numValues, 5);
    EXPECT_EQ(channel.valueIndices[0], channel.valueIndices[3]);
    EXPECT_NE(channel.valueIndices[2], channel.valueIndices[4]);
}

TEST(PlyReader, FacesWithoutTexcoordsLeaveThoseOfTheOthers) {
    Scene const scene = ParsePly(MakePair("6 0 0 1 0 1 1", "0"));
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_TRUE(scene.HasUVs(0));
    EXPECT_FALSE(scene.HasUVs(1));
    EXPECT_EQ(scene.uvs, (std::vector<double>{0, 0, 1, 0, 1, 1, 0, 0}));
    EXPECT_EQ(scene.cage.fvarChannels.at(0).valueIndices, (std::vector<Index>{0, 1, 2, 3, 3, 3}));
    EXPECT_FALSE(ParsePly(MakePair("0", "0")).HasUVs());
}

TEST(PlyReader, FurtherScalarsArePrimvarsAndNormalsAreNot) {
    std::string text = kPlyTriangle;
    text.replace(
        text.find("element face"), 0,
        "property float nx\nproperty float ny\nproperty float nz\nproperty float quality\n");
    text.replace(text.find("0 0 0\n"), 18, "0 0 0 0 0 1 .5\n1 0 0 0 0 1 -2\n0 1 0 0 0 1 3e4\n");
    Scene const scene = ParsePly(text);
    ASSERT_EQ(scene.primvars.size(), 1u);
    EXPECT_EQ(scene.primvars[0].name, "quality");
    EXPECT_EQ(scene.primvars[0].values, (std::vector<float>{0.5f, -2.0f, 3e4f}));
}

TEST(PlyReader, AlphaMakesColoursFourChannels) {
    std::string text = kPlyTriangle;
    text.replace(
        text.find("element face"), 0,
        "property float red\nproperty float green\nproperty float blue\nproperty float alpha\n");
    text.replace(text.find("0 0 0\n"), 18, "0 0 0 1 2 3 4\n1 0 0 5 6 7 8\n0 1 0 .5 .25 0 1\n");
    Scene const scene = ParsePly(text);
    ASSERT_EQ(scene.primvars.size(), 1u);
    EXPECT_EQ(scene.primvars[0].numChannels, 4);
    EXPECT_EQ(scene.primvars[0].values,
              (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 0.5f, 0.25f, 0, 1}));
}

TEST(PlyReader, ScalarNamedColorDoesNotMixWithColours) {
    std::string text = kPlyTriangle;
    text.replace(
        text.find("element face"), 0,
        "property float color\nproperty float red\nproperty float green\nproperty float blue\n");
    text.replace(text.find("0 0 0\n"), 18, "0 0 0 9 1 2 3\n1 0 0 9 4 5 6\n0 1 0 9 7 8 10\n");
    Scene scene;
    try {
        scene = ParsePly(text);
    } catch (Error const&) {
        return;  // to refuse it would be right too
    }
    size_t numValues = 0;
    for (auto const& primvar : scene.primvars) {
        EXPECT_EQ(primvar.values.size(), 3u * static_cast<size_t>(primvar.numChannels))
            << primvar.name;
        numValues += primvar.values.size();
    }
    EXPECT_EQ(numValues, 12u);  // one scalar and three colours at 3 vertices
}

TEST(PlyReader, ElementsItDoesNotKnowAreSkipped) {
    std::string text = kPlyTriangle;
    text.replace(text.find("element face"), 0,
                 "element camera 2\nproperty float f\nproperty list uchar int ids\n");
    text.replace(text.find("3 0 1 2\n"), 0, "1.5 2 7 7\n2.5 0\n");
    EXPECT_EQ(ParsePly(text).cage.faceVertices, (std::vector<Index>{0, 1, 2}));
}

TEST(PlyReader, NumbersDoNotDependOnTheLocale) {
    std::string text = kPlyTriangle;
    text.replace(text.find("1 0 0\n"), 5, "1.5 0 0");
    test::CommaLocale const commas;
    EXPECT_EQ(ParsePly(text).positions[3], 1.5);
}

// -------- refusals

TEST(PlyReader, TwoIndexListsAreRefusedOrRead) {
    std::string const text =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nproperty list uchar int "
        "vertex_index\n"
        "property list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 3 0 1 2 6 0 "
        "0 1 0 0 1\n";
    try {
        Scene const scene = ParsePly(text);
        EXPECT_EQ(scene.cage.faceVertices.size(), 3u);
        EXPECT_EQ(scene.cage.fvarChannels.at(0).valueIndices.size(), 3u);
    } catch (Error const& error) {
        EXPECT_EQ(error.GetCode(), ErrorCode::BadMesh);
    }
}

TEST(PlyReader, TexcoordListOfTheWrongLengthIsRefused) {
    std::string const message = RefusalOfPly(MakePair("6 0 0 1 0 1 1", "4 0 0 .5 .5"));
    EXPECT_EQ(message, "mesh.ply:16: list 'texcoord' has 4 numbers; 6 are needed");
}

TEST(PlyReader, NanInATexcoordIsRefused) {
    EXPECT_EQ(RefusalOfPly(MakePair("6 0 0 1 nan 1 1", "6 0 0 1 1 0 1")).find("mesh.ply:15: "), 0u);
}

TEST(PlyReader, HugeCountsInTheHeaderAreRefusedWithoutRoomForThem) {
    size_t const before = test::PeakMemory();
    for (std::string const format : {"ascii", "binary_little_endian"}) {
        for (std::string const count : {"100000000", "536870911"}) {
            std::string text = kPlyTriangle;
            text.replace(text.find("ascii"), 5, format);
            std::string huge = text;
            huge.replace(huge.find("vertex 3"), 8, "vertex " + count);
            EXPECT_NE(RefusalOfPly(huge), "") << format << " vertex " << count;
            huge = text;
            huge.replace(huge.find("face 1"), 6, "face " + count);
            EXPECT_NE(RefusalOfPly(huge), "") << format << " face " << count;
        }
    }
    EXPECT_LT(test::PeakMemory() - before, test::kModestMemory);
}

TEST(PlyReader, ManyPropertiesOfManyVerticesAreRefusedWithoutRoomForThem) {
    // 1000 properties of 100 000 vertices would take 100 MB in the file; it has 200 kB.
    std::string text =
        "ply\nformat binary_little_endian 1.0\nelement vertex 100000\n"
        "property float x\nproperty float y\nproperty float z\n";
    for (int i = 0; i < 1000; ++i) text += fmt::format("property char p{}\n", i);
    text += "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
            std::string(200000, '\0');
    size_t const before = test::PeakMemory();
    EXPECT_NE(RefusalOfPly(text), "");
    EXPECT_LT(test::PeakMemory() - before, test::kModestMemory);
}

TEST(PlyReader, HugeListInABinaryFileIsRefusedWithoutRoomForIt) {
    std::string header = kPlyTriangle.substr(0, kPlyTriangle.find("end_header\n") + 11);
    header.replace(header.find("ascii"), 5, "binary_little_endian");
    header.replace(header.find("list uchar"), 10, "list uint ");
    Bytes body(false);
    for (int i = 0; i < 9; ++i) body.Add(static_cast<float>(i));
    body.Add(900000000u).Add(0).Add(1).Add(2);
    size_t const before = test::PeakMemory();
    std::string const message = RefusalOfPly(header + body.GetText());
    EXPECT_NE(message.find("beyond the end of the file"), std::string::npos) << message;
    EXPECT_LT(test::PeakMemory() - before, test::kModestMemory);
}

TEST(PlyReader, ManyElementsAndPropertiesAreRefusedByNumber) {
    std::string elements = "ply\nformat ascii 1.0\n",
                properties = "ply\nformat ascii 1.0\nelement vertex 1\n";
    for (int i = 0; i < 100000; ++i) {
        elements += fmt::format("element e{} 0\n", i);
        properties += fmt::format("property float p{}\n", i);
    }
    EXPECT_NE(RefusalOfPly(elements).find("more than 4096 elements"), std::string::npos);
    EXPECT_NE(RefusalOfPly(properties).find("more than 4096 properties"), std::string::npos);
}

// -------- hostile bytes

TEST(PlyReader, DamagedFilesAreReadWholeOrRefusedAtALineOrElement) {
    for (std::string const& whole :
         {kPlyTriangle, MakeTyped(false), MakeTyped(true),
          MakePair("6 0 0 1 0 1 1", "6 0 0 1 1 0 1"), MakeStrips("9 0 1 2 3 -1 2 3 4 5"),
          MakeTextured("comment TextureFile a.png\n")}) {
        auto const counts = test::ReadDamaged(whole, 2000, "mesh.ply", ParsePly);
        EXPECT_GT(counts.numRead, 20) << whole;
        EXPECT_GT(counts.numRefused, 100) << whole;
    }
}

TEST(PlyReader, GarbageIsRefused) {
    std::string const header = kPlyTriangle.substr(0, kPlyTriangle.find("end_header\n") + 11);
    for (unsigned seed = 0; seed < 50; ++seed) {
        EXPECT_THROW(ParsePly(test::Garbage("", seed)), Error) << seed;
        EXPECT_THROW(ParsePly(test::Garbage("ply\n", seed)), Error) << seed;
        EXPECT_THROW(ParsePly(test::Garbage(header, seed)), Error) << seed;
    }
}

}  // namespace
}  // namespace limn
