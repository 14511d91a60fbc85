// SPDX-License-Identifier: Apache-2.0
//
// Sums of bands: `limn bands --gain` and `--from`, and the same as a layer of a bake.

#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "support/exr_level.h"
#include "support/fit_meshes.h"
#include "support/program/cli.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

class CliBands : public Cli {
protected:
    std::string const cube = test::DataPath("golden_surface/cube.obj"),
                      mesh = WriteTorus("mesh.obj", 1), other = WriteTorus("other.obj", 2);

    std::string WriteTorus(std::string const& name, unsigned seed) const {
        engine::Scene torus = test::MakeTorus(12, 8);
        for (double& uv : torus.uvs) uv = 0.1 + 0.8 * uv;
        test::AddNoise(torus, 0.2, seed);
        engine::WriteMesh(folder / name, torus, Precision::Double);
        return folder / name;
    }

    Outcome Bands(Words const& more, std::string const& output = "out.obj") const {
        return Limn(Words{"bands", mesh, "-o", folder / output, "--precision", "double", "--report",
                          folder / "r.json"} +
                    more);
    }

    std::vector<double> Read(std::string const& name) const {
        return engine::ReadMesh(folder / name).positions;
    }

    void ExpectRefusal(Words const& more, int status, std::string const& part) const {
        ExpectError(Bands(more), status, part);
        EXPECT_FALSE(std::filesystem::exists(folder / "out.obj")) << part;
    }
};

TEST_F(CliBands, GainsMakeOneMeshOfTheSumOfTheFiles) {
    ASSERT_EQ(
        Limn({"bands", mesh, "-o", folder / "b", "--count", "2", "--precision", "double"}).status,
        0);
    ASSERT_EQ(Bands({"--count", "2", "--gain", "1,2.5,-1"}).status, 0);
    test::Rows const sum = test::ToRows(Read("b.band0.obj")) +
                           2.5 * test::ToRows(Read("b.band1.obj")) -
                           test::ToRows(Read("b.remainder.obj"));
    EXPECT_LT(test::LargestOf(sum - test::ToRows(Read("out.obj"))), 1e-13);
    json const bands = Report()["bands"];
    ASSERT_EQ(bands.size(), 3u);
    EXPECT_EQ(bands[1]["index"], 1);
    EXPECT_EQ(bands[1]["gain"], 2.5);
    EXPECT_EQ(bands[2]["index"], "remainder");
    EXPECT_GT(bands[0]["rms"], bands[1]["rms"]);
    EXPECT_FALSE(Report().contains("from"));
}

TEST_F(CliBands, WithoutAMeshsEndingTheSumHasANameOfItsOwn) {
    ASSERT_EQ(Bands({"--count", "1", "--gain", "1"}, "out").status, 0);
    EXPECT_LT(test::LargestDifference(Read("out.gain.obj"), engine::ReadMesh(mesh).positions),
              1e-13);
}

TEST_F(CliBands, BandsOfAnotherMeshReplaceThoseOfTheFirst) {
    ASSERT_EQ(Bands({"--from", mesh, "--bands", "1-"}).status, 0);
    EXPECT_LT(test::LargestDifference(Read("out.obj"), engine::ReadMesh(mesh).positions), 1e-13);
    ASSERT_EQ(Bands({"--from", other, "--bands", "0-", "--carry", "object"}).status, 0);
    EXPECT_LT(test::LargestDifference(Read("out.obj"), engine::ReadMesh(other).positions), 1e-13);
    EXPECT_EQ(Report()["from"]["carry"], "object");
    EXPECT_EQ(Report()["from"]["largest_turn_degrees"], 0.0);
    ASSERT_EQ(Bands({"--from", other, "--bands", "1-3"}).status, 0);
    EXPECT_EQ(Report()["bands"].size(), 3u);
    EXPECT_EQ(Report()["from"]["bands"], "1-3");
    EXPECT_EQ(Report()["from"]["carry"], "local");
    EXPECT_GT(Report()["from"]["largest_turn_degrees"], 0.1);
}

// Of bands 1 and 2 and the remainder, --count says that the last gain is the remainder's.
TEST_F(CliBands, GainsWeighTheBandsThatAreTaken) {
    ASSERT_EQ(Bands({"--from", other, "--bands", "1-", "--gain", "2,3,4", "--count", "3"}).status,
              0);
    json const bands = Report()["bands"];
    ASSERT_EQ(bands.size(), 3u);
    EXPECT_EQ(bands[0]["index"], 1);
    EXPECT_EQ(bands[2]["index"], "remainder");
    EXPECT_EQ(bands[2]["gain"], 4.0);
    ASSERT_EQ(Bands({"--from", other, "--bands", "1-", "--gain", "2,3,4"}).status, 0);
    EXPECT_EQ(Report()["bands"].size(), 4u);
    EXPECT_EQ(Report()["bands"][3]["gain"], 1.0);
}

