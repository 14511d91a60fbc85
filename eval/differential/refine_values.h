// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstring>
#include <span>
#include <vector>

#include <opensubdiv/far/primvarRefiner.h>

#include "far_ext/types.h"

namespace limn::eval {

/// N doubles, as Far's refiner reads and blends them.
template <size_t N>
struct ValueRow {
    std::array<double, N> values;

    void Clear() { values.fill(0.0); }
    void AddWithWeight(ValueRow const& other, double weight) {
        for (size_t c = 0; c < N; ++c) values[c] += weight * other.values[c];
    }
};

/// Values of level `level` - 1 of a uniform refinement to those of `level`, N doubles each: of
/// vertices, or of a face-varying channel.
template <size_t N>
std::vector<double> RefineValues(Far::TopologyRefiner const& refiner, int level,
                                 std::span<double const> coarse, int fvarChannel = -1) {
    static_assert(sizeof(ValueRow<N>) == N * sizeof(double));
    Far::PrimvarRefinerReal<double> const primvars(refiner);
    auto const topology = refiner.GetLevel(level);
    bool const isFVar = fvarChannel >= 0;
    size_t const count =
        isFVar ? topology.GetNumFVarValues(fvarChannel) : topology.GetNumVertices();
    std::vector<ValueRow<N>> from(coarse.size() / N), to(count);
    std::memcpy(from.data(), coarse.data(), coarse.size_bytes());
    if (isFVar)
        primvars.InterpolateFaceVarying(level, from, to, fvarChannel);
    else
        primvars.Interpolate(level, from, to);
    std::vector<double> fine(count * N);
    std::memcpy(fine.data(), to.data(), fine.size() * sizeof(double));
    return fine;
}

}  // namespace limn::eval
