// SPDX-License-Identifier: Apache-2.0
#include "support/map_options.h"

#include "support/meshes.h"

namespace limn::test {

engine::Model AddColours(engine::Scene scene) {
    scene.primvars = {{"color", 3, {scene.positions.begin(), scene.positions.end()}}};
    return engine::Model::Build(std::move(scene));
}

engine::Model MakeModelWithColours() {
    return AddColours(MakeTorus(12, 8));
}

engine::BakeOptions OptionsForAllMaps(engine::Model const& model) {
    engine::BakeOptions options;
    options.maps = {"mean",      "gaussian",     "k1",
                    "k2",        "curvedness",   "shape-index",
                    "curvature", "position",     "principal-direction",
                    "normal",    "displacement", "stretch",
                    "tension",   "bands",        "noise",
                    "field",     "overlap",      "primvar:color"};
    std::vector<double> swollen = model.GetPositions();
    for (double& x : swollen) x *= 1.25;
    options.against = model.WithPoints(std::move(swollen));
    std::vector<double> sheared = model.GetPositions();
    for (size_t i = 0; i < sheared.size(); i += 3) sheared[i] += 0.3 * sheared[i + 1];
    options.rest = model.WithPoints(std::move(sheared));
    options.field.emplace();
    for (Index edge = 0; edge < model.GetLevel().GetNumEdges(); ++edge) {
        options.field->push_back(static_cast<double>(edge % 7) - 3.0);
    }
    options.noise.octaves = 2;
    return options;
}

}  // namespace limn::test
