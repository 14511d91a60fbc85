#include "eval/cascade_sweep.h"

#include <algorithm>
#include <span>
#include <vector>

#include "eval/cascade_kernel.h"

namespace limn::eval {

namespace {

using far_ext::CascadeLevel;

constexpr Index kBlocksPerGroup = 4, kRowsPerGroup = kBlocksPerGroup * kRowsPerBlock;
constexpr Index kLeastGroups = 8;  // fewer stay in the cache from sweep to sweep
constexpr size_t kSweepsPerPass = 4;

template <class Scalar>
CascadeSweepJob<Scalar> MakeJob(CascadeLevel const& level, CascadeOperator<Scalar> const& op, CascadeRows<Scalar> const& x,
                                CascadeRows<Scalar> const& x0, CascadeRows<Scalar>& to) {
    return {GetRings(level),        op.edges.data(),  op.masses.data(),   op.diagonals.data(),
            Scalar(kJacobiDamping), x.data()->data(), x0.data()->data(), to.data()->data()};
}

template <class Scalar>
void Sweep(CascadeLevel const& level, CascadeSweepJob<Scalar> const& job) {
    ForEachBlock(level.numUnknowns, [&](Index begin, Index end, size_t) { SweepCascadeRows(job, begin, end); });
}

/// Sweeps over groups of rows, each sweep two groups behind the one before: what it reads is done, and what it writes is
/// read no more, as neighbours are in the next group at most. All of one step is independent.
template <class Scalar>
void SweepInOnePass(CascadeLevel const& level, std::span<CascadeSweepJob<Scalar> const> jobs) {
    Index const numSweeps = static_cast<Index>(jobs.size()), numGroups = (level.numUnknowns + kRowsPerGroup - 1) / kRowsPerGroup;
    for (Index step = 0; step < numGroups + 2 * (numSweeps - 1); ++step) {
        tbb::parallel_for(Index{0}, numSweeps * kBlocksPerGroup, [&](Index block) {
            Index const sweep = block / kBlocksPerGroup, group = step - 2 * sweep;
            Index const begin = group * kRowsPerGroup + block % kBlocksPerGroup * kRowsPerBlock;
            Index const end = std::min(begin + kRowsPerBlock, level.numUnknowns);
            if (group >= 0 && begin < end) SweepCascadeRows(jobs[sweep], begin, end);
        });
    }
}

template <class Scalar>
void SweepAll(CascadeLevel const& level, CascadeOperator<Scalar> const& op, CascadeRows<Scalar> const& x,
              CascadeRows<Scalar> const& x0, CascadeRows<Scalar>& odd, CascadeRows<Scalar>& even, int count) {
    bool const isOneByOne = level.bandwidth > kRowsPerGroup || level.numUnknowns < kLeastGroups * kRowsPerGroup;
    std::vector<CascadeSweepJob<Scalar>> jobs;
    for (int sweep = 1; sweep <= count; ++sweep) {
        CascadeRows<Scalar> const& from = sweep == 1 ? x : sweep % 2 == 1 ? even : odd;
        jobs.push_back(MakeJob(level, op, from, x0, sweep % 2 == 1 ? odd : even));
        if (isOneByOne) {
            Sweep(level, jobs.back());
        } else if (jobs.size() == kSweepsPerPass || sweep == count) {
            SweepInOnePass<Scalar>(level, jobs);
        } else {
            continue;
        }
        jobs.clear();
    }
}

}  // namespace

void SweepJacobi(CascadeLevel const& level, CascadeOperator<float> const& op, CascadeRows<float> const& x,
                 CascadeRows<float> const& x0, CascadeRows<float>& to) {
    Sweep(level, MakeJob(level, op, x, x0, to));
}

void SweepJacobi(CascadeLevel const& level, CascadeOperator<double> const& op, CascadeRows<double> const& x,
                 CascadeRows<double> const& x0, CascadeRows<double>& to) {
    Sweep(level, MakeJob(level, op, x, x0, to));
}

void SweepJacobi(CascadeLevel const& level, CascadeOperator<float> const& op, CascadeRows<float> const& x,
                 CascadeRows<float> const& x0, CascadeRows<float>& odd, CascadeRows<float>& even, int count) {
    SweepAll(level, op, x, x0, odd, even, count);
}

void SweepJacobi(CascadeLevel const& level, CascadeOperator<double> const& op, CascadeRows<double> const& x,
                 CascadeRows<double> const& x0, CascadeRows<double>& odd, CascadeRows<double>& even, int count) {
    SweepAll(level, op, x, x0, odd, even, count);
}

}  // namespace limn::eval
