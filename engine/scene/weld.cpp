// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/weld.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/scene/coincidence.h"
#include "engine/scene/scene_checks.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

namespace {

using far_ext::ControlMesh;

/// A face's way along an edge, between vertices of the scene and between the vertices they become.
struct EdgeUse {
    std::pair<Index, Index> joined, own;  // each the lower vertex first

    auto operator<=>(EdgeUse const&) const = default;
};

std::pair<Index, Index> InOrder(Index a, Index b) {
    return {std::min(a, b), std::max(a, b)};
}

/// All ways along edges, those along the same edge side by side.
std::vector<EdgeUse> ListEdgeUses(ControlMesh const& cage, std::vector<Index> const& joinedOf) {
    std::vector<EdgeUse> uses;
    uses.reserve(cage.faceVertices.size());
    size_t first = 0;
    for (int size : cage.faceSizes) {
        for (int i = 0; i < size; ++i) {
            Index const a = cage.faceVertices[first + i],
                        b = cage.faceVertices[first + (i + 1) % size];
            uses.push_back({InOrder(joinedOf[a], joinedOf[b]), InOrder(a, b)});
        }
        first += size;
    }
    std::sort(uses.begin(), uses.end());
    return uses;
}

/// Calls visit(begin, end) for each run of elements of which `key` is the same.
template <class Range, class Key, class Visit>
void ForEachRun(Range const& range, Key key, Visit visit) {
    for (auto begin = range.begin(); begin != range.end();) {
        auto const end = std::find_if(
            begin, range.end(), [&](auto const& element) { return element.*key != (*begin).*key; });
        visit(begin, end);
        begin = end;
    }
}

/// Why vertices that coincide stay apart.
enum class Apart : char { No, TwiceInAFace, ThirdFace };

/// Which vertices become one.
class Joining {
public:
    Joining(ControlMesh const& cage, std::span<double const> positions, double tolerance)
        : _cage(cage) {
        std::vector<Index> const self = Identity();
        _groupOf = GroupCoincident(positions, FindBoundary(self), tolerance);
        _groupSizes.assign(self.size(), 0);
        for (Index group : _groupOf) ++_groupSizes[group];
        _apart.assign(self.size(), Apart::No);
        KeepCornersApart();
        KeepThirdFacesApart();
    }

    /// Per vertex the lowest of those it is joined with, itself included.
    std::vector<Index> GetJoined() const {
        std::vector<Index> joined = Identity();
        for (size_t vertex = 0; vertex < joined.size(); ++vertex) {
            if (_apart[_groupOf[vertex]] == Apart::No) joined[vertex] = _groupOf[vertex];
        }
        return joined;
    }

    Apart GetApart(Index vertex) const { return _apart[_groupOf[vertex]]; }

private:
    std::vector<Index> Identity() const {
        std::vector<Index> self(static_cast<size_t>(_cage.numVertices));
        std::iota(self.begin(), self.end(), 0);
        return self;
    }

    /// The ends of edges that one face has.
    std::vector<char> FindBoundary(std::vector<Index> const& self) const {
        std::vector<char> isBoundary(self.size(), 0);
        ForEachRun(ListEdgeUses(_cage, self), &EdgeUse::own, [&](auto begin, auto end) {
            if (end - begin == 1) isBoundary[begin->own.first] = isBoundary[begin->own.second] = 1;
        });
        return isBoundary;
    }

    /// A face of which two corners would become one stays as it is.
    void KeepCornersApart() {
        std::vector<std::pair<Index, Index>> corners;  // group and vertex
        size_t first = 0;
        for (int size : _cage.faceSizes) {
            corners.clear();
            for (int i = 0; i < size; ++i) {
                Index const vertex = _cage.faceVertices[first + i];
                corners.push_back({_groupOf[vertex], vertex});
            }
            std::sort(corners.begin(), corners.end());
            for (int i = 1; i < size; ++i) {
                auto const& [group, vertex] = corners[i];
                auto const& [groupBefore, vertexBefore] = corners[i - 1];
                if (group == groupBefore && vertex != vertexBefore)
                    _apart[group] = Apart::TwiceInAFace;
            }
            first += size;
        }
    }

