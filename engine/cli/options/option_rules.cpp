// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/option_rules.h"

#include <fmt/format.h>

#include "engine/io/file.h"
#include "far_ext/error.h"

namespace limn::cli {

void RefuseTogether(CLI::App const& verb, std::vector<char const*> const& flags) {
    char const* first = nullptr;
    for (char const* flag : flags) {
        if (verb.count(flag) == 0) continue;
        if (first) {
            throw Error(ErrorCode::BadOption,
                        fmt::format("{} and {} exclude each other", first, flag));
        }
        first = flag;
    }
}

void RefuseEach(CLI::App const& verb, std::vector<char const*> const& flags,
                std::string const& why) {
    for (char const* flag : flags) {
        if (verb.count(flag)) throw Error(ErrorCode::BadOption, fmt::format("{} {}", flag, why));
    }
}

void RequirePrefix(std::string const& flag, std::string const& prefix) {
    if (!prefix.ends_with('/')) return;
    throw Error(ErrorCode::BadOption,
                fmt::format("{} '{}': a folder; add what the files' names begin with, such as {}a",
                            flag, prefix, prefix));
}

void RequirePngEnding(std::string const& flag, std::string const& path) {
    std::string const ending = engine::GetEnding(path);
    if (ending.empty() || ending == ".png") return;
    throw Error(ErrorCode::BadOption,
                fmt::format("{} '{}': a picture is written as .png", flag, path));
}

void RequireMatrixEnding(std::string const& flag, std::string const& path) {
    std::string const ending = engine::GetEnding(path);
    if (ending.empty() || ending == ".mtx") return;
    throw Error(ErrorCode::BadOption,
                fmt::format("{} '{}': a matrix is written as .mtx", flag, path));
}

}  // namespace limn::cli
