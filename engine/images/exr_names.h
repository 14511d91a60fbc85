// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/images/exr_writer.h"
#include "far_ext/enum_words.h"

namespace limn::engine {

inline constexpr auto kExrCompressionWords =
    MakeEnumWords<ExrCompression>("compression", {{ExrCompression::Zip, "zip"},
                                                  {ExrCompression::Zips, "zips"},
                                                  {ExrCompression::Piz, "piz"},
                                                  {ExrCompression::Rle, "rle"},
                                                  {ExrCompression::None, "none"},
                                                  {ExrCompression::Dwaa, "dwaa"}});

}  // namespace limn::engine
