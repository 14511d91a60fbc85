// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/scene_checks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

namespace {

void CheckCount(std::string const& what, size_t count, size_t wanted) {
    if (count == wanted) return;
    throw Error(ErrorCode::BadMesh,
                fmt::format("{}: {} values; {} are needed", what, count, wanted));
}

/// \param length  values per element
void CheckFinite(std::string const& what, std::vector<double> const& values, size_t length) {
    auto const bad =
        std::find_if_not(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (bad == values.end()) return;
    throw Error(ErrorCode::BadMesh,
                fmt::format("{} {} is {}; a finite number is needed", what,
                            static_cast<size_t>(bad - values.begin()) / length, *bad));
}

void CheckUVs(Scene const& scene) {
    if (!scene.HasUVs()) return;
    auto const& channels = scene.cage.fvarChannels;
    size_t const numUVs = channels.empty() ? 0 : static_cast<size_t>(channels[0].numValues);
    CheckCount("texture coordinates", scene.uvs.size(), 2 * numUVs);
    CheckFinite("texture coordinate", scene.uvs, 2);
    if (scene.lacksUVs.empty()) return;
    CheckCount("faces without texture coordinates", scene.lacksUVs.size(),
               scene.cage.faceSizes.size());
}

void CheckPrimvars(Scene const& scene) {
    for (Primvar const& primvar : scene.primvars) {
        std::string const what = fmt::format("primvar '{}'", primvar.name);
        if (primvar.numChannels < 1) {
            throw Error(ErrorCode::BadMesh, fmt::format("{} has {} channels; at least 1 is needed",
                                                        what, primvar.numChannels));
        }
        CheckCount(
            what, primvar.values.size(),
            static_cast<size_t>(primvar.numChannels) * static_cast<size_t>(scene.cage.numVertices));
    }
}

void CheckGroups(Scene const& scene) {
    for (FaceGroups const& groups : scene.groups) {
        if (groups.faceGroup.empty()) continue;
        CheckCount("groups of faces", groups.faceGroup.size(), scene.cage.faceSizes.size());
        Index const numGroups = static_cast<Index>(groups.names.size());
        auto const bad = std::find_if(groups.faceGroup.begin(), groups.faceGroup.end(),
                                      [&](Index g) { return g < -1 || g >= numGroups; });
        if (bad == groups.faceGroup.end()) continue;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{} is in group {}; there are {}",
                                scene.NameFace(static_cast<Index>(bad - groups.faceGroup.begin())),
                                *bad, numGroups));
    }
}

}  // namespace

void CheckPositions(far_ext::ControlMesh const& cage, std::vector<double> const& positions) {
    CheckCount("positions", positions.size(), 3 * static_cast<size_t>(cage.numVertices));
    CheckFinite("position of vertex", positions, 3);
}

void CheckScene(Scene const& scene) {
    far_ext::Validate(scene.cage);
    CheckPositions(scene.cage, scene.positions);
    CheckUVs(scene);
    CheckPrimvars(scene);
    CheckGroups(scene);
}

}  // namespace limn::engine
