// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>

#include <fmt/format.h>

namespace limn::bench {

/// True where OpenImageIO's program maketx can be called.
inline bool HasMaketx() {
    return std::system("command -v maketx >/dev/null 2>&1") == 0;
}

/// Makes a mip-mapped tiled file from a finished one. \return false if maketx failed
inline bool RunMaketx(std::string const& from, std::string const& to, int numThreads) {
    auto const command = fmt::format(
        "maketx -d half --tile 64 64 --threads {} -o '{}' '{}' >/dev/null", numThreads, to, from);
    return std::system(command.c_str()) == 0;
}

}  // namespace limn::bench
