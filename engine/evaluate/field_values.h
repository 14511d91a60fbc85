// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "engine/evaluate/places.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// The vectors of a tangent field at places of the limit, three numbers per place; NaN where the
/// face has no limit surface.
///
/// \param form    of the field, per edge of the mesh
/// \param levels  refinements: how near the field is to its limit next to extraordinary vertices
/// \throws Error  as LocatePlaces, eval::FieldSurface
/// \throws Stopped
std::vector<double> EvaluateField(Model const& model, PlaceArrays const& places,
                                  std::span<double const> form, int levels, Job& job);

/// Refinements that a field at places is good with: 4, fewer on meshes that would have more than
/// 2^20 faces then.
int ChooseFieldLevels(Model const& model);

}  // namespace limn::engine
