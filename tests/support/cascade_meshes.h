// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <list>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "eval/cascade/cascade.h"
#include "far_ext/cascade/cascade_level.h"
#include "support/refined.h"

namespace limn::test {

/// A mesh of tests/data/cascade, as triangles.
engine::Scene LoadMesh(std::string const& name);

/// Whether all faces at each vertex are one fan.
bool IsManifold(engine::Scene const& scene);

/// Meshes with names: made ones of valence 2 to 12, open and closed, n-gons, creases of any
/// sharpness, several components, genus 0 to 2; and those of Pixar's cages that are manifolds.
std::vector<std::pair<std::string, engine::Scene>> const& GetCascadeMeshes();

/// Points of a finer mesh: each the mean of its parents.
std::vector<double> ApplyParents(std::vector<int> const& offsets, std::vector<Index> const& parents,
                                 std::vector<double> const& coarse);

struct EdgeLengths {
    double mean = 0.0;
    std::vector<double> atVertices;  ///< mean of those at each vertex
};

EdgeLengths MeasureEdges(engine::Scene const& scene);

/// Levels 1 to `count` of a scene's own refinement.
std::list<far_ext::CascadeLevel> QuarterLevels(engine::Scene const& scene, int count,
                                               far_ext::BoundaryRule rule);

/// Levels after 1 to `count` passes of bisection.
std::list<far_ext::CascadeLevel> BisectLevels(engine::Scene const& scene, int count,
                                              far_ext::BoundaryRule rule);

/// Positions after a step on each level; Jacobi sweeps and untolerant conjugate gradients by the
/// a-priori rule.
std::vector<double> Filter(engine::Scene const& scene,
                           std::list<far_ext::CascadeLevel> const& levels,
                           eval::CascadeOptions const& options,
                           std::vector<double> const& widths = {}, int finestSweeps = 1);

/// A mesh as it is, without refinement: each vertex is its own parent. Faces of 3 or 4 corners, all
/// alike.
far_ext::CascadeMesh MakeSameMesh(engine::Scene const& scene);

inline Eigen::Vector3d PointAt(std::vector<double> const& points, Index vertex) {
    return Eigen::Map<Eigen::Vector3d const>(&points[3 * static_cast<size_t>(vertex)]);
}

inline double const kPi = std::acos(-1.0);

/// Solvers with their tolerances; at 0 conjugate gradients run by count, without a preconditioner.
inline std::vector<std::pair<eval::CascadeSolver, double>> const kSolvers{
    {eval::CascadeSolver::Exact, 0.0},
    {eval::CascadeSolver::ConjugateGradients, 0.0},
    {eval::CascadeSolver::ConjugateGradients, 1e-6},
    {eval::CascadeSolver::Jacobi, 0.0}};

std::vector<double> Transform(std::vector<double> points, Eigen::Matrix3d const& matrix,
                              Eigen::Vector3d const& shift);

/// The least angle of a mesh of triangles.
double MinAngleDegrees(std::vector<double> const& points, far_ext::CascadeMesh const& mesh);

double MeanRadius(std::vector<double> const& points);

}  // namespace limn::test
