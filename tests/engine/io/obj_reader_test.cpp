// SPDX-License-Identifier: Apache-2.0
#include "engine/io/obj_reader.h"

#include <algorithm>
#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "far_ext/topology/control_mesh.h"
#include "support/readers.h"

namespace limn {
namespace {

using engine::Scene;
using test::kObjQuad;
using test::kObjQuadVertices;
using test::ParseObj;

void ExpectSameMesh(Scene const& a, Scene const& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.uvs, b.uvs);
    EXPECT_EQ(a.cage.numVertices, b.cage.numVertices);
    EXPECT_EQ(a.cage.faceSizes, b.cage.faceSizes);
    EXPECT_EQ(a.cage.faceVertices, b.cage.faceVertices);
    ASSERT_EQ(a.cage.fvarChannels.size(), b.cage.fvarChannels.size());
    for (size_t i = 0; i < a.cage.fvarChannels.size(); ++i) {
        EXPECT_EQ(a.cage.fvarChannels[i].valueIndices, b.cage.fvarChannels[i].valueIndices);
    }
}

// -------- geometry

TEST(ObjReader, ReadsPositionsFacesAndTheirLines) {
    Scene const scene = ParseObj(
        "# a comment\n\nmtllib x.mtl\nv 1 2 3\nv .5 -.5e1 +7 # here too\nv 4 5 6\nvn 0 0 1\nf 1 2 "
        "3\n");
    EXPECT_EQ(scene.positions, (std::vector<double>{1, 2, 3, 0.5, -5, 7, 4, 5, 6}));
    EXPECT_EQ(scene.cage.numVertices, 3);
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{0, 1, 2}));
    EXPECT_EQ(scene.faceLines, (std::vector<uint32_t>{8}));
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(ObjReader, NegativeIndicesCountBackFromTheirOwnLine) {
    // The first face sees 3 vertices, so -1 is vertex 2; the second sees 5, so -1 is vertex 4.
    Scene const scene = ParseObj(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf -3/-1 -2/-1 -1/-1\nv 0 0 1\nv 0 0 2\nvt 1 1\nf -1/-1 "
        "-2/-2 1/1\n");
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{0, 1, 2, 4, 3, 0}));
    EXPECT_EQ(scene.cage.fvarChannels.at(0).valueIndices, (std::vector<Index>{0, 0, 0, 1, 0, 0}));
}

TEST(ObjReader, CrlfLineEndsChangeNothing) {
    std::string const text =
        kObjQuadVertices +
        "vt 0 0\nvt 1 0\nusemtl red\nf 1/1 2/2 3/2 4/1\nt crease 2/1/0 0 1 2.5\n";
    Scene const unix = ParseObj(text), dos = ParseObj(test::WithCrlf(text));
    ExpectSameMesh(unix, dos);
    EXPECT_EQ(dos.groups[0].names, (std::vector<std::string>{"red"}));
    EXPECT_EQ(dos.cage.creaseSharpness, unix.cage.creaseSharpness);
    EXPECT_EQ(dos.faceLines, unix.faceLines);
}

TEST(ObjReader, LastLineNeedsNoLineEnd) {
    ExpectSameMesh(ParseObj(kObjQuad), ParseObj(kObjQuad.substr(0, kObjQuad.size() - 1)));
}

TEST(ObjReader, Utf8ByteOrderMarkHidesNoVertex) {
    ExpectSameMesh(ParseObj(kObjQuad), ParseObj("\xef\xbb\xbf" + kObjQuad));
}

TEST(ObjReader, KeepsPolygonsOfAnySize) {
    std::string text = "f -1 -2 -3\nf -1 -2 -3 -4\nf";
    for (int i = 1; i <= 7; ++i) {
        text = fmt::format("v {} 0 0\n", i) + text;
        text += fmt::format(" {}", i);
    }
    Scene const scene = ParseObj(text + "\n");
    EXPECT_EQ(scene.cage.faceSizes, (std::vector<Index>{3, 4, 7}));
    EXPECT_EQ(scene.cage.faceVertices.size(), 14u);
    EXPECT_NO_THROW(far_ext::Validate(scene.cage));
}

