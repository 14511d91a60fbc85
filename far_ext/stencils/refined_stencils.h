// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/stencils/stencil_groups.h"

namespace limn::far_ext {

/// Which points of a refinement stencils are wanted for, as in Far::StencilTableFactory::Options.
struct RefinedStencilOptions {
    enum class Mode { Vertex, Varying, FaceVarying };

    Mode mode = Mode::Vertex;
    int fvarChannel = 0;  ///< with FaceVarying
};

/// The stencils of all points of a uniformly refined topology's last level, over the control
/// points: what Far::StencilTableFactory makes without intermediate levels, in the same row order
/// and with the same weights (composed in double, rounded once), but without Far's table in
/// between.
///
/// How      A base face with the faces round it (FaceRing) determines the weights of everything in
///          the face, however fine. Faces with equal rings share them, so each distinct ring is
///          refined once, by its own children's weights; a face only adds its control points and
///          its place in the table. One level makes too small groups to pay: there every row is
///          taken from Far::PrimvarRefiner as it stands. Face-varying values that meet themselves
///          at a vertex, where OpenSubdiv's rule depends on the order of the faces, go through
///          Far's own table, and so do large meshes too irregular for their rings to repeat.
/// Memory   Besides the table, one dense block of weights per distinct ring and its children.
/// Usable from C++17.
///
/// \param refiner  refined uniformly, to level 1 or more
/// \throws Error   BadOption: not uniformly refined, no such channel; TooLarge: as
///                 StencilGroupsBuilder
StencilGroups BuildRefinedStencils(Far::TopologyRefiner const& refiner,
                                   RefinedStencilOptions const& options = {});

}  // namespace limn::far_ext
