// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/surface_place.h"

#include <bit>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::eval {

namespace {

bool IsFace(Index face, Index numFaces) {
    return face >= 0 && face < numFaces;
}

bool IsDomain(int domain, int numDomains) {
    return domain >= 0 && domain < numDomains;
}

constexpr double kLow = -kPlaceSlack, kHigh = 1.0 + kPlaceSlack;

bool IsInDomain(bool isLoop, double s, double t) {
    bool const isLow = isLoop ? s + t <= kHigh : (s <= kHigh) & (t <= kHigh);
    return (s >= kLow) & (t >= kLow) & isLow;
}

/// The same for many. Nothing is compared, so that compilers take several at once: a difference
/// from a bound is in [0, 2) if neither its sign, the highest of a double's bits, nor the next is
/// set. That one marks numbers from 2 on and what is no number.
template <bool IsLoop>
bool AreInDomain(std::span<double const> s, std::span<double const> t) {
    auto const toBits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    std::uint64_t bits = 0;
    for (size_t i = 0; i < s.size(); ++i) {
        bits |= toBits(s[i] - kLow) | toBits(t[i] - kLow);
        bits |=
            IsLoop ? toBits(kHigh - (s[i] + t[i])) : toBits(kHigh - s[i]) | toBits(kHigh - t[i]);
    }
    return bits >> 62 == 0;
}

// What is wrong; made only where something is, since every sample and face is checked.

std::string DescribeFace(Index face, Index numFaces) {
    return fmt::format("face {} does not exist; the surface has {} faces, 0 to {}", face, numFaces,
                       numFaces - 1);
}

std::string DescribeDomain(Index face, int domain, int numDomains) {
    if (numDomains == 0) return fmt::format("face {} has no limit", face);
    return fmt::format("domain {} does not exist; face {} has domains 0 to {}", domain, face,
                       numDomains - 1);
}

std::string DescribePlace(SurfacePlace const& place) {
    return fmt::format("({}, {}) lies outside domain {} of face {}", place.s, place.t, place.domain,
                       place.face);
}

[[noreturn]] void Refuse(std::string const& fault) {
    throw Error(ErrorCode::BadOption, fault);
}

[[noreturn]] void Refuse(size_t place, std::string const& fault) {
    Refuse(fmt::format("place {}: {}", place, fault));
}

}  // namespace

int GetChildAt(bool isLoop, double& s, double& t) {
    if (isLoop) {
        int child = 0;
        if (s >= 0.5)
            child = 1;
        else if (t >= 0.5)
            child = 2;
        else if (s + t > 0.5)
            child = 3;
        s = child == 3 ? 1.0 - 2.0 * s : 2.0 * s - (child == 1);
        t = child == 3 ? 1.0 - 2.0 * t : 2.0 * t - (child == 2);
        return child;
    }
    int const i = s >= 0.5, j = t >= 0.5;
    s = 2.0 * s - i;
    t = 2.0 * t - j;
    return j ? 3 - i : i;
}

void LeaveChild(bool isLoop, int child, double& s, double& t) {
    if (isLoop) {
        s = child == 3 ? 0.5 - 0.5 * s : 0.5 * s + (child == 1 ? 0.5 : 0.0);
        t = child == 3 ? 0.5 - 0.5 * t : 0.5 * t + (child == 2 ? 0.5 : 0.0);
        return;
    }
    s = 0.5 * s + (child == 1 || child == 2 ? 0.5 : 0.0);
    t = 0.5 * t + (child >= 2 ? 0.5 : 0.0);
}

void CheckFace(Index face, Index numFaces) {
    if (!IsFace(face, numFaces)) Refuse(DescribeFace(face, numFaces));
}

void CheckFace(LimitSurface const& surface, Index face) {
    CheckFace(face, surface.GetNumFaces());
    CheckDomain(face, 0, surface.HasLimit(face) ? surface.GetNumDomains(face) : 0);
}

void CheckDomain(Index face, int domain, int numDomains) {
    if (!IsDomain(domain, numDomains)) Refuse(DescribeDomain(face, domain, numDomains));
}

void CheckInDomain(bool isLoop, SurfacePlace const& place) {
    if (!IsInDomain(isLoop, place.s, place.t)) Refuse(DescribePlace(place));
}

void CheckInDomain(bool isLoop, Index face, int domain, std::span<double const> s,
                   std::span<double const> t) {
    if (s.size() != t.size())
        Refuse(fmt::format("places: {} values of s and {} of t; each has one of both", s.size(),
                           t.size()));
    if (isLoop ? AreInDomain<true>(s, t) : AreInDomain<false>(s, t)) return;
    for (size_t i = 0; i < s.size(); ++i) {
        if (!IsInDomain(isLoop, s[i], t[i])) Refuse(i, DescribePlace({face, domain, s[i], t[i]}));
    }
}

void CheckPlaces(LimitSurface const& surface, std::span<SurfacePlace const> places) {
    for (size_t i = 0; i < places.size(); ++i) {
        auto const& [face, domain, s, t] = places[i];
        if (!IsFace(face, surface.GetNumFaces()))
            Refuse(i, DescribeFace(face, surface.GetNumFaces()));
        int const numDomains = surface.GetNumDomains(face);
        if (!IsDomain(domain, numDomains)) Refuse(i, DescribeDomain(face, domain, numDomains));
        if (!IsInDomain(surface.IsLoop(), s, t)) Refuse(i, DescribePlace(places[i]));
    }
}

void CheckRoom(size_t numResults, size_t numPlaces) {
    if (numResults < numPlaces)
        Refuse(
            fmt::format("results: room for {} is too little for {} places", numResults, numPlaces));
}

}  // namespace limn::eval
