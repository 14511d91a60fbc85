// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "engine/io/edge_values.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/stencils/table_evaluator.h"

namespace limn::engine {

/// What a field does along an edge, from one end to the other.
struct EdgeCirculation {
    Index from, to;
    double value;
};

/// The circulation of a 1-form's limit along the limits of edges of the mesh. Of a gradient it is
/// the difference of the function's limits.
///
/// \param form    per edge of the mesh
/// \param edges   what is to be looked at; their values do not count
/// \param evaluator  subdivides the form by tables in float; null: in double
/// \throws Error  as far_ext::EdgeLimits, RefineUniformly
/// \throws Stopped
/// Source         [Forms 7.1]
std::vector<EdgeCirculation> FindCirculations(Model const& model, std::span<double const> form,
                                              std::span<EdgeValue const> edges, Job& job,
                                              eval::TableEvaluator* evaluator = nullptr);

}  // namespace limn::engine
