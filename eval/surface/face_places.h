// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "eval/surface/limit_surface.h"

namespace limn::eval {

/// A place of a face: a domain and (s,t) in it (see LimitSurface).
struct FacePlace {
    int domain = 0;
    double s = 0.0, t = 0.0;
};

/// A corner of a face.
inline FacePlace GetCornerPlace(LimitSurface const& surface, Index face, int corner) {
    constexpr double kQuad[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    constexpr double kTriangle[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    if (surface.GetNumDomains(face) > 1) return {corner, 0.0, 0.0};
    double const* const place = surface.IsLoop() ? kTriangle[corner] : kQuad[corner];
    return {0, place[0], place[1]};
}

/// The place `tau` of the way along the edge from a face's corner to the next one, of `size`
/// corners.
inline FacePlace GetEdgePlace(LimitSurface const& surface, Index face, int size, int corner,
                              double tau) {
    int const next = (corner + 1) % size;
    if (surface.GetNumDomains(face) >
        1) {  // in sub-quads (1, 0) and (0, 1) are the middles of edges
        return tau <= 0.5 ? FacePlace{corner, 2.0 * tau, 0.0}
                          : FacePlace{next, 0.0, 2.0 - 2.0 * tau};
    }
    auto const a = GetCornerPlace(surface, face, corner), b = GetCornerPlace(surface, face, next);
    return {0, a.s + tau * (b.s - a.s), a.t + tau * (b.t - a.t)};
}

/// Gauss points and weights of [0, 1].
inline constexpr double kGaussNodes[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
inline constexpr double kGaussWeights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

/// Calls visit(FacePlace, weight) for the 3 x 3 Gauss points of every domain; weights add up to the
/// domain's area (1, on a triangle 1/2). A triangle is the square with one side collapsed.
template <class Visit>
void ForEachGaussPoint(LimitSurface const& surface, Index face, Visit visit) {
    for (int domain = 0; domain < surface.GetNumDomains(face); ++domain) {
        for (int j = 0; j < 3; ++j) {
            double const width = surface.IsLoop() ? 1.0 - kGaussNodes[j] : 1.0;
            for (int i = 0; i < 3; ++i) {
                visit(FacePlace{domain, kGaussNodes[i] * width, kGaussNodes[j]},
                      kGaussWeights[i] * kGaussWeights[j] * width);
            }
        }
    }
}

}  // namespace limn::eval
