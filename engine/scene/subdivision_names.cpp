// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/subdivision_names.h"

#include <fmt/format.h>

namespace limn::engine {

std::string DescribeSubdivision(far_ext::ControlMesh const& cage) {
    Sdc::Options const& options = cage.options;
    return fmt::format("scheme={} boundary={} fvar={} creases={} triangles={}",
                       kSchemeWords.GetWord(cage.scheme),
                       kBoundaryWords.GetWord(options.GetVtxBoundaryInterpolation()),
                       kFVarWords.GetWord(options.GetFVarLinearInterpolation()),
                       kCreaseWords.GetWord(options.GetCreasingMethod()),
                       kTriangleWords.GetWord(options.GetTriangleSubdivision()));
}

}  // namespace limn::engine
