// SPDX-License-Identifier: Apache-2.0
#include "engine/io/off_reader.h"

#include <gtest/gtest.h>

#include "support/readers.h"

namespace limn {
namespace {

using engine::Scene;
using test::kOffQuad;
using test::ParseOff;
using test::Refusal;
using test::RefusalOfOff;

TEST(OffReader, ReadsVerticesAndFaces) {
    Scene const scene = ParseOff(kOffQuad);
    EXPECT_EQ(scene.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}));
    EXPECT_EQ(scene.cage.numVertices, 4);
    EXPECT_EQ(scene.cage.faceSizes, (std::vector<Index>{4}));
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{0, 1, 2, 3}));
    EXPECT_EQ(scene.faceLines, (std::vector<uint32_t>{7}));
}

TEST(OffReader, CommentsEmptyLinesAndCountsBesideTheKeywordChangeNothing) {
    Scene const scene = ParseOff(
        "# made by hand\nOFF 4 1 # no edges given\n\n0 0 0\n1 0 0 # right\n\n1 1 0\n# between\n0 1 "
        "0\n4 0 1 2 3\n");
    EXPECT_EQ(scene.positions, ParseOff(kOffQuad).positions);
    EXPECT_EQ(scene.cage.faceVertices, ParseOff(kOffQuad).cage.faceVertices);
}

TEST(OffReader, CountsMayStickToTheKeyword) {
    std::string text = kOffQuad;
    text.erase(3, 1);  // OFF4 1 0
    EXPECT_EQ(ParseOff(text).cage.faceVertices, ParseOff(kOffQuad).cage.faceVertices);
    EXPECT_EQ(ParseOff("\xef\xbb\xbf" + text).positions, ParseOff(kOffQuad).positions);
}

TEST(OffReader, LinesBehindTheLastFaceAreWarnedOf) {
    Scene const scene = ParseOff(kOffQuad + "\n# end\n3 0 1 2\n4 3 2 1 0\n");
    EXPECT_EQ(scene.cage.faceSizes, (std::vector<Index>{4}));
    EXPECT_EQ(scene.warnings,
              (std::vector<std::string>{
                  "mesh.off:10: 2 lines behind the last face that the file counts, not read"}));
    EXPECT_TRUE(ParseOff(kOffQuad + "\n# end\n \n").warnings.empty());
}

TEST(OffReader, NumbersOfAVertexThatTheKeywordDoesNotNameAreWarnedOf) {
    Scene const scene = ParseOff("OFF\n3 1 0\n0 0 0\n1 0 0 9 9 9\n0 1 0 9 # a comment\n3 0 1 2\n");
    EXPECT_EQ(scene.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0].find("mesh.off:4: 2 lines of vertices with more than"), 0u)
        << scene.warnings[0];
    EXPECT_TRUE(ParseOff("OFF\n3 1 0\n0 0 0\n1 0 0 # 9\n0 1 0\n3 0 1 2\n").warnings.empty());
}

TEST(OffReader, ColoursOfFacesAreWarnedOf) {
    Scene const scene = ParseOff(
        "OFF\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 # red\n3 0 2 3 255 0 0\n3 0 1 3 7\n");
    EXPECT_EQ(scene.cage.faceSizes, (std::vector<int>{3, 3, 3}));
    EXPECT_EQ(scene.warnings, (std::vector<std::string>{
                                  "mesh.off:8: 2 lines of faces with more than their corners, as "
                                  "colours, which is not read; colours of vertices are (COFF)"}));
}

