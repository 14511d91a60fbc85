// SPDX-License-Identifier: Apache-2.0
//
// limn field with boundary data, functions, curls and wanted indices, from outside.

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "engine/io/mesh_reader.h"
#include "engine/io/number_table.h"
#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;
using Table = engine::NumberTable;

class CliFieldForms : public Cli {
protected:
    std::string spot = test::ScenePath("spot/spot.obj"),
                hole = test::DataPath("golden_surface/gridholetri.obj"),
                icosahedron = test::DataPath("golden_surface/icosa.obj");

    Outcome Field(std::string const& mesh, std::string const& output, Words const& more) const {
        return Limn(Words{"field", mesh, "-o", folder / output, "--report", folder / "r.json"} +
                    more);
    }

    Table Read(std::string const& file, std::vector<std::string> const& columns) const {
        return engine::ReadNumberTable(folder / file, {columns});
    }

    /// x + 2 y^2 at the vertices of spot, as a file.
    std::string WriteFunction() const {
        auto const scene = engine::ReadMesh(spot);
        std::string text = "vertex,value\n";
        for (size_t i = 0; 3 * i < scene.positions.size(); ++i)
            text +=
                fmt::format("{},{}\n", i,
                            scene.positions[3 * i] + 2.0 * std::pow(scene.positions[3 * i + 1], 2));
        return folder.Write("f.csv", text);
    }
};

TEST_F(CliFieldForms, EdgesOfAFunctionAreItsDifferences) {
    Words const parts{"--values", WriteFunction(), "--levels", "2"};
    ASSERT_EQ(Field(spot, "f.edges.csv", parts).status, 0);
    ASSERT_EQ(Field(spot, "f.values.csv", parts).status, 0);
    auto const edges = Read("f.edges.csv", {"v0", "v1", "value"}),
               values = Read("f.values.csv", {"vertex", "value"});
    for (size_t row = 0; row < edges.GetNumRows(); ++row) {
        auto const at = [&](size_t column) {
            return values.Get(static_cast<size_t>(edges.Get(row, column)), 1);
        };
        ASSERT_NEAR(edges.Get(row, 2), at(1) - at(0), 1e-12);
    }
}

// The same law on the limit: circulations are differences of limit values.
TEST_F(CliFieldForms, CirculationsOfAFunctionAreDifferencesOfItsLimits) {
    std::string const function = WriteFunction();
    ASSERT_EQ(Field(spot, "f.values.csv", {"--values", function, "--limit"}).status, 0);
    ASSERT_EQ(Field(spot, "all.edges.csv", {"--values", function}).status, 0);
    ASSERT_EQ(
        Field(spot, "f.along.csv", {"--values", function, "--along", folder / "all.edges.csv"})
            .status,
        0);
    auto const along = Read("f.along.csv", {"v0", "v1", "value"}),
               limits = Read("f.values.csv", {"vertex", "value"});
    ASSERT_GT(along.GetNumRows(), 300u);
    for (size_t row = 0; row < along.GetNumRows(); ++row) {
        auto const at = [&](size_t column) {
            return limits.Get(static_cast<size_t>(along.Get(row, column)), 1);
        };
        ASSERT_NEAR(along.Get(row, 2), at(1) - at(0), 1e-10);
    }
}

TEST_F(CliFieldForms, PinsAreMet) {
    ASSERT_EQ(
        Field(spot, "f.values.csv", {"--pin", "3:-1", "--pin", "90:2", "--pin", "150:0.5"}).status,
        0);
    auto const values = Read("f.values.csv", {"vertex", "value"});
    EXPECT_NEAR(values.Get(3, 1), -1.0, 1e-9);
    EXPECT_NEAR(values.Get(90, 1), 2.0, 1e-9);
    EXPECT_NEAR(values.Get(150, 1), 0.5, 1e-9);
}

// What is asked of a face stays on it and its children; the sum of all is kept.
TEST_F(CliFieldForms, IntegralsComeBackAndAddUp) {
    std::string const file = folder.Write("k.csv", "face,value\n40,2\n150,-1.5\n70,-0.5\n");
    ASSERT_EQ(Field(spot, "k0.integrals.csv", {"--integrals", file}).status, 0);
    auto const coarse = Read("k0.integrals.csv", {"face", "value", "density"});
    EXPECT_NEAR(coarse.Get(40, 1), 2.0, 1e-10);
    EXPECT_NEAR(coarse.Get(150, 1), -1.5, 1e-10);
    EXPECT_NEAR(coarse.Get(41, 1), 0.0, 1e-10);
    ASSERT_EQ(
        Field(spot, "k2.integrals.csv", {"--vortex", "40:2", "--vortex", "150:-2", "--levels", "2"})
            .status,
        0);
    auto const fine = Read("k2.integrals.csv", {"face", "value", "density"});
    double sum = 0.0, size = 0.0;
    for (size_t row = 0; row < fine.GetNumRows(); ++row) {
        sum += fine.Get(row, 1);
        size += std::abs(fine.Get(row, 1));
    }
    EXPECT_NEAR(sum, 0.0, 1e-10);
    EXPECT_NEAR(size, 4.0, 1e-9);
}

