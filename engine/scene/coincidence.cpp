// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/coincidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nanoflann.hpp>

#include "engine/scene/parity_sets.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

namespace {

/// Points of distinct places as nanoflann reads them.
struct Places {
    far_ext::Points points;
    std::vector<Index> const& places;

    size_t kdtree_get_point_count() const { return places.size(); }
    double kdtree_get_pt(size_t index, size_t axis) const {
        return points[places[index]][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using PlaceTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Places>,
                                                      Places, 3, uint32_t>;

/// Joins candidates that are equal. Returns one of each place.
std::vector<Index> JoinEqual(far_ext::Points points, std::span<char const> isCandidate,
                             ParitySets& groups) {
    std::vector<Index> sorted;
    for (size_t i = 0; i < isCandidate.size(); ++i) {
        if (isCandidate[i]) sorted.push_back(static_cast<Index>(i));
    }
    auto const isBefore = [&](Index a, Index b) {
        return std::ranges::lexicographical_compare(points[a], points[b]);
    };
    std::sort(sorted.begin(), sorted.end(), isBefore);
    std::vector<Index> places;
    for (Index point : sorted) {
        if (places.empty() || isBefore(places.back(), point))
            places.push_back(point);
        else
            groups.Join(places.back(), point, 0);
    }
    return places;
}

/// The places within a distance of one, as nanoflann finds them: no more than are of use.
class NearPlaces {
public:
    static constexpr size_t kMost = 257;  // a place itself, and 256 others

    explicit NearPlaces(double distance)
        : _beyond(std::nextafter(distance * distance, std::numeric_limits<double>::infinity())) {}

    std::vector<uint32_t> const& GetPlaces() const { return _places; }
    void Clear() { _places.clear(); }

    // What a search asks for.
    using DistanceType = double;
    size_t size() const { return _places.size(); }
    bool full() const { return true; }
    double worstDist() const { return _beyond; }
    bool addPoint(double, uint32_t place) {
        _places.push_back(place);
        return _places.size() < kMost;
    }
    void sort() {}

private:
    double _beyond;  // a square, the least that is too far
    std::vector<uint32_t> _places;
};

/// Joins places within `tolerance` of each other.
void JoinNear(far_ext::Points points, std::vector<Index> const& places, double tolerance,
              ParitySets& groups) {
    Places const kept{points, places};  // the tree refers to it
    PlaceTree const tree(3, kept);
    NearPlaces near(tolerance);
    for (Index place : places) {
        near.Clear();
        tree.findNeighbors(near, points[place].data(), {});
        if (near.GetPlaces().size() == NearPlaces::kMost) {
            throw Error(ErrorCode::BadOption,
                        fmt::format("`weld`: {} reaches {} other places from vertex {}, and more; "
                                    "it must be far below the length of edges",
                                    tolerance, NearPlaces::kMost - 1, place));
        }
        for (uint32_t other : near.GetPlaces()) groups.Join(place, places[other], 0);
    }
}

}  // namespace

std::vector<Index> GroupCoincident(std::span<double const> positions,
                                   std::span<char const> isCandidate, double tolerance) {
    ParitySets groups(static_cast<Index>(isCandidate.size()));
    auto const places = JoinEqual(positions, isCandidate, groups);
    if (tolerance > 0.0) JoinNear(positions, places, tolerance, groups);
    std::vector<Index> lowest(isCandidate.size(), -1), groupOf(isCandidate.size());
    for (Index point = 0; point < static_cast<Index>(isCandidate.size()); ++point) {
        Index& first = lowest[groups.Find(point).first];
        if (first < 0) first = point;
        groupOf[point] = first;
    }
    return groupOf;
}

}  // namespace limn::engine
