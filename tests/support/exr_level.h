// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <OpenEXR/ImfTiledInputFile.h>

namespace limn::test {

/// A level of a file by OpenEXR's own reader: these channels of one pixel after another, rows from
/// the top.
std::vector<float> ReadLevel(Imf::TiledInputFile& input, int level,
                             std::vector<std::string> const& channels);

}  // namespace limn::test
