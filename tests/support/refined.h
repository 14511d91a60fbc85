// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "eval/differential/refine_values.h"
#include "far_ext/rows/sparse_rows.h"
#include "far_ext/topology/refiner.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn::test {

/// The topology of a scene, refined uniformly.
inline std::unique_ptr<Far::TopologyRefiner> MakeRefiner(engine::Scene const& scene, int levels) {
    auto refiner = far_ext::CreateRefiner(scene.cage);
    Far::TopologyRefiner::UniformOptions options(levels);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);
    return refiner;
}

/// A mesh of tests/data/differential under its scheme; boundaries as its references have them.
inline engine::Scene LoadDifferential(std::string const& name, Sdc::SchemeType scheme) {
    engine::Scene scene = LoadData("differential/" + name + ".obj");
    scene.cage.scheme = scheme;
    scene.cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    return scene;
}

inline std::vector<double> Apply(far_ext::SparseRows const& rows,
                                 std::vector<double> const& points) {
    std::vector<double> result(3 * static_cast<size_t>(rows.GetNumRows()));
    rows.Apply(points.data(), result.data(), 3);
    return result;
}

/// Points of the last level, subdivided and moved out to the unit sphere.
inline std::vector<double> SubdivideToSphere(Far::TopologyRefiner const& refiner,
                                             std::vector<double> points) {
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level)
        points = eval::RefineValues<3>(refiner, level, points);
    for (size_t i = 0; i < points.size(); i += 3) {
        double const length = std::hypot(points[i], points[i + 1], points[i + 2]);
        for (size_t c = 0; c < 3; ++c) points[i + c] /= length;
    }
    return points;
}

}  // namespace limn::test
