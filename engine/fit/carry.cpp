// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/carry.h"

#include <vector>

#include "eval/fit/local_rotations.h"

namespace limn::engine {

namespace {

/// Fewer steps leave bumps of the edges' length in the frames, more forget how the surface bends.
constexpr int kSmoothings = 8;

std::vector<double> Smooth(eval::LimitApplication const& A, std::span<double const> positions,
                           Job& job) {
    std::vector<double> smooth(positions.begin(), positions.end()), limits(positions.size());
    for (int i = 0; i < kSmoothings; ++i) {
        job.CheckStopped();
        A.Apply(smooth, 3, limits);
        std::swap(smooth, limits);
    }
    return smooth;
}

}  // namespace

double CarryVectors(Carry carry, eval::LimitApplication const& A, Far::TopologyLevel const& level,
                    std::span<double const> from, std::span<double const> to,
                    std::span<double> vectors, Job& job) {
    if (carry == Carry::Object) return 0.0;
    job.Start("finding local frames");
    eval::LocalRotations const rotations(level, Smooth(A, from, job), Smooth(A, to, job));
    rotations.Apply(vectors);
    return rotations.FindLargestTurn();
}

}  // namespace limn::engine
