// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "eval/surface/surface_place.h"

namespace limn::eval {

/// Where a place of a cage's limit surface lies on the uniformly refined cage, whose limit is the
/// same: the refined face, in OpenSubdiv's numbering, and (s,t) in its own domain.
///
/// Errors  BadOption: a face that does not exist or has no limit, a domain it has not, (s,t) more
///         than kPlaceSlack outside. On the refined face they may lie 2^levels as far outside, so
///         that they are for FaceTree::LocateChecked.
class RefinedFaces {
public:
    /// \param base    the unrefined surface; kept only while this is built
    /// \param levels  0 or more
    RefinedFaces(LimitSurface const& base, int levels);

    SurfacePlace Find(SurfacePlace const& place) const;

    /// The other way: where a place of a refined face lies on the cage.
    ///
    /// \pre  a refined face of a face with a limit
    SurfacePlace FindBase(SurfacePlace place) const;

    /// A place of a list, and which one it was.
    struct Sample {
        SurfacePlace at;
        size_t index;
    };

    /// Finds places of one face and domain, in the order of refined faces: each of these need be
    /// bound once only.
    void FindSorted(Index face, int domain, std::span<double const> s, std::span<double const> t,
                    std::vector<Sample>& samples) const;

private:
    struct BaseFace {
        Index firstChild;  // on level 1
        int numDomains;    // 0 without a limit
    };

    void CheckDomain(Index face, int domain) const;
    SurfacePlace Descend(SurfacePlace place) const;

    int _levels;
    bool _isLoop;
    std::vector<BaseFace> _baseFaces;
};

}  // namespace limn::eval