TEST(ObjReader, ALineOfAMegabyteIsOneFace) {
    constexpr int kCorners = 150000;  // 6 digits and a space each: more than 1 MB
    std::string text, face = "f";
    for (int i = 1; i <= kCorners; ++i) {
        text += "v 0 0 0\n";
        face += fmt::format(" {:06}", i);
    }
    ASSERT_GT(face.size(), 1u << 20);
    Scene const scene = ParseObj(text + face + "\n");
    ASSERT_EQ(scene.cage.faceSizes, (std::vector<Index>{kCorners}));
    EXPECT_EQ(scene.cage.faceVertices.back(), kCorners - 1);
}

TEST(ObjReader, NumbersDoNotDependOnTheLocale) {
    test::CommaLocale const commas;
    Scene const scene = ParseObj("v 1.5 2.25 3.125\n" + kObjQuad);
    EXPECT_EQ(scene.positions[0], 1.5);
    EXPECT_EQ(scene.positions[2], 3.125);
}

TEST(ObjReader, AnyLineEndChangesNothing) {
    for (std::string const end : {"\r", "\n\r"}) {
        Scene const other =
            ParseObj(std::regex_replace(kObjQuad + kObjQuad, std::regex("\n"), end));
        ExpectSameMesh(ParseObj(kObjQuad + kObjQuad), other);
        EXPECT_EQ(other.faceLines, (std::vector<uint32_t>{5, 10}));
    }
}

TEST(ObjReader, LinesJoinedByBackslashesAreOneFaceAndKeepTheirNumbers) {
    Scene const scene = ParseObj(kObjQuadVertices +
                                 "f 1 2 \\\n 3\\\n4\n# C:\\\nf 1 2 3\nt crease \\\n2/1/0 0 1 2\n");
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{0, 1, 2, 3, 0, 1, 2}));
    EXPECT_EQ(scene.faceLines, (std::vector<uint32_t>{5, 9}));
    EXPECT_EQ(scene.cage.creaseSharpness, (std::vector<float>{2}));
}

TEST(ObjReader, FreeFormGeometryIsNamedInOneWarning) {
    Scene const scene = ParseObj(kObjQuad + "vp 0 0\ncstype bspline\ncurv 0 1 1 2\nvp 1 1\n");
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0],
              "mesh.obj:6: curves and surfaces in free form have no effect (export polygons): "
              "4 lines ('vp', 'cstype', 'curv')");
}

TEST(ObjReader, WhatStandsInOtherFilesIsNamed) {
    Scene const scene = ParseObj(kObjQuad + "call part.obj\ncsh -cat part.obj\n");
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0],
              "mesh.obj:6: what stands in other files is not read: 2 lines ('call', 'csh')");
}

TEST(ObjReader, WordsThatObjDoesNotHaveAreNamedInOneWarning) {
    std::string text = kObjQuad + "vt 0 0\nvn 0 0 1\ns off\nl 1 2\np 1\nmtllib a.mtl\nvf 1 2 3\n";
    for (int i = 0; i < 20; ++i) text += fmt::format("word{} 1\n", i);
    Scene const scene = ParseObj(text);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0],
              "mesh.obj:12: OBJ has no such statement, so it has no effect: 21 lines ('vf', "
              "'word0', 'word1', 'word2', 'word3', 'word4', ...)");
}

// -------- colours

