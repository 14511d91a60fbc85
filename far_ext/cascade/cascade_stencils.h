// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "far_ext/cascade/cascade_level.h"

namespace limn::far_ext {

/// One damped Jacobi sweep X - theta D^-1 ((M + L) X - M X0) as a stencil table over [X; X0], that
/// OpenSubdiv's evaluators run where weights are floats.
///
/// Shape   n rows over 2 n points, for the n rows of a level: X, then X0. An unknown's row is
///         itself, its ring and its start value; that of a row that stays is itself.
/// Source  [Diewald02] Sec. 7
template <class Weight>
class BasicCascadeStencils {
public:
    /// \throws Error  TooLarge: more than 2^31 entries
    explicit BasicCascadeStencils(CascadeLevel const& level);

    /// Refills the weights; indices stay.
    ///
    /// \param edges   -L_ij, per entry of CascadeLevel::neighbours
    /// \param masses  M_ii, per unknown
    /// \param scales  theta / D_ii, per unknown; 0 for one that nothing moves
    void SetWeights(CascadeLevel const& level, std::span<Weight const> edges,
                    std::span<Weight const> masses, std::span<Weight const> scales);

    // Accessors of Far::StencilTable.
    Index GetNumStencils() const { return static_cast<Index>(_sizes.size()); }
    Index GetNumControlVertices() const { return 2 * GetNumStencils(); }
    std::vector<int> const& GetSizes() const { return _sizes; }
    std::vector<Index> const& GetOffsets() const { return _offsets; }
    std::vector<Index> const& GetControlIndices() const { return _indices; }
    std::vector<Weight> const& GetWeights() const { return _weights; }

private:
    std::vector<int> _sizes;
    std::vector<Index> _offsets, _indices;
    std::vector<Weight> _weights;
};

using CascadeStencils = BasicCascadeStencils<float>;

}  // namespace limn::far_ext
