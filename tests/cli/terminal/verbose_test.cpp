// SPDX-License-Identifier: Apache-2.0
//
// What --verbose tells, and that it changes nothing else.

#include <algorithm>
#include <map>
#include <regex>

#include <gtest/gtest.h>

#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

struct VerbRun {
    std::string verb;
    Words words;  // MESH, PLACES and OUT/ stand for a mesh, a table and the test's folder
    Words phases;
};

void PrintTo(VerbRun const& run, std::ostream* out) {
    *out << run.verb;
}

std::vector<VerbRun> const kVerbRuns{
    {"eval",
     {"MESH", "--at", "PLACES", "-o", "OUT/a.csv"},
     {"reading", "evaluating places", "writing"}},
    {"info", {"MESH"}, {"reading", "topology", "describing"}},
    {"bake",
     {"MESH", "-o", "OUT/a.{map}.exr", "--maps", "mean,normal", "--size", "64", "--audit",
      "--audit-bound", "1"},
     {"reading", "preparing maps", "baking spot", "auditing spot"}},
    {"refine",
     {"MESH", "-o", "OUT/a.obj", "--space", "differential", "--solver", "cholesky"},
     {"subdividing coordinates", "factorising", "solving", "writing"}},
    {"refine", {"MESH", "-o", "OUT/a.obj", "--limit"}, {"refining positions", "moving"}},
    {"measure", {"MESH", "-o", "OUT/a"}, {"measuring", "finding curvature", "writing"}},
    {"fit",
     {"MESH", "-o", "OUT/a.obj"},
     {"building the limit matrix", "solving for positions", "certifying", "writing"}},
    {"bands", {"MESH", "-o", "OUT/a", "--count", "2"}, {"filtering", "writing"}},
    {"bands",
     {"MESH", "-o", "OUT/a.obj", "--from", "MESH", "--bands", "1-"},
     {"filtering", "finding local frames", "writing"}},
    {"combine", {"MESH", "-o", "OUT/a.obj", "--scale", "2"}, {"reading", "writing"}},
    {"denoise", {"MESH", "-o", "OUT/a.obj"}, {"filtering", "writing"}},
    {"sharpen", {"MESH", "-o", "OUT/a.obj"}, {"filtering", "writing"}},
    {"morph", {"MESH", "MESH", "-o", "OUT/a", "--steps", "2"}, {"morphing", "writing"}},
    {"smooth", {"MESH", "-o", "OUT/a.obj", "--levels", "1"}, {"smooth", "writing"}},
    {"field",
     {"MESH", "-o", "OUT/a.obj", "--source", "0", "--sink", "9"},
     {"designing the field", "subdividing the field", "finding vectors", "writing"}}};

class CliVerbose : public testing::TestWithParam<VerbRun> {
protected:
    Outcome RunIn(test::TemporaryFolder const& folder, Words const& more) const {
        Words words{GetParam().verb};
        for (std::string const& word : GetParam().words) {
            if (word == "MESH")
                words.push_back(test::ScenePath("spot/spot.obj"));
            else if (word == "PLACES")
                words.push_back(_places);
            else
                words.push_back(word.starts_with("OUT/") ? folder / word.substr(4) : word);
        }
        return Limn(words + more);
    }

private:
    test::TemporaryFolder _inputs;
    std::string const _places = _inputs.Write("places.csv", "face,s,t\n0,0.5,0.5\n");
};

/// "limn: factorising: 0.012 s"
bool HasPhase(std::string const& text, std::string const& phase) {
    return std::regex_search(text,
                             std::regex("(^|\n)limn: " + phase + "[^\n]*: [0-9]+\\.[0-9]{3} s\n"));
}

std::map<std::string, std::string> ReadAll(test::TemporaryFolder const& folder) {
    std::map<std::string, std::string> files;
    for (std::string const& name : folder.List()) files[name] = test::ReadText(folder / name);
    return files;
}

TEST_P(CliVerbose, TellsPhasesAndSecondsAndChangesNoByteOfTheOutput) {
    test::TemporaryFolder const plainFolder, folder;
    Outcome const plain = RunIn(plainFolder, {});
    Outcome const outcome = RunIn(folder, {"--verbose"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    for (std::string const& phase : GetParam().phases)
        EXPECT_TRUE(HasPhase(outcome.err, phase)) << phase << " is not in:\n" << outcome.err;
    EXPECT_TRUE(std::regex_search(outcome.err, std::regex("\nlimn: [0-9.]+ s in all\n$")));
    EXPECT_EQ(outcome.out, plain.out);
    EXPECT_EQ(ReadAll(folder), ReadAll(plainFolder));
    EXPECT_FALSE(folder.List().empty() && outcome.out.empty()) << "nothing to compare";
}

INSTANTIATE_TEST_SUITE_P(Of, CliVerbose, testing::ValuesIn(kVerbRuns));

TEST_F(Cli, VerboseIsTriedWithEveryVerb) {
    for (std::string const& verb : ListVerbs())
        EXPECT_TRUE(std::ranges::any_of(kVerbRuns, [&](VerbRun const& run) {
            return run.verb == verb;
        })) << verb;
}

TEST_F(Cli, VerboseNamesTilesAndFiles) {
    Outcome const outcome =
        Limn({"bake", test::ScenePath("spot/spot.obj"), "-o", folder / "a.<UDIM>.exr", "--maps",
              "position", "--size", "64", "--verbose"});
    EXPECT_TRUE(Contains(outcome.err, "limn: tile 1001: 64 x 64 texels\n")) << outcome.err;
    EXPECT_TRUE(Contains(outcome.err, "limn: " + (folder / "a.1001.exr") + ": done\n"));
}

TEST_F(Cli, VerboseNamesThePhaseThatFailedBeforeTheError) {
    std::string const mesh = folder.Write("a.obj", "v 0 0 x\n");
    Outcome const outcome = Limn({"info", mesh, "--verbose"});
    ExpectError(outcome, 3, "a.obj:1");
    EXPECT_TRUE(HasPhase(outcome.err, "reading ")) << outcome.err;
}

TEST_F(Cli, QuietAndVerboseContradictEachOther) {
    ExpectError(Limn({"info", Shape("catmark_cube"), "--quiet", "--verbose"}), 2,
                "exclude each other");
}

}  // namespace
}  // namespace limn
