// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/widths.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

namespace {

[[noreturn]] void RefuseWidth(std::string const& what, double sigma) {
    throw Error(ErrorCode::BadOption,
                fmt::format("{} is {}; a finite number from 0 up is needed", what, sigma));
}

}  // namespace

void CheckWidths(FilterWidths const& widths, Model const& model) {
    auto const* const constant = std::get_if<ConstantWidth>(&widths);
    if (constant && !IsWidth(constant->sigma)) RefuseWidth("the filter width", constant->sigma);
    auto const* const atVertices = std::get_if<VertexWidths>(&widths);
    if (!atVertices) return;
    auto const& sigmas = atVertices->sigmas;
    if (sigmas.size() != static_cast<size_t>(model.GetCage().numVertices)) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("{} filter widths; '{}' has {} vertices", sigmas.size(),
                                model.GetPath(), model.GetCage().numVertices));
    }
    auto const bad = std::find_if_not(sigmas.begin(), sigmas.end(), IsWidth);
    if (bad != sigmas.end())
        RefuseWidth(fmt::format("the filter width of vertex {}", bad - sigmas.begin()), *bad);
}

double ScaledWidths::GetLargest() const {
    struct Largest {
        double operator()(ConstantWidth const& width) const { return width.sigma; }
        double operator()(VertexWidths const& widths) const {
            return std::accumulate(widths.sigmas.begin(), widths.sigmas.end(), 0.0,
                                   [](double a, double b) { return std::max(a, b); });
        }
        double operator()(EdgeWidths const& widths) const { return widths.GetLargest(); }
        double operator()(PaintedWidths const& widths) const { return widths.GetLargest(); }
    };
    return _factor * std::visit(Largest{}, _widths);
}

double ScaledWidths::GetResolvedLength() const {
    // Widths near an edge reach three of them to both sides.
    if (std::holds_alternative<EdgeWidths>(_widths)) return 6.0 * GetLargest();
    if (std::holds_alternative<PaintedWidths>(_widths)) return GetLargest();
    return std::numeric_limits<double>::infinity();
}

std::optional<double> ScaledWidths::GetConstant() const {
    auto const* const constant = std::get_if<ConstantWidth>(&_widths);
    return constant ? std::optional(_factor * constant->sigma) : std::nullopt;
}

std::vector<double> ScaledWidths::GetStart(Model const& model) const {
    if (GetConstant()) return {};
    auto const* const atVertices = std::get_if<VertexWidths>(&_widths);
    if (!atVertices) return std::vector<double>(model.GetPositions().size() / 3, 0.0);
    std::vector<double> widths = atVertices->sigmas;
    for (double& width : widths) width *= _factor;
    return widths;
}

std::vector<double> ScaledWidths::SampleLevel(SmoothLevels& levels,
                                              std::vector<double> const& positions) const {
    std::vector<double> widths;
    if (auto const* const edges = std::get_if<EdgeWidths>(&_widths))
        widths = edges->Sample(levels, positions);
    else if (auto const* const painted = std::get_if<PaintedWidths>(&_widths))
        widths = painted->Sample(levels);
    for (double& width : widths) width *= _factor;
    return widths;
}

}  // namespace limn::engine
