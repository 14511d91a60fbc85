// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace limn::cli {

/// limn(1), as roff: all verbs and options of this command line.
std::string WriteManual(CLI::App const& app);

}  // namespace limn::cli
