// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/bake/bake_options.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// One bake per group, for a pattern with {group}: of the groups that the options name; of all
/// groups of one kind otherwise, materials (usemtl) before groups (g) before objects (o), with a
/// warning of faces that are in none, and of those without texture coordinates. A group without a
/// texel is a warning, too, and no error.
///
/// \throws Error  BadOption: a group that there is not, a mesh without groups, or two groups whose
///                outputs would have one name, as `b/c` and `b_c` have
std::vector<BakeOptions> SplitByGroup(Model const& model, BakeOptions const& options, Job& job);

}  // namespace limn::engine
