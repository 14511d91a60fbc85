// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/cascade_sweep.h"

#include <vector>

#include "eval/cascade/cascade_kernel.h"
#include "eval/kernels/dispatch.h"
#include "eval/parallel/step_pass.h"

namespace limn::eval {

namespace {

using far_ext::CascadeLevel;

template <class Scalar>
CascadeSweepJob<Scalar> MakeJob(CascadeLevel const& level, CascadeOperator<Scalar> const& op,
                                CascadeRows<Scalar> const& x, CascadeRows<Scalar> const& x0,
                                CascadeRows<Scalar>& to) {
    return {GetRings(level),        op.edges.data(),  op.masses.data(),  op.diagonals.data(),
            Scalar(kJacobiDamping), x.data()->data(), x0.data()->data(), to.data()->data()};
}

template <class Scalar>
CascadeFunctions<Scalar> const& GetFunctions() {
    return GetKernel<CascadeKernel>();
}

template <class Scalar>
void Sweep(CascadeLevel const& level, CascadeSweepJob<Scalar> const& job) {
    ForEachBlock(level.numUnknowns, kRowsPerBlock, [&](Index begin, Index end) {
        GetFunctions<Scalar>().sweepRows(job, begin, end);
    });
}

template <class Scalar>
void SweepAll(CascadeLevel const& level, CascadeOperator<Scalar> const& op,
              CascadeRows<Scalar> const& x, CascadeRows<Scalar> const& x0, CascadeRows<Scalar>& odd,
              CascadeRows<Scalar>& even, int count) {
    int const perPass = CountStepsPerPass(level.numUnknowns, level.bandwidth);
    std::vector<CascadeSweepJob<Scalar>> jobs;
    for (int sweep = 1; sweep <= count; ++sweep) {
        CascadeRows<Scalar> const& from = sweep == 1 ? x : sweep % 2 == 1 ? even : odd;
        jobs.push_back(MakeJob(level, op, from, x0, sweep % 2 == 1 ? odd : even));
        if (static_cast<int>(jobs.size()) < perPass && sweep < count) continue;
        if (jobs.size() == 1) {
            Sweep(level, jobs[0]);
        } else {
            RunStepsInOnePass(static_cast<Index>(jobs.size()), level.numUnknowns, level.bandwidth,
                              [&](Index step, Index begin, Index end) {
                                  GetFunctions<Scalar>().sweepRows(jobs[step], begin, end);
                              });
        }
        jobs.clear();
    }
}

}  // namespace

void SweepJacobi(CascadeLevel const& level, CascadeOperator<float> const& op,
                 CascadeRows<float> const& x, CascadeRows<float> const& x0,
                 CascadeRows<float>& to) {
    Sweep(level, MakeJob(level, op, x, x0, to));
}

void SweepJacobi(CascadeLevel const& level, CascadeOperator<double> const& op,
                 CascadeRows<double> const& x, CascadeRows<double> const& x0,
                 CascadeRows<double>& to) {
    Sweep(level, MakeJob(level, op, x, x0, to));
}

void SweepJacobi(CascadeLevel const& level, CascadeOperator<float> const& op,
                 CascadeRows<float> const& x, CascadeRows<float> const& x0, CascadeRows<float>& odd,
                 CascadeRows<float>& even, int count) {
    SweepAll(level, op, x, x0, odd, even, count);
}

void SweepJacobi(CascadeLevel const& level, CascadeOperator<double> const& op,
                 CascadeRows<double> const& x, CascadeRows<double> const& x0,
                 CascadeRows<double>& odd, CascadeRows<double>& even, int count) {
    SweepAll(level, op, x, x0, odd, even, count);
}

}  // namespace limn::eval
