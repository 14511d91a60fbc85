// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/require_limit.h"

#include <fmt/format.h>

#include "eval/surface/limit_surface.h"
#include "far_ext/error.h"

namespace limn::engine {

void RequireLimit(Model const& model) {
    auto const excess = eval::LimitSurface::FindExcess(model.GetRefiner());
    if (!excess) return;
    std::string const name = excess->isFace ? model.NameFace(excess->element)
                                            : fmt::format("vertex {}", excess->element);
    throw Error(ErrorCode::TooLarge,
                fmt::format("{}: {}", model.GetPath(), excess->Describe(name)));
}

}  // namespace limn::engine