    /// Edges that would become one of three faces or more stay as they are, unless one of them has
    /// as many by itself.
    void KeepThirdFacesApart() {
        auto const uses = ListEdgeUses(_cage, GetJoined());
        ForEachRun(uses, &EdgeUse::joined, [&](auto begin, auto end) {
            if (end - begin < 3) return;
            std::ptrdiff_t most = 0;
            ForEachRun(std::ranges::subrange(begin, end), &EdgeUse::own,
                       [&](auto from, auto to) { most = std::max(most, to - from); });
            if (most > 2) return;
            for (Index vertex : {begin->joined.first, begin->joined.second}) {
                Index const group = _groupOf[vertex];
                if (_groupSizes[group] > 1 && _apart[group] == Apart::No)
                    _apart[group] = Apart::ThirdFace;
            }
        });
    }

    ControlMesh const& _cage;
    std::vector<Index> _groupOf;  // per vertex: the lowest of those that coincide with it
    std::vector<Index> _groupSizes;
    std::vector<Apart> _apart;  // per group
};

/// A crease or corner, at an edge or a vertex, and whether welding has brought others there.
template <class Place>
struct Sharp {
    Place place;
    float sharpness;
    bool isJoined;
};

/// All in their order; those that have come together at one place are one, as sharp as the
/// sharpest.
template <class Place>
std::vector<Sharp<Place>> KeepSharpest(std::vector<Sharp<Place>> const& all) {
    std::vector<Sharp<Place>> kept;
    std::map<Place, size_t> keptAt;
    for (Sharp<Place> const& sharp : all) {
        if (sharp.isJoined) {
            auto const [found, isNew] = keptAt.try_emplace(sharp.place, kept.size());
            if (!isNew) {
                float& sharpness = kept[found->second].sharpness;
                sharpness = std::max(sharpness, sharp.sharpness);
                continue;
            }
        }
        kept.push_back(sharp);
    }
    return kept;
}

/// Makes one vertex of those that are joined.
class Welder {
public:
    Welder(Scene& scene, Joining const& joining)
        : _scene(scene), _joining(joining), _joined(joining.GetJoined()) {
        _newOf.resize(_joined.size());
        for (size_t vertex = 0; vertex < _joined.size(); ++vertex) {
            Index const first = _joined[vertex];
            bool const isFirst = static_cast<size_t>(first) == vertex;
            _newOf[vertex] = isFirst ? _numNew++ : _newOf[first];
        }
        ListOlds();
    }

    void Weld(double tolerance) {
        auto& cage = _scene.cage;
        Index const numOld = cage.numVertices;
        WeldUVs();
        WeldPositions();
        WeldPrimvars();
        WeldSharpness();
        for (Index& vertex : cage.faceVertices) vertex = _newOf[vertex];
        cage.numVertices = _numNew;
        _scene.normals.clear();
        _scene.weld = {tolerance, numOld - _numNew, WarnOfApart(tolerance)};
    }

private:
    /// Sorts the old vertices by the new ones that they become.
    void ListOlds() {
        _firstOld.assign(static_cast<size_t>(_numNew) + 1, 0);
        for (Index vertex : _newOf) ++_firstOld[vertex + 1];
        std::partial_sum(_firstOld.begin(), _firstOld.end(), _firstOld.begin());
        _olds.resize(_newOf.size());
        auto next = _firstOld;
        for (size_t old = 0; old < _newOf.size(); ++old)
            _olds[next[_newOf[old]]++] = static_cast<Index>(old);
    }

    std::span<Index const> GetOlds(Index vertex) const {
        return {_olds.begin() + _firstOld[vertex], _olds.begin() + _firstOld[vertex + 1]};
    }
    bool IsJoined(Index vertex) const { return GetOlds(vertex).size() > 1; }

    /// Of vertices that are joined, the first point by x, y, z.
    void WeldPositions() {
        far_ext::Points const points(_scene.positions);
        std::vector<double> positions;
        positions.reserve(3 * static_cast<size_t>(_numNew));
        for (Index vertex = 0; vertex < _numNew; ++vertex) {
            Index const first = *std::ranges::min_element(GetOlds(vertex), [&](Index a, Index b) {
                return std::ranges::lexicographical_compare(points[a], points[b]);
            });
            positions.insert(positions.end(), points[first].begin(), points[first].end());
        }
        _scene.positions = std::move(positions);
    }

