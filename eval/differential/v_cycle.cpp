// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/v_cycle.h"

#include "eval/parallel/rows.h"
#include "far_ext/error.h"

namespace limn::eval {

namespace {

// Took the least time of 1 to 3 sweeps and shares of 3 to 6: 324 k irregular unknowns need 6
// iterations, with one sweep 9 and 8 % more time, with three 6 and 20 % more.
constexpr int kSweeps = 2;
constexpr float kSmoothedShare = 4.0f;

}  // namespace

VCycle::VCycle(std::vector<MultigridLevel> const& levels) : _levels(levels), _work(levels.size()) {
    for (size_t k = 0; k < levels.size(); ++k) {
        size_t const numRows = levels[k].GetNumRows();
        for (auto* rows : {&_work[k].rightSide, &_work[k].x, &_work[k].next})
            rows->assign(numRows, FloatLanes::Zero());
    }
}

void VCycle::SetWeights(std::vector<RowWeights<float>> weights,
                        std::vector<float> largestEigenvalues, bool areConstantsFree) {
    _areConstantsFree = areConstantsFree;
    _weights = std::move(weights);
    _largestEigenvalues = std::move(largestEigenvalues);
    FactoriseCoarsest();
}

/// One unknown of each singular block stays zero; what is left is positive definite.
void VCycle::FactoriseCoarsest() {
    MultigridLevel const& level = _levels.front();
    _pins.assign(level.numUnknowns, 0);
    for (auto const& block : level.blocks) {
        if (block.isSingular && _areConstantsFree) _pins[block.begin] = -1;
    }
    Index numEquations = 0;
    for (Index& pin : _pins) {
        if (pin == 0) pin = numEquations++;
    }
    if (numEquations == 0) return;
    std::vector<Eigen::Triplet<double>> entries;
    for (Index row = 0; row < level.numUnknowns; ++row) {
        if (_pins[row] < 0) continue;
        entries.emplace_back(_pins[row], _pins[row],
                             static_cast<double>(GetDiagonal(level, _weights.front(), row)));
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
            Index const neighbour = level.neighbours[k];
            if (neighbour >= level.numUnknowns || _pins[neighbour] < 0) continue;
            double const weight = _weights.front().entries.empty()
                                      ? 1.0
                                      : static_cast<double>(_weights.front().entries[k]);
            entries.emplace_back(_pins[row], _pins[neighbour], -weight);
        }
    }
    Eigen::SparseMatrix<double> matrix(numEquations, numEquations);
    matrix.setFromTriplets(entries.begin(), entries.end());
    _cholesky.compute(matrix);
    if (_cholesky.info() != Eigen::Success) {
        throw Error(
            ErrorCode::BadMesh,
            "the coarsest level's equation cannot be factorised; its weights are not positive");
    }
}

void VCycle::SolveCoarsest() {
    MultigridLevel const& level = _levels.front();
    Work& work = _work.front();
    auto const subtractMean = [&](std::vector<FloatLanes>& rows) {
        for (auto const& block : level.blocks) {
            if (!block.isSingular || !_areConstantsFree) continue;
            DoubleLanes sum = DoubleLanes::Zero();
            for (Index row = block.begin; row < block.end; ++row) sum += rows[row].cast<double>();
            FloatLanes const mean = (sum / (block.end - block.begin)).cast<float>();
            for (Index row = block.begin; row < block.end; ++row) rows[row] -= mean;
        }
    };
    subtractMean(work.rightSide);
    Eigen::Matrix<double, Eigen::Dynamic, 3> b(_cholesky.rows(), 3);
    for (Index row = 0; row < level.numUnknowns; ++row) {
        if (_pins[row] >= 0)
            b.row(_pins[row]) = work.rightSide[row].head<3>().cast<double>().transpose();
    }
    if (b.rows() > 0) b = _cholesky.solve(b).eval();
    for (Index row = 0; row < level.numUnknowns; ++row) {
        work.x[row].setZero();
        if (_pins[row] >= 0)
            work.x[row].head<3>() = b.row(_pins[row]).transpose().array().cast<float>();
    }
    subtractMean(work.x);
}

