// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/audit/audit.h"

#include <algorithm>

#include <fmt/format.h>

namespace limn::engine {

AuditInput::AuditInput(Scene const& bakedScene, Far::TopologyRefiner const& refiner,
                       BakeOptions const& bakeOptions, BakeReport const& bakeReport)
    : scene(bakedScene),
      level(refiner.GetLevel(0)),
      options(bakeOptions),
      bake(bakeReport),
      surface(refiner),
      uvSurface(refiner, 0),
      isBaked(scene.cage.faceSizes.size(), 1) {
    if (!options.groups.empty()) isBaked = SelectGroups(scene, options.groups);
    for (Index face = 0; face < surface.GetNumFaces(); ++face)
        isBaked[face] &= surface.HasLimit(face);
}

TileGrid AuditInput::MakeGrid(int tile) const {
    TileGrid grid;
    grid.width = options.width;
    grid.height = options.height;
    grid.tileU = (tile - 1001) % 10;
    grid.tileV = (tile - 1001) / 10;
    return grid;
}

AuditReport Audit(Scene const& scene, Far::TopologyRefiner const& refiner,
                  BakeOptions const& options, BakeReport const& bake, double bound, Job& job) {
    job.Start(fmt::format("auditing {}", scene.name), 2);
    AuditInput const input(scene, refiner, options, bake);
    AuditReport report;
    report.seams = AuditSeams(input);
    job.Advance();
    report.gaussBonnet = AuditGaussBonnet(input);
    report.isWithin = std::all_of(
        report.gaussBonnet.begin(), report.gaussBonnet.end(), [&](auto const& component) {
            return !component.wasAudited || component.relativeError <= bound;
        });
    job.Finish();
    return report;
}

}  // namespace limn::engine
