// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/io/mesh_writer.h"

namespace limn::engine {

/// The subdivision of forms as matrices, from the base to the last level: S1 of values along edges
/// and S2 of integrals over faces as Matrix Market files, and beside S1 what its columns and rows
/// are, as tables `edge,v0,v1` of the base's and the last level's edges.
///
/// \param s1      x.mtx; the tables are x.edges0.csv and x.edgesK.csv, of level K
/// \throws Error  as far_ext::ComposeFormStencils; Io
void AddFormMatrices(Far::TopologyRefiner const& refined, int levels, std::string const& s1,
                     std::string const& s2, MeshSequence& files);

/// Those tables' names.
std::string NameEdgeTable(std::string const& s1, int level);

}  // namespace limn::engine
