// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "eval/surface/face_tree.h"

namespace limn::eval {

/// One sector of a disc: the part of it in a domain of a face, at a corner of the domain (in the
/// order of GetCornerPlace of a quad or triangle). Coordinates (a,b) there measure from the corner,
/// a along the domain's edge that leaves it, b along the one that arrives at it.
///
/// Extent  quad: a, b <= radius; triangle: a + b <= radius. A power of two, at most 1/2: other
///         corners lie outside, and pieces of the surface end where the disc does.
struct DiscSector {
    Index face = 0;
    int domain = 0, corner = 0;
    double radius = 0.0;
};

/// Corner coordinates of a place of a domain, and the place (s,t) of corner coordinates.
std::array<double, 2> ToCorner(bool isLoop, int corner, double s, double t);
std::array<double, 2> FromCorner(bool isLoop, int corner, double a, double b);

/// Weight of a place in a disc of that radius: 1 at half of it and nearer, 0 at its border and
/// beyond, twice continuously differentiable also from sector to sector.
double GetDiscWeight(bool isLoop, double a, double b, double radius);

/// Integral of the Gaussian curvature over the inner half of a disc (a, b <= radius / 2; a + b on
/// triangles), by the theorem of Gauss and Bonnet: 2 pi less the geodesic curvature along the
/// border and the angles at which the border turns. Nothing is evaluated inside, where curvature
/// may be unbounded.
///
/// \param sectors  counter-clockwise once round the vertex
/// \return not finite where the border has no tangent plane somewhere
double IntegrateInnerDisc(FaceTree& tree, std::span<DiscSector const> sectors);

/// Integral of Gaussian curvature times GetDiscWeight over the whole disc: the inner half as above,
/// the ring round it by cubature over the surface's polynomial pieces.
double IntegrateDisc(FaceTree& tree, std::span<DiscSector const> sectors);

}  // namespace limn::eval
