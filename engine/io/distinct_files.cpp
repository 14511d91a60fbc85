// SPDX-License-Identifier: Apache-2.0
#include "engine/io/distinct_files.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "engine/io/atomic_file.h"
#include "far_ext/error.h"

namespace limn::engine {

std::string NormalisePath(std::string const& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    fs::path const whole = fs::weakly_canonical(fs::absolute(path, error), error);
    return error ? path : whole.string();
}

void DistinctFiles::AddRead(std::string const& path, std::string const& role) {
    Add(path, {role, false});
}

void DistinctFiles::AddWritten(std::string const& path, std::string const& role) {
    Add(path, {role, true});
}

void DistinctFiles::Add(std::string const& path, Use const& use) {
    if (FindOutputKind(path) != OutputKind::File) return;
    auto const [found, isNew] = _uses.try_emplace(NormalisePath(path), use);
    Use const& other = found->second;
    if (isNew || (!use.isWritten && !other.isWritten)) return;
    if (use.isWritten && other.isWritten) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("'{}' would be written twice, by {} and {}; give one of them "
                                "another name",
                                path, other.role, use.role));
    }
    Use const& written = use.isWritten ? use : other;
    Use const& read = use.isWritten ? other : use;
    throw Error(ErrorCode::BadOption,
                fmt::format("'{}' is an input ({}), and {} would overwrite it; give the output "
                            "another name",
                            path, read.role, written.role));
}

}  // namespace limn::engine