    void WeldPrimvars() {
        std::vector<std::string> conflicts;
        Index most = 0;
        for (Primvar& primvar : _scene.primvars) {
            Index const numDifferent = WeldPrimvar(primvar);
            if (numDifferent > 0) conflicts.push_back("'" + primvar.name + "'");
            most = std::max(most, numDifferent);
        }
        if (conflicts.empty()) return;
        Warn(
            fmt::format("of the joined vertices up to {} had different values of {}; they have the "
                        "mean",
                        most, fmt::join(conflicts, ", ")));
    }

    /// The mean, summed up in the order of values so that it does not depend on numbers. Returns at
    /// how many vertices they differed.
    Index WeldPrimvar(Primvar& primvar) const {
        size_t const n = static_cast<size_t>(primvar.numChannels);
        std::vector<float> welded;
        welded.reserve(n * static_cast<size_t>(_numNew));
        std::vector<double> values;
        Index numDifferent = 0;
        for (Index vertex = 0; vertex < _numNew; ++vertex) {
            bool isDifferent = false;
            for (size_t c = 0; c < n; ++c) {
                values.clear();
                for (Index old : GetOlds(vertex)) values.push_back(primvar.values[old * n + c]);
                std::ranges::sort(values, [](double a, double b) {
                    return std::strong_order(a, b) < 0;  // one that sorts NaN, too
                });
                isDifferent |= values.front() != values.back();
                double const sum = std::accumulate(values.begin(), values.end(), 0.0);
                welded.push_back(static_cast<float>(sum / static_cast<double>(values.size())));
            }
            numDifferent += isDifferent;
        }
        primvar.values = std::move(welded);
        return numDifferent;
    }

    /// Corners of a joined vertex with equal texture coordinates share them.
    void WeldUVs() {
        if (!_scene.HasUVs()) return;
        far_ext::FVarChannel& channel = _scene.cage.fvarChannels[0];
        struct Corner {
            Index vertex;
            double u, v;
            Index value;
            size_t corner;
        };
        std::vector<Corner> corners;
        size_t corner = 0;
        for (Index face = 0; face < _scene.cage.GetNumFaces(); ++face) {
            for (int i = 0; i < _scene.cage.faceSizes[face]; ++i, ++corner) {
                Index const vertex = _newOf[_scene.cage.faceVertices[corner]],
                            value = channel.valueIndices[corner];
                double const* const uv = &_scene.uvs[2 * static_cast<size_t>(value)];
                if (IsJoined(vertex) && _scene.HasUVs(face))
                    corners.push_back({vertex, uv[0], uv[1], value, corner});
            }
        }
        auto const place = [](Corner const& c) { return std::tie(c.vertex, c.u, c.v); };
        std::ranges::sort(corners, {}, [&](Corner const& c) {
            return std::tuple_cat(place(c), std::tie(c.value));
        });
        std::vector<char> const wasUsed = FindUsed(channel);
        for (size_t i = 1; i < corners.size(); ++i) {
            if (place(corners[i]) != place(corners[i - 1])) continue;
            corners[i].value = corners[i - 1].value;
            channel.valueIndices[corners[i].corner] = corners[i].value;
        }
        DropUVs(channel, wasUsed);
    }

    static std::vector<char> FindUsed(far_ext::FVarChannel const& channel) {
        std::vector<char> isUsed(static_cast<size_t>(channel.numValues), 0);
        for (Index value : channel.valueIndices) isUsed[value] = 1;
        return isUsed;
    }

    /// Drops the values that no corner uses any more.
    void DropUVs(far_ext::FVarChannel& channel, std::vector<char> const& wasUsed) {
        std::vector<char> const isUsed = FindUsed(channel);
        std::vector<Index> newOf(wasUsed.size(), -1);
        std::vector<double> uvs;
        channel.numValues = 0;
        for (size_t value = 0; value < wasUsed.size(); ++value) {
            if (wasUsed[value] && !isUsed[value]) continue;
            newOf[value] = channel.numValues++;
            uvs.insert(uvs.end(), {_scene.uvs[2 * value], _scene.uvs[2 * value + 1]});
        }
        for (Index& value : channel.valueIndices) value = newOf[value];
        _scene.uvs = std::move(uvs);
    }

