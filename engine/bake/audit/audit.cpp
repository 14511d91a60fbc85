// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/audit/audit.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

AuditInput::AuditInput(Model const& bakedModel, BakeOptions const& bakeOptions,
                       BakeReport const& bakeReport, Job const& auditJob)
    : model(bakedModel),
      level(model.GetLevel()),
      options(bakeOptions),
      bake(bakeReport),
      job(auditJob),
      surface(model.GetLimitSurface()),
      faces(model, options.groups, job) {}

TileGrid AuditInput::MakeGrid(int tile) const {
    return TileGrid::OfTile(tile, options.width, options.height);
}

TileGrid AuditInput::MakeSampleGrid(int tile) const {
    return TileGrid::OfTile(tile, options.width * options.samplesPerSide,
                            options.height * options.samplesPerSide);
}

namespace {

void JudgeSeams(AuditBounds const& bounds, std::vector<SeamAudit>& seams) {
    for (SeamAudit& seam : seams) {
        auto const own = bounds.seamOfMap.find(seam.map);
        seam.bound = own != bounds.seamOfMap.end() ? own->second : bounds.seam;
        seam.isWithin = !seam.bound || seam.max <= *seam.bound;
    }
}

/// Every bound that is missed, with its cure.
std::vector<std::string> DescribeMisses(AuditReport const& report, AuditInput const& input,
                                        double gaussBonnetBound) {
    constexpr char const* kCure = "more texels come nearer, by `width` or `samplesPerSide`";
    std::vector<std::string> misses;
    for (GaussBonnetAudit const& audit : report.gaussBonnet) {
        if (audit.isWithin) continue;
        misses.push_back(fmt::format(
            "{}: component {}: the integral of Gaussian curvature is {:.6g}, and {:.6g} is "
            "expected: a relative error of {:.3g}, the bound is {:g}; the texels farthest off, by "
            "{:.2g}, are those of {}; {}",
            input.model.GetPath(), audit.component, audit.integral, audit.expected,
            audit.relativeError, gaussBonnetBound, audit.worstFaceError,
            input.model.NameFace(audit.worstFace), kCure));
    }
    for (SeamAudit const& seam : report.seams) {
        if (seam.isWithin) continue;
        misses.push_back(fmt::format(
            "{}: map {}: along a seam its sides differ by up to {:.4g}, the bound is {:g}: {}; {}",
            input.model.GetPath(), seam.map, seam.max, *seam.bound, seam.place, kCure));
    }
    return misses;
}

/// "it is not closed (2 components)", each reason once.
std::string ListReasons(std::vector<GaussBonnetAudit> const& audits) {
    std::vector<std::pair<std::string, int>> reasons;
    for (GaussBonnetAudit const& audit : audits) {
        auto found = std::ranges::find(reasons, audit.reason, &std::pair<std::string, int>::first);
        if (found == reasons.end()) found = reasons.insert(found, {audit.reason, 0});
        ++found->second;
    }
    std::string text;
    for (auto const& [reason, count] : reasons) {
        text += fmt::format("{}{} ({} component{})", text.empty() ? "" : "; ", reason, count,
                            count == 1 ? "" : "s");
    }
    return text;
}

/// Says so where nothing was compared with a bound, and where a bound was given for nothing.
void WarnOfNothing(AuditReport const& report, AuditInput const& input, Job& job) {
    bool const wasIntegralJudged =
        std::ranges::any_of(report.gaussBonnet, &GaussBonnetAudit::wasAudited);
    bool hasSeam = false, wasSeamJudged = false;
    for (SeamAudit const& seam : report.seams) {
        hasSeam |= seam.samples > 0;
        wasSeamJudged |= seam.samples > 0 && seam.bound;
        if (seam.samples > 0 || !seam.bound) continue;
        job.Warn(
            fmt::format("{}: there is no seam to compare map {} along: its bound has judged "
                        "nothing",
                        input.model.GetPath(), seam.map));
    }
    if (wasIntegralJudged || wasSeamJudged) return;
    job.Warn(fmt::format("{}: the audit has judged nothing. Gauss-Bonnet: {}. Seams: {}",
                         input.model.GetPath(), ListReasons(report.gaussBonnet),
                         hasSeam                ? "reported, but not judged without `seam`"
                         : report.seams.empty() ? "none of the maps can be compared along them"
                                                : "there are none"));
}

/// \throws Error BadOption: nothing is within it
void RequireBound(char const* member, double bound) {
    if (bound >= 0.0) return;
    throw Error(ErrorCode::BadOption,
                fmt::format("`{}` is {:g}; a bound of 0 or more is needed", member, bound));
}

}  // namespace

void CheckBounds(AuditBounds const& bounds, std::vector<std::string> const& maps) {
    RequireBound("gaussBonnet", bounds.gaussBonnet);
    if (bounds.seam) RequireBound("seam", *bounds.seam);
    for (auto const& [map, bound] : bounds.seamOfMap) {
        RequireBound("seam", bound);
        if (std::ranges::find(maps, map) != maps.end()) continue;
        throw Error(ErrorCode::BadOption,
                    fmt::format("`seam` {0}={1:g}: the map '{0}' is not baked", map, bound));
    }
}

AuditReport Audit(Model const& model, BakeOptions const& options, BakeReport const& bake,
                  AuditBounds const& bounds, Job& job) {
    CheckBounds(bounds, options.maps);
    job.Start(fmt::format("auditing {}", model.GetName()), 2);
    AuditInput const input(model, options, bake, job);
    AuditReport report;
    report.seams = AuditSeams(input);
    JudgeSeams(bounds, report.seams);
    job.Advance();
    report.gaussBonnet = AuditGaussBonnet(input, bounds.gaussBonnet);
    report.misses = DescribeMisses(report, input, bounds.gaussBonnet);
    job.Finish();
    WarnOfNothing(report, input, job);
    return report;
}

}  // namespace limn::engine
