// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "eval/differential/area_fit.h"
#include "far_ext/differential/laplacian.h"

namespace limn::test {

inline far_ext::AreaLaplacian BuildLaplacian(eval::AreaLaplacianKind kind,
                                             Far::TopologyLevel const& level,
                                             std::span<double const> positions,
                                             far_ext::HeatKernel* kernel = nullptr) {
    return kind == eval::AreaLaplacianKind::Heat
               ? far_ext::BuildHeatLaplacian(level, positions, kernel)
               : far_ext::BuildCotangentLaplacian(level, positions);
}

}  // namespace limn::test
