// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Dense>

#include "engine/scene/scene.h"
#include "support/program/cli.h"

namespace limn::test::cli {

using Vector = Eigen::Vector3d;

/// Runs of limn smooth, and the meshes they are run on.
class CliSmooth : public Cli {
protected:
    std::string spot = ScenePath("spot/spot.obj"), icosa = DataPath("cascade/icosa.obj"),
                grid = DataPath("cascade/gridholetri.obj"),
                torus = DataPath("cascade/torustri.obj");

    /// A cube from -1 to 1 with a texture of its own per side, side by side along u.
    std::string WriteCube() const;

    /// Runs limn smooth in double; the result.
    engine::Scene Smooth(std::string const& mesh, Words const& options,
                         std::string const& output = "out.ply") const;

    /// The start mesh on a level: vertices stay, edges are halved, quads get their centre.
    static std::vector<double> Interpolate(engine::Scene scene, int levels);
};

Vector At(std::vector<double> const& points, size_t i);

/// By the triangles of both ways to cut a face into a fan from its first or last corner, half each:
/// quads' both diagonals.
double MeasureVolume(engine::Scene const& scene);

std::vector<float> GetWidths(engine::Scene const& scene);

}  // namespace limn::test::cli
