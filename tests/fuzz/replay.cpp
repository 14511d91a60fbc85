// SPDX-License-Identifier: Apache-2.0
//
// main of a fuzzer without libFuzzer: takes the files that are named, and those of folders that
// are.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/fuzzer.h"
#include "support/files.h"

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> ListInputs(int count, char const* const* names) {
    std::vector<fs::path> files;
    for (int i = 0; i < count; ++i) {
        if (fs::is_directory(names[i])) {
            for (auto const& entry : fs::recursive_directory_iterator(names[i])) {
                if (entry.is_regular_file()) files.push_back(entry.path());
            }
        } else {
            files.emplace_back(names[i]);
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): what is thrown ends a replay, as it should
int main(int argc, char** argv) {
    std::vector<fs::path> const inputs = ListInputs(argc - 1, argv + 1);
    for (fs::path const& path : inputs) {
        std::fprintf(stderr, "%s\n", path.c_str());  // the last one is what failed
        std::string const bytes = limn::test::ReadText(path);
        LLVMFuzzerTestOneInput(reinterpret_cast<uint8_t const*>(bytes.data()), bytes.size());
    }
    std::printf("%zu inputs\n", inputs.size());
    return inputs.empty() ? 1 : 0;
}