TEST_F(CliFieldForms, LoopsHaveWhatTheyAreTold) {
    ASSERT_EQ(Field(hole, "f.edges.csv",
                    {"--scheme", "loop", "--source", "10:0.5", "--loop", "0:flux=0.5"})
                  .status,
              0);
    json const report = Report();
    ASSERT_EQ(report["boundary"].size(), 2u);
    EXPECT_EQ(report["boundary"][0]["kind"], "flux");
    EXPECT_NEAR(report["boundary"][0]["flux"].get<double>(), 0.5, 1e-9);
    EXPECT_EQ(report["boundary"][1]["kind"], "tangent");
    EXPECT_NEAR(report["boundary"][1]["flux"].get<double>(), 0.0, 1e-9);
    EXPECT_LT(report["boundary_residual"], 1e-11);

    ASSERT_EQ(Field(hole, "g.edges.csv", {"--scheme", "loop", "--loop", "0:circulation=1"}).status,
              0);
    EXPECT_NEAR(Report()["boundary"][0]["circulation"].get<double>(), 1.0, 1e-9);
    // No vortices: what runs round outside runs round inside.
    EXPECT_NEAR(Report()["boundary"][1]["circulation"].get<double>(), -1.0, 1e-9);
}

TEST_F(CliFieldForms, WantedIndicesComeOut) {
    std::string const sphere = folder / "sphere.obj";
    ASSERT_EQ(
        Limn({"refine", icosahedron, "--scheme", "loop", "-o", sphere, "--levels", "2"}).status, 0);
    ASSERT_EQ(Field(sphere, "f.edges.csv",
                    {"--scheme", "loop", "--singularity", "0:1", "--singularity", "3:1"})
                  .status,
              0);
    json const report = Report();
    ASSERT_EQ(report["singularities"].size(), 2u);
    EXPECT_EQ(report["singularities"][0]["vertex"], 0);
    EXPECT_EQ(report["singularities"][1]["vertex"], 3);
    EXPECT_EQ(report["singularities"][1]["index"], 1.0);
}

// The gradient of a coordinate is its axis less the normal's part, which eval knows, too.
TEST_F(CliFieldForms, EvalHasTheFieldAtPlaces) {
    auto const scene = engine::ReadMesh(spot);
    std::string values = "vertex,value\n";
    for (size_t i = 0; 3 * i < scene.positions.size(); ++i)
        values += fmt::format("{},{}\n", i, scene.positions[3 * i + 2]);
    ASSERT_EQ(Field(spot, "z.edges.csv", {"--values", folder.Write("z.csv", values)}).status, 0);
    std::string places = "face,s,t\n";
    for (int face = 0; face < 180; face += 3) places += fmt::format("{},0.4,0.3\n", face);
    ASSERT_EQ(Limn({"eval", spot, "--at", folder.Write("p.csv", places), "--field",
                    folder / "z.edges.csv", "-o", folder / "e.csv"})
                  .status,
              0);
    auto const table = Read("e.csv", {"nx", "ny", "nz", "fx", "fy", "fz"});
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        double const nz = table.Get(row, 2);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(table.Get(row, 3 + c), (c == 2 ? 1.0 : 0.0) - nz * table.Get(row, c), 5e-3);
    }
}

TEST_F(CliFieldForms, WhatCannotBeIsRefused) {
    auto const expect = [&](std::string const& mesh, Words const& words, int status,
                            std::string const& part) {
        ExpectError(Field(mesh, "f.edges.csv", words), status, part);
    };
    Words const loop{"--scheme", "loop"};
    expect(hole, loop + Words{"--loop", "0:flux=1"}, 3, "flows out of boundaries");
    expect(hole, loop + Words{"--loop", "0:sideways"}, 2, "sideways");
    expect(hole, loop + Words{"--loop", "99999:normal"}, 3, "99999");
    expect(hole, loop + Words{"--loop", "0:normal", "--loop", "0:tangent"}, 3, "twice");
    expect(hole, loop + Words{"--loop", "0:normal", "--harmonic", "1"}, 2, "--harmonic");
    expect(hole, loop + Words{"--loop", "0:normal", "--arc-flux", "0:1"}, 3, "first arc");
    expect(spot, {"--boundary-data", folder.Write("b.csv", "v0,v1,kind,value\n0,1,round,1\n")}, 3,
           "b.csv:2");
    expect(spot, {"--pin", "3:1"}, 2, "--pin");
    expect(spot, {"--pin", "3:1", "--pin", "3:2"}, 3, "vertex 3");
    expect(spot, {"--pin", "3", "--pin", "4:1"}, 2, "--pin");
    expect(spot, {"--integrals", folder.Write("k.csv", "face,value\n3,1\n")}, 3, "add up to 1");
    expect(spot, {"--values", folder.Write("v.csv", "vertex,value\n3,nan\n")}, 3, "v.csv:2");
    expect(spot, {"--singularity", "3:1"}, 3, "Euler characteristic 2");
    expect(spot, {"--singularity", "3:2"}, 3, "1 at most");
    expect(spot, {"--singularity", "3:-9"}, 3, "edges");
    expect(spot, {"--source", "0", "--sink", "1", "--limit"}, 2, "--limit");
    expect(spot, {"--source", "0", "--sink", "1", "--along", folder / "k.csv"}, 2, "--along");
}

}  // namespace
}  // namespace limn
