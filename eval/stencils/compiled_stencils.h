// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <opensubdiv/far/stencilTable.h>

#include "far_ext/stencils/stencil_groups.h"

namespace limn::eval {

struct StencilJob;

/// A stencil table in the forms that are evaluated fastest, side by side and chosen by counting:
/// grouped rows with weight blocks kept once, and single rows with their weights kept once; or,
/// where single rows repeat little or data is one float per point, these sorted by size and sliced
/// instead.
///
/// Shape    GetNumStencils() rows over GetNumControlVertices() control vertices; 1 weight set
///          (values), 3 (and first derivatives) or 6 (and second ones).
/// Threads  Immutable once built; safe to share.
/// Usable from C++17. Evaluated through SimdEvaluator.
class CompiledStencils {
public:
    struct Options {
        /// Single rows in slices of 16 of nearly one size: for one float per point, and for rows of
        /// many weights and sizes at any multiple of four, as 1-forms have them. Either form takes
        /// any length.
        bool isSliced = false;
    };

    /// Compiles rows already grouped, such as those of far_ext::BuildRefinedStencils.
    ///
    /// \throws Error  BadOption: a group of more than StencilGroups::kMaxColumns control vertices
    CompiledStencils(far_ext::StencilGroups groups, Options options);
    explicit CompiledStencils(far_ext::StencilGroups groups)
        : CompiledStencils(std::move(groups), Options()) {}

    /// Compiles rows as they stand.
    ///
    /// \throws Error  as far_ext::Validate and far_ext::GroupRows
    static CompiledStencils Compile(far_ext::StencilRowsView const& rows, Options options);

    /// Compiles a table of Far (a Far::StencilTable or Far::LimitStencilTable), which is not kept.
    /// Limit stencils bring as many derivatives as they hold.
    static CompiledStencils Compile(Far::StencilTableReal<float> const& table, Options options);
    static CompiledStencils Compile(Far::LimitStencilTableReal<float> const& table,
                                    Options options);

    template <class Table>
    static CompiledStencils Compile(Table const& table) {
        return Compile(table, Options());
    }

    Index GetNumStencils() const { return _groups.numRows; }
    Index GetNumControlVertices() const { return _groups.numControls; }
    int GetNumSets() const { return _groups.numSets; }

    /// Bytes of all arrays.
    std::size_t GetMemory() const;

private:
    friend class SimdEvaluator;

    /// Rows in slices of 16 of nearly one size, see StencilSliceArrays.
    struct Slices {
        std::vector<std::size_t> offsets{0};
        std::vector<Index> rows, indices;
        std::vector<float> weights[far_ext::kMaxWeightSets];

        Index GetNum() const { return static_cast<Index>(offsets.size()) - 1; }
    };

    void Evaluate(StencilJob const& job) const;
    void EvaluateGroups(StencilJob const& job) const;
    void EvaluateSingles(StencilJob const& job) const;
    void EvaluateSlices(StencilJob const& job) const;

    static Slices MakeSlices(far_ext::StencilGroups const& groups);

    far_ext::StencilGroups _groups;
    Slices _slices;  // with isSliced, in place of the singles
};

}  // namespace limn::eval
