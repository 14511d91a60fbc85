// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/bake/bake_options.h"
#include "engine/bake/bake_report.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// Warns of faces that have no texture coordinates beside others that have some, and of those whose
/// polygon in the texture has no area, as DescribeUVs counts them.
void WarnOfLostFaces(Model const& model, Job& job);

/// Warns of what is known before anything is baked: faces left out (unless the bake is one of
/// several, SplitByGroup), values that their type cannot hold.
void WarnBeforeBake(Model const& model, BakeOptions const& options,
                    std::vector<FileLayout> const& files, Job& job);

/// Warns of what a person would want to know of a bake that is done.
///
/// \param movedPlaces  the vertices that samples were moved away from
void WarnAfterBake(Model const& model, BakeOptions const& options, BakeReport const& report,
                   std::vector<std::string> movedPlaces, Job& job);

}  // namespace limn::engine
