// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace limn::engine {

/// A picture of a flow: noise, blurred along the streamline through each pixel, so that streaks
/// show where it goes.
///
/// \param flow     x and y per pixel, rows from the top, y downwards; only the direction counts
/// \param isInside per pixel: streamlines end where it is 0, and such pixels are 0
/// \return grey per pixel, 0 to 255
/// Threads  the pool; the same bits for any size of it
/// Source   line integral convolution, Cabral and Leedom 1993
std::vector<uint8_t> ConvolveLines(int width, int height, std::span<float const> flow,
                                   std::span<uint8_t const> isInside);

}  // namespace limn::engine
