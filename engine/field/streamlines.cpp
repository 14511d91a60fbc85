// SPDX-License-Identifier: Apache-2.0
#include "engine/field/streamlines.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "engine/scene/extent.h"
#include "engine/scene/require_limit.h"
#include "eval/streamlines/even_streamlines.h"
#include "eval/surface/vertex_limits.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

namespace {

constexpr double kMostSteps = 0x1p27;  // of a line

void RequirePositive(char const* member, std::optional<double> const& value) {
    if (!value || *value > 0.0) return;
    throw Error(ErrorCode::BadOption,
                fmt::format("`{}` is {:g}; it has to be more than 0", member, *value));
}

void Check(StreamlineOptions const& options) {
    if (!options.separation && !options.seeds)
        throw Error(ErrorCode::BadOption, "streamlines need `separation` or `seeds`");
    RequirePositive("separation", options.separation);
    RequirePositive("step", options.step);
    RequirePositive("maxLength", options.maxLength);
    if (!(options.stopDistance > 0.0 && options.stopDistance <= 1.0)) {
        throw Error(ErrorCode::BadOption, fmt::format("`stopDistance` is {:g}; it has to be more "
                                                      "than 0 and at most 1",
                                                      options.stopDistance));
    }
    if (options.separation && options.step && *options.step > 0.25 * *options.separation) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("`step` is {:g}; lines that are kept `separation` {:g} apart need "
                                "a quarter of that or less",
                                *options.step, *options.separation));
    }
}

double FindMeanEdge(Model const& model) {
    eval::LimitSurface const surface(model.GetRefiner());
    auto const limits = eval::EvaluateVertexLimits(surface, model.GetPositions(), 3);
    far_ext::Points const points(limits.values);
    double sum = 0.0;
    size_t count = 0;
    for (Index edge = 0; edge < model.GetLevel().GetNumEdges(); ++edge) {
        auto const ends = model.GetLevel().GetEdgeVertices(edge);
        if (!limits.hasLimit[ends[0]] || !limits.hasLimit[ends[1]]) continue;
        sum += (points[ends[1]] - points[ends[0]]).norm();
        ++count;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

/// Of the integration.
eval::StreamlineOptions MakeLineOptions(Model const& model, eval::FlowSurface const& flow,
                                        StreamlineOptions const& options, Job& job) {
    constexpr double kNoSpeed = 1e-6;  // of the root mean square
    constexpr double kDiagonals = 10.0;
    eval::StreamlineOptions line;
    if (options.step) {
        line.step = *options.step;
    } else {
        line.step = 0.25 * FindMeanEdge(model);
        if (options.separation) line.step = std::min(line.step, *options.separation / 8.0);
    }
    double const diagonal = FindExtent(model.GetPositions()).GetDiagonal();
    // All lines would be too short, each traced before that is known.
    if (options.separation && !options.seeds && *options.separation > diagonal) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("`separation` is {:g}; no two lines are that far apart on a mesh "
                                "whose box has a diagonal of {:g}",
                                *options.separation, diagonal));
    }
    if (options.maxLength)
        line.maxLength = *options.maxLength;
    else if (!options.separation)
        line.maxLength = kDiagonals * diagonal;
    double const longest = options.maxLength.value_or(kDiagonals * diagonal);
    if (!(longest / line.step < kMostSteps)) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("`step` is {:g}; a line of length {:g} would have more than 2^27 "
                                "of them",
                                line.step, longest));
    }
    line.isForwardOnly = options.isForwardOnly;
    line.leastSpeed = kNoSpeed * flow.FindRmsSpeed();
    line.onSteps = [&job] { job.CheckStopped(); };
    return line;
}

std::vector<eval::SurfacePlace> FindSeeds(Model const& model, eval::FlowSurface const& flow,
                                          PlaceArrays const& seeds) {
    auto places = LocatePlaces(model, seeds);
    eval::LimitSurface const surface(model.GetRefiner());
    for (size_t i = 0; i < places.size(); ++i) {
        if (!surface.HasLimit(places[i].face))
            throw PlaceError(i, fmt::format("face {} has no limit surface", places[i].face));
        places[i] = flow.FindPlace(places[i]);
    }
    return places;
}

}  // namespace

