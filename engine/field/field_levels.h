// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/scene/model.h"

namespace limn::engine {

/// How often a field's form is refined before it is baked into textures of this size: so often that
/// a refined face is 1 to 2 texels wide, or that there are a million.
///
/// \pre the mesh has texture coordinates
int ChooseFieldLevels(Model const& model, int width, int height);

}  // namespace limn::engine
