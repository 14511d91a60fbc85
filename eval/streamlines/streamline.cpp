// SPDX-License-Identifier: Apache-2.0
#include "eval/streamlines/streamline.h"

#include <algorithm>
#include <optional>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "eval/streamlines/point_grid.h"

namespace limn::eval {

namespace {

/// One half of a line after the other, from a seed: what was walked, and when it has to end.
class LineWalk {
public:
    LineWalk(StreamTracer& tracer, SurfacePlace const& seed, Apartness const& apartness,
             std::function<void()> const& onSteps)
        : _tracer(tracer),
          _onSteps(onSteps),
          _apartness(apartness),
          _start(tracer.MakeStart(seed)),
          _ownPoints(apartness.separation > 0.0 ? apartness.separation : 1.0) {
        if (KeepsApart()) _ownPoints.Add(_start.position, 0.0);
    }

    StreamPoint const& GetStart() const { return _start; }

    struct Half {
        std::vector<StreamPoint> points;  ///< after the start
        StreamEnd end;
    };

    Half Run(Heading heading, double longest) {
        Half half{{}, StreamEnd::Singular};
        double const sign = heading == Heading::Backward ? -1.0 : 1.0;
        std::optional<size_t> firstNearStart;
        bool hasLeft = false, isClosed = false;
        half.end = _tracer.Walk(_start.place, heading, longest, [&](StreamPoint const& point) {
            if (_onSteps && half.points.size() % kStepsBetween == 0) _onSteps();
            isClosed = hasLeft && IsAtStart(half.points, point);
            if (isClosed) return false;
            hasLeft |= (point.position - _start.position).norm() > GetClosingDistance();
            if (KeepsApart() && !IsApart(half.points, point, sign, firstNearStart)) return false;
            half.points.push_back(point);
            if (KeepsApart()) _ownPoints.Add(point.position, sign * point.length);
            return true;
        });
        if (isClosed) {
            half.end = StreamEnd::Closed;
        } else if (firstNearStart) {
            half.points.resize(*firstNearStart);
            half.end = StreamEnd::Near;
        }
        return half;
    }

private:
    static constexpr size_t kLeastSteps = 4, kStepsBetween = 256;

    bool KeepsApart() const { return _apartness.separation > 0.0; }
    double GetClosingDistance() const { return 0.75 * _tracer.GetStep(); }

    bool IsAtStart(std::vector<StreamPoint> const& points, StreamPoint const& point) const {
        if (points.size() + 1 < kLeastSteps) return false;
        Eigen::Vector3d const onward = point.position - points.back().position,
                              first = points.front().position - _start.position;
        return (point.position - _start.position).norm() < GetClosingDistance() &&
               onward.dot(first) > 0.0;
    }

    /// Whether the line may have this point. Near to its own start it may, for so long as it takes
    /// to close; if it does not, it has ended where it came near.
    bool IsApart(std::vector<StreamPoint> const& points, StreamPoint const& point, double sign,
                 std::optional<size_t>& firstNearStart) const {
        if (_apartness.isNear && _apartness.isNear(point.position)) return false;
        double const own = 2.0 * _apartness.separation, at = sign * point.length;
        bool isNearStart = false;
        bool const isNearItself =
            _ownPoints.FindNear(point.position, [&](Eigen::Vector3d const& other, double length) {
                bool const isNear = std::abs(at - length) >= own &&
                                    (other - point.position).norm() < _apartness.nearest;
                isNearStart |= isNear && std::abs(length) < own;
                return isNear && std::abs(length) >= own;
            });
        if (isNearItself) return false;
        if (isNearStart && !firstNearStart) firstNearStart = points.size();
        if (!firstNearStart) return true;
        double const since =
            point.length - (*firstNearStart > 0 ? points[*firstNearStart - 1].length : 0.0);
        return since <= 2.0 * (_apartness.nearest + _tracer.GetStep());
    }

    StreamTracer& _tracer;
    std::function<void()> const& _onSteps;
    Apartness const& _apartness;
    StreamPoint _start;
    PointGrid<double> _ownPoints;  // with their lengths from the seed
};

}  // namespace

Streamline TraceStreamline(StreamTracer& tracer, SurfacePlace const& seed,
                           StreamlineOptions const& options, Apartness const& apartness) {
    LineWalk walk(tracer, seed, apartness, options.onSteps);
    double const longest = options.isForwardOnly ? options.maxLength : 0.5 * options.maxLength;
    auto const forward = walk.Run(Heading::Forward, longest);
    Streamline line;
    line.ends.push_back(forward.end);
    line.isClosed = forward.end == StreamEnd::Closed;
    if (!line.isClosed && !options.isForwardOnly) {
        auto const backward = walk.Run(Heading::Backward, longest);
        line.ends.push_back(backward.end);
        line.points.assign(backward.points.rbegin(), backward.points.rend());
        double const before = line.points.empty() ? 0.0 : line.points.front().length;
        for (StreamPoint& point : line.points) point.length = before - point.length;
        line.length = before;
    }
    double const before = line.length;
    line.points.push_back(walk.GetStart());
    line.points.back().length = before;
    for (StreamPoint const& point : forward.points) {
        line.points.push_back(point);
        line.points.back().length += before;
    }
    line.length = line.points.back().length;
    if (line.isClosed)
        line.length += (line.points.back().position - line.points.front().position).norm();
    return line;
}

std::vector<Streamline> TraceStreamlines(FlowSurface const& flow,
                                         std::span<SurfacePlace const> seeds,
                                         StreamlineOptions const& options,
                                         std::function<void()> const& onLine) {
    std::vector<Streamline> lines(seeds.size());
    tbb::enumerable_thread_specific<StreamTracer> tracers(
        [&] { return StreamTracer(flow, options.step, options.leastSpeed); });
    tbb::parallel_for(tbb::blocked_range<size_t>(0, seeds.size(), 16), [&](auto const& range) {
        StreamTracer& tracer = tracers.local();
        for (size_t i = range.begin(); i != range.end(); ++i) {
            lines[i] = TraceStreamline(tracer, seeds[i], options);
            if (onLine) onLine();
        }
    });
    return lines;
}

}  // namespace limn::eval
