// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/meshes.h"
#include "support/program/program.h"

/// What tests of the command line share; LIMN_PROGRAM is the program under test.
namespace limn::test::cli {

using nlohmann::json;
using test::Outcome;
using Words = std::vector<std::string>;

inline Words operator+(Words a, Words const& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

std::string Shape(std::string const& name);

Outcome Limn(Words const& arguments, test::RunOptions const& options = {});

std::vector<std::string> Lines(std::string const& text);

bool Contains(std::string const& text, std::string const& part);

/// The verbs that limn's own help lists.
Words ListVerbs();

/// The error line; the test fails unless there is exactly one, the last of stderr, it says `part`,
/// and the status fits.
std::string ExpectError(Outcome const& outcome, int status, std::string const& part);

json ParseJson(std::string const& text);
json ReadJson(std::string const& path);

/// A test of the command line with a folder of its own.
class Cli : public testing::Test {
protected:
    test::TemporaryFolder folder;

    /// What --report wrote to r.json.
    json Report() const { return ReadJson(folder / "r.json"); }

    /// A small bake of the mean curvature, unless further words say otherwise.
    Outcome Bake(std::string const& mesh, std::string const& output, Words const& more = {},
                 test::RunOptions const& options = {}) const;
};

}  // namespace limn::test::cli
