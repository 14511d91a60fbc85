// SPDX-License-Identifier: Apache-2.0
#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "support/fit_meshes.h"
#include "support/program/cli.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

class CliCombine : public Cli {
protected:
    std::string const cube = test::DataPath("golden_surface/cube.obj"), a = WriteTorus("a.ply", 1),
                      b = WriteTorus("b.ply", 2), c = WriteTorus("c.ply", 3);

    /// A noisy torus whose scalar "x" is its x coordinate; PLY scalars are floats.
    std::string WriteTorus(std::string const& name, unsigned seed) const {
        engine::Scene torus = test::MakeTorus(12, 8);
        test::AddNoise(torus, 0.2, seed);
        engine::Primvar x{"first", 1, {}};
        for (size_t i = 0; i < torus.positions.size(); i += 3)
            x.values.push_back(static_cast<float>(torus.positions[i]));
        torus.primvars = {x};
        engine::WriteMesh(folder / name, torus, Precision::Double);
        return folder / name;
    }

    Outcome Combine(Words const& more, std::string const& output = "out.ply") const {
        return Limn(Words{"combine", a, "-o", folder / output, "--precision", "double", "--report",
                          folder / "r.json"} +
                    more);
    }

    test::Rows Read(std::string const& path) const {
        return test::ToRows(engine::ReadMesh(path).positions);
    }

    void ExpectSum(test::Rows const& expected) const {
        EXPECT_LT(test::LargestOf(Read(folder / "out.ply") - expected), 1e-13);
    }
};

TEST_F(CliCombine, AddsMeshesWithTheirWeights) {
    ASSERT_EQ(Combine({"--scale", "0.5", "--add", b, "--add", c + ":-2"}).status, 0);
    ExpectSum(0.5 * Read(a) + Read(b) - 2.0 * Read(c));
    auto const out = engine::ReadMesh(folder / "out.ply");
    for (size_t i = 0; i < out.primvars.at(0).values.size(); ++i)  // scalars alike
        EXPECT_NEAR(out.primvars[0].values[i], out.positions[3 * i], 1e-6);
}

TEST_F(CliCombine, BandsAndTheirRemainderAddUpToTheMesh) {
    std::string const band = folder / "b";
    ASSERT_EQ(Limn({"bands", a, "-o", band, "--count", "2", "--precision", "double"}).status, 0);
    ASSERT_EQ(Limn({"combine", band + ".band0.obj", "-o", folder / "out.ply", "--precision",
                    "double", "--add", band + ".band1.obj", "--add", band + ".remainder.obj"})
                  .status,
              0);
    ExpectSum(Read(a));
}

// R is of the way from A to MESH: none here.
TEST_F(CliCombine, AnOffsetFromTheMeshItselfLeadsToTheOther) {
    for (char const* carry : {"local", "object"}) {
        ASSERT_EQ(Combine({"--offset", a + "," + b, "--carry", carry}).status, 0);
        ExpectSum(Read(b));
        EXPECT_NEAR(Report()["largest_turn_degrees"], 0.0, 1e-6);
        test::Rows const offset = Read(b) - Read(a);
        EXPECT_NEAR(Report()["offset"]["max"], offset.rowwise().norm().maxCoeff(), 1e-12);
        EXPECT_NEAR(Report()["offset"]["rms"], std::sqrt(offset.rowwise().squaredNorm().mean()),
                    1e-12);
    }
}

TEST_F(CliCombine, OffsetsInObjectSpaceAreDifferences) {
    ASSERT_EQ(Combine({"--offset", b + "," + c + ":0.5", "--carry", "object"}).status, 0);
    ExpectSum(Read(a) + 0.5 * (Read(c) - Read(b)));
}

TEST_F(CliCombine, WritesTheOffsetAsScalarsOfAPly) {
    ASSERT_EQ(Combine({"--add", b + ":0.25", "--write-offset", "d"}).status, 0);
    auto const out = engine::ReadMesh(folder / "out.ply");
    test::Rows const offset = test::ToRows(out.positions) - Read(a);
    ASSERT_EQ(out.primvars.size(), 4u);
    for (int axis : {0, 1, 2}) {
        auto const& primvar = out.primvars[static_cast<size_t>(axis) + 1];
        EXPECT_EQ(primvar.name, std::string("d") + "xyz"[axis]);
        for (Index i = 0; i < offset.rows(); ++i)
            EXPECT_NEAR(primvar.values[static_cast<size_t>(i)], offset(i, axis), 1e-6);
    }
}

TEST_F(CliCombine, OptionsThatDoNotFitAreStatus2) {
    auto const refuse = [&](Words const& more, std::string const& part,
                            std::string const& output = "out.ply") {
        ExpectError(Combine(more, output), 2, part);
        EXPECT_FALSE(std::filesystem::exists(folder / output)) << part;
    };
    refuse({"--add", b + ":x"}, "--add: 'x'");
    refuse({"--add", b + ":nan"}, "--add: 'nan'");
    refuse({"--add", b + ":"}, "--add");
    refuse({"--offset", b}, "--offset: '" + b + "' is not A,B");
    refuse({"--offset", b + ","}, "is not A,B");
    refuse({"--offset", a + "," + b + "," + c}, "is not A,B");
    refuse({"--scale", "inf"}, "--scale");
    refuse({"--carry", "object"}, "--carry needs --offset");
    refuse({"--write-offset", "d"}, "--write-offset", "out.obj");
    refuse({"--write-offset", "two words"}, "--write-offset");
    refuse({"--write-offset", "n"}, "a PLY's normals", "out.ply");
    refuse({"--add", b}, "out.stl", "out.stl");
}

TEST_F(CliCombine, MeshesThatDoNotFitAreStatus3) {
    auto const refuse = [&](Words const& more, std::string const& part) {
        ExpectError(Combine(more), 3, part);
        EXPECT_FALSE(std::filesystem::exists(folder / "out.ply")) << part;
    };
    refuse({"--add", cube}, "cube.obj do not have the same faces: 96 and 8 vertices");
    refuse({"--offset", a + "," + cube}, "cube.obj do not have the same faces");
    refuse({"--add", folder.Write("empty.ply", "")}, "empty.ply");
    refuse({"--add", folder.Write("nan.obj", "v 0 0 nan\nf 1 1 1\n")}, "nan.obj");
}

}  // namespace
}  // namespace limn
