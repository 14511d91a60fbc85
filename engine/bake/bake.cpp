// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/bake.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/bake/bake_tiles.h"
#include "engine/bake/bake_warnings.h"
#include "engine/bake/exr_sink.h"
#include "engine/bake/maps/map_table.h"
#include "engine/bake/output_names.h"
#include "engine/bake/strip_baker.h"
#include "engine/bake/tile_job.h"
#include "engine/scene/require_limit.h"
#include "engine/scene/udim.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

void CheckPattern(std::string const& pattern, BakeOptions const& options) {
    CheckTokens(pattern);
    if (!HasGroupToken(pattern) || !options.group.empty()) return;
    throw Error(ErrorCode::BadOption,
                fmt::format("`pattern` '{}': a bake of one group after another is needed for "
                            "{{group}}, as SplitByGroup makes them",
                            pattern));
}

void CheckSide(char const* name, int texels) {
    if (texels >= 1 && texels <= kMaxImageSide) return;
    throw Error(ErrorCode::BadOption, fmt::format("`{}` is {}; 1 to {} texels are possible", name,
                                                  texels, kMaxImageSide));
}

BakeReport BakeAs(std::string const& pattern, BakeDestination& destination, Model const& model,
                  BakeOptions const& options, Job& job) {
    CheckSide("width", options.width);
    CheckSide("height", options.height);
    RequireLimit(model);
    CheckPattern(pattern, options);
    job.Start("preparing maps");
    auto const maps = MakeMaps(options, model);
    BakeReport report;
    report.files = LayOutFiles(maps, pattern, options.hasCoverage);
    job.Start("finding tiles");
    TexturedFaces const faces(model, options.groups, job);
    auto const tiles = FindBakedTiles(faces, model, options, HasUdimToken(pattern), job);
    for (int tile : tiles) {
        for (FileLayout const& file : report.files) destination.CheckPlace(file, tile);
    }
    WarnBeforeBake(model, options, report.files, job);
    StripBaker baker(model, faces, options, maps, job);

    size_t const numStrips = static_cast<size_t>(CountStrips(options.height));
    job.Start(fmt::format("baking {}", model.GetName()), numStrips * tiles.size());
    for (int tile : tiles) {
        TileJob tileJob(tile, baker, report.files, options, destination, job);
        if (tileJob.HasWork() || options.countsSkipped) tileJob.Run();
        tileJob.Finish(report);
    }
    job.Finish();

    std::vector<std::string> movedPlaces;
    baker.AddCounts(report, movedPlaces);
    for (auto const& map : maps) {
        for (int level : map->GetSingularLevels()) report.singularNoiseLevels.push_back(level);
    }
    if (report.outputs.empty() && !options.mayBeEmpty) {
        bool const isAnyBaked = std::ranges::find(faces.isBaked, 1) != faces.isBaked.end();
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: no texel is covered {}", model.GetPath(),
                                isAnyBaked ? "in the tiles asked for; the texture coordinates lie "
                                             "in others"
                                           : "by the faces asked for; they have no texture "
                                             "coordinates, or no limit"));
    }
    WarnAfterBake(model, options, report, std::move(movedPlaces), job);
    return report;
}

}  // namespace

BakeReport Bake(Model const& model, BakeOptions const& options, Job& job) {
    RequireExrEnding(options.pattern);
    ExrDestination destination(model, options, job);
    return BakeAs(options.pattern, destination, model, options, job);
}

BakeReport BakeTo(BakeDestination& destination, Model const& model, BakeOptions const& options,
                  Job& job) {
    return BakeAs(options.pattern.empty() ? "{map}.<UDIM>" : options.pattern, destination, model,
                  options, job);
}

BakedImages BakeToMemory(Model const& model, BakeOptions const& options, Job& job) {
    MemoryDestination destination;
    BakedImages baked;
    baked.report = BakeTo(destination, model, options, job);
    baked.images = destination.TakeImages();
    return baked;
}

}  // namespace limn::engine
