#include "engine/bake/dilate.h"

#include <algorithm>
#include <cstdlib>

namespace limn::engine {

namespace {

/// For one row: the nearest covered texel of each column, up or down; ties go up (smaller y).
void FindInColumns(CoverageRows const& coverage, int row, int radius, std::vector<int>& dy) {
    constexpr int kFar = 1 << 14;
    dy.assign(static_cast<size_t>(coverage.width), kFar);
    int const first = std::max(coverage.firstRow, row - radius);
    int const last = std::min(coverage.firstRow + static_cast<int>(coverage.rows.size()) - 1, row + radius);
    // From far to near, down before up at equal distance, so that the preferred one is written last.
    for (int distance = radius; distance >= 0; --distance) {
        for (int const y : {row + distance, row - distance}) {
            if (y < first || y > last) continue;
            uint8_t const* const covered = coverage.rows[y - coverage.firstRow];
            int const value = y - row;
            for (int x = 0; x < coverage.width; ++x) dy[x] = covered[x] ? value : dy[x];
        }
    }
}

}  // namespace

std::vector<int32_t> FindPadding(CoverageRows const& coverage, int firstRow, int numRows, int radius) {
    std::vector<int32_t> sources(static_cast<size_t>(numRows) * coverage.width, kNoSource);
    constexpr int kFar = 1 << 14;
    std::vector<int> dy;
    std::vector<char> isNear;  // per block of columns: is anything covered within reach?
    constexpr int kBlock = 64;
    for (int row = firstRow; row < firstRow + numRows; ++row) {
        int32_t* const out = &sources[static_cast<size_t>(row - firstRow) * coverage.width];
        uint8_t const* const covered = coverage.rows[row - coverage.firstRow];
        if (std::all_of(covered, covered + coverage.width, [](uint8_t c) { return c != 0; })) {
            std::fill(out, out + coverage.width, 0);
            continue;
        }
        FindInColumns(coverage, row, radius, dy);
        int const numBlocks = (coverage.width + kBlock - 1) / kBlock;
        isNear.assign(static_cast<size_t>(numBlocks) + 2, 0);
        for (int b = 0; b < numBlocks; ++b) {
            int const end = std::min(coverage.width, (b + 1) * kBlock);
            isNear[b + 1] = std::any_of(dy.begin() + b * kBlock, dy.begin() + end, [](int d) { return d != kFar; });
        }
        for (int x = 0; x < coverage.width; ++x) {
            int const block = x / kBlock + 1;
            if (dy[x] == 0) {
                out[x] = 0;
                continue;
            }
            if (!isNear[block - 1] && !isNear[block] && !isNear[block + 1] && radius <= kBlock) {
                x = std::min(coverage.width, block * kBlock) - 1;  // nothing in this block either
                continue;
            }
            int best = radius * radius + 1, bestX = 0, bestY = 0;
            int const from = std::max(0, x - radius), to = std::min(coverage.width - 1, x + radius);
            for (int at = from; at <= to; ++at) {
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
    return sources;
}

}  // namespace limn::engine
