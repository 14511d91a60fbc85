// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/critical_factor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/smooth/cascade_space.h"
#include "engine/smooth/smooth_checks.h"
#include "eval/cascade/critical_width.h"

namespace limn::engine {

namespace {

int CountGridLevels(Model const& model, SmoothRefinement refinement) {
    bool const isBisection = refinement == SmoothRefinement::Bisect;
    double const growth = isBisection ? 2.0 : 4.0;
    int levels = isBisection ? 6 : 3;
    while (levels > 1 &&
           model.GetLevel().GetNumVertices() * std::pow(growth, levels) > kMaxCriticalVertices)
        --levels;
    return levels;
}

/// The smallest mean radius of a closed component; 0 without any.
double FindSmallestRadius(Model const& model) {
    SmoothComponents const components(model.GetLevel());
    auto const radii =
        eval::FindMeanRadii(model.GetPositions(), components.ofVertex, components.count);
    double smallest = 0.0;
    for (size_t component = 0; component < radii.size(); ++component) {
        if (!components.isClosed[component] || !(radii[component] > 0.0)) continue;
        if (smallest == 0.0 || radii[component] < smallest) smallest = radii[component];
    }
    return smallest;
}

}  // namespace

double MeasureCriticalFactor(Model const& model, ScaledWidths const& widths,
                             SmoothOptions const& options, Job& job) {
    int const numLevels = options.levels > 0 ? CountGridLevels(model, options.refinement) : 0;
    SmoothLevels levels(model, numLevels, options.refinement, options.keepsCreases);
    SmoothComponents const components(model.GetLevel());
    std::vector<int> ofVertex = components.ofVertex;
    std::vector<double> start = model.GetPositions();
    std::vector<far_ext::CascadeLevel> rows;
    double const unit = FindUnit(start);
    eval::CascadeWidths scaled;
    if (auto const constant = widths.GetConstant())
        scaled.constant = *constant / unit;
    else
        scaled.atVertices = Times(1.0 / unit, widths.GetStart(model));
    for (int level = std::min(1, numLevels); level <= numLevels; ++level) {
        far_ext::CascadeMesh const& mesh = level == 0 ? levels.MakeUnrefined() : levels.MakeNext();
        rows.push_back(far_ext::BuildCascadeLevel(
            mesh, rows.empty() ? std::vector<Index>{} : rows.back().vertices, options.boundary));
        ofVertex = Inherit(mesh, ofVertex);
        start = Interpolate(mesh, start);
        auto given = widths.SampleLevel(levels, start);
        if (!given.empty()) scaled.atLevels.push_back(Times(1.0 / unit, std::move(given)));
    }
    auto const origin = FindFloatOrigin(FindExtent(model.GetPositions()));
    return eval::FindCriticalFactor(
        rows, ToCascade(model.GetPositions(), origin, unit), scaled, ofVertex, components.isClosed,
        {.order = options.order, .features = ScaleFeatures(model, options, unit)},
        [&] { job.CheckStopped(); });
}

std::optional<double> MeasureCriticalWidth(Model const& model, Job& job) {
    RefuseDefects(model, job);
    // A sphere carries half of its radius, and whatever has an area collapses at a few times that.
    constexpr int kMostDoublings = 8;
    double width = FindSmallestRadius(model);
    for (int doubling = 0; width > 0.0 && doubling < kMostDoublings; ++doubling, width *= 2.0) {
        FilterWidths const widths = ConstantWidth{width};
        double const factor = MeasureCriticalFactor(model, ScaledWidths(widths, 1.0), {}, job);
        if (factor < 1.0) return factor * width;
    }
    return std::nullopt;
}

}  // namespace limn::engine
