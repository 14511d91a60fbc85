// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "engine/images/picture.h"

namespace limn::engine {

/// Remarks in a PNG file: keywords of Latin letters and their texts.
using PngTexts = std::map<std::string, std::string>;

/// Writes a picture as PNG, complete or not at all. \throws Error Io
void WritePng(std::string const& path, Picture const& picture, PngTexts const& texts = {});

/// Writes a picture that is made row by row, from the top: fillRow(row, rgb). What fillRow throws
/// ends the writing, and nothing is left of the file.
///
/// \throws Error Io
void WritePngRows(std::string const& path, int width, int height,
                  std::function<void(int row, uint8_t* rgb)> const& fillRow,
                  PngTexts const& texts = {});

/// The remarks of a PNG file that stand before its pixels; none if it is not there or no PNG.
PngTexts ReadPngTexts(std::string const& path);

}  // namespace limn::engine
