// SPDX-License-Identifier: Apache-2.0
#include "engine/io/off_reader.h"

#include <locale>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "engine/io/mesh_reader.h"
#include "far_ext/topology/control_mesh.h"
#include "support/files.h"

namespace limn {
namespace {

using engine::Scene;

Scene Parse(std::string const& text) {
    Scene scene;
    scene.path = "mesh.off";
    engine::ReadOff(text, scene);
    return scene;
}

std::string RefusalOfText(std::string const& text) {
    return test::RefusalOf([&] { Parse(text); });
}

std::string const kQuad = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

TEST(OffReader, ReadsVerticesAndFaces) {
    Scene const scene = Parse(kQuad);
    EXPECT_EQ(scene.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}));
    EXPECT_EQ(scene.cage.numVertices, 4);
    EXPECT_EQ(scene.cage.faceSizes, (std::vector<Index>{4}));
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{0, 1, 2, 3}));
    EXPECT_EQ(scene.faceLines, (std::vector<uint32_t>{7}));
}

TEST(OffReader, CommentsEmptyLinesAndCountsBesideTheKeywordChangeNothing) {
    Scene const scene = Parse(
        "# made by hand\nOFF 4 1 # no edges given\n\n0 0 0\n1 0 0 # right\n\n1 1 0\n# between\n0 1 "
        "0\n4 0 1 2 3\n");
    EXPECT_EQ(scene.positions, Parse(kQuad).positions);
    EXPECT_EQ(scene.cage.faceVertices, Parse(kQuad).cage.faceVertices);
}

TEST(OffReader, CrlfAndMissingLastLineEndChangeNothing) {
    std::string crlf;
    for (char c : kQuad) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    for (std::string const& text : {crlf, kQuad.substr(0, kQuad.size() - 1)}) {
        EXPECT_EQ(Parse(text).positions, Parse(kQuad).positions);
        EXPECT_EQ(Parse(text).cage.faceVertices, Parse(kQuad).cage.faceVertices);
    }
}

TEST(OffReader, FaceColoursAreSkipped) {
    Scene const scene =
        Parse("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3 0.5 0.5 0.5 1\n");
    EXPECT_EQ(scene.cage.faceVertices, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
}

TEST(OffReader, VertexColoursOfCoffArePrimvars) {
    Scene const scene =
        Parse("COFF\n3 1 0\n0 0 0 1 .5 .25 1\n1 0 0 0 0 0 1\n0 1 0 1 1 1 0\n3 0 1 2\n");
    ASSERT_EQ(scene.primvars.size(), 1u);
    EXPECT_EQ(scene.primvars[0].name, "color");
    EXPECT_EQ(scene.primvars[0].values,
              (std::vector<float>{1, 0.5f, 0.25f, 1, 0, 0, 0, 1, 1, 1, 1, 0}));
}

std::vector<float> ColoursOf(std::string const& first, std::string const& second) {
    return Parse("COFF\n3 1 0\n0 0 0 " + first + "\n1 0 0 " + second + "\n0 1 0 0 0 0 0\n3 0 1 2\n")
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
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
    };
    std::locale const before = std::locale::global(std::locale(std::locale(), new Comma));
    Scene const scene = Parse("OFF\n3 1 0\n1.5 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    std::locale::global(before);
    EXPECT_EQ(scene.positions[0], 1.5);
}

struct Refusal {
    std::string name, text, where;
    std::vector<std::string> says;
};

void PrintTo(Refusal const& refusal, std::ostream* out) {
    *out << refusal.name;
}

class OffRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(OffRefusal, NamesLineReasonAndRemedy) {
    std::string const message = RefusalOfText(GetParam().text);
    EXPECT_EQ(message.find(GetParam().where), 0u) << message;
    for (std::string const& part : GetParam().says)
        EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
    EXPECT_LT(message.size(), 400u);
}

std::string const kPoints = "0 0 0\n1 0 0\n0 1 0\n";

INSTANTIATE_TEST_SUITE_P(
    Of, OffRefusal,
    testing::Values(
        Refusal{"Empty", "", "mesh.off:", {"ends before the keyword OFF"}},
        Refusal{"WrongKeyword", "NOFF\n", "mesh.off:1: ", {"'NOFF'", "OFF or COFF is needed"}},
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

TEST(OffReader, HugeCountsTakeNoMemory) {
    rusage before{}, after{};
    ::getrusage(RUSAGE_SELF, &before);
    RefusalOfText("OFF\n536870911 536870911 0\n" + kPoints);
    RefusalOfText("OFF\n3 1 0\n" + kPoints + "536870911 0 1 2\n");
    ::getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 * 1024);  // kB
}

TEST(OffReader, DamagedFilesAreReadOrRefusedButNeverMore) {
    for (unsigned seed = 0; seed < 2000; ++seed) {
        try {
            far_ext::Validate(Parse(test::Damage(kQuad, seed)).cage);
        } catch (Error const&) {
        }
    }
}

TEST(OffReader, GarbageIsRefused) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        EXPECT_THROW(Parse(test::Garbage("", seed)), Error) << seed;
        EXPECT_THROW(Parse(test::Garbage("OFF\n4 1 0\n", seed)), Error) << seed;
    }
}

// -------- which reader a file gets

TEST(MeshReader, ChoosesByEndingAndThenByFirstBytes) {
    test::TemporaryFolder const folder;
    for (std::string const name : {"a.off", "a.OFF", "a.mesh"}) {
        EXPECT_EQ(engine::ReadMesh(folder.Write(name, kQuad)).cage.numVertices, 4) << name;
    }
    for (std::string const name : {"a.obj", "a.OBJ", "a.PLY"}) {
        EXPECT_THROW(engine::ReadMesh(folder.Write(name, kQuad)), Error) << name;
    }
}

TEST(MeshReader, KnowsNameAndChecksumOfTheFile) {
    test::TemporaryFolder const folder;
    Scene const scene = engine::ReadMesh(folder.Write("some.quad.off", kQuad));
    EXPECT_EQ(scene.name, "some.quad");
    // sha256sum of kQuad
    EXPECT_EQ(scene.sha256, "b6a8fcc3bd3d5d5ca0616db0b1004cf66e4735145d0ffd738cf1a93b7c767104");
}

TEST(MeshReader, MissingFileAndFolderAreIoErrors) {
    test::TemporaryFolder const folder;
    for (std::string const& path : {folder / "none.obj", folder.GetPath()}) {
        try {
            engine::ReadMesh(path);
            ADD_FAILURE() << path;
        } catch (Error const& error) {
            EXPECT_EQ(error.GetCode(), ErrorCode::Io);
            EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
        }
    }
}

TEST(MeshReader, EmptyFileIsRefusedByName) {
    test::TemporaryFolder const folder;
    std::string const path = folder.Write("empty.ply", "");
    EXPECT_EQ(test::RefusalOf([&] { engine::ReadMesh(path); }), path + ": the file is empty");
}

}  // namespace
}  // namespace limn
