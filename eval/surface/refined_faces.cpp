// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/refined_faces.h"

#include <algorithm>
#include <iterator>

namespace limn::eval {

RefinedFaces::RefinedFaces(LimitSurface const& base, int levels)
    : _levels(levels), _isLoop(base.IsLoop()) {
    Index next = 0;
    for (Index face = 0; face < base.GetNumFaces(); ++face) {
        int const numDomains = base.GetNumDomains(face);
        _baseFaces.push_back({next, base.HasLimit(face) ? numDomains : 0});
        next += numDomains > 1 ? numDomains : 4;
    }
}

void RefinedFaces::CheckDomain(Index face, int domain) const {
    CheckFace(face, static_cast<Index>(_baseFaces.size()));
    eval::CheckDomain(face, domain, _baseFaces[face].numDomains);
}

SurfacePlace RefinedFaces::Find(SurfacePlace const& place) const {
    CheckDomain(place.face, place.domain);
    CheckInDomain(_isLoop, place);
    return Descend(place);
}

SurfacePlace RefinedFaces::Descend(SurfacePlace place) const {
    if (_levels == 0) return place;
    BaseFace const& base = _baseFaces[place.face];
    if (base.numDomains > 1)  // a polygon's domains are its children, in their own coordinates
        place = {base.firstChild + place.domain, 0, place.s, place.t};
    else
        place.face = base.firstChild + GetChildAt(_isLoop, place.s, place.t);
    for (int level = 2; level <= _levels; ++level)
        place.face = 4 * place.face + GetChildAt(_isLoop, place.s, place.t);
    return place;
}

SurfacePlace RefinedFaces::FindBase(SurfacePlace place) const {
    if (_levels == 0) return place;
    for (int level = _levels; level > 1; --level) {
        LeaveChild(_isLoop, place.face % 4, place.s, place.t);
        place.face /= 4;
    }
    auto const after =
        std::upper_bound(_baseFaces.begin(), _baseFaces.end(), place.face,
                         [](Index child, BaseFace const& base) { return child < base.firstChild; });
    auto const base = std::prev(after);
    int const child = place.face - base->firstChild;
    place.face = static_cast<Index>(base - _baseFaces.begin());
    if (base->numDomains > 1)
        place.domain = child;
    else
        LeaveChild(_isLoop, child, place.s, place.t);
    return place;
}

void RefinedFaces::FindSorted(Index face, int domain, std::span<double const> s,
                              std::span<double const> t, std::vector<Sample>& samples) const {
    CheckDomain(face, domain);
    CheckInDomain(_isLoop, face, domain, s, t);
    samples.clear();
    for (size_t i = 0; i < s.size(); ++i)
        samples.push_back({Descend({face, domain, s[i], t[i]}), i});
    std::sort(samples.begin(), samples.end(), [](Sample const& a, Sample const& b) {
        return a.at.face != b.at.face ? a.at.face < b.at.face : a.index < b.index;
    });
}

}  // namespace limn::eval
