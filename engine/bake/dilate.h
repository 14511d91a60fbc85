// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace limn::engine {

/// Rows of texels as padding sees them: which are covered. Row r of the tile is rows[r - firstRow].
struct CoverageRows {
    int firstRow = 0, width = 0;
    std::vector<uint8_t const*> rows;  ///< one byte per texel, 0 where uncovered, 1 where covered
};

/// For each uncovered texel of a rectangle the nearest covered texel within a radius (Euclidean;
/// ties: smaller y, then smaller x).
///
/// Threads  one per thread
class PaddingSearch {
public:
    /// \param coverage  kept by reference; at least `radius` rows beyond what is asked for, where
    ///                  the tile has them
    PaddingSearch(CoverageRows const& coverage, int radius);

    /// \return false if nothing is to be padded: all are covered, or no covered texel is near
    bool Find(int firstRow, int numRows, int firstColumn, int numColumns);

    /// Offsets (dy * 65536 + dx, see GetOffsetX) of the rectangle last searched, row after row; 0
    /// where covered, kNoSource where nothing is near.
    std::vector<int32_t> const& GetOffsets() const { return _offsets; }

    static constexpr int32_t kNoSource = INT32_MIN;
    static constexpr int GetOffsetX(int32_t packed) {
        return static_cast<int16_t>(packed & 0xffff);
    }
    static constexpr int GetOffsetY(int32_t packed) {
        return (packed - GetOffsetX(packed)) / 65536;
    }

private:
    struct Window {
        int firstRow, numRows, firstColumn, numColumns;
    };
    bool IsNear(Window const& window) const;
    void FindInColumns(Window const& inner, Window const& outer);
    void FindInRow(int32_t const* dy, int count, int32_t* out);
    void FindInRowFast(int32_t const* dy, int count, int32_t* out);

    CoverageRows const& _coverage;
    int _radius;
    bool _isFast;
    int32_t _far;                    // what stands for no covered texel in a column
    std::vector<int16_t> _distance;  // per column of the window
    std::vector<int32_t>
        _columns;  // per texel of the rectangle and `radius` columns beside it: dy in its column
    std::vector<int32_t> _best, _offsets;
};

}  // namespace limn::engine
