// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "engine/scene/model.h"

namespace limn::engine {

/// Filter widths at vertices of the control mesh; linear between them, and filtered along with the
/// surface ([Diewald02] Sec. 8).
struct VertexWidths {
    std::vector<double> sigmas;
};

/// Mean length of the edges at each vertex, times a scale.
VertexWidths MakeLocalWidths(Model const& model, double scale);

/// A table `vertex,width`; 0 at vertices that are not listed.
///
/// \throws Error  BadMesh: a vertex that does not exist or comes twice, a width that is negative.
///                Io
VertexWidths ReadVertexWidths(std::string const& path, Model const& model);

/// A number that a filter width can be.
inline bool IsWidth(double sigma) {
    return sigma >= 0.0 && std::isfinite(sigma);
}

/// A width that a line of a table gives. \throws Error  BadMesh: it is negative
void CheckWidth(double width, std::string const& path, size_t line);

}  // namespace limn::engine
