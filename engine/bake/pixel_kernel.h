#pragma once

#include <cstddef>
#include <cstdint>

namespace limn::engine {

/// The two loops over pixels that decide how fast a file is written. Integer arithmetic, the same
/// bytes at every vector width.

/// 32-bit floats to 16-bit, rounding to nearest even. Finite values beyond +-65504 are clamped.
///
/// \return how many were clamped
size_t ConvertToHalf(float const* from, uint16_t* to, size_t count);

/// The first half of OpenEXR's ZIP scheme: bytes at even places, then bytes at odd places, each
/// replaced by its difference to the byte before it, plus 128.
///
/// \param words  `count` 16-bit words, little-endian: the pixels' bytes
/// \param bytes  2 * count bytes
void SplitAndPredict(uint16_t const* words, size_t count, uint8_t* scratch, uint8_t* bytes);

}  // namespace limn::engine
