// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "engine/images/picture.h"
#include "engine/io/atomic_file.h"

namespace limn::engine {

/// Remarks in a PNG file: keywords of Latin letters and their texts.
using PngTexts = std::map<std::string, std::string>;

/// Writes a picture as PNG, to be committed by the caller. \throws Error Io
void WritePng(AtomicFile& file, Picture const& picture, PngTexts const& texts = {});

/// Writes a picture that is made row by row, from the top: fillRow(row, rgb). What fillRow throws
/// ends the writing.
///
/// \throws Error Io
void WritePngRows(AtomicFile& file, int width, int height,
                  std::function<void(int row, uint8_t* rgb)> const& fillRow,
                  PngTexts const& texts = {});

/// The remarks of a PNG file that stand before its pixels; none if it is not there or no PNG.
PngTexts ReadPngTexts(std::string const& path);

}  // namespace limn::engine
