// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/bake/bake_options.h"
#include "engine/scene/model.h"

namespace limn::test {

/// A torus with texture coordinates and a primvar 'color' of three channels.
engine::Model MakeModelWithColours();

/// `scene` with a primvar 'color' made of its positions.
engine::Model AddColours(engine::Scene scene);

/// Options that name every map there is, with what each needs: another mesh, a field, ...
engine::BakeOptions OptionsForAllMaps(engine::Model const& model);

}  // namespace limn::test
