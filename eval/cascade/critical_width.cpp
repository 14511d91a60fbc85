// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/critical_width.h"

#include <algorithm>
#include <cmath>

namespace limn::eval {

namespace {

constexpr int kMaxIterations = 1000;  // of conjugate gradients
constexpr double kTolerance = 1e-7;

std::vector<double> Scale(std::vector<double> values, double factor) {
    for (double& value : values) value *= factor;
    return values;
}

}  // namespace

std::vector<double> FindMeanRadii(std::span<double const> positions,
                                  std::span<int const> componentOfVertex, int numComponents) {
    size_t const count = numComponents;
    std::vector<std::array<double, 3>> means(count, {0.0, 0.0, 0.0});
    std::vector<double> numVertices(count, 0.0), radii(count, 0.0);
    for (size_t vertex = 0; vertex < componentOfVertex.size(); ++vertex) {
        if (componentOfVertex[vertex] < 0) continue;
        size_t const component = componentOfVertex[vertex];
        numVertices[component] += 1.0;
        for (size_t c = 0; c < 3; ++c) means[component][c] += positions[3 * vertex + c];
    }
    for (size_t component = 0; component < count; ++component) {
        for (double& value : means[component]) value /= std::max(1.0, numVertices[component]);
    }
    for (size_t vertex = 0; vertex < componentOfVertex.size(); ++vertex) {
        if (componentOfVertex[vertex] < 0) continue;
        size_t const component = componentOfVertex[vertex];
        auto const& mean = means[component];
        radii[component] +=
            std::hypot(positions[3 * vertex] - mean[0], positions[3 * vertex + 1] - mean[1],
                       positions[3 * vertex + 2] - mean[2]) /
            numVertices[component];
    }
    return radii;
}

double FindCriticalFactor(std::span<far_ext::CascadeLevel const> levels,
                          std::span<double const> positions, CascadeWidths const& widths,
                          std::span<int const> componentOfVertex, std::span<char const> isWanted,
                          CascadeOptions const& filter, std::function<void()> const& check) {
    int const numComponents = static_cast<int>(isWanted.size());
    auto const carries = [&](double factor) {
        CascadeOptions const options{
            .tolerance = kTolerance,
            .width = widths.constant < 0.0 ? -1.0 : factor * widths.constant,
            .order = filter.order,
            .features = filter.features};
        Cascade<double> cascade(
            positions,
            widths.constant < 0.0 ? Scale(widths.atVertices, factor) : std::vector<double>{},
            options);
        for (size_t level = 0; level < levels.size(); ++level) {
            check();
            cascade.Step(levels[level], kMaxIterations,
                         widths.atLevels.empty() ? std::vector<double>{}
                                                 : Scale(widths.atLevels[level], factor));
        }
        auto const start =
            FindMeanRadii(cascade.GetStartPositions(), componentOfVertex, numComponents);
        constexpr int kMaxRepeats = 300;
        constexpr double kSettled = 1e-5;  // nothing moves by more in a step
        std::vector<double> radii =
            FindMeanRadii(cascade.GetPositions(), componentOfVertex, numComponents);
        for (int repeat = 0; repeat < kMaxRepeats; ++repeat) {
            check();
            cascade.Repeat(kMaxIterations);
            auto const next =
                FindMeanRadii(cascade.GetPositions(), componentOfVertex, numComponents);
            double largestChange = 0.0;
            for (size_t component = 0; component < isWanted.size(); ++component) {
                if (!isWanted[component] || !(start[component] > 0.0)) continue;
                if (next[component] < kLeastRadiusRatio * start[component]) return false;
                largestChange = std::max(
                    largestChange, std::abs(next[component] - radii[component]) / start[component]);
            }
            if (largestChange < kSettled) return true;
            radii = next;
        }
        return true;
    };
    if (carries(1.0)) return 1.0;
    double carried = 0.0, collapsed = 1.0;
    while (collapsed - carried > 0.005 * collapsed) {
        double const middle = carried == 0.0 ? collapsed / 2 : (carried + collapsed) / 2;
        (carries(middle) ? carried : collapsed) = middle;
        if (collapsed < 1e-9) break;  // nothing is carried
    }
    return carried;
}

}  // namespace limn::eval
