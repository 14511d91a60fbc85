// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::engine {

/// A row of a table of edges.
struct EdgeValue {
    Index edge, from, to;
    double value;
    size_t line;
    int kind = 0;  ///< which of the table's kinds
};

/// Rows of a table `v0,v1,COLUMN`, as they come; with kinds, "a|b", of `v0,v1,kind,COLUMN`.
///
/// \throws Error  BadMesh: an edge that does not exist or comes twice (file and line named).  Io
std::vector<EdgeValue> ReadEdgeTable(std::string const& path, char const* column,
                                     Far::TopologyLevel const& level, char const* kinds = nullptr);

/// The edges of a table `v0,v1`, as they come. \throws Error  as above
std::vector<EdgeValue> ReadEdgeList(std::string const& path, Far::TopologyLevel const& level);

/// A 1-form from a table `v0,v1,value`: what a field does along the edges from v0 to v1; 0 on edges
/// that are not listed.
///
/// \return per edge of the level, in the direction of far_ext/forms/form_operators.h
/// \throws Error  as above
std::vector<double> ReadEdgeValues(std::string const& path, Far::TopologyLevel const& level);

/// The same table of a 1-form, all edges, each from its lower vertex; numbers read back the same.
std::string FormatEdgeValues(Far::TopologyLevel const& level, std::span<double const> form);

}  // namespace limn::engine
