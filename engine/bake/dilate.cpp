// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/dilate.h"

#include <algorithm>
#include <cstring>

#include "engine/images/pixel_kernel.h"
#include "eval/kernels/dispatch.h"

namespace limn::engine {

namespace {

constexpr int kFastRadius = 64;  // what FindNearest takes

constexpr int32_t PackOffset(int dx, int dy) {
    return dy * 65536 + dx;
}

}  // namespace

PaddingSearch::PaddingSearch(CoverageRows const& coverage, int radius)
    : _coverage(coverage),
      _radius(radius),
      _isFast(radius <= kFastRadius),
      _far(_isFast ? kFarRow : radius + 1) {}

bool PaddingSearch::IsNear(Window const& window) const {
    for (int row = 0; row < window.numRows; ++row) {
        uint8_t const* const covered =
            _coverage.rows[window.firstRow + row - _coverage.firstRow] + window.firstColumn;
        if (std::memchr(covered, 1, static_cast<size_t>(window.numColumns))) return true;
    }
    return false;
}

bool PaddingSearch::Find(int firstRow, int numRows, int firstColumn, int numColumns) {
    Window const inner{firstRow, numRows, firstColumn, numColumns};
    bool isAllCovered = true;
    for (int row = 0; row < numRows && isAllCovered; ++row) {
        uint8_t const* const covered =
            _coverage.rows[firstRow + row - _coverage.firstRow] + firstColumn;
        isAllCovered = !std::memchr(covered, 0, static_cast<size_t>(numColumns));
    }
    if (isAllCovered) return false;
    int const lastRow = _coverage.firstRow + static_cast<int>(_coverage.rows.size());
    Window outer;
    outer.firstRow = std::max(firstRow - _radius, _coverage.firstRow);
    outer.numRows = std::min(firstRow + numRows + _radius, lastRow) - outer.firstRow;
    outer.firstColumn = std::max(firstColumn - _radius, 0);
    outer.numColumns =
        std::min(firstColumn + numColumns + _radius, _coverage.width) - outer.firstColumn;
    if (!IsNear(outer)) return false;

    FindInColumns(inner, outer);
    _offsets.assign(static_cast<size_t>(numRows) * numColumns, kNoSource);
    size_t const stride = static_cast<size_t>(numColumns + 2 * _radius);
    for (int row = 0; row < numRows; ++row) {
        int32_t const* const dy = &_columns[static_cast<size_t>(row) * stride + _radius];
        int32_t* const out = &_offsets[static_cast<size_t>(row) * numColumns];
        _isFast ? FindInRowFast(dy, numColumns, out) : FindInRow(dy, numColumns, out);
    }
    return true;
}

/// For each texel of the inner rows and the outer columns the nearest covered texel of its column
/// within the radius, as dy (ties: up), or _far. One sweep down and one sweep up.
void PaddingSearch::FindInColumns(Window const& inner, Window const& outer) {
    size_t const stride = static_cast<size_t>(inner.numColumns + 2 * _radius),
                 width = static_cast<size_t>(outer.numColumns);
    size_t const shift = static_cast<size_t>(outer.firstColumn - (inner.firstColumn - _radius));
    _columns.assign(stride * static_cast<size_t>(inner.numRows), _far);
    auto const none = static_cast<int16_t>(_radius + 1);
    int32_t const radius = _radius, far = _far;
    int16_t* const distance = (_distance.assign(width, none), _distance.data());
    auto const step = [&](int row) {
        uint8_t const* const covered = _coverage.rows[row - _coverage.firstRow] + outer.firstColumn;
        for (size_t x = 0; x < width; ++x) {
            auto const next = static_cast<int16_t>(distance[x] + (distance[x] < none));
            distance[x] = covered[x] ? int16_t{0} : next;
        }
    };
    auto const findLine = [&](int row) -> int32_t* {
        bool const isWanted = row >= inner.firstRow && row < inner.firstRow + inner.numRows;
        return isWanted ? &_columns[static_cast<size_t>(row - inner.firstRow) * stride + shift]
                        : nullptr;
    };
    int const end = outer.firstRow + outer.numRows;
    for (int row = outer.firstRow; row < end; ++row) {  // downwards: what lies above
        step(row);
        if (int32_t* const out = findLine(row)) {
            for (size_t x = 0; x < width; ++x) out[x] = distance[x] > radius ? far : -distance[x];
        }
    }
    _distance.assign(width, none);
    for (int row = end - 1; row >= outer.firstRow;
         --row) {  // upwards: what lies below, if it is nearer
        step(row);
        if (int32_t* const out = findLine(row)) {
            for (size_t x = 0; x < width; ++x) {
                int32_t const above = out[x] < 0 ? -out[x] : out[x];
                out[x] = distance[x] <= radius && distance[x] < above ? distance[x] : out[x];
            }
        }
    }
}

/// The row search for radii whose distances fit findNearest's keys.
void PaddingSearch::FindInRowFast(int32_t const* dy, int count, int32_t* out) {
    bool isAnyNear = false, isAllCovered = true;
    for (int x = -_radius; x < count + _radius; ++x) isAnyNear |= dy[x] != kFarRow;
    for (int x = 0; x < count; ++x) isAllCovered &= dy[x] == 0;
    if (isAllCovered) {
        std::fill_n(out, count, 0);
        return;
    }
    if (!isAnyNear) return;
    int32_t const none = (_radius * _radius + 1) * 65536;
    _best.assign(static_cast<size_t>(count), none);
    eval::GetKernel<PixelKernel>().findNearest(dy, _best.data(), static_cast<size_t>(count),
                                               _radius);
    for (int x = 0; x < count; ++x) {
        int32_t const key = _best[static_cast<size_t>(x)];
        out[x] = key < none ? PackOffset((key & 255) - 128, ((key >> 8) & 255) - 128) : out[x];
    }
}

void PaddingSearch::FindInRow(int32_t const* dy, int count, int32_t* out) {
    for (int x = 0; x < count; ++x) {
        int best = _radius * _radius + 1, bestX = 0, bestY = 0;
        for (int dx = -_radius; dx <= _radius; ++dx) {
            int const there = dy[x + dx];
            if (there > _radius) continue;
            int const distance = dx * dx + there * there;
            if (distance < best || (distance == best && there < bestY)) {
                best = distance;
                bestX = dx;
                bestY = there;
            }
        }
        if (best <= _radius * _radius) out[x] = PackOffset(bestX, bestY);
    }
}

}  // namespace limn::engine
