// SPDX-License-Identifier: Apache-2.0
#include "support/chaikin_meshes.h"

#include "far_ext/topology/refiner.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn::test {

namespace {

/// Gives a share of the edges a sharpness from 0.5 to 6.5, at random.
engine::Scene AddChaikinCreases(engine::Scene scene, double share) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const level = refiner->GetLevel(0);
    auto const noise = MakeNoise(2 * static_cast<size_t>(level.GetNumEdges()), 7);
    scene.cage.options.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN);
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        size_t const at = 2 * static_cast<size_t>(edge);
        if (noise[at] > 2.0 * share - 1.0) continue;
        for (Index end : level.GetEdgeVertices(edge)) scene.cage.creaseVertexPairs.push_back(end);
        scene.cage.creaseSharpness.push_back(static_cast<float>(3.5 + 3.0 * noise[at + 1]));
    }
    return scene;
}

}  // namespace

std::vector<engine::Scene> MakeChaikinMeshes() {
    std::vector<engine::Scene> scenes;
    for (double share : {0.15, 0.5}) {
        for (auto const& scene :
             {MakeCube(), MakeDodecahedron(), MakeFan(3, Sdc::SCHEME_CATMARK, 0.1, 0.05),
              MakeFan(5, Sdc::SCHEME_LOOP, 0.1, 0.05), MakeGridWithHole(5, 4), MakeTorus(5, 4),
              MakeIrregularTriangles(5, 5, 3), LoadShape("catmark_hole_test1"),
              LoadShape("catmark_nonman_edges"), LoadShape("loop_nonman_edges")})
            scenes.push_back(AddChaikinCreases(scene, share));
    }
    return scenes;
}

}  // namespace limn::test
