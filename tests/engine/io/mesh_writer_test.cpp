// SPDX-License-Identifier: Apache-2.0
#include "engine/io/mesh_writer.h"

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "engine/io/mesh_reader.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/readers.h"

namespace limn {
namespace {

using engine::Scene;

/// Writes a scene and reads it back.
Scene RoundTrip(Scene const& scene, std::string const& name, Precision precision) {
    test::TemporaryFolder const folder;
    engine::WriteMesh(folder / name, scene, precision);
    EXPECT_EQ(folder.List(), (std::vector<std::string>{name}));
    return engine::ReadMesh(folder / name);
}

/// Same bits: tells -0 from 0, which == does not.
void ExpectSameBits(std::vector<double> const& a, std::vector<double> const& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(std::bit_cast<uint64_t>(a[i]), std::bit_cast<uint64_t>(b[i]))
            << "value " << i << ": " << a[i] << " " << b[i];
    }
}

std::vector<double> AsFloats(std::vector<double> values) {
    for (double& value : values) value = static_cast<double>(static_cast<float>(value));
    return values;
}

/// Corner for corner the same texture coordinates, however they are shared.
void ExpectSameCornerUVs(Scene const& a, Scene const& b) {
    auto const& p = a.cage.fvarChannels.at(0).valueIndices;
    auto const& q = b.cage.fvarChannels.at(0).valueIndices;
    ASSERT_EQ(p.size(), q.size());
    for (size_t corner = 0; corner < p.size(); ++corner) {
        for (int c = 0; c < 2; ++c)
            ASSERT_EQ(a.uvs[2 * p[corner] + c], b.uvs[2 * q[corner] + c]) << corner;
    }
}

/// Numbers no short decimal hits: random mantissas over many magnitudes, and the edges of the
/// range.
Scene MakeAwkward(Precision precision) {
    bool const isDouble = precision == Precision::Double;
    Scene scene = test::MakeTorus(8, 6);
    std::mt19937_64 random(7);
    auto const number = [&] {
        double const x =
            std::ldexp(static_cast<double>(random() >> 11), static_cast<int>(random() % 60) - 83);
        return random() % 2 ? x : -x;
    };
    for (double& value : scene.positions) value = number();
    for (double& value : scene.uvs) value = std::abs(number());
    using Float = std::numeric_limits<float>;
    using Double = std::numeric_limits<double>;
    std::vector<double> const edges =
        isDouble ? std::vector<double>{1e30, Double::min(), -0.0, 1.0 / 3, 5e-324, 0.1}
                 : std::vector<double>{9.99e29f, Float::min(),        -0.0,
                                       1.0f / 3, Float::denorm_min(), 0.1f};
    std::copy(edges.begin(), edges.end(), scene.positions.begin());
    if (!isDouble) {
        scene.positions = AsFloats(scene.positions);
        scene.uvs = AsFloats(scene.uvs);
    }
    return scene;
}

class WrittenMesh : public testing::TestWithParam<std::tuple<std::string, Precision>> {};

TEST_P(WrittenMesh, ReadsBackAsTheSameNumbers) {
    auto const& [ending, precision] = GetParam();
    Scene const scene = MakeAwkward(precision);
    Scene back = RoundTrip(scene, "mesh" + ending, precision);
    if (precision == Precision::Float) {  // digits of a float name a double beside it; as floats
                                          // the two are the same
        back.positions = AsFloats(back.positions);
        back.uvs = AsFloats(back.uvs);
    }
    ExpectSameBits(scene.positions, back.positions);
    ExpectSameCornerUVs(scene, back);
    EXPECT_EQ(scene.cage.faceVertices, back.cage.faceVertices);
    EXPECT_EQ(scene.cage.faceSizes, back.cage.faceSizes);
}

TEST_P(WrittenMesh, IsTheSameInEveryLocale) {
    auto const& [ending, precision] = GetParam();
    test::TemporaryFolder const folder;
    Scene const scene = MakeAwkward(precision);
    engine::WriteMesh(folder / "a" + ending, scene, precision);
    {
        test::CommaLocale const commas;
        engine::WriteMesh(folder / "b" + ending, scene, precision);
    }
    EXPECT_EQ(test::ReadText(folder / "a" + ending), test::ReadText(folder / "b" + ending));
}

INSTANTIATE_TEST_SUITE_P(Format, WrittenMesh,
                         testing::Combine(testing::Values(".obj", ".ply"),
                                          testing::Values(Precision::Float, Precision::Double)),
                         [](auto const& instance) {
                             return std::get<0>(instance.param).substr(1) +
                                    (std::get<1>(instance.param) == Precision::Double ? "Double"
                                                                                      : "Float");
                         });

TEST(MeshWriter, FloatOutputRoundsToTheNearestFloat) {
    Scene scene = test::MakeCube();
    scene.positions[0] = 0.1;
    for (std::string const name : {"a.obj", "a.ply"}) {
        EXPECT_EQ(static_cast<float>(RoundTrip(scene, name, Precision::Float).positions[0]), 0.1f)
            << name;
    }
}

TEST(MeshWriter, NumberBeyondFloatIsRefusedRatherThanWrittenAsInfinity) {
    Scene scene = test::MakeCube();
    scene.positions[4] = 1e300;
    for (std::string const name : {"a.obj", "a.ply"}) {
        test::TemporaryFolder const folder;
        std::string const path = folder / name;
        EXPECT_EQ(test::RefusalOf([&] { engine::WriteMesh(path, scene, Precision::Float); }),
                  "'" + path +
                      "': position of vertex 1 is 1e+300, and a float at most 3.40282e+38; use "
                      "`precision` double");
        EXPECT_TRUE(folder.List().empty()) << name;
    }
}

TEST(MeshWriter, SceneWhosePartsDoNotBelongTogetherIsRefused) {
    struct Case {
        void (*damage)(Scene&);
        std::string refusal;
    };
    std::vector<Case> const cases{
        {[](Scene& s) { s.positions[7] = std::nan(""); },
         "position of vertex 2 is nan; a finite number is needed"},
        {[](Scene& s) { s.positions.resize(2); }, "positions: 2 values; 72 are needed"},
        {[](Scene& s) { s.cage.faceVertices[2] = 1 << 20; },
         "face 0 uses vertex 1048576; there are 24 vertices"},
        {[](Scene& s) { s.cage.faceVertices.resize(3); }, "face 0: its corners are missing"},
        {[](Scene& s) { s.cage.creaseVertexPairs = {0}; },
         "creases: 1 vertices and 0 sharpnesses; each needs two and one"},
        {[](Scene& s) { s.cage.fvarChannels[0].valueIndices[0] = 1 << 20; },
         "face-varying channel 0: face 0 uses value 1048576; there are 35 values"},
        {[](Scene& s) { s.cage.fvarChannels.clear(); },
         "texture coordinates: 70 values; 0 are needed"},
        {[](Scene& s) { s.lacksUVs = {1}; },
         "faces without texture coordinates: 1 values; 24 are needed"},
        {[](Scene& s) { s.primvars = {{"color", 3, {1}}}; },
         "primvar 'color': 1 values; 72 are needed"},
        {[](Scene& s) { s.normals = {1}; }, "normals: 1 values; 72 are needed"},
        {[](Scene& s) { s.groups[0] = {{"a"}, std::vector<Index>(24, 5)}; },
         "face 0 is in group 5; there are 1"}};
    for (std::string const path : {"a.obj", "a.ply"}) {
        for (Case const& damaged : cases) {
            Scene scene = test::MakeTorus(6, 4);
            damaged.damage(scene);
            EXPECT_EQ(test::RefusalOf([&] { FormatMesh(path, scene, Precision::Double); }),
                      "'" + path + "': " + damaged.refusal);
        }
    }
}

TEST(MeshWriter, PlyHasAPropertyPerChannelOfAWidePrimvar) {
    Scene scene = test::MakeCube();
    scene.primvars = {{"bone", 5, std::vector<float>(40, 0.25f)}};
    std::string const bytes = FormatMesh("a.ply", scene, Precision::Float).bytes;
    EXPECT_NE(bytes.find("property float bone_4\n"), std::string::npos);
}

TEST(MeshWriter, ObjKeepsTags) {
    Scene scene = test::MakeTorus(4, 4);
    auto& cage = scene.cage;
    cage.creaseVertexPairs = {0, 1, 1, 2, 5, 4};
    cage.creaseSharpness = {2.5f, 0.1f, 10.0f};
    cage.cornerVertices = {7, 3};
    cage.cornerSharpness = {1.0f / 3, 4.0f};
    cage.holes = {2, 9};
    Scene const back = RoundTrip(scene, "a.obj", Precision::Float);
    EXPECT_EQ(back.cage.creaseVertexPairs, cage.creaseVertexPairs);
    EXPECT_EQ(back.cage.creaseSharpness, cage.creaseSharpness);
    EXPECT_EQ(back.cage.cornerVertices, cage.cornerVertices);
    EXPECT_EQ(back.cage.cornerSharpness, cage.cornerSharpness);
    EXPECT_EQ(back.cage.holes, cage.holes);
}

TEST(MeshWriter, ObjKeepsEverySubdivisionRule) {
    Scene scene = test::MakeTorus(4, 4);
    auto& options = scene.cage.options;
    for (auto boundary : {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY,
                          Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
        for (int fvar = Sdc::Options::FVAR_LINEAR_NONE; fvar <= Sdc::Options::FVAR_LINEAR_ALL;
             ++fvar) {
            for (bool isOther : {false, true}) {
                options.SetVtxBoundaryInterpolation(boundary);
                options.SetFVarLinearInterpolation(
                    static_cast<Sdc::Options::FVarLinearInterpolation>(fvar));
                options.SetCreasingMethod(isOther ? Sdc::Options::CREASE_CHAIKIN
                                                  : Sdc::Options::CREASE_UNIFORM);
                options.SetTriangleSubdivision(isOther ? Sdc::Options::TRI_SUB_SMOOTH
                                                       : Sdc::Options::TRI_SUB_CATMARK);
                auto const back = RoundTrip(scene, "a.obj", Precision::Float).cage.options;
                EXPECT_EQ(back.GetVtxBoundaryInterpolation(), boundary);
                EXPECT_EQ(back.GetFVarLinearInterpolation(), fvar);
                EXPECT_EQ(back.GetCreasingMethod(), options.GetCreasingMethod());
                EXPECT_EQ(back.GetTriangleSubdivision(), options.GetTriangleSubdivision());
            }
        }
    }
}

TEST(MeshWriter, EndingsMayBeCapital) {
    Scene const torus = test::MakeTorus(6, 4);
    for (char const* name : {"a.OBJ", "a.Obj", "a.PLY", "a.Ply"}) {
        Scene const back = RoundTrip(torus, name, Precision::Double);
        ExpectSameBits(back.positions, torus.positions);
        ExpectSameCornerUVs(back, torus);
    }
}

TEST(MeshWriter, ObjKeepsSeveralNamesOfAGroup) {
    Scene scene = test::MakeCube();
    scene.groups[1] = {{"left arm", "arm"}, {0, 0, 1, -1, 0, 1}};
    Scene const back = RoundTrip(scene, "a.obj", Precision::Float);
    EXPECT_EQ(engine::SelectGroups(back, {"arm"}), (std::vector<char>{1, 1, 1, 0, 1, 1}));
    EXPECT_EQ(engine::SelectGroups(back, {"left"}), (std::vector<char>{1, 1, 0, 0, 1, 0}));
}

TEST(MeshWriter, ObjKeepsGroups) {
    Scene scene = test::MakeCube();
    scene.groups[0] = {{"red", "dark blue"}, {0, 0, 1, -1, 0, 1}};
    scene.groups[2] = {{"body"}, {-1, 0, 0, 0, 0, 0}};
    Scene const back = RoundTrip(scene, "a.obj", Precision::Float);
    for (size_t kind = 0; kind < 3; ++kind) {
        EXPECT_EQ(back.groups[kind].names, scene.groups[kind].names) << kind;
        EXPECT_EQ(back.groups[kind].faceGroup, scene.groups[kind].faceGroup) << kind;
    }
}

TEST(MeshWriter, ObjKeepsUVSharingAndOrder) {
    Scene const scene = test::LoadShape("catmark_cube");
    Scene const back = RoundTrip(scene, "a.obj", Precision::Double);
    EXPECT_EQ(back.uvs, scene.uvs);
    EXPECT_EQ(back.cage.fvarChannels.at(0).valueIndices,
              scene.cage.fvarChannels.at(0).valueIndices);
}

TEST(MeshWriter, FacesWithoutUVsStayWithout) {
    Scene scene = test::MakeTorus(8, 6);
    auto values = scene.cage.fvarChannels.at(0).valueIndices;
    scene.cage.fvarChannels.clear();
    std::fill(values.begin() + 4, values.begin() + 12, -1);  // of faces 1 and 2
    std::vector<char> lacks(scene.cage.faceSizes.size(), 0);
    lacks[1] = lacks[2] = 1;
    scene.AddUVChannel(values, lacks);
    for (char const* name : {"a.obj", "a.ply"}) {
        Scene const back = RoundTrip(scene, name, Precision::Double);
        EXPECT_EQ(back.lacksUVs, lacks) << name;
        auto const& found = back.cage.fvarChannels.at(0).valueIndices;
        for (size_t corner = 0; corner < values.size(); ++corner) {
            if (values[corner] < 0) continue;
            for (int c = 0; c < 2; ++c) {
                ASSERT_EQ(back.uvs[2 * found[corner] + c], scene.uvs[2 * values[corner] + c])
                    << name << " " << corner;
            }
        }
    }
    // Nothing is written for what stands for none.
    Scene const once = RoundTrip(scene, "a.obj", Precision::Double);
    EXPECT_EQ(RoundTrip(once, "a.obj", Precision::Double).uvs.size(), once.uvs.size());
}

TEST(MeshWriter, PlyKeepsPrimvars) {
    Scene scene = test::MakeCube();
    scene.primvars = {{"color", 3, {}}, {"quality", 1, {}}};
    for (int i = 0; i < 24; ++i) scene.primvars[0].values.push_back(static_cast<float>(i) / 7);
    for (int i = 0; i < 8; ++i) scene.primvars[1].values.push_back(static_cast<float>(-i) * 1e9f);
    Scene const back = RoundTrip(scene, "a.ply", Precision::Float);
    ASSERT_EQ(back.primvars.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(back.primvars[i].name, scene.primvars[i].name);
        EXPECT_EQ(back.primvars[i].numChannels, scene.primvars[i].numChannels);
        EXPECT_EQ(back.primvars[i].values, scene.primvars[i].values);
    }
}

TEST(MeshWriter, ObjKeepsColours) {
    for (int numChannels : {3, 4}) {
        Scene scene = test::MakeCube();
        scene.primvars = {{"color", numChannels, {}}};
        for (int i = 0; i < 8 * numChannels; ++i)
            scene.primvars[0].values.push_back(static_cast<float>(i) / 7);
        Scene const back = RoundTrip(scene, "a.obj", Precision::Float);
        ASSERT_EQ(back.primvars.size(), 1u);
        EXPECT_EQ(back.primvars[0].numChannels, numChannels);
        EXPECT_EQ(back.primvars[0].values, scene.primvars[0].values);
        EXPECT_EQ(back.positions, scene.positions);
        test::TemporaryFolder const folder;
        EXPECT_TRUE(engine::WriteMesh(folder / "a.obj", scene, Precision::Float).empty());
    }
}

TEST(MeshWriter, WhatAFormatCannotHoldIsSaid) {
    Scene scene = test::MakeCube();
    scene.cage.creaseVertexPairs = {0, 1};
    scene.cage.creaseSharpness = {2};
    test::TemporaryFolder const folder;
    auto const write = [&](char const* name) {
        return engine::WriteMesh(folder / name, scene, Precision::Float);
    };
    EXPECT_EQ(write("a.ply"), std::vector<std::string>{
                                  folder / "a.ply" +
                                  ": PLY holds no creases, corners or holes; they are left out"});
    EXPECT_TRUE(write("a.obj").empty());
    scene.primvars = {{"quality", 1, std::vector<float>(8)}};
    EXPECT_EQ(write("a.obj"),
              std::vector<std::string>{folder / "a.obj" +
                                       ": OBJ holds no primvars but colours; they are left out"});
}

TEST(MeshWriter, OtherEndingsAreRefusedAndLeaveNothing) {
    test::TemporaryFolder const folder;
    for (std::string const name : {"a.stl", "a", "obj", "a.obj.txt"}) {
        auto const error = test::CatchError(
            [&] { engine::WriteMesh(folder / name, test::MakeCube(), Precision::Float); });
        ASSERT_TRUE(error) << name;
        EXPECT_EQ(error->GetCode(), ErrorCode::BadOption);
        EXPECT_NE(std::string(error->what()).find(".obj or .ply"), std::string::npos);
    }
    EXPECT_TRUE(folder.List().empty());
}

TEST(MeshWriter, ReplacesAFileWhole) {
    test::TemporaryFolder const folder;
    std::string const path = folder.Write("a.obj", std::string(100000, 'x'));
    engine::WriteMesh(path, test::MakeCube(), Precision::Float);
    EXPECT_EQ(engine::ReadMesh(path).cage.numVertices, 8);
    EXPECT_EQ(folder.List(), (std::vector<std::string>{"a.obj"}));
}

TEST(MeshWriter, RefinedMeshReadsBackWithItsTags) {
    Scene scene = test::LoadShape("catmark_cube_creases0");
    Scene const fine = test::Refine(scene, 1);
    Scene const back = RoundTrip(fine, "a.obj", Precision::Double);
    ExpectSameBits(fine.positions, back.positions);
    ExpectSameCornerUVs(fine, back);
    EXPECT_EQ(back.cage.creaseVertexPairs, fine.cage.creaseVertexPairs);
    EXPECT_EQ(back.cage.creaseSharpness, fine.cage.creaseSharpness);
}

// Normals go with the vertices, beside texture coordinates or alone; a reader that leaves them out
// reads the same mesh.
TEST(MeshWriter, NormalsAreThoseOfTheVertices) {
    for (bool hasUVs : {false, true}) {
        Scene scene = hasUVs ? test::MakeTorus(5, 4) : test::MakeCube();
        Scene const plain = scene;
        for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex)
            scene.normals.insert(scene.normals.end(), {0.25 * vertex, 0.5, -1.0});
        std::string const text = engine::FormatMesh("a.obj", scene, Precision::Double).bytes;
        std::string const first = std::to_string(scene.cage.faceVertices[0] + 1);
        std::string const uv =
            hasUVs ? std::to_string(scene.cage.fvarChannels[0].valueIndices[0] + 1) : "";
        EXPECT_NE(text.find("\nf " + first + "/" + uv + "/" + first + " "), std::string::npos);
        EXPECT_NE(text.find("\nvn 0.25 0.5 -1\n"), std::string::npos);
        Scene const read = RoundTrip(scene, "a.obj", Precision::Double);
        EXPECT_EQ(read.cage.faceVertices, plain.cage.faceVertices);
        ExpectSameBits(read.positions, plain.positions);
        if (hasUVs) ExpectSameCornerUVs(read, plain);
    }
}

}  // namespace
}  // namespace limn
