#pragma once

#include "engine/scene.h"

namespace limn::engine {

/// Refines a mesh uniformly by OpenSubdiv's rules, in double.
///
/// The result has OpenSubdiv's vertex order, refined UVs and primvars, decayed creases and corners,
/// holes and groups of the parents.
///
/// \param levels  0 to 10
/// \param toLimit also moves the vertices (not the UVs) to their limit
/// \throws Error  BadOption; TooLarge where the refined mesh would pass 2^31 indices
Scene RefineUniformly(Scene const& scene, int levels, bool toLimit);

}  // namespace limn::engine
