// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::far_ext {

/// What rules need that look across edges and along boundaries.
///
/// \param rule    its name, for messages
/// \throws Error  BadMesh: an edge with more than two faces, or a vertex where boundaries meet
void RequireSimpleEdges(Far::TopologyLevel const& level, char const* rule);

}  // namespace limn::far_ext
