// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/audit/audit.h"

#include <algorithm>

#include <fmt/format.h>

namespace limn::engine {

AuditInput::AuditInput(Model const& bakedModel, BakeOptions const& bakeOptions,
                       BakeReport const& bakeReport, Job const& auditJob)
    : model(bakedModel),
      level(model.GetLevel()),
      options(bakeOptions),
      bake(bakeReport),
      job(auditJob),
      surface(model.GetRefiner()),
      uvSurface(model.GetRefiner(), 0),
      isBaked(model.GetCage().faceSizes.size(), 1) {
    if (!options.groups.empty()) isBaked = model.SelectGroups(options.groups);
    for (Index face = 0; face < surface.GetNumFaces(); ++face)
        isBaked[face] &= surface.HasLimit(face);
}

TileGrid AuditInput::MakeGrid(int tile) const {
    return TileGrid::OfTile(tile, options.width, options.height);
}

AuditReport Audit(Model const& model, BakeOptions const& options, BakeReport const& bake,
                  double bound, Job& job) {
    job.Start(fmt::format("auditing {}", model.GetName()), 2);
    AuditInput const input(model, options, bake, job);
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
