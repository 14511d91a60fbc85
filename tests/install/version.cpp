// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include <limn/version.h>

// The version in each of its forms, a line each.
int main() {
    std::printf("%d.%d.%d\n%s\n%s\n", LIMN_VERSION_MAJOR, LIMN_VERSION_MINOR, LIMN_VERSION_PATCH,
                limn::kVersion, limn::kVersionAndBuild);
}