TEST(ObjReader, ColoursBehindPositionsBecomeAPrimvar) {
    Scene const scene =
        ParseObj("v 0 0 0 1 0.5 0.25\nv 1 0 0 0 0 0 # black\nv 0 1 0 1 1 1\nf 1 2 3\n");
    ASSERT_EQ(scene.primvars.size(), 1u);
    EXPECT_EQ(scene.primvars[0].name, "color");
    EXPECT_EQ(scene.primvars[0].numChannels, 3);
    EXPECT_EQ(scene.primvars[0].values, (std::vector<float>{1, 0.5f, 0.25f, 0, 0, 0, 1, 1, 1}));
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(ObjReader, ColoursMayHaveAnAlphaOrBeBytes) {
    auto const colours = [](std::string const& first) {
        return ParseObj("v 0 0 0 " + first + "\nv 1 0 0 " + first + "\nv 0 1 0 " + first +
                        "\nf 1 2 3\n")
            .primvars.at(0);
    };
    EXPECT_EQ(colours("0 0.5 1 0.25").numChannels, 4);
    EXPECT_EQ(colours("0 0.5 1 0.25").values[3], 0.25f);
    EXPECT_EQ(colours("255 51 0").values[1], 0.2f);  // 51/255
}

TEST(ObjReader, AWeightBehindAPositionIsNoColour) {
    Scene const scene = ParseObj("v 0 0 0 1\nv 1 0 0 1.0\nv 0 1 0 0.5\nf 1 2 3\n");
    EXPECT_TRUE(scene.primvars.empty());
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(ObjReader, ColoursOfSomeVerticesAreLeftOutAndAWarningSaysSo) {
    Scene const scene = ParseObj("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_TRUE(scene.primvars.empty());
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("2 of 3 vertices have no colour"), std::string::npos);
}

TEST(ObjReader, WhatIsNoColourBehindAPositionIsNamedInOneWarning) {
    Scene const scene = ParseObj("v 0 0 0 what\nv 1 0 0 1 2\nv 0 1 0\nf 1 2 3\n");
    EXPECT_TRUE(scene.primvars.empty());
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("mesh.obj:1: what stands behind x, y and z of 2 vertices"),
              std::string::npos)
        << scene.warnings[0];
}

// -------- texture coordinates

TEST(ObjReader, TextureCoordinatesAreOptional) {
    Scene const scene = ParseObj(kObjQuadVertices + "vt 0 0\nf 1 2 3\nf 1//1 2//1 4//1\n");
    EXPECT_FALSE(scene.HasUVs());
    EXPECT_TRUE(scene.cage.fvarChannels.empty());
}

TEST(ObjReader, CornersNameTextureCoordinatesWithOrWithoutNormals) {
    Scene const scene = ParseObj(
        kObjQuadVertices + "vt 0 0.25\nvt 1 0 9\nvt 0.5\nf 1/1 2/2 3/3\nf 1/3/7 3/2/7 4/1/7\n");
    EXPECT_EQ(scene.uvs,
              (std::vector<double>{0, 0.25, 1, 0, 0.5, 0}));  // w is dropped, v defaults to 0
    EXPECT_EQ(scene.cage.fvarChannels.at(0).numValues, 3);
    EXPECT_EQ(scene.cage.fvarChannels.at(0).valueIndices, (std::vector<Index>{0, 1, 2, 2, 1, 0}));
}

TEST(ObjReader, CommentMayFollowALoneTextureCoordinate) {
    Scene const scene = ParseObj(kObjQuadVertices + "vt 0.5 # u only\nf 1/1 2/1 3/1\n");
    EXPECT_EQ(scene.uvs, (std::vector<double>{0.5, 0}));
}

TEST(ObjReader, FacesWithoutTextureIndicesLeaveThoseOfTheOthers) {
    Scene const scene = ParseObj(kObjQuadVertices + "vt 0 0.5\nf 1/1 2/1 3/1\nf 1 3 4\n");
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_TRUE(scene.HasUVs());
    EXPECT_TRUE(scene.HasUVs(0));
    EXPECT_FALSE(scene.HasUVs(1));
    // What stands for none lies where a value is.
    EXPECT_EQ(scene.uvs, (std::vector<double>{0, 0.5, 0, 0.5}));
    EXPECT_EQ(scene.cage.fvarChannels.at(0).numValues, 2);
    EXPECT_EQ(scene.cage.fvarChannels.at(0).valueIndices, (std::vector<Index>{0, 0, 0, 1, 1, 1}));
}

TEST(ObjReader, WhereAllOrNoFacesHaveTextureIndicesNoneIsMarked) {
    for (char const* faces : {"f 1/1 2/1 3/1\nf 1/1 3/1 4/1\n", "f 1 2 3\nf 1 3 4\n"}) {
        Scene const scene = ParseObj(kObjQuadVertices + "vt 0 0.5\n" + faces);
        EXPECT_TRUE(scene.lacksUVs.empty()) << faces;
        EXPECT_EQ(scene.HasUVs(1), scene.HasUVs()) << faces;
    }
}

// -------- groups

TEST(ObjReader, KeepsGroupsOfAllThreeKinds) {
    Scene const scene =
        ParseObj(kObjQuadVertices +
                 "f 1 2 3\no body\nusemtl red\nf 1 2 3\ng left side\nf 1 2 4\nusemtl "
                 "blue\ng\nf 1 3 4\nusemtl red\nf 2 3 4\n");
    auto const& [materials, groups, objects] = scene.groups;
    EXPECT_EQ(materials.names, (std::vector<std::string>{"red", "blue"}));
    EXPECT_EQ(materials.faceGroup, (std::vector<Index>{-1, 0, 0, 1, 0}));
    EXPECT_EQ(groups.names, (std::vector<std::string>{"left side"}));
    EXPECT_EQ(groups.faceGroup, (std::vector<Index>{-1, -1, 0, -1, -1}));
    EXPECT_EQ(objects.faceGroup, (std::vector<Index>{-1, 0, 0, 0, 0}));
}

TEST(ObjReader, SelectsTheFacesOfNamedGroups) {
    Scene const scene =
        ParseObj(kObjQuadVertices + "usemtl red\nf 1 2 3\ng left\nf 1 2 4\nusemtl blue\nf 1 3 4\n");
    EXPECT_EQ(engine::SelectGroups(scene, {"red"}), (std::vector<char>{1, 1, 0}));
    EXPECT_EQ(engine::SelectGroups(scene, {"left"}), (std::vector<char>{0, 1, 1}));
}

// `g` takes several names; materials and objects have one, which may hold blanks.
TEST(ObjReader, AFaceIsInEachOfTheGroupsNamedAfterG) {
    Scene const scene =
        ParseObj(kObjQuadVertices +
                 "g left arm\nf 1 2 3\ng left\nf 1 2 4\ng arm\tright\nusemtl dark blue\nf 1 3 4\n");
    EXPECT_EQ(engine::SelectGroups(scene, {"left"}), (std::vector<char>{1, 1, 0}));
    EXPECT_EQ(engine::SelectGroups(scene, {"arm"}), (std::vector<char>{1, 0, 1}));
    EXPECT_EQ(engine::SelectGroups(scene, {"right", "dark blue"}), (std::vector<char>{0, 0, 1}));
    EXPECT_EQ(engine::ListGroups(scene),
              (std::vector<std::string>{"dark blue", "left", "arm", "right"}));
    EXPECT_FALSE(test::RefusalOf([&] { engine::SelectGroups(scene, {"left arm"}); }).empty());
}

TEST(ObjReader, UnknownGroupIsRefusedWithTheNamesThereAre) {
    Scene const scene = ParseObj(kObjQuadVertices + "usemtl red\nf 1 2 3\ng left\nf 1 2 4\n");
    EXPECT_EQ(test::RefusalOf([&] { engine::SelectGroups(scene, {"green"}); }),
              "`groups`: 'mesh.obj' has no group 'green'; it has: red, left");
}

TEST(ObjReader, GroupDeclaredAfterTheLastFaceHoldsNoFace) {
    Scene const scene = ParseObj(kObjQuad + "usemtl late\n");
    EXPECT_EQ(engine::SelectGroups(scene, {"late"}), (std::vector<char>{0}));
}

// -------- tags

TEST(ObjReader, CreaseTagNamesOneEdge) {
    Scene const scene = ParseObj(kObjQuad + "t crease 2/1/0 0 1 2.5\nt crease 2/1/0 3 2 10\n");
    EXPECT_EQ(scene.cage.creaseVertexPairs, (std::vector<Index>{0, 1, 3, 2}));
    EXPECT_EQ(scene.cage.creaseSharpness, (std::vector<float>{2.5f, 10.0f}));
}

TEST(ObjReader, CreaseChainSharesItsSharpness) {
    Scene const scene = ParseObj(kObjQuad + "t crease 4/1/0 0 1 2 3 1.5\n");
    EXPECT_EQ(scene.cage.creaseVertexPairs, (std::vector<Index>{0, 1, 1, 2, 2, 3}));
    EXPECT_EQ(scene.cage.creaseSharpness, (std::vector<float>{1.5f, 1.5f, 1.5f}));
}

TEST(ObjReader, CreaseChainMayHaveASharpnessForEachEdge) {
    Scene const scene = ParseObj(kObjQuad + "t crease 4/3/0 0 1 2 3 1 2 3\n");
    EXPECT_EQ(scene.cage.creaseSharpness, (std::vector<float>{1, 2, 3}));
}

TEST(ObjReader, CornerTagNamesOneVertexOrMore) {
    Scene const scene =
        ParseObj(kObjQuad + "t corner 1/1/0 3 2\nt corner 2/1/0 0 1 4\nt corner 2/2/0 1 2 5 6\n");
    EXPECT_EQ(scene.cage.cornerVertices, (std::vector<Index>{3, 0, 1, 1, 2}));
    EXPECT_EQ(scene.cage.cornerSharpness, (std::vector<float>{2, 4, 4, 5, 6}));
}

TEST(ObjReader, ValuesThatATagDoesNotTakeAreWarnedOf) {
    Scene const scene = ParseObj(kObjQuad + "t crease 2/1/0 0 1 2.5 7 # 8\nt hole 1/0/0 0 1\n");
    EXPECT_EQ(scene.cage.creaseVertexPairs, (std::vector<Index>{0, 1}));
    EXPECT_EQ(scene.warnings,
              (std::vector<std::string>{"mesh.obj:6: 2 lines ('crease', 'hole') of tags with more "
                                        "values than they take, which are not read"}));
    EXPECT_TRUE(ParseObj(kObjQuad + "t crease 2/1/0 0 1 2.5 # 7\n").warnings.empty());
}

TEST(ObjReader, HoleTagNamesFacesByZeroBasedIndex) {
    Scene const scene = ParseObj(kObjQuad + "f 1 2 3\nf 1 3 4\nt hole 1/0/0 2\nt hole 2/0/0 0 1\n");
    EXPECT_EQ(scene.cage.holes, (std::vector<Index>{2, 0, 1}));
}

TEST(ObjReader, TagsMayStandBeforeWhatTheyName) {
    Scene const scene =
        ParseObj("t crease 2/1/0 0 1 2\nt corner 1/1/0 3 2\nt hole 1/0/0 0\n" + kObjQuad);
    EXPECT_EQ(scene.cage.creaseSharpness.size(), 1u);
    EXPECT_EQ(scene.cage.holes, (std::vector<Index>{0}));
}

TEST(ObjReader, BoundaryTagSetsTheBoundaryRule) {
    // The tag: 0 none, 1 edge and corner, 2 edge only.
    for (auto const& [value, rule] : {std::pair{0, Sdc::Options::VTX_BOUNDARY_NONE},
                                      {1, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER},
                                      {2, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY}}) {
        Scene const scene =
            ParseObj(kObjQuad + fmt::format("t interpolateboundary 1/0/0 {}\n", value));
        EXPECT_EQ(scene.cage.options.GetVtxBoundaryInterpolation(), rule) << value;
        EXPECT_TRUE(scene.hasBoundaryTag);
    }
}

TEST(ObjReader, FaceVaryingTagSetsTheFaceVaryingRule) {
    // The tag: 0 none, 1 corners only, 2 corners plus1, 3 corners plus2, 4 boundaries, 5 all.
    Sdc::Options::FVarLinearInterpolation const rules[] = {
        Sdc::Options::FVAR_LINEAR_NONE,          Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
        Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2,
        Sdc::Options::FVAR_LINEAR_BOUNDARIES,    Sdc::Options::FVAR_LINEAR_ALL};
    for (int value = 0; value < 6; ++value) {
        Scene const scene =
            ParseObj(kObjQuad + fmt::format("t facevaryinginterpolateboundary 1/0/0 {}\n", value));
        EXPECT_EQ(scene.cage.options.GetFVarLinearInterpolation(), rules[value]) << value;
        EXPECT_TRUE(scene.hasFVarTag);
    }
}

TEST(ObjReader, CreaseMethodTagSetsTheCreaseRule) {
    EXPECT_EQ(
        ParseObj(kObjQuad + "t creasemethod 0/0/1 chaikin\n").cage.options.GetCreasingMethod(),
        Sdc::Options::CREASE_CHAIKIN);
    EXPECT_EQ(ParseObj(kObjQuad + "t creasemethod 0/0/1 normal\n").cage.options.GetCreasingMethod(),
              Sdc::Options::CREASE_UNIFORM);
}

TEST(ObjReader, SmoothTrianglesTagSetsTheTriangleRule) {
    EXPECT_EQ(ParseObj(kObjQuad + "t smoothtriangles 0/0/1 smooth\n")
                  .cage.options.GetTriangleSubdivision(),
              Sdc::Options::TRI_SUB_SMOOTH);
    EXPECT_EQ(ParseObj(kObjQuad + "t smoothtriangles 0/0/1 catmark\n")
                  .cage.options.GetTriangleSubdivision(),
              Sdc::Options::TRI_SUB_CATMARK);
}

TEST(ObjReader, FileWithoutTagsHasTheDefaultRules) {
    Scene const scene = ParseObj(kObjQuad);
    EXPECT_EQ(scene.cage.options.GetVtxBoundaryInterpolation(),
              Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    EXPECT_EQ(scene.cage.options.GetFVarLinearInterpolation(),
              Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1);
    EXPECT_FALSE(scene.hasBoundaryTag);
    EXPECT_FALSE(scene.hasFVarTag);
}

TEST(ObjReader, TagsItCannotHonourAreNamedInWarnings) {
    Scene const scene = ParseObj(kObjQuad +
                                 "t vertexedit 2/3/2 0 1 1 2 3 a b\nt edgeedit 1/1/1 x\nt faceedit "
                                 "1/1/1 x\nt sparkle 1/0/0 3\n");
    ASSERT_EQ(scene.warnings.size(), 4u);
    size_t line = 6;
    for (std::string const name : {"vertexedit", "edgeedit", "faceedit", "sparkle"}) {
        std::string const& warning = scene.warnings[line - 6];
        EXPECT_EQ(warning.find(fmt::format("mesh.obj:{}: ", line)), 0u) << warning;
        EXPECT_NE(warning.find(name), std::string::npos) << warning;
        ++line;
    }
}

TEST(ObjReader, TagsWithoutAnEffectMakeFewWarningsHoweverManyThereAre) {
    std::string text = kObjQuad;
    for (int i = 0; i < 1000; ++i) text += fmt::format("t sparkle 1/0/0 3\nt tag{} 1/0/0 3\n", i);
    Scene const scene = ParseObj(text);
    EXPECT_LT(scene.warnings.size(), 20u);
    EXPECT_EQ(scene.warnings.at(0),
              "mesh.obj:6: tag 'sparkle' is not known and has no effect, nor have 999 more");
}

// Looking a name up among all others, or all faces up for each name, would take minutes.
TEST(ObjReader, ManyGroupsTakeTimeInProportion) {
    constexpr int kCount = 100000;
    std::string text = kObjQuadVertices;
    for (int i = 0; i < kCount; ++i) text += fmt::format("g all part{}\nf 1 2 3\n", i);
    Scene const scene = ParseObj(text);
    EXPECT_EQ(engine::ListGroups(scene).size(), kCount + 1u);
    auto const selected = engine::SelectGroups(scene, {"all"});
    EXPECT_EQ(std::count(selected.begin(), selected.end(), 1), kCount);
    EXPECT_EQ(engine::SelectGroups(scene, {"part7"})[7], 1);
}

// -------- hostile bytes

TEST(ObjReader, DamagedFilesAreReadWholeOrRefusedAtALine) {
    std::string const whole =
        kObjQuadVertices +
        "vt 0 0\nvt 1 0\nvt 1 1\nusemtl a\ng b\nf 1/1 2/2 3/3\nf -4/1/1 -2/2/2 -1/3/3\nt crease "
        "3/2/0 0 1 2 1 "
        "2\nt corner 1/1/0 3 2\nt hole 1/0/0 1\nt interpolateboundary 1/0/0 2\n";
    auto const counts = test::ReadDamaged(whole, 2000, "mesh.obj", ParseObj);
    EXPECT_GT(counts.numRead, 100);
    EXPECT_GT(counts.numRefused, 100);
}

TEST(ObjReader, GarbageIsRefused) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        for (std::string const& beginning :
             {std::string(), std::string("v 0 0 0\nf "), std::string("t crease ")}) {
            EXPECT_THROW(ParseObj(test::Garbage(beginning, seed)), Error) << seed;
        }
    }
}

}  // namespace
}  // namespace limn
