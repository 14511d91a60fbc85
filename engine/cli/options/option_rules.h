// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace limn::cli {

// What options of a verb have to do with each other. \throws Error BadOption

/// Refuses two of these flags together.
void RefuseTogether(CLI::App const& verb, std::vector<char const*> const& flags);

/// Refuses each of these flags, which `why` follows in the message: "--sweeps needs ...".
void RefuseEach(CLI::App const& verb, std::vector<char const*> const& flags,
                std::string const& why);

/// Refuses a beginning of files' names that is only their folder: the files would be hidden ones.
void RequirePrefix(std::string const& flag, std::string const& prefix);

/// Refuses a picture's name that promises another format. Without an ending it may be a device or
/// a pipe.
void RequirePngEnding(std::string const& flag, std::string const& path);

/// Refuses a matrix's name that promises another format. As above.
void RequireMatrixEnding(std::string const& flag, std::string const& path);

}  // namespace limn::cli
