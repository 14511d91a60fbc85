#include "engine/bake/dilate.h"

#include <algorithm>

#include "engine/bake/pixel_kernel.h"

namespace limn::engine {

namespace {

/// For each texel of rows [firstRow, firstRow + numRows) the nearest covered texel of its column within
/// `radius`, as dy (ties: up), or `far`. One sweep down and one sweep up.
std::vector<int32_t> FindInColumns(CoverageRows const& coverage, int firstRow, int numRows, int radius, int32_t far) {
    size_t const width = static_cast<size_t>(coverage.width);
    std::vector<int32_t> nearest(width * static_cast<size_t>(numRows));
    int const first = std::max(coverage.firstRow, firstRow - radius);
    int const last = std::min(coverage.firstRow + static_cast<int>(coverage.rows.size()), firstRow + numRows + radius) - 1;
    std::vector<int32_t> distance(width, radius + 1);
    auto const step = [&](int row) {
        uint8_t const* const covered = coverage.rows[row - coverage.firstRow];
        for (size_t x = 0; x < width; ++x) {
            int32_t const next = distance[x] > radius ? radius + 1 : distance[x] + 1;
            distance[x] = covered[x] ? 0 : next;
        }
    };
    auto const isWanted = [&](int row) { return row >= firstRow && row < firstRow + numRows; };
    for (int row = first; row <= last; ++row) {  // downwards: what lies above
        step(row);
        if (!isWanted(row)) continue;
        int32_t* const out = &nearest[static_cast<size_t>(row - firstRow) * width];
        for (size_t x = 0; x < width; ++x) out[x] = distance[x] > radius ? far : -distance[x];
    }
    std::fill(distance.begin(), distance.end(), radius + 1);
    for (int row = last; row >= first; --row) {  // upwards: what lies below, if it is nearer
        step(row);
        if (!isWanted(row)) continue;
        int32_t* const out = &nearest[static_cast<size_t>(row - firstRow) * width];
        for (size_t x = 0; x < width; ++x) {
            int32_t const above = out[x] < 0 ? -out[x] : out[x];
            out[x] = distance[x] <= radius && distance[x] < above ? distance[x] : out[x];
        }
    }
    return nearest;
}

/// The row search for radii whose distances fit FindNearest's keys.
void FindInRowFast(int32_t const* dy, int width, int radius, int32_t* out) {
    constexpr int kBlock = 256;
    std::vector<int32_t> padded(static_cast<size_t>(kBlock + 2 * radius)), best(kBlock);
    for (int start = 0; start < width; start += kBlock) {
        int const count = std::min(kBlock, width - start);
        bool isAnyNear = false, isAllCovered = true;
        for (int k = -radius; k < count + radius; ++k) {
            int const x = start + k;
            int32_t const value = x >= 0 && x < width ? dy[x] : kFarRow;
            padded[static_cast<size_t>(k + radius)] = value;
            isAnyNear |= value != kFarRow;
            isAllCovered &= value == 0 || k < 0 || k >= count;
        }
        if (isAllCovered) {
            std::fill_n(out + start, count, 0);
            continue;
        }
        if (!isAnyNear) continue;
        std::fill(best.begin(), best.end(), (radius * radius + 1) * 65536);
        FindNearest(padded.data() + radius, best.data(), static_cast<size_t>(count), radius);
        for (int k = 0; k < count; ++k) {
            int32_t const key = best[static_cast<size_t>(k)];
            if (key < (radius * radius + 1) * 65536) {
                out[start + k] = PackOffset((key & 255) - 128, ((key >> 8) & 255) - 128);
            }
        }
    }
}

void FindInRow(int32_t const* dy, int width, int radius, int32_t* out) {
    for (int x = 0; x < width; ++x) {
        int best = radius * radius + 1, bestX = 0, bestY = 0;
        int const from = std::max(0, x - radius), to = std::min(width - 1, x + radius);
        for (int at = from; at <= to; ++at) {
            if (dy[at] > radius) continue;
            int const distance = (at - x) * (at - x) + dy[at] * dy[at];
            if (distance < best || (distance == best && dy[at] < bestY)) {
                best = distance;
                bestX = at - x;
                bestY = dy[at];
            }
        }
        if (best <= radius * radius) out[x] = PackOffset(bestX, bestY);
    }
}

}  // namespace

std::vector<int32_t> FindPadding(CoverageRows const& coverage, int firstRow, int numRows, int radius) {
    constexpr int kFastRadius = 64;  // what FindNearest takes
    bool const isFast = radius <= kFastRadius;
    size_t const width = static_cast<size_t>(coverage.width);
    std::vector<int32_t> sources(static_cast<size_t>(numRows) * width, kNoSource);
    auto const dy = FindInColumns(coverage, firstRow, numRows, radius, isFast ? kFarRow : radius + 1);
    for (int row = 0; row < numRows; ++row) {
        size_t const at = static_cast<size_t>(row) * width;
        (isFast ? FindInRowFast : FindInRow)(&dy[at], coverage.width, radius, &sources[at]);
    }
    return sources;
}

}  // namespace limn::engine
