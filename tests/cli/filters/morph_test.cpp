// SPDX-License-Identifier: Apache-2.0
//
// Schedules and exact ends of `limn morph`.

#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "support/fit_meshes.h"
#include "support/program/cli.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

class CliMorph : public Cli {
protected:
    std::string const from = WriteTorus("from.obj", 1), to = WriteTorus("to.obj", 2);

    std::string WriteTorus(std::string const& name, unsigned seed) const {
        engine::Scene torus = test::MakeTorus(12, 8);
        test::AddNoise(torus, 0.3, seed);
        engine::WriteMesh(folder / name, torus, Precision::Float);
        return folder / name;
    }

    Outcome Morph(std::string const& prefix, Words const& more) const {
        return Limn(Words{"morph", from, to, "-o", folder / prefix} + more);
    }

    void ExpectRefusal(std::string const& schedule, std::string const& part) const {
        ExpectError(Morph("x", {"--schedule", folder.Write("s.csv", schedule)}), 3, part);
        EXPECT_FALSE(std::filesystem::exists(folder / "x.0001.obj"));
    }
};

TEST_F(CliMorph, AScheduleOfEqualStepsIsThatOfTheOptions) {
    ASSERT_EQ(Morph("a", {"--detail", "3", "--rate", "0.5", "--steps", "3"}).status, 0);
    ASSERT_EQ(Morph("b", {"--schedule", folder.Write("s.csv",
                                                     "step,detail,rate\n1,3,0.5\n2,3,.5\n"
                                                     "3,3,0.5\n")})
                  .status,
              0);
    for (char const* name : {".0001.obj", ".0002.obj", ".0003.obj"}) {
        EXPECT_TRUE(test::ReadText(folder / (std::string("a") + name)) ==
                    test::ReadText(folder / (std::string("b") + name)))
            << name;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "b.0004.obj"));
}

TEST_F(CliMorph, AnExactEndIsTheOtherMeshToTheLastDigit) {
    ASSERT_EQ(Morph("a", {"--steps", "3", "--exact-end"}).status, 0);
    EXPECT_EQ(engine::ReadMesh(folder / "a.0003.obj").positions, engine::ReadMesh(to).positions);
    ASSERT_EQ(Morph("b", {"--steps", "3"}).status, 0);
    EXPECT_NE(engine::ReadMesh(folder / "b.0003.obj").positions, engine::ReadMesh(to).positions);
}

TEST_F(CliMorph, AScheduleTakesThePlaceOfTheOtherOptions) {
    std::string const schedule = folder.Write("s.csv", "step,detail,rate\n1,3,0.5\n");
    for (Words const& words : {Words{"--detail", "2"}, {"--rate", "0.8"}, {"--steps", "3"}}) {
        ExpectError(Morph("x", words + Words{"--schedule", schedule}), 2,
                    "--schedule and " + words[0] + " exclude each other");
    }
}

TEST_F(CliMorph, ASchedulesErrorsAreStatus3WithTheirLine) {
    std::string const head = "step,detail,rate\n";
    ExpectRefusal(head + "1,2,0.5\n3,2,0.5\n", "s.csv:3: step 3 stands where step 2 should");
    ExpectRefusal(head + "0,2,0.5\n", "s.csv:2: step 0");
    ExpectRefusal(head + "1,2.5,0.5\n", "s.csv:2: detail 2.5 is no whole number");
    ExpectRefusal(head + "1,-1,0.5\n", "s.csv:2: detail -1");
    ExpectRefusal(head + "1,2,1\n", "s.csv:2: rate 1 is not between 0 and 1");
    ExpectRefusal(head + "1,2,nan\n", "s.csv:2");
    ExpectRefusal(head, "s.csv: a schedule of no steps");
    ExpectRefusal("", "s.csv");
    ExpectRefusal("step,rate\n1,0.5\n", "detail");
}

TEST_F(CliMorph, AScheduleIsNoFrame) {
    std::string const schedule = folder.Write("x.0001.obj", "step,detail,rate\n1,3,0.5\n");
    ExpectError(Morph("x", {"--schedule", schedule}), 2, "--schedule");
}

}  // namespace
}  // namespace limn
