// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "eval/surface/face_tree.h"

namespace limn::eval {

/// First and second fundamental forms turned into curvatures, in 1/length (Gaussian: 1/length^2).
/// A sphere of radius r seen from outside has k1 = k2 = +1/r. Source: [Bake 3].
struct Curvature {
    double mean = 0.0, gaussian = 0.0, k1 = 0.0, k2 = 0.0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< of k1; a line, its sign is free
};

/// Everything known at one place of the limit surface, in double.
struct SurfaceSample {
    Eigen::Vector3d position, normal;
    Eigen::Vector3d tangentS, tangentT;  ///< dP/ds, dP/dt of the domain
    Curvature curvature;
    bool isMoved = false;       ///< second derivatives come from 2^-16 off an irregular corner
    bool isDegenerate = false;  ///< no tangent plane here: normal and curvature from nearby
};

/// Position and its derivatives by a domain's s and t.
struct SurfaceDerivatives {
    Eigen::Vector3d position, ds, dt, dss, dst, dtt;
};

// Places are (s,t) in a domain of the tree's current face.
//
// Errors  BadOption: those of FaceTree; a tree of less than three channels where they are to be the
//         position.

/// Evaluates the tree's first three channels as they are: nothing is moved away from an irregular
/// corner but what is nearer to it than doubles can tell.
SurfaceDerivatives EvaluateDerivatives(FaceTree& tree, int domain, double s, double t);

/// The same of a piece with a point in it.
SurfaceDerivatives EvaluateDerivatives(FaceTree const& tree, PatchPoint const& at);

/// Curvature from derivatives; the unit normal is ds x dt.
///
/// \pre ds and dt are not parallel
Curvature ComputeCurvature(Eigen::Vector3d const& ds, Eigen::Vector3d const& dt,
                           Eigen::Vector3d const& dss, Eigen::Vector3d const& dst,
                           Eigen::Vector3d const& dtt,
                           Orientation orientation = Orientation::Right);

/// True if the tangents span a plane: neither is zero, and the sine of their angle is above a
/// bound. Rounding leaves about 1e-15 of each product in their cross product; below 1e-12 it says
/// nothing.
bool HasTangentPlane(SurfaceDerivatives const& derivatives, double leastSine = 1e-12);

/// The sample that derivatives make. \pre HasTangentPlane
SurfaceSample MakeSample(SurfaceDerivatives const& derivatives, Orientation orientation);

/// Value and derivatives of one channel of a piece: P, Ps, Pt, Pss, Pst, Ptt by (s,t) of the
/// domain.
std::array<double, 6> EvaluateDerivatives(FaceTree const& tree, PatchPoint const& at, int channel);

/// Evaluates one place; the tree's first three channels are the position.
///
SurfaceSample EvaluateSample(FaceTree& tree, int domain, double s, double t,
                             Orientation orientation = Orientation::Right);

/// One channel's value at a place, in double; nearer than 2^-maxDepth to an irregular corner, at
/// that distance.
double EvaluateChannel(FaceTree& tree, int domain, double s, double t, int channel,
                       int maxDepth = FaceTree::kLimitDepth);

}  // namespace limn::eval