    /// Creases and corners move along with their vertices.
    void WeldSharpness() {
        auto& cage = _scene.cage;
        std::vector<Sharp<std::pair<Index, Index>>> creases;
        for (size_t i = 0; i < cage.creaseSharpness.size(); ++i) {
            Index const a = _newOf[cage.creaseVertexPairs[2 * i]],
                        b = _newOf[cage.creaseVertexPairs[2 * i + 1]];
            bool const isJoined = IsJoined(a) || IsJoined(b);
            creases.push_back(
                {isJoined ? InOrder(a, b) : std::pair(a, b), cage.creaseSharpness[i], isJoined});
        }
        cage.creaseVertexPairs.clear();
        cage.creaseSharpness.clear();
        for (auto const& crease : KeepSharpest(creases)) {
            cage.creaseVertexPairs.insert(cage.creaseVertexPairs.end(),
                                          {crease.place.first, crease.place.second});
            cage.creaseSharpness.push_back(crease.sharpness);
        }
        std::vector<Sharp<Index>> corners;
        for (size_t i = 0; i < cage.cornerSharpness.size(); ++i) {
            Index const vertex = _newOf[cage.cornerVertices[i]];
            corners.push_back({vertex, cage.cornerSharpness[i], IsJoined(vertex)});
        }
        cage.cornerVertices.clear();
        cage.cornerSharpness.clear();
        for (auto const& corner : KeepSharpest(corners)) {
            cage.cornerVertices.push_back(corner.place);
            cage.cornerSharpness.push_back(corner.sharpness);
        }
    }

    /// Returns how many vertices stay apart.
    Index WarnOfApart(double tolerance) {
        Index count = 0, first = -1;
        for (Index old = 0; old < static_cast<Index>(_newOf.size()); ++old) {
            if (_joining.GetApart(old) == Apart::No) continue;
            if (count++ == 0) first = old;
        }
        if (count == 0) return 0;
        bool const isThirdFace = _joining.GetApart(first) == Apart::ThirdFace;
        Warn(fmt::format(
            "{} boundary vertices {} and stay apart, first vertex {}: joined, {}{}", count,
            tolerance > 0.0 ? fmt::format("lie within {:g} of others", tolerance)
                            : "coincide with others",
            first,
            isThirdFace ? "an edge would have more than two faces"
                        : "a face would have a corner twice",
            tolerance > 0.0 && !isThirdFace ? "; use a `weld` far below the length of edges" : ""));
        return count;
    }

    void Warn(std::string const& message) {
        _scene.warnings.push_back(fmt::format("{}: {}", _scene.path, message));
    }

    Scene& _scene;
    Joining const& _joining;
    std::vector<Index> const _joined;
    std::vector<Index> _newOf;  // per old vertex
    Index _numNew = 0;
    std::vector<Index> _olds;      // of each new vertex, one after another
    std::vector<Index> _firstOld;  // per new vertex, and one more
};

void CheckTolerance(double tolerance) {
    if (tolerance >= 0.0 && std::isfinite(tolerance)) return;
    throw Error(ErrorCode::BadOption,
                fmt::format("`weld` is {}; a length of 0 or more is needed", tolerance));
}

}  // namespace

Scene Weld(Scene scene, double tolerance) {
    CheckTolerance(tolerance);
    NamingMesh(scene.path, [&] { CheckScene(scene); });
    Joining const joining(scene.cage, scene.positions, tolerance);
    Welder(scene, joining).Weld(tolerance);
    return scene;
}

bool CanWeld(ControlMesh const& cage, std::span<double const> positions, double tolerance) {
    auto const joined = Joining(cage, positions, tolerance).GetJoined();
    for (size_t vertex = 0; vertex < joined.size(); ++vertex) {
        if (joined[vertex] != static_cast<Index>(vertex)) return true;
    }
    return false;
}

}  // namespace limn::engine
