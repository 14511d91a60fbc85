#pragma once

#include <vector>

#include "eval/limit_surface.h"

namespace limn::eval {

/// Where a place of a cage's limit surface lies on the uniformly refined cage, whose limit is the same: the
/// refined face, in OpenSubdiv's numbering, and (s,t) in its own domain.
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

private:
    int _levels;
    bool _isLoop;
    std::vector<char> _isPolygon;      // per base face: with a domain per corner
    std::vector<Index> _firstChild;    // per base face, on level 1
};

}  // namespace limn::eval
