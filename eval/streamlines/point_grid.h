// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace limn::eval {

/// Points with something to each, to be found by place: in cells of a cubic grid.
template <class Item>
class PointGrid {
public:
    /// \param cell  its side: as far as one can look
    explicit PointGrid(double cell) : _cell(cell) {}

    void Add(Eigen::Vector3d const& point, Item const& item) {
        _cells[FindCell(point)].emplace_back(point, item);
    }

    /// Calls visit(point, item) for the points in the cells round a place, which are all that are
    /// within a cell's side of it, and some more; until it returns true. Whether it did.
    template <class Visit>
    bool FindNear(Eigen::Vector3d const& place, Visit visit) const {
        auto const middle = FindCell(place);
        for (int i = 0; i < 27; ++i) {
            Key const key{middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1};
            auto const found = _cells.find(key);
            if (found == _cells.end()) continue;
            for (auto const& [point, item] : found->second) {
                if (visit(point, item)) return true;
            }
        }
        return false;
    }

private:
    using Key = std::array<std::int64_t, 3>;
    struct Hash {
        size_t operator()(Key const& key) const {
            std::uint64_t hash = 0;
            for (std::int64_t part : key)
                hash = (hash ^ static_cast<std::uint64_t>(part)) * 0x9e3779b97f4a7c15u;
            return static_cast<size_t>(hash ^ (hash >> 32));
        }
    };

    Key FindCell(Eigen::Vector3d const& point) const {
        constexpr double kFarthest = 0x1p60;
        Key key{};
        for (int c = 0; c < 3; ++c)
            key[static_cast<size_t>(c)] = static_cast<std::int64_t>(
                std::clamp(std::floor(point[c] / _cell), -kFarthest, kFarthest));
        return key;
    }

    double _cell;
    std::unordered_map<Key, std::vector<std::pair<Eigen::Vector3d, Item>>, Hash> _cells;
};

}  // namespace limn::eval
