// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/differential/differential.h"

namespace limn::engine {

/// Reads an edit of differential coordinates:
///     {"curvature": [{"vertex": 3, "factor": 1.5}],
///      "rotate": [{"vertex": 7, "axis": [0, 0, 1], "degrees": 20}], "filter": "polarise"}
/// All keys are optional; vertices are 0-based.
///
/// \throws Error  Io; BadMesh: no JSON, values nested deeper than an edit has them, an unknown key,
/// a
///                value of the wrong kind, an axis without length
CurvatureEdit ReadCurvatureEdit(std::string const& path);

}  // namespace limn::engine
