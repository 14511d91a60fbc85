// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/field/field.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// The form on the control mesh, and what an audit says of it.
struct ControlForm {
    std::vector<double> form;
    /// Per vertex: the function of the gradient part. Given values and pins stay as they are; what
    /// else has a gradient is 0 at the lowest vertex of each component.
    std::vector<double> values;
    FieldAudit audit;
};

/// \throws Error  as DesignField  \throws Stopped
ControlForm DesignControlForm(Model const& model, FieldOptions const& options, Job& job);

}  // namespace limn::engine
