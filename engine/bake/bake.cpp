// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/bake.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/bake/exr_sink.h"
#include "engine/bake/maps/map_table.h"
#include "engine/bake/strip_baker.h"
#include "engine/bake/tile_job.h"
#include "engine/scene/require_limit.h"
#include "engine/scene/udim.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

std::string NameSome(std::vector<Index> const& faces, Model const& model) {
    std::string text;
    for (size_t i = 0; i < std::min<size_t>(3, faces.size()); ++i) {
        text += (i ? ", " : "") + model.NameFace(faces[i]);
    }
    if (faces.size() > 3) text += fmt::format(" and {} more", faces.size() - 3);
    return text;
}

/// Adds the numbers of the tiles that bounds meet.
void AddTiles(UVBounds const& bounds, std::set<int>& tiles) {
    auto const low = [](float x, int count) {
        return static_cast<int>(std::floor(std::clamp(x, 0.0f, static_cast<float>(count - 1))));
    };
    for (int v = low(bounds.minV, kMaxUdimRows); v <= low(bounds.maxV, kMaxUdimRows); ++v) {
        for (int u = low(bounds.minU, 10); u <= low(bounds.maxU, 10); ++u) {
            tiles.insert(UdimTile{u, v}.GetNumber());
        }
    }
}

/// The tiles that the bounds of some baked face meet. Bounds are generous: a tile may turn out
/// empty.
std::vector<int> FindTiles(StripBaker& baker, Model const& model, BakeOptions const& options,
                           bool hasTiles, Job& job) {
    std::set<int> tiles;
    std::vector<Index> outOfRange, elsewhere;
    for (Index face = 0; face < static_cast<Index>(baker.GetBounds().size()); ++face) {
        if (!baker.GetIsBaked()[face]) continue;
        UVBounds const& b = baker.GetBounds()[face];
        if (baker.LeavesUdimRange(face)) outOfRange.push_back(face);
        if (b.minU > 0.9999f || b.minV > 0.9999f) elsewhere.push_back(face);
        AddTiles(b, tiles);
    }
    if (!outOfRange.empty()) {
        job.Warn(
            fmt::format("{}: the texture coordinates of {} leave the UDIM range (u 0 to 10, v "
                        "from 0); what lies outside is not baked",
                        model.GetPath(), NameSome(outOfRange, model)));
    }
    if (!hasTiles) {
        tiles = {UdimTile{}.GetNumber()};
        if (!elsewhere.empty()) {
            job.Warn(
                fmt::format("{}: {} lie in other tiles than 1001; put <UDIM> into the "
                            "output's name to bake them",
                            model.GetPath(), NameSome(elsewhere, model)));
        }
    }
    std::vector<int> wanted;
    for (int tile : tiles) {
        auto const& asked = options.tiles;
        bool const isWanted =
            asked.empty() || std::find(asked.begin(), asked.end(), tile) != asked.end();
        if (isWanted) wanted.push_back(tile);
    }
    return wanted;
}

/// What a person would want to know of a bake that is done.
void WarnOf(BakeReport const& report, std::vector<std::string> movedPlaces, Model const& model,
            Job& job) {
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
                        "without `isHalf` to keep them",
                        model.GetPath(), report.clamped));
    }
}

BakeReport BakeTo(BakeDestination& destination, std::string const& pattern, Model const& model,
                  BakeOptions const& options, Job& job) {
    RequireLimit(model);
    auto const maps = MakeMaps(options, model);
    BakeReport report;
    report.files = LayOutFiles(maps, pattern, options.hasCoverage);
    StripBaker baker(model, options, maps, job);
    std::vector<int> const tiles = FindTiles(baker, model, options, HasUdimToken(pattern), job);

    size_t const numStrips = static_cast<size_t>(CountStrips(options.height));
    job.Start(fmt::format("baking {}", model.GetName()), numStrips * tiles.size());
    for (int tile : tiles) {
        TileJob tileJob(tile, baker, report.files, options, destination, job);
        if (tileJob.HasWork()) tileJob.Run();
        tileJob.Finish(report);
    }
    job.Finish();

    std::vector<std::string> movedPlaces;
    baker.AddCounts(report, movedPlaces);
    if (report.outputs.empty()) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: no texel is covered in the tiles asked for; the texture "
                                "coordinates lie in others",
                                model.GetPath()));
    }
    WarnOf(report, std::move(movedPlaces), model, job);
    return report;
}

}  // namespace

BakeReport Bake(Model const& model, BakeOptions const& options, Job& job) {
    ExrDestination destination(model, options);
    return BakeTo(destination, options.pattern, model, options, job);
}

BakedImages BakeToMemory(Model const& model, BakeOptions const& options, Job& job) {
    MemoryDestination destination;
    BakedImages baked;
    std::string const pattern = options.pattern.empty() ? "{map}.<UDIM>" : options.pattern;
    baked.report = BakeTo(destination, pattern, model, options, job);
    baked.images = destination.TakeImages();
    return baked;
}

}  // namespace limn::engine
