// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/rows/sparse_rows.h"
#include "far_ext/stencils/stencil_rows.h"

namespace limn::far_ext {

/// One refinement of 1-forms and 2-forms beside OpenSubdiv's of 0-forms (S0): with d0 and d1 of
/// both levels,
///     d0 S0 = S1 d0    and    d1 S1 = S2 d1
/// hold to rounding. So the gradient of a subdivided function is the subdivided gradient, closed
/// forms stay closed, and what flows round a face is never lost.
///
/// Shape    S1: edges of the level x edges of the one before, S2: faces x faces; Far's numbering,
///          form_operators.h's directions. Columns of S2 add up to 1, its weights are >= 0.
/// Source   [Wang06] Sec. 3; [Forms 2]. limn's own: boundaries, creases [Forms 5], valence 3
///          [Forms 6].
struct FormStencils {
    // Their names in reports.
    static constexpr char const* kS1 = "S1";
    static constexpr char const* kS2 = "S2";

    SparseRows s1, s2;
};

/// Makes the step from `level` - 1 to `level` in linear time.
///
/// \param refiner  refined uniformly with full topology in the last level
/// \pre            CheckForms has passed
/// \throws Error   TooLarge: more than 2^31 entries, or a vertex with more than 4096 faces (named)
FormStencils BuildFormStencils(Far::TopologyRefiner const& refiner, int level);

/// All steps up to `level` in one table each: over the edges and faces of the base.
///
/// \throws Error  as BuildFormStencils
FormStencils ComposeFormStencils(Far::TopologyRefiner const& refiner, int level);

/// The rows as a stencil table in float, for OpenSubdiv's evaluators and limn's: one float per edge
/// or face, or several forms side by side as one primvar.
///
/// \param numColumns  edges or faces of the level before
/// \throws Error      TooLarge: more than 2^31 entries
StencilRows MakeStencilRows(SparseRows const& rows, Index numColumns);

}  // namespace limn::far_ext
