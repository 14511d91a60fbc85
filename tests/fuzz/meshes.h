// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/scene/scene.h"
#include "fuzz/choices.h"

namespace limn::fuzz {

/// A mesh of at most 60 faces: a shape with damage, tags, texture coordinates, groups, primvars and
/// rules. Most can be built; some must be refused.
engine::Scene ChooseMesh(Choices& choices);

}  // namespace limn::fuzz
