// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/dissection_ordering.h"

#include <mutex>
#include <new>
#include <stdexcept>
#include <vector>

#include <metis.h>

namespace limn::eval {

namespace {

/// Where memory runs out METIS ends the process. It takes up to 17 bytes per entry and 136 per row
/// of meshes' matrices (measured), less than the factorisation that follows.
void RequireMemoryForMetis(size_t numRows, size_t numEntries) {
    ::operator delete(::operator new(256 * numRows + 32 * numEntries));
}

}  // namespace

void DissectionOrdering::operator()(Eigen::SparseMatrix<double> const& matrix,
                                    PermutationType& order) const {
    auto const numRows = static_cast<idx_t>(matrix.cols());
    std::vector<idx_t> starts{0}, neighbours;
    starts.reserve(static_cast<size_t>(numRows) + 1);
    neighbours.reserve(static_cast<size_t>(matrix.nonZeros()));
    for (int column = 0; column < matrix.outerSize(); ++column) {
        for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
            if (entry.row() != column) neighbours.push_back(static_cast<idx_t>(entry.row()));
        }
        starts.push_back(static_cast<idx_t>(neighbours.size()));
    }
    RequireMemoryForMetis(static_cast<size_t>(numRows), neighbours.size());

    std::vector<idx_t> rowAt(static_cast<size_t>(numRows)), placeOf(rowAt);
    idx_t separatorSizes[1] = {0};  // 2 * numParts - 1
    static std::mutex oneAtATime;
    std::lock_guard const lock(oneAtATime);
    // The entry that ParMETIS uses, for the whole in one part, does what METIS_NodeND does, but
    // leaves signals alone.
    if (METIS_NodeNDP(numRows, starts.data(), neighbours.data(), nullptr, 1, nullptr, rowAt.data(),
                      placeOf.data(), separatorSizes) != METIS_OK)
        throw std::logic_error("METIS refuses a matrix");
    order.resize(numRows);
    for (idx_t row = 0; row < numRows; ++row)
        order.indices()[placeOf[static_cast<size_t>(row)]] = static_cast<int>(row);
}

}  // namespace limn::eval
