// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "far_ext/differential/subdivision_rows.h"

namespace limn::eval {
class AlphaSteps;
class TableEvaluator;
class ValueRefiner;
}  // namespace limn::eval

namespace limn::engine {

struct RefineOptions {
    int levels = 1;        ///< 0 to 10
    bool toLimit = false;  ///< also moves the vertices (not the UVs) to their limit
    /// Of the positions. Both Butterflies need the Loop scheme, Kobbelt quads and the Catmull-Clark
    /// scheme; vertices of all but the scheme's own rule are in the limit already.
    far_ext::TunedRule rule{};
    /// Of positions and primvars by the scheme's rule: generalised Catmull-Clark in every step, 0
    /// (plain) to 1. Source [LaiCheng11] Appendix A; [Limit 4]
    double alpha = 0.0;
    /// Applies the rules, and the limit matrix, as tables in float; null: all in double. What alpha
    /// adds is in double.
    eval::TableEvaluator* evaluator = nullptr;
};

/// Refines a mesh uniformly by OpenSubdiv's rules, in double.
///
/// The result has OpenSubdiv's vertex order, refined UVs and primvars, decayed creases and corners,
/// holes and groups of the parents.
///
/// \param job     told of vertices at which the rule is not smooth
/// \throws Error  BadOption, also for an alpha outside [0, 1], or with another scheme or rule than
///                Catmull-Clark's; TooLarge where the refined mesh would pass 2^31 indices; as
///                far_ext::BuildSubdivisionRows
/// \throws Stopped
Scene RefineUniformly(Model const& model, RefineOptions const& options, Job& job);

/// A topology, refined uniformly, with the last level's full topology.
///
/// \param path    of the mesh, for messages
/// \throws Error  as RefineUniformly
std::unique_ptr<Far::TopologyRefiner> MakeUniformRefiner(far_ext::ControlMesh const& cage,
                                                         std::string const& path, int levels);

/// Warns of vertices whose valence a rule is not smooth at: for the original Butterfly 3, where
/// there is no tangent plane, and 8 and more, where nearly none is left; for the interpolating rule
/// of Loop's scheme 3.
void WarnOfRoughVertices(Model const& model, far_ext::TunedRule const& rule, Job& job);

/// All of RefineUniformly's result but the positions.
///
/// \param values  refines them
/// \param alpha   of primvars; none: the plain rule
Scene RefineAllButPositions(Model const& model, eval::ValueRefiner& values, Job& job,
                            eval::AlphaSteps const* alpha = nullptr);

/// Gives refined faces the groups of the base faces they lie in, and leaves those without texture
/// coordinates whose base face has none.
void InheritFromFaces(Model const& model, std::vector<Index> const& baseFaces, Scene& fine);

}  // namespace limn::engine
