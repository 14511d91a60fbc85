// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/refined_faces.h"

#include <algorithm>

namespace limn::eval {

RefinedFaces::RefinedFaces(LimitSurface const& base, int levels)
    : _levels(levels), _isLoop(base.IsLoop()) {
    Index next = 0;
    for (Index face = 0; face < base.GetNumFaces(); ++face) {
        int const numDomains = base.GetNumDomains(face);
        _isPolygon.push_back(numDomains > 1);
        _firstChild.push_back(next);
        next += numDomains > 1 ? numDomains : 4;
    }
}

RefinedFaces::Place RefinedFaces::Find(Index face, int domain, double s, double t) const {
    Place place{face, domain, s, t};
    for (int level = 1; level <= _levels; ++level) {
        Index const first = level == 1 ? _firstChild[place.face] : 4 * place.face;
        if (level == 1 && _isPolygon[face]) {
            // A polygon's domains are its children, in their own coordinates.
            place.face = first + domain;
            place.domain = 0;
            continue;
        }
        place.face = first + GetChildAt(_isLoop, place.s, place.t);
    }
    return place;
}

void RefinedFaces::FindSorted(Index face, int domain, std::span<double const> s,
                              std::span<double const> t, std::vector<Sample>& samples) const {
    samples.clear();
    for (size_t i = 0; i < s.size(); ++i) samples.push_back({Find(face, domain, s[i], t[i]), i});
    std::sort(samples.begin(), samples.end(), [](Sample const& a, Sample const& b) {
        return a.at.face != b.at.face ? a.at.face < b.at.face : a.index < b.index;
    });
}

}  // namespace limn::eval