/// Chebyshev iteration for the upper part of the spectrum: each sweep makes `next` from x, its
/// residual and the iterate before, which `next` holds.
void VCycle::Smooth(size_t k, bool startsAtZero) {
    MultigridLevel const& level = _levels[k];
    RowWeights<float> const& weights = _weights[k];
    Work& work = _work[k];
    float const high = _largestEigenvalues[k], low = high / kSmoothedShare;
    float const middle = 0.5f * (high + low), half = 0.5f * (high - low);
    float rho = half / middle;
    FloatLanes const* const b = work.rightSide.data();
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        float const nextRho = sweep == 0 ? rho : 1.0f / (2.0f * middle / half - rho);
        float const step = sweep == 0 ? 1.0f / middle : 2.0f * nextRho / half;
        float const momentum = sweep == 0 ? 0.0f : nextRho * rho;
        rho = nextRho;
        FloatLanes* const x = work.x.data();
        FloatLanes* const next = work.next.data();
        if (sweep == 0 && startsAtZero) {
            ForEachRow(level.numUnknowns, [&](Index row) {
                next[row] = step / GetDiagonal(level, weights, row) * b[row];
                x[row].setZero();
            });
        } else if (sweep == 0) {
            ForEachRow(level.numUnknowns, [&](Index row) {
                next[row] = x[row] + step / GetDiagonal(level, weights, row) *
                                         (b[row] - ApplyRow(level, weights, x, row));
            });
        } else {
            ForEachRow(level.numUnknowns, [&](Index row) {
                next[row] = x[row] + momentum * (x[row] - next[row]) +
                            step / GetDiagonal(level, weights, row) *
                                (b[row] - ApplyRow(level, weights, x, row));
            });
        }
        work.x.swap(work.next);
    }
}

/// The transpose of Prolong, of level k's residual (in `next`), to the right-hand side of level k -
/// 1. The neighbours of a vertex that was kept are the middles of its edges, and perhaps middles of
/// faces are theirs.
void VCycle::Restrict(size_t k) {
    MultigridLevel const &fine = _levels[k], &coarse = _levels[k - 1];
    FloatLanes const* const residual = _work[k].next.data();
    ForEachRow(coarse.numUnknowns, [&](Index row) {
        Index const child = coarse.children[row];
        FloatLanes sum = FloatLanes::Zero();
        for (int i = fine.offsets[child]; i < fine.offsets[child + 1]; ++i) {
            Index const middle = fine.neighbours[i];
            if (middle >= fine.numUnknowns) continue;
            sum += residual[middle];
            if (!fine.hasFaceVertices) continue;
            for (int j = fine.offsets[middle]; j < fine.offsets[middle + 1]; ++j) {
                Index const face = fine.neighbours[j];
                if (face >= fine.numUnknowns || fine.parents[face][0] >= 0) continue;
                sum += residual[face] /
                       static_cast<float>(fine.offsets[face + 1] - fine.offsets[face]);
            }
        }
        _work[k - 1].rightSide[row] = residual[child] + 0.5f * sum;
    });
}

void VCycle::Prolong(size_t k) {
    MultigridLevel const& fine = _levels[k];
    FloatLanes const* const coarse = _work[k - 1].x.data();
    FloatLanes* const x = _work[k].x.data();
    auto const meanOfParents = [&](Index row) -> FloatLanes {
        auto const& [a, b] = fine.parents[row];
        return 0.5f * (coarse[a] + coarse[b]);
    };
    ForEachRow(fine.numUnknowns, [&](Index row) {
        if (fine.parents[row][0] >= 0) {
            x[row] += meanOfParents(row);
            return;
        }
        FloatLanes sum = FloatLanes::Zero();
        for (int i = fine.offsets[row]; i < fine.offsets[row + 1]; ++i) {
            if (fine.neighbours[i] < fine.numUnknowns) sum += meanOfParents(fine.neighbours[i]);
        }
        x[row] += sum / static_cast<float>(fine.offsets[row + 1] - fine.offsets[row]);
    });
}

void VCycle::Descend(size_t k) {
    if (k == 0) return SolveCoarsest();
    MultigridLevel const& level = _levels[k];
    Work& work = _work[k];
    Smooth(k, true);
    ForEachRow(level.numUnknowns, [&](Index row) {
        work.next[row] = work.rightSide[row] - ApplyRow(level, _weights[k], work.x.data(), row);
    });
    Restrict(k);
    Descend(k - 1);
    Prolong(k);
    Smooth(k, false);
}

std::vector<FloatLanes> const& VCycle::Run() {
    Descend(_levels.size() - 1);
    return GetResult();
}

size_t VCycle::GetNumBytes() const {
    size_t bytes = 0;
    for (auto const& work : _work) bytes += 3 * work.x.size() * sizeof(FloatLanes);
    for (auto const& weights : _weights)
        bytes += (weights.entries.size() + weights.diagonals.size()) * sizeof(float);
    return bytes;
}

}  // namespace limn::eval
