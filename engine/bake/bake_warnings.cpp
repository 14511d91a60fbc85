// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/bake_warnings.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/scene/extent.h"
#include "engine/scene/uv_info.h"

namespace limn::engine {

namespace {

// Layouts are written with so many digits that charts which touch reach over one another by less.
constexpr double kDeepEnough = 0.05;         // texels
constexpr double kOftenEnough = 1e-3;        // of all covered texels; with faces smaller than that
constexpr double kMostLeftOut = 0.05;        // of the longest displacement
constexpr double kMostRoundedInHalf = 1e-3;  // of the mesh's size; floats: kMostRounded

/// Places are told by their distance to the origin: far from it there are no digits left for the
/// mesh.
void WarnOfRoundedPlaces(Model const& model, BakeOptions const& options, MapTraits const& map,
                         Job& job) {
    Extent const extent =
        FindExtent(Subtract(model.GetPositions(), map.origin.value_or(std::array<double, 3>{})));
    bool const isHalf = options.IsHalf(map.name);
    Encoding const encoding = options.encoding.value_or(Encoding{});
    double const scale = std::abs(encoding.scale);
    double const farthest = scale * extent.GetFarthest() + std::abs(encoding.offset);
    double const step = isHalf ? GetHalfStep(farthest) : GetFloatStep(farthest);
    double const most = isHalf ? kMostRoundedInHalf : kMostRounded;
    if (!(step > most * scale * extent.GetDiagonal())) return;
    job.Warn(fmt::format(
        "{}: positions of {} precision are {:g} apart, of a mesh of size {:g}{}; `origin` auto "
        "writes them relative to a point near the mesh",
        model.GetPath(), isHalf ? "half" : "single", step / scale, extent.GetDiagonal(),
        isHalf ? "; name the other maps by `halfMaps`, and positions stay floats" : ""));
}

/// "materials red and blue", of the first kind of group that tells all or most of the texels apart.
std::string NameOverlappingGroups(Model const& model, BakeReport const& report) {
    constexpr char const* kKinds[] = {"materials", "groups", "objects"};
    for (size_t kind = 0; kind < model.GetGroups().size(); ++kind) {
        size_t const count = report.overlap.betweenGroups[kind];
        if (2 * count < report.overlaps) continue;
        FaceGroups const& groups = model.GetGroups()[kind];
        std::vector<std::string> names;
        for (Index face : report.overlap.faces) {
            if (groups.faceGroup.empty()) break;
            Index const group = groups.faceGroup[face];
            names.push_back(group < 0 ? "none" : groups.names[group]);
        }
        if (names.empty() || names[0] == names[1]) continue;
        return fmt::format(
            "; {} of them under faces of different {}, such as {}: bake these apart, "
            "by `groups` or with {{group}} in the output's name",
            count == report.overlaps ? "all" : std::to_string(count), kKinds[kind],
            fmt::join(names, " and "));
    }
    return {};
}

void WarnOfOverlaps(Model const& model, BakeReport const& report, Job& job) {
    double const share = static_cast<double>(report.overlaps) /
                         static_cast<double>(std::max<size_t>(1, report.texelsCovered));
    if (report.overlaps == 0) return;
    if (report.overlap.depth < kDeepEnough && share < kOftenEnough) return;
    auto const& [owner, other] = report.overlap.faces;
    job.Warn(fmt::format(
        "{}: {} of {} covered texels ({:.3g} %) lie under several faces, of which "
        "the lowest is baked: first {} and {}{}; `maps` overlap shows where",
        model.GetPath(), report.overlaps, report.texelsCovered, 100.0 * share,
        model.NameFace(owner), model.NameFace(other), NameOverlappingGroups(model, report)));
}

/// Once per map: what displacement along the normal leaves out.
void WarnOfLeftOutDisplacement(Model const& model, BakeReport const& report, Job& job) {
    std::map<std::string, TangentialPart> ofMap;
    for (BakeOutput const& output : report.outputs) ofMap[output.map].Add(output.leftOut);
    for (auto const& [map, part] : ofMap) {
        if (!(part.max > kMostLeftOut * part.longest)) continue;
        job.Warn(
            fmt::format("{}: {} holds the part of each displacement along the normal; what it "
                        "leaves out is up to {:.3g} long ({:.3g} rms), the longest "
                        "displacement {:.3g}: `isVector` bakes all of it",
                        model.GetPath(), map, part.max, part.GetRms(), part.longest));
    }
}

/// Says of the faces that are marked what they are, with their number and the first.
void WarnOfFaces(Model const& model, std::vector<char> const& isMarked, char const* what,
                 Job& job) {
    auto const first = std::ranges::find(isMarked, 1);
    if (first == isMarked.end()) return;
    job.Warn(fmt::format("{}: {} of {} faces {}, first {}", model.GetPath(),
                         std::ranges::count(isMarked, 1), isMarked.size(), what,
                         model.NameFace(static_cast<Index>(first - isMarked.begin()))));
}

}  // namespace

void WarnOfLostFaces(Model const& model, Job& job) {
    WarnOfFaces(model, model.GetFacesLackingUVs(), "have no texture coordinates and are not baked",
                job);
    WarnOfFaces(model, FindFlatFaces(model),
                "have no area in the texture, so that no texel shows what lies on them", job);
}

void WarnBeforeBake(Model const& model, BakeOptions const& options,
                    std::vector<FileLayout> const& files, Job& job) {
    if (options.group.empty()) WarnOfLostFaces(model, job);
    for (FileLayout const& file : files) {
        for (MapTraits const& map : file.maps) {
            if (map.isPlace) WarnOfRoundedPlaces(model, options, map, job);
        }
    }
}

void WarnAfterBake(Model const& model, BakeOptions const& options, BakeReport const& report,
                   std::vector<std::string> movedPlaces, Job& job) {
    if (report.outputs.empty()) {
        std::string const faces = options.groups.empty()
                                      ? "any face"
                                      : fmt::format("{}", fmt::join(options.groups, ", "));
        job.Warn(fmt::format(
            "{}: no texel is covered by {}{}", model.GetPath(), faces,
            options.tiles.empty() && options.groups.empty() ? "" : " in the tiles asked for"));
        return;
    }
    WarnOfOverlaps(model, report, job);
    WarnOfLeftOutDisplacement(model, report, job);
    if (!movedPlaces.empty()) {
        movedPlaces.resize(std::min<size_t>(movedPlaces.size(), 8));
        job.Warn(
            fmt::format("{}: {} samples lie within 2^-16 of an extraordinary vertex, where "
                        "curvature is taken at that distance: {}",
                        model.GetPath(), report.movedSamples, fmt::join(movedPlaces, ", ")));
    }
    if (report.newtonFailures) {
        job.Warn(
            fmt::format("{}: the texture map could not be inverted at {} texels, which stay empty",
                        model.GetPath(), report.newtonFailures));
    }
    if (report.clamped) {
        job.Warn(
            fmt::format("{}: {} values were beyond the range of half and were clamped; bake "
                        "without `halfMaps` to keep them",
                        model.GetPath(), report.clamped));
    }
}

}  // namespace limn::engine