size_t Streamlines::CountClosed() const {
    return static_cast<size_t>(
        std::ranges::count_if(lines, [](eval::Streamline const& line) { return line.isClosed; }));
}

size_t Streamlines::CountPoints() const {
    size_t count = 0;
    for (auto const& line : lines) count += line.points.size();
    return count;
}

double Streamlines::FindTotalLength() const {
    double sum = 0.0;
    for (auto const& line : lines) sum += line.length;
    return sum;
}

std::array<size_t, eval::kNumStreamEnds> Streamlines::CountEnds() const {
    std::array<size_t, eval::kNumStreamEnds> counts{};
    for (auto const& line : lines) {
        for (eval::StreamEnd const end : line.ends) ++counts[static_cast<size_t>(end)];
    }
    return counts;
}

std::vector<std::vector<Eigen::Vector3d>> Streamlines::ListPoints() const {
    std::vector<std::vector<Eigen::Vector3d>> list;
    for (auto const& line : lines) {
        auto& points = list.emplace_back();
        for (auto const& point : line.points) points.push_back(point.position);
        if (line.isClosed) points.push_back(points.front());
    }
    return list;
}

Streamlines TraceStreamlines(Model const& model, std::span<double const> form,
                             StreamlineOptions const& options, Job& job) {
    Check(options);
    RequireLimit(model);
    job.Start("preparing streamlines");
    auto const start = std::chrono::steady_clock::now();
    eval::FlowSurface const flow(model.GetCage(), model.GetPositions(), form, options.evaluator);
    auto const line = MakeLineOptions(model, flow, options, job);
    std::vector<eval::SurfacePlace> seeds;
    if (options.seeds) seeds = FindSeeds(model, flow, *options.seeds);

    Streamlines result;
    if (options.separation) {
        job.Start("tracing streamlines");
        eval::EvenOptions const even{line, *options.separation, options.stopDistance};
        auto found = options.seeds ? TraceApart(flow, seeds, even) : FillEvenly(flow, even);
        result.lines = std::move(found.lines);
        result.farthest = found.farthest;
    } else {
        job.Start("tracing streamlines", seeds.size());
        result.lines = eval::TraceStreamlines(flow, seeds, line, [&job] { job.Advance(); });
        job.Finish();
    }
    for (auto& traced : result.lines) {
        for (auto& point : traced.points) point.place = flow.FindOnCage(point.place);
    }
    if (result.lines.empty()) {
        job.Warn(model.GetPath() +
                 ": there are no streamlines: the field vanishes, or the lines would be shorter "
                 "than the distance between them");
    }
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

std::string FormatLineElements(Streamlines const& streamlines, Precision precision) {
    int const digits = precision == Precision::Double ? 17 : 9;
    std::string text;
    auto const out = std::back_inserter(text);
    for (auto const& line : streamlines.lines) {
        for (auto const& point : line.points)
            fmt::format_to(out, "v {:.{}g} {:.{}g} {:.{}g}\n", point.position.x(), digits,
                           point.position.y(), digits, point.position.z(), digits);
    }
    size_t next = 1;
    for (auto const& line : streamlines.lines) {
        size_t const first = next;
        if (line.points.size() > 1) {
            text += 'l';
            for (size_t i = 0; i < line.points.size(); ++i) fmt::format_to(out, " {}", first + i);
            if (line.isClosed) fmt::format_to(out, " {}", first);
            text += '\n';
        }
        next += line.points.size();
    }
    return text;
}

std::string FormatLineTable(Model const& model, Streamlines const& streamlines,
                            Precision precision) {
    int const digits = precision == Precision::Double ? 17 : 9;
    std::string text = "line,face,s,t,x,y,z,length\n";
    auto const append = [&](size_t number, eval::StreamPoint const& point, double length) {
        auto const [s, t] = FindCoordinates(model, point.place);
        auto const& p = point.position;
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{:.{}g},{:.{}g},{:.{}g},{:.{}g}\n",
                       number, point.place.face, s, t, p.x(), digits, p.y(), digits, p.z(), digits,
                       length, digits);
    };
    for (size_t number = 0; number < streamlines.lines.size(); ++number) {
        auto const& line = streamlines.lines[number];
        for (auto const& point : line.points) append(number, point, point.length);
        if (line.isClosed) append(number, line.points.front(), line.length);
    }
    return text;
}

}  // namespace limn::engine
