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

inline std::string Shape(std::string const& name) {
    return test::DataPath("opensubdiv_shapes/" + name + ".obj");
}

inline Outcome Limn(Words arguments, test::RunOptions const& options = {}) {
    arguments.insert(arguments.begin(), LIMN_PROGRAM);
    return test::Process(arguments, options).Wait();
}

inline std::vector<std::string> Lines(std::string const& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// The error line; the test fails unless there is exactly one, the last of stderr, and the status
/// fits.
inline std::string ExpectError(Outcome const& outcome, int status) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    auto const lines = Lines(outcome.err);
    auto const isError = [](std::string const& line) { return line.starts_with("limn: error: "); };
    EXPECT_EQ(std::count_if(lines.begin(), lines.end(), isError), 1) << outcome.err;
    if (lines.empty() || !isError(lines.back())) {
        ADD_FAILURE() << "stderr does not end with an error line: " << outcome.err;
        return {};
    }
    return lines.back();
}

inline bool Contains(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

inline json ReadJson(std::string const& path) {
    return json::parse(test::ReadText(path));
}

}  // namespace limn::test::cli
