// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/alpha_steps.h"

#include "eval/parallel/rows.h"

namespace limn::eval {

namespace {

/// Whether the rule of a level's vertices has an alpha.
///
/// \param parents  the same of the level before
std::vector<char> FindSmooth(LimitOperator const& A, std::vector<char> const& parents) {
    std::vector<char> isSmooth(static_cast<size_t>(A.GetNumVertices()));
    for (Index vertex = 0; vertex < A.GetNumVertices(); ++vertex)
        isSmooth[vertex] = A.GetClass(vertex).kind == far_ext::LimitRow::Kind::Smooth;
    for (size_t vertex = 0; vertex < parents.size(); ++vertex)
        isSmooth[vertex] = isSmooth[vertex] && parents[vertex];
    return isSmooth;
}

}  // namespace

AlphaSteps::AlphaSteps(Far::TopologyRefiner const& refiner, int lastLevel, double alpha)
    : _refiner(refiner), _alpha(alpha) {
    for (int level = 0; level <= lastLevel; ++level) {
        LimitOperator rows = LimitOperator::Build(refiner, level, {.alpha = alpha});
        auto takesAlpha =
            FindSmooth(rows, level > 0 ? _levels.back().takesAlpha : std::vector<char>());
        _levels.push_back({std::move(rows), std::move(takesAlpha)});
    }
}

void AlphaSteps::Add(int level, std::span<double const> values, int length,
                     std::span<double> children) const {
    auto const& [rows, takesAlpha] = _levels[level];
    size_t const stride = length;
    eval::ForEachRow(rows.GetNumVertices(), [&, &A = rows, &takes = takesAlpha](Index vertex) {
        if (!takes[vertex]) return;
        double const n = A.GetClass(vertex).numEdges;
        auto const edges = A.GetNeighbours(vertex).first(A.GetClass(vertex).numEdges);
        for (size_t k = 0; k < stride; ++k) {
            double sum = 0.0;
            for (Index neighbour : edges) sum += values[neighbour * stride + k];
            double& child = children[vertex * stride + k];
            child += _alpha / n * (values[vertex * stride + k] - sum / n);
        }
    });
}

std::vector<double> AlphaSteps::FindLimits(std::span<double const> values, int length) const {
    int const last = static_cast<int>(_levels.size()) - 1;
    auto const& takesAlpha = _levels.back().takesAlpha;
    using Rule = far_ext::LimitOptions::AlphaRule;
    std::vector<double> limits(values.size()), plain(values.size());
    LimitOperator::Build(_refiner, last, {.alpha = _alpha, .alphaRule = Rule::Stationary})
        .Apply(values, length, limits);
    LimitOperator::Build(_refiner, last).Apply(values, length, plain);
    size_t const stride = length;
    for (size_t i = 0; i < limits.size(); ++i) {
        if (!takesAlpha[i / stride]) limits[i] = plain[i];
    }
    return limits;
}

}  // namespace limn::eval
