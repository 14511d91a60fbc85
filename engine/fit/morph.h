// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/fit/limit_application.h"

namespace limn::engine {

/// From a frame to the next.
struct MorphStep {
    int detail = 2;     ///< the last band of the difference to keep
    double rate = 0.8;  ///< share of the difference that is kept
};

struct MorphOptions {
    std::vector<MorphStep> steps = std::vector<MorphStep>(10);  ///< one per frame
    bool endsExactly = false;  ///< the last frame is the mesh that is gone to; what the steps leave
                               ///< of the difference is taken off little by little
    far_ext::LimitOptions rule{};               ///< of the limit matrix, as SplitIntoBands
    eval::TableEvaluator* evaluator = nullptr;  ///< the same; outlives the morph

    /// \throws Error  BadOption
    void Check() const;
};

/// The way from one mesh to another of the same faces, frame by frame; detail goes first.
///
/// Frames are Q_k, with Q_k - M = rho_k D_k (Q_(k-1) - M) and M the mesh that is gone to; with an
/// exact end Q_k - s_k (Q_N - M), s_k = (1 - rho_1 .. rho_k) / (1 - rho_1 .. rho_N).
///
/// Source  [LaiCheng11] (9); [Limit 7]
class Morph {
public:
    /// \param to      its tags rule the filter; kept
    /// \throws Error  BadMesh where the meshes do not have the same faces (the first difference is
    ///                named).  BadOption: alpha outside [0, 1] or with a scheme that has none; an
    ///                exact end of steps that keep the whole difference; a rate that is not from 0
    ///                to 1, a detail that is no band
    Morph(Model const& from, Model const& to, MorphOptions const& options);

    /// Goes on to the next frame. \return its positions, until the next call
    ///
    /// \throws Error  BadOption: there are no more steps
    /// \throws Stopped
    std::vector<double> const& MakeNext(Job& job);

private:
    void FindRest(Job& job);
    void TakeStep(size_t step, std::vector<double>& positions) const;

    Model _to;
    MorphOptions _options;
    eval::LimitApplication _operator;
    size_t _numMade = 0;
    double _kept = 1.0, _keptAtEnd = 1.0;           // products of rates
    std::vector<double> _positions, _rest, _frame;  // Q_k, Q_N - M, the frame where that differs
};

}  // namespace limn::engine
