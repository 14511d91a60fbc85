// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "eval/surface/face_tree.h"

namespace limn::eval {

/// Limit points of the vertices of a mesh.
struct VertexLimits {
    std::vector<double>
        values;  ///< `length` numbers per vertex; of a vertex without a limit: its own
    std::vector<char> hasLimit;  ///< per vertex: some face round it has a limit surface
};

/// Evaluates the limit surface at all vertices, each as a corner of one of its faces: by refinement
/// towards the corner, without any limit mask, and so independent of the limit matrix.
///
/// \param maxDepth  refinements towards an irregular corner; the place evaluated is 2^-maxDepth of
///                  the face off it
/// \param onBlock   called now and then; may throw to end the work
/// \throws Error    BadOption: values that do not reach all vertices
VertexLimits EvaluateVertexLimits(LimitSurface const& surface, std::span<double const> values,
                                  int length, int maxDepth = FaceTree::kLimitDepth,
                                  std::function<void()> const& onBlock = {});

}  // namespace limn::eval
