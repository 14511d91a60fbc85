// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "support/files.h"

namespace limn::test {

/// The repository's own files, for tests of what is written in them.
inline std::filesystem::path const kSourceRoot = LIMN_SOURCE_DIR;

/// All files of the folders with one of the endings, sorted.
inline std::set<std::filesystem::path> ListFiles(std::vector<std::string> const& folders,
                                                 std::set<std::string> const& endings) {
    std::set<std::filesystem::path> files;
    for (std::string const& folder : folders) {
        for (auto const& entry :
             std::filesystem::recursive_directory_iterator(kSourceRoot / folder)) {
            if (endings.contains(entry.path().extension().string())) files.insert(entry.path());
        }
    }
    return files;
}

}  // namespace limn::test
