// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "engine/scene/scene.h"

namespace limn::engine {

/// Joins vertices on boundaries that lie in one place, as where an exporter has cut a mesh along
/// its texture seams: sheets that only touched become one surface.
///
/// * Vertices coincide as engine/scene/coincidence.h says; of a group the point that comes first by
///   x, y, z stays, as one vertex. Vertices within a surface stay as they are.
/// * Faces, groups and holes stay. Texture coordinates stay face-varying; corners of one vertex
/// that
///   had equal ones share them. Creases and corners move along; of several at one place the
///   sharpest counts. Of primvars that differ the mean is taken, and a warning says so.
/// * A group stays apart, and a warning says so, if joined it would give a face one corner twice or
///   an edge of two sheets a third face.
///
/// The result does not depend on the numbering of vertices (but for its own), and welding it again
/// changes nothing. Its vertices are numbered in the order of the first that each has been. Normals
/// are left out: limits have their own.
///
/// \param tolerance  0 (equal positions) or more
/// \throws Error     BadMesh: what far_ext::Validate refuses, positions that are missing or not
///                   finite; BadOption: a tolerance below 0, or too large for GroupCoincident
Scene Weld(Scene scene, double tolerance);

/// Whether Weld would join any vertices, rather than leave all apart.
///
/// \pre  a mesh that could be built
bool CanWeld(far_ext::ControlMesh const& cage, std::span<double const> positions, double tolerance);

}  // namespace limn::engine
