// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "eval/surface/limit_surface.h"

namespace limn::eval {

/// Where a place of a cage's limit surface lies on the uniformly refined cage, whose limit is the
/// same: the refined face, in OpenSubdiv's numbering, and (s,t) in its own domain.
class RefinedFaces {
public:
    struct Place {
        Index face;
        int domain;
        double s, t;
    };

    /// \param base    the unrefined surface
    /// \param levels  0 or more
    RefinedFaces(LimitSurface const& base, int levels);

    Place Find(Index face, int domain, double s, double t) const;

    /// A place of a list, and which one it was.
    struct Sample {
        Place at;
        size_t index;
    };

    /// Finds places of one face and domain, in the order of refined faces: each of these need be
    /// bound once only.
    void FindSorted(Index face, int domain, std::span<double const> s, std::span<double const> t,
                    std::vector<Sample>& samples) const;

private:
    int _levels;
    bool _isLoop;
    std::vector<char> _isPolygon;    // per base face: with a domain per corner
    std::vector<Index> _firstChild;  // per base face, on level 1
};

}  // namespace limn::eval
