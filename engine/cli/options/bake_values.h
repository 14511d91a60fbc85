// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/bake/maps/map_options.h"

namespace limn::cli {

/// Of --encode: "scale,offset". \throws Error BadOption
engine::Encoding ParseEncoding(std::string const& text);

/// Of --origin: "X,Y,Z" or "auto". \throws Error BadOption
engine::Origin ParseOrigin(std::string const& text);

}  // namespace limn::cli
