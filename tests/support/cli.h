// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/meshes.h"
#include "support/program.h"

/// What tests of the command line share; LIMN_PROGRAM is the program under test.
namespace limn::test::cli {

using nlohmann::json;
using test::Outcome;
using Words = std::vector<std::string>;

inline Words operator+(Words a, Words const& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

inline std::string Shape(std::string const& name) {
    return test::DataPath("opensubdiv_shapes/" + name + ".obj");
}

inline Outcome Limn(Words const& arguments, test::RunOptions const& options = {}) {
    return test::Process(Words{LIMN_PROGRAM} + arguments, options).Wait();
}

inline std::vector<std::string> Lines(std::string const& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

inline bool Contains(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

/// The verbs that limn's own help lists.
inline Words ListVerbs() {
    Words verbs;
    auto const lines = Lines(Limn({"--help"}).out);
    auto line = std::find(lines.begin(), lines.end(), "Verbs:");
    while (line != lines.end() && ++line != lines.end() && line->starts_with("  "))
        verbs.push_back(line->substr(2, line->find(' ', 2) - 2));
    return verbs;
}

/// The error line; the test fails unless there is exactly one, the last of stderr, it says `part`,
/// and the status fits.
inline std::string ExpectError(Outcome const& outcome, int status, std::string const& part) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    auto const lines = Lines(outcome.err);
    auto const isError = [](std::string const& line) { return line.starts_with("limn: error: "); };
    EXPECT_EQ(std::count_if(lines.begin(), lines.end(), isError), 1) << outcome.err;
    if (lines.empty() || !isError(lines.back())) {
        ADD_FAILURE() << "stderr does not end with an error line: " << outcome.err;
        return {};
    }
    EXPECT_FALSE(part.empty()) << "any error would do";
    EXPECT_TRUE(Contains(lines.back(), part)) << "no '" << part << "' in: " << lines.back();
    return lines.back();
}

inline json ReadJson(std::string const& path) {
    return json::parse(test::ReadText(path));
}

/// A test of the command line with a folder of its own.
class Cli : public testing::Test {
protected:
    test::TemporaryFolder folder;

    /// What --report wrote to r.json.
    json Report() const { return ReadJson(folder / "r.json"); }

    /// A small bake of the mean curvature, unless further words say otherwise.
    Outcome Bake(std::string const& mesh, std::string const& output, Words const& more = {},
                 test::RunOptions const& options = {}) const {
        Words words = Words{"bake", mesh, "-o", folder / output, "--quiet"} + more;
        auto const has = [&](char const* option) {
            return std::find(more.begin(), more.end(), option) != more.end();
        };
        if (!has("--size")) words = words + Words{"--size", "64"};
        if (!has("--maps")) words = words + Words{"--maps", "mean"};
        return Limn(words, options);
    }
};

}  // namespace limn::test::cli
