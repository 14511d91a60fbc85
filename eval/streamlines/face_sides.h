// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace limn::eval {

/// The sides of a quad's domain [0,1]^2, or of a triangle's s, t >= 0, s + t <= 1, side j from
/// corner j to the next.
class FaceSides {
public:
    using Coordinates = std::array<double, 2>;

    explicit FaceSides(bool isTriangle) : _isTriangle(isTriangle) {}

    int GetCount() const { return _isTriangle ? 3 : 4; }

    /// How far inside of a side: 0 on it, negative beyond.
    double GetDepth(int side, Coordinates const& at) const {
        switch (side) {
            case 0:
                return at[1];
            case 1:
                return _isTriangle ? 1.0 - at[0] - at[1] : 1.0 - at[0];
            case 2:
                return _isTriangle ? at[0] : 1.0 - at[1];
            default:
                return at[0];
        }
    }

    /// The same of a direction: how fast it goes inwards.
    double GetInward(int side, Coordinates const& direction) const {
        return GetDepth(side, direction) - GetDepth(side, {0.0, 0.0});
    }

    /// The side that a place is least inside of, or most beyond.
    int FindNearest(Coordinates const& at) const {
        int nearest = 0;
        for (int side = 1; side < GetCount(); ++side) {
            if (GetDepth(side, at) < GetDepth(nearest, at)) nearest = side;
        }
        return nearest;
    }

    /// How far along a side, from 0 at its corner to 1 at the next.
    double GetAlong(int side, Coordinates const& at) const {
        double const along[4] = {at[0], at[1], 1.0 - (_isTriangle ? at[1] : at[0]), 1.0 - at[1]};
        return std::clamp(along[side], 0.0, 1.0);
    }

    Coordinates GetPlace(int side, double along) const {
        Coordinates const from = GetCorner(side), to = GetCorner((side + 1) % GetCount());
        return {from[0] + along * (to[0] - from[0]), from[1] + along * (to[1] - from[1])};
    }

    Coordinates GetCorner(int corner) const {
        constexpr Coordinates kQuad[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        constexpr Coordinates kTriangle[3] = {{0, 0}, {1, 0}, {0, 1}};
        return _isTriangle ? kTriangle[corner] : kQuad[corner];
    }

    /// The corner that is no further than this away; -1: none.
    int FindCorner(Coordinates const& at, double distance) const {
        for (int corner = 0; corner < GetCount(); ++corner) {
            Coordinates const place = GetCorner(corner);
            if (std::max(std::abs(place[0] - at[0]), std::abs(place[1] - at[1])) <= distance)
                return corner;
        }
        return -1;
    }

    /// The directions of the sides that meet at a corner, both away from it: of the side that
    /// starts there, then of the one that ends there.
    std::array<Coordinates, 2> GetCornerDirections(int corner) const {
        Coordinates const at = GetCorner(corner), next = GetCorner((corner + 1) % GetCount()),
                          last = GetCorner((corner + GetCount() - 1) % GetCount());
        return {Coordinates{next[0] - at[0], next[1] - at[1]},
                Coordinates{last[0] - at[0], last[1] - at[1]}};
    }

    /// A place outside of the domain, by rounding or little more, as one on its edge.
    Coordinates Clamp(Coordinates const& at) const {
        double const s = std::clamp(at[0], 0.0, 1.0), t = std::clamp(at[1], 0.0, 1.0);
        double const beyond = _isTriangle ? std::max(0.0, s + t - 1.0) : 0.0;
        double const onS = std::clamp(s - 0.5 * beyond, 0.0, 1.0);
        return {onS, _isTriangle ? std::min(t, 1.0 - onS) : t};
    }

private:
    bool _isTriangle;
};

}  // namespace limn::eval
