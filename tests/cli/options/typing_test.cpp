// SPDX-License-Identifier: Apache-2.0
//
// Command lines as people type them, right and nearly right.

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/cli/options/option_list.h"
#include "engine/cli/parser.h"
#include "support/errors.h"
#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;
using cli::OptionEntry;

std::string Refusal(Words const& words) {
    return test::RefusalOf([&] { cli::Parser().Parse(words); });
}

TEST(Typing, UnknownVerbsAndOptionsAreToldWithTheNearest) {
    auto const expect = [](Words const& words, std::string const& says) {
        EXPECT_TRUE(Contains(Refusal(words), says)) << Refusal(words);
    };
    expect({"bkae", "a.obj"}, "no verb 'bkae'; did you mean bake?");
    expect({"help", "mesure"}, "no verb 'mesure'; did you mean measure?");
    expect({"bake", "a.obj", "--sise", "64"}, "bake: no option '--sise'; did you mean --size?");
    expect({"bake", "a.obj", "--sise=64"}, "bake: no option '--sise'; did you mean --size?");
    expect({"bake", "a.obj", "--ouput", "a.exr", "--maps", "mean"}, "did you mean --output?");
    expect({"bake", "a.obj", "-size", "64"}, "bake: no option '-size'; did you mean --size?");
    expect({"bake", "a.obj", "-output", "a.exr"}, "no option '-output'; did you mean --output?");
    expect({"info", "a.obj", "--frobnicate"}, "info: no option '--frobnicate' (limn info --help");
    expect({"info", "a.obj", "b.obj"}, "info: 'b.obj' is one argument too many");
    expect({"--threads", "4", "info"}, "no option '--threads' before the verb");
    expect({"info", "a.obj", "--scheme", "catmrk"}, "did you mean catmark?");
    expect({"bake", "--maps", "mean"}, "(limn bake --help tells more)");
}

TEST(Typing, AnEmptyValueIsNoOptionLeftOut) {
    Words const bake{"bake", "a.obj", "-o", "a.exr", "--maps", "noise"};
    for (Words const& words : {bake + Words{"--noise-ramp", ""},
                               bake + Words{"--encode", ""},
                               bake + Words{"--groups", "red", ""},
                               bake + Words{"--report", ""},
                               {"eval", "a.obj", "--at", "p.csv", "--output", ""},
                               {"measure", "a.obj", "--output", ""},
                               {"refine", "a.obj", "-o", "b.obj", "--edit", ""},
                               {"smooth", "a.obj", "-o", "b.obj", "--width-map", ""}}) {
        std::string const& flag = *(std::ranges::find_if(
            words.rbegin(), words.rend(), [](auto& w) { return w.starts_with("--"); }));
        EXPECT_EQ(Refusal(words), flag + ": '' is empty; give a value or leave the option out");
    }
}

TEST(Typing, AFolderIsNoBeginningOfNames) {
    for (Words const& words : {Words{"bands", "a.obj", "--count", "2", "-o", "out/"},
                               {"morph", "a.obj", "b.obj", "-o", "out/"},
                               {"measure", "a.obj", "-o", "out/"}})
        ExpectError(Limn(words), 2, "-o 'out/': a folder; add what the files' names begin with");
}

TEST(Typing, HelpOfAVerbIsTheSameBothWays) {
    EXPECT_EQ(Limn({"help"}).out, Limn({"--help"}).out);
    for (std::string const& verb : ListVerbs())
        EXPECT_EQ(Limn({"help", verb}).out, Limn({verb, "--help"}).out);
}

