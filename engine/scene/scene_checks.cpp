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

/// \param length  values per element
template <class T>
void CheckMagnitude(std::string const& what, std::span<T const> values, size_t length) {
    auto const bad = std::find_if_not(values.begin(), values.end(), [](T v) {
        return std::abs(v) <= static_cast<T>(kLargestNumber);
    });
    if (bad == values.end()) return;
    throw Error(
        ErrorCode::BadMesh,
        fmt::format("{} {} is {:g}; at most {:g} in magnitude is possible", what,
                    static_cast<size_t>(bad - values.begin()) / length, *bad, kLargestNumber));
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
    auto const& cage = scene.cage;
    size_t const numCoordinates = 3 * static_cast<size_t>(std::max(0, cage.numVertices));
    // First, for what comes then takes memory by the number of vertices.
    if (numCoordinates > 0) CheckCount("positions", scene.positions.size(), numCoordinates);
    far_ext::Validate(cage);
    CheckPositions(cage, scene.positions);
    if (!scene.normals.empty()) CheckCount("normals", scene.normals.size(), numCoordinates);
    CheckFinite("normal of vertex", scene.normals, 3);
    CheckUVs(scene);
    CheckPrimvars(scene);
    CheckGroups(scene);
    if (!scene.faceLines.empty())
        CheckCount("lines of faces", scene.faceLines.size(), cage.faceSizes.size());
}

void CheckMagnitudes(Scene const& scene) {
    CheckMagnitudes(scene.positions);
    CheckMagnitude<double>("texture coordinate", scene.uvs, 2);
    for (Primvar const& primvar : scene.primvars) {
        CheckMagnitude<float>(fmt::format("primvar '{}' of vertex", primvar.name), primvar.values,
                              static_cast<size_t>(primvar.numChannels));
    }
}

void CheckMagnitudes(std::span<double const> positions) {
    CheckMagnitude<double>("position of vertex", positions, 3);
}

}  // namespace limn::engine
