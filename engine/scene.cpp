#include "engine/scene.h"

#include <algorithm>

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

std::vector<char> SelectGroups(Scene const& scene, std::vector<std::string> const& names) {
    std::vector<char> selected(scene.cage.faceSizes.size(), 0);
    for (std::string const& name : names) {
        bool known = false;
        for (FaceGroups const& groups : scene.groups) {
            auto const found = std::find(groups.names.begin(), groups.names.end(), name);
            if (found == groups.names.end()) continue;
            known = true;
            if (groups.faceGroup.empty()) continue;  // named, but no face follows
            Index const group = static_cast<Index>(found - groups.names.begin());
            for (size_t face = 0; face < selected.size(); ++face) {
                if (groups.faceGroup[face] == group) selected[face] = 1;
            }
        }
        if (!known) {
            std::vector<std::string> all;
            for (FaceGroups const& groups : scene.groups) {
                all.insert(all.end(), groups.names.begin(), groups.names.end());
            }
            throw Error(ErrorCode::BadOption,
                        fmt::format("--groups: '{}' has no group '{}'; it has: {}", scene.path, name,
                                    all.empty() ? "none" : fmt::format("{}", fmt::join(all, ", "))));
        }
    }
    return selected;
}

}  // namespace limn::engine