TEST(Typing, VersionIsTheSameEverywhere) {
    Outcome const outcome = Limn({"version"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(Limn({"--version"}).out, outcome.out);
    for (std::string const& verb : ListVerbs())
        EXPECT_EQ(Limn({verb, "--version"}).out, outcome.out);
}

/// Calls `check(verb, option)` for every option that takes numbers.
template <class Check>
void ForEachNumberOption(Check check) {
    cli::Parser const parser;
    size_t count = 0;
    for (CLI::App const* verb : cli::ListVerbs(parser.GetApp())) {
        for (OptionEntry const& option : cli::ListOptions(*verb)) {
            if (option.value != OptionEntry::Value::Number) continue;
            check(verb->get_name(), option.longFlag);
            ++count;
        }
    }
    EXPECT_GT(count, 40u);
}

TEST(Typing, EveryNumberOptionQuotesWhatIsNone) {
    ForEachNumberOption([](std::string const& verb, std::string const& flag) {
        std::string const text = flag == "--view" ? "abc,abc,abc" : "abc";
        std::string const refusal = Refusal({verb, flag, text});
        EXPECT_TRUE(refusal.starts_with(flag + ": 'abc' is no ")) << refusal;
        EXPECT_TRUE(Contains(refusal, "number")) << refusal;
    });
}

TEST(Typing, OwnVariableOfThreadsIsRefusedWhereTheOptionWouldBe) {
    auto const info = [](Words const& environment, Words const& more = {}) {
        return Limn(Words{"info", Shape("catmark_cube"), "--json"} + more,
                    {.environment = environment});
    };
    Outcome const plain = info({});
    for (std::string const text : {"abc", "0", "-1", "1e3", "2 ", "1025", "99999999999"}) {
        ExpectError(info({"LIMN_THREADS=" + text}), 2,
                    "LIMN_THREADS: '" + text + "' is no whole number from 1 to 1024");
        EXPECT_EQ(info({"LIMN_THREADS=" + text}, {"--threads", "2"}).out, plain.out);
        EXPECT_EQ(info({"OPENIMAGEIO_THREADS=" + text, "CUE_THREADS=" + text}).out, plain.out);
    }
    EXPECT_EQ(info({"LIMN_THREADS="}).out, plain.out);
}

TEST(Typing, FirstVariableWithANumberOfThreadsCounts) {
    test::TemporaryFolder const folder;
    auto const threads = [&](Words const& environment) {
        Words const words{"info", Shape("catmark_cube"), "--report", folder / "r.json"};
        EXPECT_EQ(Limn(words, {.environment = environment}).status, 0);
        return ReadJson(folder / "r.json")["effective_options"]["threads"].get<int>();
    };
    EXPECT_EQ(threads({"LIMN_THREADS=2", "OPENIMAGEIO_THREADS=3", "CUE_THREADS=4"}), 2);
    EXPECT_EQ(threads({"LIMN_THREADS=", "OPENIMAGEIO_THREADS=3", "CUE_THREADS=4"}), 3);
    EXPECT_EQ(threads({"LIMN_THREADS=", "OPENIMAGEIO_THREADS=0", "CUE_THREADS=4"}), 4);
}

/// Calls `check(verb, option)` for every option that takes a value.
template <class Check>
void ForEachOptionWithAValue(Check check) {
    cli::Parser const parser;
    size_t count = 0;
    for (CLI::App const* verb : cli::ListVerbs(parser.GetApp())) {
        for (OptionEntry const& option : cli::ListOptions(*verb)) {
            if (option.value == OptionEntry::Value::None || option.IsPositional()) continue;
            check(verb->get_name(), option);
            ++count;
        }
    }
    EXPECT_GT(count, 150u);
}

TEST(Typing, AnOptionWithoutItsValueIsToldWithAnExampleThatItTakes) {
    ForEachOptionWithAValue([](std::string const& verb, OptionEntry const& option) {
        std::string const& flag = option.longFlag;
        std::string const refusal = Refusal({verb, "a.obj", flag});
        std::string const start = flag + " needs a value, such as " + flag + " ";
        ASSERT_TRUE(refusal.starts_with(start)) << verb << ": " << refusal;
        size_t const end = std::min(refusal.find(" (limn"), refusal.find("; files stand"));
        std::string example = refusal.substr(start.size(), end - start.size());
        EXPECT_FALSE(example.empty()) << refusal;
        std::erase(example, '\'');
        std::string const next = Refusal({verb, "a.obj", flag, example});
        EXPECT_FALSE(next.starts_with(flag)) << verb << ": " << next;
    });
}

TEST(Typing, WhatTheParserFindsIsToldInOurWords) {
    auto const expect = [](Words const& words, std::string const& says) {
        EXPECT_TRUE(Refusal(words).starts_with(says)) << Refusal(words);
    };
    expect({"info"}, "MESH is required, such as spot.obj (limn info --help");
    expect({"morph", "a.obj"}, "TO is required, such as smile.obj (");
    expect({"completion"}, "SHELL is required, such as bash (");
    expect({"morph", "a.obj", "b.obj"}, "--output is required, such as --output out/spot (");
    expect({"bake", "a.obj", "--view", "1,2"},
           "--view takes 3 values and has 2, such as --view 1,0.6,0.8 (");
    expect({"bake", "a.obj", "--view", "1,2,3,4"}, "--view takes 3 values and has 4");
    expect({"info", "a.obj", "--threads", "1", "--threads", "2"},
           "--threads takes one value and has 2 (");
    expect({"info", "a.obj", "--quiet", "--verbose"}, "--quiet and --verbose exclude each other (");
    expect({"smooth", "a.obj", "-o", "b.obj", "--view", "1,2,3"},
           "--view needs --picture, such as --picture out/spot.png (");
    expect({"info", "a.obj", "--json=maybe"}, "--json takes no value (");
}

TEST(Typing, TextsWithNumbersQuoteTheirPartThatIsNone) {
    auto const expect = [](Words const& words, std::string const& says) {
        ExpectError(Limn(words), 2, says);
    };
    std::string const mesh = Shape("catmark_cube");
    Words const bake{"bake", mesh, "-o", "a.exr", "--maps", "mean"};
    expect(bake + Words{"--size", "abc"}, "--size: 'abc' is no number of texels from 1 to 65536");
    expect(bake + Words{"--tiles", "1001,x"}, "--tiles: 'x' is no whole number from 1001 to 9999");
    expect(bake + Words{"--preview", "--preview-range", "0,1e400"},
           "--preview-range: '1e400' is too large a number");
    expect(bake + Words{"--encode", "1,x"}, "--encode: 'x' is no number");
    expect(bake + Words{"--audit", "--seam-bound", "mean=x"}, "--seam-bound: 'x' is no number");
    Words const field{"field", mesh, "-o", "a.obj"};
    for (std::string const flag : {"--source", "--sink", "--vortex"}) {
        expect(field + Words{flag, "1.5"}, flag + ": '1.5' is no whole number");
        expect(field + Words{flag, "1:x"}, flag + ": 'x' is no number");
    }
    expect(field + Words{"--harmonic", "1,x"}, "--harmonic: 'x' is no number");
}

TEST(Typing, SizesTakeK) {
    test::TemporaryFolder const folder;
    Outcome const outcome =
        Limn({"bake", test::ScenePath("spot/spot.obj"), "-o", folder / "a.exr", "--maps",
              "position", "--size", "1kx16", "--quiet", "--report", folder / "r.json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    json const output = ReadJson(folder / "r.json")["outputs"][0];
    EXPECT_EQ(output["width"], 1024);
    EXPECT_EQ(output["height"], 16);
}

TEST(Typing, BakesHelpSaysWhatARendererMustKnow) {
    std::string const help = Limn({"bake", "--help"}).out;
    for (char const* part : {"corners-plus1", "Keep Corners, Junctions", "(T, n x T, n)",
                             "point + value * n", "point + vector"})
        EXPECT_TRUE(Contains(help, part)) << part;
}

}  // namespace
}  // namespace limn
