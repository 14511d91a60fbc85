// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/images/picture.h"

namespace limn::engine {

/// Writes a picture as PNG, complete or not at all. \throws Error Io
void WritePng(std::string const& path, Picture const& picture);

}  // namespace limn::engine
