#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace limn::engine {

/// Rows of texels as padding sees them: which are covered. Row r of the tile is rows[r - firstRow].
struct CoverageRows {
    int firstRow = 0, width = 0;
    std::vector<uint8_t const*> rows;  ///< one byte per texel, 0 where uncovered
};

/// For each uncovered texel of rows [firstRow, firstRow + numRows) the nearest covered texel within
/// `radius` (Euclidean; ties: smaller y, then smaller x), as (dy * 65536 + dx) offsets packed by
/// PackOffset, or kNoSource. Covered texels get offset 0.
///
/// \param coverage  at least `radius` rows beyond each side, where the tile has them
inline constexpr int32_t kNoSource = INT32_MIN;
std::vector<int32_t> FindPadding(CoverageRows const& coverage, int firstRow, int numRows, int radius);

constexpr int32_t PackOffset(int dx, int dy) { return dy * 65536 + dx; }
constexpr int GetOffsetX(int32_t packed) { return static_cast<int16_t>(packed & 0xffff); }
constexpr int GetOffsetY(int32_t packed) { return (packed - GetOffsetX(packed)) / 65536; }

}  // namespace limn::engine
