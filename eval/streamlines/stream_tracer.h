// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>

#include <Eigen/Core>

#include "eval/streamlines/flow_surface.h"

namespace limn::eval {

/// A point of a line: where it lies on the flow's faces and in space, and how far along the line.
struct StreamPoint {
    SurfacePlace place;
    Eigen::Vector3d position;
    double length = 0.0;
};

/// Why a line ends: at a boundary; where the field vanishes or turns at once; too near to another
/// line; as long as it may be; back at its start.
enum class StreamEnd { Boundary, Singular, Near, Length, Closed };
inline constexpr size_t kNumStreamEnds = 5;

/// Walks along a flow by the classical method of Runge and Kutta of order 4, by arc length, in the
/// domains of faces. A step that would leave its face ends on the edge, and the walk goes on in
/// the neighbour at the same place of it; at a vertex, in the face whose corner the field points
/// into. So every step lies in one polynomial piece and the order is that of the method.
///
/// Steps    are halved where the field turns by more than 60 degrees within one, and next to
///          irregular corners.
/// Threads  one per thread
/// Source   [Forms 12]
class StreamTracer {
public:
    /// \param flow        kept by view, it must outlive this
    /// \param step        in units of length
    /// \param leastSpeed  a field that is not faster counts as none
    StreamTracer(FlowSurface const& flow, double step, double leastSpeed);

    double GetStep() const { return _step; }
    StreamPoint MakeStart(SurfacePlace const& place);

    /// Visits the points after the start, one per step.
    ///
    /// \param visit    false ends the walk, before this point: Near
    /// \param longest  in units of length
    using Visit = std::function<bool(StreamPoint const& point)>;
    StreamEnd Walk(SurfacePlace const& start, Heading heading, double longest, Visit const& visit);

private:
    using Coordinates = std::array<double, 2>;
    struct Start {
        Eigen::Vector3d position;
        Velocity velocity;
    };
    struct Step {
        Coordinates end;
        Eigen::Vector3d move;  ///< in space, by the directions on the way
        double length;
    };
    enum class Turn { Onward, AlongEdge, Boundary, Singular };

    std::optional<Velocity> FindVelocityAt(Coordinates const& at);
    std::optional<Step> TryStep(Start const& start, double length);
    bool IsTrue(Start const& start, Step const& step);
    std::optional<Step> MakeStep(Start const& start, double longest, bool isAlongEdge);
    std::optional<Step> ShortenToEdge(Start const& start, Step const& leaving);

    Turn LeaveFace();
    bool CrossEdge(int side);
    Turn ChooseFace(Index vertex);
    std::optional<Coordinates> FindShares(int corner);
    void StartFromCorner(int corner, bool isRegular, Coordinates const& shares);

    FlowSurface const& _flow;
    FlowSurface::Sampler _sampler;
    double _step, _leastSpeed;
    Heading _heading = Heading::Forward;
    Index _face = -1;
    Coordinates _at{};
};

}  // namespace limn::eval
