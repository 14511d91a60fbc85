// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/differential/differential.h"

namespace limn::engine {

/// Reads an edit of differential coordinates:
///     {"set_curvature": [{"vertex": 3, "mean": 0.2}],
///      "curvature": [{"vertex": 3, "factor": 1.5}],
///      "set_normal": [{"vertex": 7, "normal": [0, 1, 1]}],
///      "rotate": [{"vertex": 7, "axis": [0, 0, 1], "degrees": 20}],
///      "filter": "polarise" or {"points": [[0, 0], [0.5, 0.2], [1, 1]]}}
/// All keys are optional; vertices are 0-based; x of the filter's points rises within [0, 1].
///
/// \throws Error  Io; BadMesh: no JSON, values nested deeper than an edit has them, an unknown key,
/// a
///                value of the wrong kind, a direction without length
CurvatureEdit ReadCurvatureEdit(std::string const& path);

}  // namespace limn::engine