TEST_F(CliBands, OptionsThatDoNotFitAreStatus2) {
    ExpectRefusal({}, 2, "--count is required");
    ExpectRefusal({"--gain", "1,1"}, 2, "--gain needs --count");
    ExpectRefusal({"--gain", "1,1", "--count", "4"}, 2, "--gain: 2 numbers for 4 bands");
    ExpectRefusal({"--gain", "1,nan", "--count", "2"}, 2, "--gain");
    ExpectRefusal({"--count", "2", "--carry", "local"}, 2, "--carry needs --from");
    ExpectRefusal({"--count", "2", "--bands", "1-2"}, 2, "--bands 1-2 needs --from");
    ExpectRefusal({"--count", "2", "--bands", "1"}, 2, "--bands needs --from");
    ExpectRefusal({"--from", other}, 2, "--from needs --bands");
    ExpectRefusal({"--from", other, "--bands", "3-1"}, 2, "--bands: '1'");
    ExpectRefusal({"--from", other, "--bands", "-1"}, 2, "--bands");
    ExpectRefusal({"--from", other, "--bands", "1-2", "--gain", "1,1,1"}, 2, "--gain: 3 numbers");
    ExpectRefusal({"--from", other, "--bands", "1-2", "--count", "2"}, 2,
                  "--count and --bands 1-2 exclude each other");
    ExpectRefusal({"--from", other, "--bands", "3-", "--count", "2"}, 2, "ends before --bands 3-");
    ExpectRefusal({"--from", folder / "out.obj", "--bands", "1"}, 2, "--from");
}

TEST_F(CliBands, MeshesThatDoNotFitAreStatus3) {
    ExpectRefusal({"--from", cube, "--bands", "1"}, 3, "96 and 8 vertices");
    std::string text = test::ReadText(other);
    ExpectRefusal({"--from", folder.Write("empty.obj", ""), "--bands", "1"}, 3, "empty.obj");
    text.replace(text.find("v ") + 2, 1, "nan ");
    ExpectRefusal({"--from", folder.Write("nan.obj", text), "--bands", "1"}, 3, "nan.obj:");
}

// The layer is the displacement that a bake against the sum has.
TEST_F(CliBands, AreALayerOfABake) {
    ASSERT_EQ(Bands({"--from", other, "--bands", "1-2", "--gain", "2,1"}).status, 0);
    ASSERT_EQ(Bake(mesh, "x.exr",
                   {"--maps", "bands,displacement", "--from", other, "--bands", "1-2", "--gain",
                    "2,1", "--against", folder / "out.obj", "--vector", "--precision", "double"})
                  .status,
              0);
    Imf::TiledInputFile input((folder / "x.exr").c_str());
    auto const pixels = test::ReadLevel(input, 0,
                                        {"bands.from.R", "bands.from.G", "bands.from.B",
                                         "displacement.R", "displacement.G", "displacement.B"});
    double largest = 0.0;
    for (size_t i = 0; i < pixels.size(); i += 6) {
        for (size_t c = 0; c < 3; ++c) {
            ASSERT_NEAR(pixels[i + c], pixels[i + 3 + c], 1e-6);
            largest = std::max(largest, std::abs(double{pixels[i + c]}));
        }
    }
    EXPECT_GT(largest, 0.01);
}

TEST_F(CliBands, InABakeOptionsThatDoNotFitAreStatus2) {
    auto const refuse = [&](Words const& more, std::string const& part) {
        ExpectError(Bake(mesh, "x.exr", more), 2, part);
    };
    refuse({"--maps", "bands", "--bands", "1-2"}, "--bands 1-2 needs --from");
    refuse({"--maps", "bands", "--from", other}, "--from needs --bands");
    refuse({"--maps", "bands", "--bands", "2", "--gain", "1,1,1,1"}, "--gain: 4 numbers");
    refuse({"--maps", "mean", "--gain", "1,1,1,1"}, "--gain has no effect on mean");
    refuse({"--maps", "bands", "--carry", "object"}, "--carry needs --from");
    refuse({"--maps", "bands", "--bands", "65"}, "--bands: '65'");
}

}  // namespace
}  // namespace limn
