// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// Images with a vector field on a surface, as the map `field` of a bake has it: its vectors in
/// object space, or its flow in texture coordinates.
struct FieldTexture {
    std::string pattern;  ///< with <UDIM> a file for each tile, else that of tile 1001
    bool isFlow = false;  ///< texture coordinates per unit of time, in R and G
};

/// The form per edge of the mesh whose limit field has the vectors of the images. Of the texels
/// that the surface covers 16 a face count at most, those nearest to a lattice on it; what they do
/// not tell, on faces without texels above all, is filled in smoothly, and warned of.
///
/// \throws Error  BadMesh: no texture coordinates, no texel on the surface, a texel on it that is
///                not finite; as far_ext::CheckForms.  Io: no image, or without such channels
/// \throws Stopped
/// Source  [Forms 15]
std::vector<double> MatchFieldTexture(Model const& model, FieldTexture const& texture, Job& job);

}  // namespace limn::engine
