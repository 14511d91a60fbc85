// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "engine/scene/scene.h"
#include "eval/streamlines/streamline.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/refiner.h"

namespace limn::test {

/// A function per vertex that is smooth at the scale of a mesh, and even in no direction.
inline std::vector<double> MakeSmoothFunction(engine::Scene const& scene) {
    far_ext::Points const points(scene.positions);
    std::vector<double> values;
    for (size_t i = 0; i < points.GetCount(); ++i) {
        auto const p = points[i];
        values.push_back(p.x() + 0.7 * p.y() - 0.4 * p.z() + 0.1 * p.x() * p.y());
    }
    return values;
}

/// The rotation axis x p as a form: its integrals along straight edges a to b are axis . (a x b).
inline std::vector<double> MakeRotationForm(engine::Scene const& scene,
                                            Eigen::Vector3d const& axis) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const level = refiner->GetLevel(0);
    far_ext::Points const points(scene.positions);
    std::vector<double> form;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        auto const a = points[std::min(ends[0], ends[1])], b = points[std::max(ends[0], ends[1])];
        form.push_back(axis.dot(a.cross(b)));
    }
    return form;
}

/// Steps of a share of the mean distance between neighbouring vertices.
inline eval::StreamlineOptions MakeStreamlineOptions(eval::FlowSurface const& flow, double share) {
    auto const level = flow.GetLevel();
    eval::FlowSurface::Sampler sampler(flow);
    double sum = 0.0;
    int count = 0;
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        if (!flow.GetSurface().HasLimit(face)) continue;
        sampler.Bind(face);
        sum += (sampler.Evaluate(1.0, 0.0).position - sampler.Evaluate(0.0, 0.0).position).norm();
        ++count;
    }
    return {
        .step = share * sum / count, .maxLength = 20.0, .leastSpeed = 1e-6 * flow.FindRmsSpeed()};
}

}  // namespace limn::test
