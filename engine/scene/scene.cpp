// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/scene.h"

#include <algorithm>
#include <iterator>
#include <sstream>

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

namespace {

/// The groups that one entry of Scene::groups stands for.
std::vector<std::string> SplitName(std::string const& name, GroupKind kind) {
    if (kind != GroupKind::Group) return {name};
    std::istringstream words(name);
    return {std::istream_iterator<std::string>(words), {}};
}

/// Calls visit(groups, entry, name) for each group's name, kind by kind in the order of the file.
template <class Visit>
void ForEachName(Scene const& scene, Visit visit) {
    for (GroupKind kind : {GroupKind::Material, GroupKind::Group, GroupKind::Object}) {
        FaceGroups const& groups = scene.groups[static_cast<size_t>(kind)];
        for (size_t entry = 0; entry < groups.names.size(); ++entry) {
            for (std::string const& name : SplitName(groups.names[entry], kind)) {
                visit(groups, static_cast<Index>(entry), name);
            }
        }
    }
}

}  // namespace

std::vector<std::string> ListGroups(Scene const& scene) {
    std::vector<std::string> all;
    ForEachName(scene, [&](FaceGroups const&, Index, std::string const& name) {
        if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    });
    return all;
}

std::vector<char> SelectGroups(Scene const& scene, std::vector<std::string> const& names) {
    auto const all = ListGroups(scene);
    for (std::string const& name : names) {
        if (std::find(all.begin(), all.end(), name) != all.end()) continue;
        throw Error(ErrorCode::BadOption,
                    fmt::format("`groups`: '{}' has no group '{}'; it has: {}", scene.path, name,
                                all.empty() ? "none" : fmt::format("{}", fmt::join(all, ", "))));
    }
    std::vector<char> selected(scene.cage.faceSizes.size(), 0);
    ForEachName(scene, [&](FaceGroups const& groups, Index entry, std::string const& name) {
        if (std::find(names.begin(), names.end(), name) == names.end()) return;
        if (groups.faceGroup.empty()) return;  // named, but no face follows
        for (size_t face = 0; face < selected.size(); ++face) {
            if (groups.faceGroup[face] == entry) selected[face] = 1;
        }
    });
    return selected;
}

}  // namespace limn::engine
