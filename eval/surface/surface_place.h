// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "eval/surface/limit_surface.h"

namespace limn::eval {

/// A place of a limit surface: (s,t) in one of a face's domains (see LimitSurface).
struct SurfacePlace {
    Index face = 0;
    int domain = 0;
    double s = 0.0, t = 0.0;
};

/// A corner of a face.
inline SurfacePlace GetCornerPlace(LimitSurface const& surface, Index face, int corner) {
    constexpr double kQuad[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    constexpr double kTriangle[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    if (surface.GetNumDomains(face) > 1) return {face, corner, 0.0, 0.0};
    double const* const place = surface.IsLoop() ? kTriangle[corner] : kQuad[corner];
    return {face, 0, place[0], place[1]};
}

/// The place `tau` of the way along the edge from a face's corner to the next one, of `size`
/// corners.
inline SurfacePlace GetEdgePlace(LimitSurface const& surface, Index face, int size, int corner,
                                 double tau) {
    int const next = (corner + 1) % size;
    if (surface.GetNumDomains(face) > 1) {
        // In sub-quads (1, 0) and (0, 1) are the middles of edges.
        return tau <= 0.5 ? SurfacePlace{face, corner, 2.0 * tau, 0.0}
                          : SurfacePlace{face, next, 0.0, 2.0 - 2.0 * tau};
    }
    auto const a = GetCornerPlace(surface, face, corner), b = GetCornerPlace(surface, face, next);
    return {face, 0, a.s + tau * (b.s - a.s), a.t + tau * (b.t - a.t)};
}

/// Which of a face's four children holds (s,t), as OpenSubdiv numbers them: one per corner (Loop:
/// and the flipped triangle in the middle). (s,t) become coordinates of that child.
int GetChildAt(bool isLoop, double& s, double& t);

/// The other way: (s,t) of a child become coordinates of the face it is a child of.
void LeaveChild(bool isLoop, int child, double& s, double& t);

/// Gauss points and weights of [0, 1].
inline constexpr double kGaussNodes[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
inline constexpr double kGaussWeights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

/// Calls visit(SurfacePlace, weight) for the 3 x 3 Gauss points of every domain; weights add up to
/// the domain's area (1, on a triangle 1/2). A triangle is the square with one side collapsed.
template <class Visit>
void ForEachGaussPoint(LimitSurface const& surface, Index face, Visit visit) {
    for (int domain = 0; domain < surface.GetNumDomains(face); ++domain) {
        for (int j = 0; j < 3; ++j) {
            double const width = surface.IsLoop() ? 1.0 - kGaussNodes[j] : 1.0;
            for (int i = 0; i < 3; ++i) {
                visit(SurfacePlace{face, domain, kGaussNodes[i] * width, kGaussNodes[j]},
                      kGaussWeights[i] * kGaussWeights[j] * width);
            }
        }
    }
}

// Refusals, for all that take places: each throws an Error, BadOption, that names the face or the
// place, the value and the bound.

/// (s,t) outside a domain by no more than this are in it: what found them may have rounded.
inline constexpr double kPlaceSlack = 1e-12;

/// Refuses a face that there is not.
void CheckFace(Index face, Index numFaces);

/// Refuses a face that there is not, or that has no limit.
void CheckFace(LimitSurface const& surface, Index face);

/// Refuses a domain that the face has not. \param numDomains  0 of a face without a limit
void CheckDomain(Index face, int domain, int numDomains);

/// Refuses (s,t) outside the domain; not a number is outside.
void CheckInDomain(bool isLoop, SurfacePlace const& place);

/// The same for places of one domain, by their number, and for arrays of unequal length.
void CheckInDomain(bool isLoop, Index face, int domain, std::span<double const> s,
                   std::span<double const> t);

/// All of it for places of any face; one without a limit is none to refuse.
void CheckPlaces(LimitSurface const& surface, std::span<SurfacePlace const> places);

/// Refuses an array that has no room for the results of all places.
void CheckRoom(size_t numResults, size_t numPlaces);

}  // namespace limn::eval
