// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/sweep_matrices.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "eval/cascade/cascade_sweep.h"
#include "far_ext/cascade/cascade_stencils.h"

namespace limn::eval {

namespace {

using far_ext::CascadeLevel;
using far_ext::SparseRows;

template <class Scalar>
std::vector<double> ToDoubles(far_ext::LargeArray<Scalar> const& values) {
    return {values.begin(), values.end()};
}

template <class Scalar>
far_ext::BasicCascadeStencils<double> MakeStencils(CascadeLevel const& level,
                                                   CascadeOperator<Scalar> const& op) {
    std::vector<double> scales;
    for (Scalar const diagonal : op.diagonals) {
        scales.push_back(diagonal != Scalar(0) ? kJacobiDamping / static_cast<double>(diagonal)
                                               : 0.0);
    }
    far_ext::BasicCascadeStencils<double> stencils(level);
    stencils.SetWeights(level, ToDoubles(op.edges), ToDoubles(op.masses), scales);
    return stencils;
}

void Append(SparseRows& rows, Index index, double weight) {
    rows.indices.push_back(index);
    rows.weights.push_back(weight);
}

void EndRow(SparseRows& rows) {
    rows.offsets.push_back(static_cast<int>(rows.indices.size()));
}

/// The same matrix with rows and columns of other numbers.
///
/// \param names  per row and column of the old ones
SparseRows Renumber(SparseRows const& rows, std::span<Index const> names) {
    std::vector<int> ofName(names.size());
    for (size_t row = 0; row < names.size(); ++row) ofName[names[row]] = static_cast<int>(row);
    SparseRows renumbered;
    std::vector<std::pair<Index, double>> entries;
    for (int const row : ofName) {
        entries.clear();
        for (int k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k)
            entries.emplace_back(names[rows.indices[k]], rows.weights[k]);
        std::ranges::sort(entries);
        for (auto const& [index, weight] : entries) Append(renumbered, index, weight);
        EndRow(renumbered);
    }
    return renumbered;
}

}  // namespace

template <class Scalar>
SweepMatrices MakeSweepMatrices(CascadeLevel const& level, CascadeOperator<Scalar> const& op) {
    auto const stencils = MakeStencils(level, op);
    auto const& indices = stencils.GetControlIndices();
    Index const numRows = level.GetNumRows();
    SweepMatrices made;
    for (Index row = 0; row < numRows; ++row) {
        bool const isMoved = row < level.numUnknowns && op.diagonals[row] != Scalar(0);
        if (!isMoved) Append(made.load, row, 1.0);
        int const begin = stencils.GetOffsets()[row], end = begin + stencils.GetSizes()[row];
        for (int k = begin; isMoved && k < end; ++k) {
            bool const isOfStart = indices[k] >= numRows;
            Append(isOfStart ? made.load : made.sweep, indices[k] - (isOfStart ? numRows : 0),
                   stencils.GetWeights()[k]);
        }
        EndRow(made.sweep);
        EndRow(made.load);
    }
    return made;
}

template SweepMatrices MakeSweepMatrices(CascadeLevel const& level,
                                         CascadeOperator<float> const& op);
template SweepMatrices MakeSweepMatrices(CascadeLevel const& level,
                                         CascadeOperator<double> const& op);

SweepMatrices ToPublicOrder(CascadeLevel const& level, SweepMatrices const& ofRows) {
    return {Renumber(ofRows.sweep, level.vertices), Renumber(ofRows.load, level.vertices)};
}

}  // namespace limn::eval
