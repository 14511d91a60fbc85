// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

namespace limn::cli {

/// What is wrong with a verb's command line where all its options are known, and what would be
/// right: "--size needs a value, such as --size 2048".
///
/// \param findExample  a value that an option may have; may be empty
std::string DescribeFault(CLI::App const& verb, CLI::ParseError const& error,
                          std::function<std::string(CLI::Option const&)> const& findExample);

}  // namespace limn::cli
