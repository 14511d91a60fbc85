// SPDX-License-Identifier: Apache-2.0
#include "support/program/cli.h"

#include <algorithm>
#include <sstream>

namespace limn::test::cli {

std::string Shape(std::string const& name) {
    return test::DataPath("opensubdiv_shapes/" + name + ".obj");
}

Outcome Limn(Words const& arguments, test::RunOptions const& options) {
    return test::Process(Words{LIMN_PROGRAM} + arguments, options).Wait();
}

std::vector<std::string> Lines(std::string const& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

bool Contains(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

Words ListVerbs() {
    Words verbs;
    auto const lines = Lines(Limn({"--help"}).out);
    auto line = std::find(lines.begin(), lines.end(), "Verbs:");
    while (line != lines.end() && ++line != lines.end() && line->starts_with("  "))
        verbs.push_back(line->substr(2, line->find(' ', 2) - 2));
    return verbs;
}

std::string ExpectError(Outcome const& outcome, int status, std::string const& part) {
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

json ParseJson(std::string const& text) {
    return json::parse(text);
}

json ReadJson(std::string const& path) {
    return ParseJson(test::ReadText(path));
}

Outcome Cli::Bake(std::string const& mesh, std::string const& output, Words const& more,
                  test::RunOptions const& options) const {
    Words words = Words{"bake", mesh, "-o", folder / output, "--quiet"} + more;
    auto const has = [&](char const* option) {
        return std::find(more.begin(), more.end(), option) != more.end();
    };
    if (!has("--size")) words = words + Words{"--size", "64"};
    if (!has("--maps")) words = words + Words{"--maps", "mean"};
    return Limn(words, options);
}

}  // namespace limn::test::cli
