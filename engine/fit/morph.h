// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/fit/limit_operator.h"

namespace limn::engine {

struct MorphOptions {
    int detail = 2;      ///< the last band of the difference to keep
    double rate = 0.8;   ///< share of the difference that a step keeps
    double alpha = 0.0;  ///< generalised Catmull-Clark in the first step, 0 (plain) to 1
};

/// The way from one mesh to another of the same faces, frame by frame; detail goes first.
class Morph {
public:
    /// \param to      its tags rule the filter; kept
    /// \throws Error  BadMesh where the meshes do not have the same faces (the first difference is
    ///                named).  BadOption: alpha outside [0, 1] or with a scheme that has none
    Morph(Model const& from, Model const& to, MorphOptions const& options);

    /// Goes on to the next frame. \return its positions, until the next call
    ///
    /// \throws Stopped
    std::vector<double> const& MakeNext(Job& job);

private:
    Model _to;
    MorphOptions _options;
    eval::LimitOperator _operator;
    std::vector<double> _positions;
};

}  // namespace limn::engine
