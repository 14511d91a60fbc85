// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "eval/surface/limit_surface.h"
#include "eval/surface/surface_place.h"
#include "far_ext/topology/control_mesh.h"

namespace limn::eval {

/// A tangent vector that a field is to have at a place of the limit surface.
struct WantedAtPlace {
    SurfacePlace at;
    Eigen::Vector3d vector;
    double area = 0.0;  ///< of the surface that the place stands for: its weight
};

/// The 1-form of a cage whose limit field is nearest to the wanted vectors: least squares in the
/// tangent planes. What they leave open is filled in with the least curl and divergence.
///
/// Exact     of vectors that a form's limit has at some places per face that form comes back, to
///           rounding; where places are among regular faces of the cage, refined `levels` times.
///           Elsewhere the field is no polynomial, and places there say nothing.
/// \param surface  the cage's limit
/// \param levels   1 or 2: which places count. No matter what, forms are those of the cage
/// \param onStep   called now and then; may throw to end the work
/// \throws Error   as far_ext::CheckForms, far_ext::FindHodgeStars, RefinedFaces
/// Source          [Wang06] Sec. 4.1, 4.2; [Forms 7.3], [Forms 15]
std::vector<double> MatchPlaces(far_ext::ControlMesh const& cage, LimitSurface const& surface,
                                std::span<double const> positions,
                                std::span<WantedAtPlace const> wanted, int levels,
                                std::function<void()> const& onStep = {});

}  // namespace limn::eval
