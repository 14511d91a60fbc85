// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "far_ext/limit/limit_row.h"
#include "far_ext/rows/sparse_matrix.h"

namespace limn::far_ext {

/// The limit-point matrix A: row i of A P is the point of the limit surface that control vertex i
/// of the control points P converges to.
///
/// Shape   n x n for n vertices of the level; row i reaches the one-ring of faces of vertex i. Its
///         diagonal comes first, no column twice.
/// Weights add up to 1 in each row; no unit. On a closed Catmull-Clark mesh the eigenvalues lie in
/// (0, 1]; 0 can
///         occur where all valences are 3 (a cube).
/// Source  [LaiCheng11] Sec. 3, Appendix B; [Limit 2], [Limit 5].
class LimitMatrix {
public:
    /// Builds A of one level in linear time; alpha as in LimitOptions.
    ///
    /// \throws Error  as LimitRowBuilder; TooLarge where A would pass 2^31 entries
    static LimitMatrix Build(Far::TopologyRefiner const& refiner, int level = 0,
                             LimitOptions const& options = {});

    /// The arrays of a stencil table, as OpenSubdiv's evaluators read them.
    int GetNumControlVertices() const { return _rows.GetNumRows(); }
    int GetNumStencils() const { return _rows.GetNumRows(); }
    std::vector<int> const& GetSizes() const { return _sizes; }
    std::vector<int> const& GetOffsets() const {
        return _rows.offsets;
    }  ///< with the end of the last row
    LargeArray<Index> const& GetControlIndices() const { return _rows.indices; }
    LargeArray<double> const& GetWeights() const { return _rows.weights; }
    std::vector<float> MakeFloatWeights() const {
        return {_rows.weights.begin(), _rows.weights.end()};
    }

    /// The same arrays as a matrix; valid as long as this is.
    using Matrix = SparseRowsView;
    Matrix AsMatrix() const;

    /// The diagonal of D: D A is symmetric on closed meshes.
    std::vector<double> const& GetScales() const { return _scales; }

private:
    SparseRows _rows;
    std::vector<int> _sizes;
    std::vector<double> _scales;
};

}  // namespace limn::far_ext
