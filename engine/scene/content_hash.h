// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace limn::engine {

/// SHA-256 of a mesh from arrays, as 64 hexadecimal digits: of everything but names, paths and
/// lines in files, so that two meshes of one hash are baked to the same pixels.
///
/// \param scene      its positions do not count
/// \param positions  those that count, 3 per vertex
std::string HashContent(Scene const& scene, std::vector<double> const& positions);

/// SHA-256 of numbers, as 64 hexadecimal digits.
std::string HashNumbers(std::vector<double> const& numbers);

}  // namespace limn::engine
