// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/scene/mesh_info.h"
#include "engine/scene/model.h"

namespace limn::test {

inline engine::MeshInfo Describe(engine::Scene const& scene) {
    return engine::DescribeMesh(engine::Model::Build(scene));
}

}  // namespace limn::test
