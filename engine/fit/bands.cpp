// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/bands.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "eval/fit/decompose.h"
#include "far_ext/error.h"
#include "far_ext/option_checks.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

MeshExtent MeasureExtent(Model const& model, std::span<double const> positions) {
    auto const& level = model.GetLevel();
    far_ext::CheckPoints(positions, level.GetNumVertices());
    MeshExtent extent{FindExtent(positions), {}};
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        if (level.IsEdgeBoundary(edge) || level.IsEdgeNonManifold(edge)) return extent;
    }
    // Tetrahedra from a point near by, which keeps the digits of a mesh far from the origin.
    far_ext::Points const points(positions);
    Eigen::Vector3d const low(extent.low.data());
    double sixfold = 0.0;
    size_t corner = 0;
    for (int size : model.GetCage().faceSizes) {
        auto const at = [&](size_t i) -> Eigen::Vector3d {
            return points[model.GetCage().faceVertices[corner + i]] - low;
        };
        for (int i = 1; i + 1 < size; ++i) sixfold += at(0).dot(at(i).cross(at(i + 1)));
        corner += size;
    }
    extent.volume = sixfold / 6.0;
    return extent;
}

Bands SplitIntoBands(Model const& model, int count, far_ext::LimitOptions const& rule, Job& job,
                     eval::TableEvaluator* evaluator) {
    RequireRange("count", count, 0, kMaxBands);
    job.Start("building the limit matrix");
    auto const A = eval::LimitApplication::Build(model.GetRefiner(), rule, evaluator);
    std::vector<std::vector<double>> bands;
    job.Start("filtering");
    std::vector<double> rest = model.GetPositions();
    eval::ApplyHighPass(A, 3, count, rest, [&](int i, std::span<double const> part) {
        job.CheckStopped();
        // Band i is (E-A)^i A M = (E-A)^i M - (E-A)^(i+1) M.
        if (i > 0) {
            for (size_t k = 0; k < part.size(); ++k) bands.back()[k] -= part[k];
        }
        bands.emplace_back(part.begin(), part.end());
    });
    std::vector<double> remainder = std::move(bands.back());
    bands.pop_back();
    return {std::move(bands), std::move(remainder)};
}

std::vector<double> Denoise(Model const& model, DenoiseOptions const& options, Job& job) {
    RequireRange("detail", options.detail, 0, kMaxBands);
    RequireAtLeast("steps", options.steps, 0);
    job.Start("building the limit matrix");
    auto const A =
        eval::LimitApplication::Build(model.GetRefiner(), options.rule, options.evaluator);
    job.Start("filtering");
    std::vector<double> positions = model.GetPositions();
    for (int step = 0; step < options.steps; ++step) {
        job.CheckStopped();
        eval::Denoise(A, 3, options.detail, 1, positions);
    }
    return positions;
}

std::vector<double> Sharpen(Model const& model, SharpenOptions const& options, Job& job) {
    if (options.first < 1 || options.first > options.last) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("bands {} to {} are none; they begin at 1, and are given in order",
                                options.first, options.last));
    }
    RequireRange("last", options.last, 1, kMaxBands);
    RequireAtLeast("steps", options.steps, 0);
    job.Start("building the limit matrix");
    auto const A =
        eval::LimitApplication::Build(model.GetRefiner(), options.rule, options.evaluator);
    job.Start("filtering");
    std::vector<double> positions = model.GetPositions();
    Extent const before = FindExtent(positions);
    int firstGrown = 0;
    for (int step = 1; step <= options.steps; ++step) {
        job.CheckStopped();
        eval::Sharpen(A, 3, options.first, options.last, 1, positions);
        if (!std::ranges::all_of(positions, [](double x) { return std::isfinite(x); })) {
            throw Error(ErrorCode::TooLarge,
                        fmt::format("{}: `steps` {}: after {} of them coordinates are beyond the "
                                    "range of double",
                                    model.GetPath(), options.steps, step));
        }
        if (firstGrown == 0 && FindGrowth(before, FindExtent(positions)) > kMostGrown)
            firstGrown = step;
    }
    if (firstGrown > 0) {
        job.Warn(fmt::format(
            "{}: after {} of {} steps the mesh reaches more than {} times as far as at the start, "
            "at the "
            "end {:.3g} times; each step multiplies the highest frequencies by up to {}: fewer "
            "`steps`, or a smaller `last`",
            model.GetPath(), firstGrown, options.steps, kMostGrown,
            FindGrowth(before, FindExtent(positions)), 2 + options.last - options.first));
    }
    return positions;
}

}  // namespace limn::engine
