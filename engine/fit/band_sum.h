// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "engine/fit/carry.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/fit/decompose.h"

namespace limn::engine {

struct BandSumOptions {
    eval::BandGains gains;         ///< of the bands that are taken
    std::optional<Model> from{};   ///< whose bands take the place of the mesh's; none: its own,
                                   ///< which then are all that is left of it
    Carry carry = Carry::Local;    ///< how those of another mesh come over
    far_ext::LimitOptions rule{};  ///< of the limit matrix, as SplitIntoBands
    eval::TableEvaluator* evaluator = nullptr;  ///< the same

    /// \throws Error  BadOption
    void Check() const;
};

/// A mesh as a sum of bands: its own, weighed, or itself with some bands of another.
struct BandSum {
    /// A band that is in the sum, before it is weighed and carried.
    struct Part {
        std::optional<int> band;  ///< none: the remainder
        double rms = 0.0;         ///< length of its vectors, in the unit of the mesh
        double gain = 0.0;
    };

    std::vector<double> positions;  ///< 3 per vertex
    std::vector<Part> parts;
    double largestTurnDegrees = 0.0;  ///< of Carry::Local
};

/// sum over k of g_k (E-A)^k A M, + r (E-A)^N M; of another mesh O: M - b(M) + R b(O), b being the
/// bands that are taken, all with gain 1 for M, and R as Carry says.
///
/// \param model   M; its tags make A
/// \throws Error  BadMesh: other faces than those of the mesh that bands come from (the first
///                difference is named).  BadOption: as SplitIntoBands, bands below 0,
///                gains that are no numbers
/// \throws Stopped
/// Source  [LaiCheng11] (6); [Limit 7]
BandSum SumBands(Model const& model, BandSumOptions const& options, Job& job);

}  // namespace limn::engine
