// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace limn::cli {

/// Version and build for people: "0.2.0 (OpenSubdiv 3.5), commit 0123456789ab", the commit that was
/// checked out; there is none in a release without history. What is baked does not have it: a
/// commit that changes nothing about a bake leaves its bytes alone, and its files up to date.
std::string GetVersionText();

}  // namespace limn::cli
