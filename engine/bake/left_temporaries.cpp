// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/left_temporaries.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <sys/stat.h>

#include "engine/io/atomic_file.h"

namespace limn::engine {

namespace {

using std::chrono::sys_seconds;

/// The time on the clock of each folder, as told by the last file written there.
std::map<std::string, sys_seconds> FindFolders(std::vector<std::string> const& written) {
    std::map<std::string, sys_seconds> folders;
    for (std::string const& path : written) {
        struct stat status{};
        if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
        auto const folder = std::filesystem::path(path).parent_path().string();
        sys_seconds& time = folders[folder.empty() ? "." : folder];
        time = std::max(time, sys_seconds(std::chrono::seconds(status.st_mtime)));
    }
    return folders;
}

}  // namespace

std::string DescribeLeftTemporaries(std::vector<std::string> const& written) {
    std::vector<std::string> left;
    for (auto const& [folder, time] : FindFolders(written)) {
        auto const found = FindLeftTemporaries(folder, time - std::chrono::hours(24));
        left.insert(left.end(), found.begin(), found.end());
    }
    if (left.empty()) return {};
    constexpr size_t kMaxNamed = 3;
    std::string names;
    for (size_t i = 0; i < std::min(kMaxNamed, left.size()); ++i)
        names += (i ? ", '" : "'") + left[i] + "'";
    if (left.size() > kMaxNamed) names += fmt::format(" and {} more", left.size() - kMaxNamed);
    return fmt::format(
        "runs that were killed more than a day ago have left {}, which nobody "
        "writes any more: remove them",
        names);
}

}  // namespace limn::engine
