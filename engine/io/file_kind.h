// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace limn::engine {

/// What a file's bytes say it is, whatever its name: "USD", "glTF (binary)", "an image (PNG)".
/// Empty where they say nothing, as for the formats that limn reads.
std::string_view RecogniseForeignFile(std::string_view bytes);

/// Refuses a file of another kind before anybody parses it.
///
/// \param wanted  what can be read here: "OBJ, PLY or OFF"
/// \throws Error  BadMesh: "FILE: looks like USD: OBJ, PLY or OFF is needed"
void RefuseForeignFile(std::string_view bytes, std::string const& path, char const* wanted);

}  // namespace limn::engine
