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

/// Finds the limit points of all vertices of a level by the rows of the limit matrix, in double: no
/// face is refined but round vertices whose row has no closed form.
///
/// \param refiner  its level with all relations (a base level has them)
/// \param values   `length` numbers per vertex of the level
/// \param onBlock  called now and then; may throw to end the work
/// \throws Error   BadOption: values that do not reach all vertices
/// Source   [Limit 2], [Limit 3]
VertexLimits FindVertexLimits(Far::TopologyRefiner const& refiner, int level,
                              std::span<double const> values, int length,
                              std::function<void()> const& onBlock = {});

/// Evaluates the limit surface at all vertices, each as a corner of one of its faces: by refinement
/// towards the corner, without any limit mask, and so independent of the limit matrix.
///
/// \param maxDepth  refinements towards an irregular corner; the place evaluated is 2^-maxDepth of
///                  the face off it
/// \param onBlock   as above
/// \throws Error    BadOption: values that do not reach all vertices
VertexLimits EvaluateVertexLimits(LimitSurface const& surface, std::span<double const> values,
                                  int length, int maxDepth = FaceTree::kLimitDepth,
                                  std::function<void()> const& onBlock = {});

/// The same at some vertices; of the others nothing changes in `limits`.
void EvaluateVertexLimitsAt(std::span<Index const> vertices, LimitSurface const& surface,
                            std::span<double const> values, int length, VertexLimits& limits,
                            int maxDepth = FaceTree::kLimitDepth,
                            std::function<void()> const& onBlock = {});

}  // namespace limn::eval
