// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "engine/bake/audit/gauss_bonnet.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/differential/mesh_curvature.h"

namespace limn::engine {

/// Which surface a measurement is of.
enum class MeasuredSurface {
    Limit,  ///< exact curvature of the limit, by cubature
    Mesh    ///< the mesh itself, by the tensor of its dihedral angles
};

/// Of a curvature, weighted by area. Extremes are those of the sampled places: curvature may be
/// unbounded next to extraordinary vertices.
struct CurvatureStatistics {
    double min = 0.0, max = 0.0, mean = 0.0, stddev = 0.0;
};

struct Measurement {
    double area = 0.0;
    std::optional<double> volume;  ///< of closed surfaces whose faces are wound one way; positive
                                   ///< where normals point out
    int eulerCharacteristic = 0;
    eval::ThinPlateEnergy energy;
    CurvatureStatistics mean, gaussian;
    size_t numSamples = 0;                      ///< places that statistics and integrals come from
    std::vector<GaussBonnetAudit> gaussBonnet;  ///< per component, as a bake's audit numbers them
};

/// Warns of a surface that is seen inside out.
///
/// \throws Stopped
Measurement Measure(Model const& model, MeasuredSurface surface, Orientation orientation, Job& job);

/// Curvature at each vertex of a mesh; 0 where there is none.
struct VertexCurvature {
    std::vector<double> mean, gaussian, k1, k2;
};

/// \throws Stopped
VertexCurvature FindVertexCurvature(Model const& model, MeasuredSurface surface,
                                    Orientation orientation, Job& job);

/// The mesh with curvature as primvars mean, gaussian, k1 and k2.
Scene AddVertexCurvature(Model const& model, VertexCurvature const& curvature);

}  // namespace limn::engine
