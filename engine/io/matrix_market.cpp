// SPDX-License-Identifier: Apache-2.0
#include "engine/io/matrix_market.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/version.h"

namespace limn::engine {

namespace {

constexpr double kSmallestEntry = 1e-15;

}  // namespace

void WriteMatrixMarket(AtomicFile& file, far_ext::SparseRowsView const& matrix,
                       MatrixNames const& names) {
    auto const isKept = [](double value) { return std::abs(value) >= kSmallestEntry; };
    auto const count =
        std::count_if(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(), isKept);
    file.Write(
        fmt::format("%%MatrixMarket matrix coordinate real general\n"
                    "% limn {}: rows are {}, columns are {}\n{} {} {}\n",
                    kVersion, names.rows, names.columns, matrix.rows(), matrix.cols(), count));
    std::vector<std::pair<Index, double>> entries;
    std::string text;
    constexpr size_t kBlock = 1 << 16;
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        entries.clear();
        for (far_ext::SparseRowsView::InnerIterator entry(matrix, row); entry; ++entry) {
            if (isKept(entry.value())) entries.emplace_back(entry.col(), entry.value());
        }
        std::ranges::sort(entries, {}, &std::pair<Index, double>::first);
        for (auto const& [column, value] : entries)
            fmt::format_to(std::back_inserter(text), "{} {} {:.17g}\n", row + 1, column + 1, value);
        if (text.size() < kBlock) continue;
        file.Write(text);
        text.clear();
    }
    file.Write(text);
}

}  // namespace limn::engine
