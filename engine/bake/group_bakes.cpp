// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/group_bakes.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/bake/bake_warnings.h"
#include "engine/bake/output_names.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

/// The groups of the first kind that the mesh has, those with faces.
std::vector<std::string> ListGroupsOfOneKind(Model const& model, Job& job) {
    for (GroupKind kind : {GroupKind::Material, GroupKind::Group, GroupKind::Object}) {
        auto const names = model.ListGroups(kind);
        if (names.empty()) continue;
        auto const& ofFace = model.GetGroups()[static_cast<size_t>(kind)].faceGroup;
        if (auto const bare = std::ranges::find(ofFace, -1); bare != ofFace.end()) {
            job.Warn(
                fmt::format("{}: {} of {} faces are in none of the groups that are baked one "
                            "by one, first {}",
                            model.GetPath(), std::ranges::count(ofFace, -1), ofFace.size(),
                            model.NameFace(static_cast<Index>(bare - ofFace.begin()))));
        }
        return names;
    }
    throw Error(
        ErrorCode::BadOption,
        fmt::format("`pattern`: {{group}} needs groups, and '{}' has none", model.GetPath()));
}

}  // namespace

std::vector<BakeOptions> SplitByGroup(Model const& model, BakeOptions const& options, Job& job) {
    model.SelectGroups(options.groups);  // refuses those that there are not
    WarnOfLostFaces(model, job);
    std::vector<BakeOptions> bakes;
    OutputNames names;
    auto const groups = options.groups.empty() ? ListGroupsOfOneKind(model, job) : options.groups;
    for (std::string const& group : groups) {
        BakeOptions& own = bakes.emplace_back(options);
        own.groups = {group};
        own.group = group;
        own.mayBeEmpty = true;
        if (HasGroupToken(own.pattern)) names.Add(own, model.GetName(), model.GetPath());
    }
    return bakes;
}

}  // namespace limn::engine
