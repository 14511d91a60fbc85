// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/scene.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>
#include <unordered_set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "far_ext/error.h"

namespace limn::engine {

std::string Scene::NameFace(Index face) const {
    if (static_cast<size_t>(face) < faceLines.size()) {
        return fmt::format("face {} (line {})", face, faceLines[face]);
    }
    return fmt::format("face {}", face);
}

void Scene::AddUVChannel(std::vector<Index> values, std::vector<char> lacks) {
    if (std::ranges::count(lacks, 1) > 0) {
        // One value for all corners without: a chart of its own, which no seam joins to another. It
        // lies where a value lies already, so that it enlarges no bounds and adds no tile.
        std::ranges::replace(values, -1, static_cast<Index>(uvs.size() / 2));
        uvs.insert(uvs.end(), {uvs[0], uvs[1]});
        lacksUVs = std::move(lacks);
    }
    cage.fvarChannels.push_back({static_cast<Index>(uvs.size() / 2), std::move(values)});
}

namespace {

/// The groups that one entry of Scene::groups stands for.
std::vector<std::string> SplitName(std::string const& name, GroupKind kind) {
    if (kind != GroupKind::Group) return {name};
    std::istringstream words(name);
    return {std::istream_iterator<std::string>(words), {}};
}

/// Calls visit(groups, entry, name) for each name of a kind, in the order of the file.
template <class Visit>
void ForEachName(Scene const& scene, GroupKind kind, Visit visit) {
    FaceGroups const& groups = scene.groups[static_cast<size_t>(kind)];
    for (size_t entry = 0; entry < groups.names.size(); ++entry) {
        for (std::string const& name : SplitName(groups.names[entry], kind)) {
            visit(groups, static_cast<Index>(entry), name);
        }
    }
}

template <class Visit>
void ForEachName(Scene const& scene, Visit visit) {
    for (GroupKind kind : {GroupKind::Material, GroupKind::Group, GroupKind::Object})
        ForEachName(scene, kind, visit);
}

}  // namespace

std::vector<std::string> ListGroups(Scene const& scene) {
    std::vector<std::string> all;
    std::unordered_set<std::string> known;
    ForEachName(scene, [&](FaceGroups const&, Index, std::string const& name) {
        if (known.insert(name).second) all.push_back(name);
    });
    return all;
}

std::vector<std::string> ListGroups(Scene const& scene, GroupKind kind) {
    FaceGroups const& groups = scene.groups[static_cast<size_t>(kind)];
    std::vector<char> isUsed(groups.names.size(), 0);
    for (Index entry : groups.faceGroup) {
        if (entry >= 0) isUsed[entry] = 1;
    }
    std::vector<std::string> used;
    std::unordered_set<std::string> known;
    ForEachName(scene, kind, [&](FaceGroups const&, Index entry, std::string const& name) {
        if (isUsed[entry] && known.insert(name).second) used.push_back(name);
    });
    return used;
}

std::vector<char> SelectGroups(Scene const& scene, std::vector<std::string> const& names) {
    auto const all = ListGroups(scene);
    std::unordered_set<std::string> const known(all.begin(), all.end());
    for (std::string const& name : names) {
        if (known.contains(name)) continue;
        throw Error(ErrorCode::BadOption,
                    fmt::format("`groups`: '{}' has no group '{}'; it has: {}", scene.path, name,
                                all.empty() ? "none" : fmt::format("{}", fmt::join(all, ", "))));
    }
    std::unordered_set<std::string> const wanted(names.begin(), names.end());
    std::array<std::vector<char>, 3> isWanted;  // per kind and entry
    for (size_t kind = 0; kind < isWanted.size(); ++kind)
        isWanted[kind].assign(scene.groups[kind].names.size(), 0);
    ForEachName(scene, [&](FaceGroups const& groups, Index entry, std::string const& name) {
        if (wanted.contains(name)) isWanted[&groups - scene.groups.data()][entry] = 1;
    });
    std::vector<char> selected(scene.cage.faceSizes.size(), 0);
    for (size_t kind = 0; kind < isWanted.size(); ++kind) {
        auto const& ofFace = scene.groups[kind].faceGroup;  // empty: named, but no face follows
        for (size_t face = 0; face < ofFace.size(); ++face)
            selected[face] |= ofFace[face] >= 0 && isWanted[kind][ofFace[face]];
    }
    return selected;
}

}  // namespace limn::engine