TEST(OffReader, NormalsAreSkipped) {
    Scene const scene = ParseOff("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
    EXPECT_EQ(scene.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
    EXPECT_TRUE(scene.primvars.empty());
}

TEST(OffReader, TextureCoordinatesOfStoffAreUVs) {
    Scene const scene = ParseOff("STOFF\n3 1 0\n0 0 0 .25 .5\n1 0 0 1 0\n0 1 0 0 1\n3 0 2 1\n");
    EXPECT_EQ(scene.uvs, (std::vector<double>{0.25, 0.5, 1, 0, 0, 1}));
    EXPECT_EQ(scene.cage.fvarChannels.at(0).numValues, 3);
    EXPECT_EQ(scene.cage.fvarChannels.at(0).valueIndices, (std::vector<Index>{0, 2, 1}));
}

// Geomview's order: position, normal, colour, texture coordinates.
TEST(OffReader, VerticesMayHaveAllAtOnce) {
    for (std::string const alpha : {"", " 1"}) {
        Scene const scene =
            ParseOff("STCNOFF\n3 1 0\n0 0 0 0 0 1 .5 0 0" + alpha + " .25 .5\n1 0 0 0 0 1 0 1 0" +
                     alpha + " 1 0\n0 1 0 0 0 1 0 0 1" + alpha + " 0 1\n3 0 1 2\n");
        EXPECT_EQ(scene.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
        EXPECT_EQ(scene.uvs, (std::vector<double>{0.25, 0.5, 1, 0, 0, 1}));
        EXPECT_EQ(scene.primvars.at(0).numChannels, alpha.empty() ? 3 : 4);
        EXPECT_EQ(scene.primvars.at(0).values[0], 0.5f);
    }
}

TEST(OffReader, CrlfAndMissingLastLineEndChangeNothing) {
    for (std::string const& text :
         {test::WithCrlf(kOffQuad), kOffQuad.substr(0, kOffQuad.size() - 1)}) {
        EXPECT_EQ(ParseOff(text).positions, ParseOff(kOffQuad).positions);
        EXPECT_EQ(ParseOff(text).cage.faceVertices, ParseOff(kOffQuad).cage.faceVertices);
    }
}

TEST(OffReader, FaceColoursAreSkipped) {
    Scene const scene = ParseOff(
        "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3 0.5 0.5 0.5 1\n");
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
}

TEST(OffReader, VertexColoursOfCoffArePrimvars) {
    Scene const scene =
        ParseOff("COFF\n3 1 0\n0 0 0 1 .5 .25 1\n1 0 0 0 0 0 1\n0 1 0 1 1 1 0\n3 0 1 2\n");
    ASSERT_EQ(scene.primvars.size(), 1u);
    EXPECT_EQ(scene.primvars[0].name, "color");
    EXPECT_EQ(scene.primvars[0].values,
              (std::vector<float>{1, 0.5f, 0.25f, 1, 0, 0, 0, 1, 1, 1, 1, 0}));
}

std::vector<float> ColoursOf(std::string const& first, std::string const& second) {
    return ParseOff("COFF\n3 1 0\n0 0 0 " + first + "\n1 0 0 " + second +
                    "\n0 1 0 0 0 0 0\n3 0 1 2\n")
        .primvars.at(0)
        .values;
}

// Bytes of a PLY become the same numbers: value * (1.0 / 255), rounded to float.
TEST(OffReader, WholeVertexColoursUpTo255BecomeSharesOf255) {
    auto const share = [](int byte) { return static_cast<float>(byte * (1.0 / 255)); };
    EXPECT_EQ(ColoursOf("255 128 0 255", "1 2 3 254"),
              (std::vector<float>{1, share(128), 0, 1, share(1), share(2), share(3), share(254), 0,
                                  0, 0, 0}));
}

TEST(OffReader, OtherVertexColoursStayAsTheyAre) {
    EXPECT_EQ(ColoursOf("1 0 0 1", "0 0 1 1"),
              (std::vector<float>{1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0}));  // 0 to 1
    EXPECT_EQ(ColoursOf("2 0.5 0 1", "0 0 1 1"),
              (std::vector<float>{2, 0.5f, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0}));  // brighter than white
    EXPECT_EQ(ColoursOf("256 0 0 1", "0 0 1 1"),
              (std::vector<float>{256, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0}));  // no bytes
    EXPECT_EQ(ColoursOf("-1 0 0 1", "0 0 2 1"),
              (std::vector<float>{-1, 0, 0, 1, 0, 0, 2, 1, 0, 0, 0, 0}));
}

TEST(OffReader, NumbersDoNotDependOnTheLocale) {
    test::CommaLocale const commas;
    Scene const scene = ParseOff("OFF\n3 1 0\n1.5 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_EQ(scene.positions[0], 1.5);
}

class OffRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(OffRefusal, NamesLineReasonAndRemedy) {
    test::ExpectRefusal(GetParam(), RefusalOfOff(GetParam().text));
}

std::string const kPoints = "0 0 0\n1 0 0\n0 1 0\n";

INSTANTIATE_TEST_SUITE_P(
    Of, OffRefusal,
    testing::Values(
        Refusal{"Empty", "", "mesh.off:", {"ends before the keyword OFF"}},
        Refusal{"WrongKeyword", "NOF\n", "mesh.off:1: ", {"'NOF'", "is needed"}},
        Refusal{"Homogeneous", "4OFF\n3 1 0\n", "mesh.off:1: ", {"4OFF", "homogeneous"}},
        Refusal{"HomogeneousColoured", "C4OFF\n3 1 0\n", "mesh.off:1: ", {"4OFF"}},
        Refusal{"AnyDimension", "nOFF\n3\n3 1 0\n", "mesh.off:1: ", {"nOFF", "dimension"}},
        Refusal{"NormalThatIsMissing",
                "NOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                "mesh.off:3: ",
                {"a normal is missing"}},
        Refusal{"Binary", "OFF BINARY\n", "mesh.off:1: ", {"'BINARY'"}},
        Refusal{"NoCounts", "OFF\n", "mesh.off:1: ", {"ends before the counts"}},
        Refusal{"OneCount", "OFF\n3\n", "mesh.off:2: ", {"number of faces is missing"}},
        Refusal{
            "NegativeCount", "OFF\n-3 1 0\n", "mesh.off:2: ", {"number of vertices is -3", "0 to"}},
        Refusal{"CountWithAFraction", "OFF\n3.5 1 0\n", "mesh.off:2: ", {"3.5"}},
        Refusal{"CountBeyond32Bits", "OFF\n3 99999999999 0\n", "mesh.off:2: ", {"number of faces"}},
        Refusal{"NoFaces", "OFF\n3 0 0\n" + kPoints, "mesh.off:2: ", {"no faces"}},
        Refusal{"HugeCount",
                "OFF\n500000000 1 0\n" + kPoints + "3 0 1 2\n",
                "mesh.off:2: ",
                {"too short for 500000000"}},
        Refusal{"MissingFace",
                "OFF\n3 2 0\n" + kPoints + "3 0 1 2\n",
                "mesh.off:6: ",
                {"ends before face 1 of 2"}},
        Refusal{"NotANumber",
                "OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n",
                "mesh.off:4: ",
                {"y is 'x'"}},
        Refusal{"Nan",
                "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 nan\n3 0 1 2\n",
                "mesh.off:5: ",
                {"z is 'nan'", "finite"}},
        Refusal{"Infinity",
                "OFF\n3 1 0\ninf 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                "mesh.off:3: ",
                {"x is 'inf'"}},
        Refusal{"IndexTooLarge",
                "OFF\n3 1 0\n" + kPoints + "3 0 1 3\n",
                "mesh.off:6: ",
                {"vertex 3", "0 to 2"}},
        Refusal{"NegativeIndex",
                "OFF\n3 1 0\n" + kPoints + "3 0 1 -1\n",
                "mesh.off:6: ",
                {"vertex -1", "0 to 2"}},
        Refusal{"TwoCorners",
                "OFF\n3 1 0\n" + kPoints + "2 0 1\n",
                "mesh.off:6: ",
                {"2 corners", "at least 3"}},
        Refusal{
            "MissingCorner", "OFF\n3 1 0\n" + kPoints + "4 0 1 2\n", "mesh.off:6: ", {"missing"}},
        Refusal{"HugeFace",
                "OFF\n3 1 0\n" + kPoints + "500000000 0 1 2\n",
                "mesh.off:6: ",
                {"missing"}}),
    [](testing::TestParamInfo<Refusal> const& instance) { return instance.param.name; });

TEST(OffReader, HugeCountsAreRefusedWithoutRoomForThem) {
    size_t const before = test::PeakMemory();
    EXPECT_NE(RefusalOfOff("OFF\n536870911 536870911 0\n" + kPoints), "");
    EXPECT_NE(RefusalOfOff("OFF\n3 1 0\n" + kPoints + "536870911 0 1 2\n"), "");
    EXPECT_LT(test::PeakMemory() - before, test::kModestMemory);
}

TEST(OffReader, DamagedFilesAreReadWholeOrRefusedAtALine) {
    for (std::string const& whole :
         {kOffQuad, std::string("STCNOFF3 1 0\n0 0 0 0 0 1 1 0 0 0 0\n1 0 0 0 0 1 0 1 0 1 0\n"
                                "0 1 0 0 0 1 0 0 1 0 1\n3 0 1 2\n")}) {
        auto const counts = test::ReadDamaged(whole, 2000, "mesh.off", ParseOff);
        EXPECT_GT(counts.numRead, 100);
        EXPECT_GT(counts.numRefused, 100);
    }
}

TEST(OffReader, GarbageIsRefused) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        EXPECT_THROW(ParseOff(test::Garbage("", seed)), Error) << seed;
        EXPECT_THROW(ParseOff(test::Garbage("OFF\n4 1 0\n", seed)), Error) << seed;
    }
}

}  // namespace
}  // namespace limn
