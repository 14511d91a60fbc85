// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "eval/differential/lanes.h"
#include "eval/differential/multigrid_levels.h"

namespace limn::eval {

/// Weights of a level in the order of its rows; empty for uniform ones.
template <class Scalar>
struct RowWeights {
    std::vector<Scalar> entries;    ///< per entry of MultigridLevel::neighbours
    std::vector<Scalar> diagonals;  ///< per unknown
};

/// Row i of G x.
template <class Scalar, class Row>
inline Row ApplyRow(MultigridLevel const& level, RowWeights<Scalar> const& weights, Row const* x,
                    Index row) {
    int const begin = level.offsets[row], end = level.offsets[row + 1];
    Index const* const neighbours = level.neighbours.data();
    Row sum = Row::Zero();
    if (!weights.entries.empty()) {
        for (int k = begin; k < end; ++k) sum += weights.entries[k] * x[neighbours[k]];
        return weights.diagonals[row] * x[row] - sum;
    }
    Row other = Row::Zero();  // two sums at once: an addition takes several cycles
    int k = begin;
    for (; k + 1 < end; k += 2) {
        sum += x[neighbours[k]];
        other += x[neighbours[k + 1]];
    }
    if (k < end) sum += x[neighbours[k]];
    return static_cast<Scalar>(end - begin) * x[row] - (sum + other);
}

template <class Scalar>
inline Scalar GetDiagonal(MultigridLevel const& level, RowWeights<Scalar> const& weights,
                          Index row) {
    return weights.entries.empty()
               ? static_cast<Scalar>(level.offsets[row + 1] - level.offsets[row])
               : weights.diagonals[row];
}

/// An approximate inverse of a level's equation, the same symmetric map for every right-hand side.
class VCycle {
public:
    /// \param levels  kept by reference
    explicit VCycle(std::vector<MultigridLevel> const& levels);

    /// Takes over weights, one entry per level (empty ones for uniform weights), and factorises the
    /// coarsest.
    ///
    /// \param largestEigenvalues  per level: a bound of those of diag(G)^-1 G
    /// \param areConstantsFree    whether singular blocks are: false with masses
    void SetWeights(std::vector<RowWeights<float>> weights, std::vector<float> largestEigenvalues,
                    bool areConstantsFree);

    /// The finest level's right-hand side, to be filled; one entry per row, those of fixed vertices
    /// are zero.
    std::vector<FloatLanes>& GetRightSide() { return _work.back().rightSide; }

    /// Runs one cycle. \return per row of the finest level
    std::vector<FloatLanes> const& Run();

    /// What Run returned last.
    std::vector<FloatLanes> const& GetResult() const { return _work.back().x; }

    size_t GetNumBytes() const;

private:
    struct Work {
        std::vector<FloatLanes> rightSide, x, next;
    };

    void Descend(size_t k);
    void Smooth(size_t k, bool startsAtZero);
    void Restrict(size_t k);
    void Prolong(size_t k);
    void FactoriseCoarsest();
    void SolveCoarsest();

    std::vector<MultigridLevel> const& _levels;
    std::vector<RowWeights<float>> _weights;
    std::vector<float> _largestEigenvalues;
    std::vector<Work> _work;
    bool _areConstantsFree = true;
    std::vector<Index> _pins;  // per unknown of the coarsest level: its equation, or -1
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> _cholesky;
};

}  // namespace limn::eval
