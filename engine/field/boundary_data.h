// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/field/field.h"
#include "engine/scene/model.h"
#include "eval/forms/boundary_problem.h"

namespace limn::engine {

/// A field's part by sources and vortices under boundary data, and what it does there.
struct BoundedField {
    std::vector<double> form;
    BoundaryAudit audit;
};

/// Rows of a table `v0,v1,kind,value`, of kinds circulation (from v0 to v1) and flux (outwards).
///
/// \throws Error  as ReadEdgeTable
std::vector<BoundaryEdge> ReadBoundaryEdges(std::string const& path,
                                            Far::TopologyLevel const& level);

/// Designs it.
///
/// \param sources   per vertex  \param vortices  per face
/// \throws Error    BadMesh: an element that does not exist or is none of a boundary's, a loop or
///                  edge given twice, numbers that cannot be met together (both named).
///                  BadOption: `harmonics` beside boundary data
BoundedField DesignBounded(Model const& model, FieldOptions const& options,
                           std::vector<double> sources, std::vector<double> vortices);

}  // namespace limn::engine
