// SPDX-License-Identifier: Apache-2.0
#include "eval/streamlines/stream_tracer.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "eval/streamlines/face_sides.h"
#include "far_ext/forms/form_operators.h"

namespace limn::eval {

namespace {

constexpr double kOnEdge = 1e-10;  // of a domain: nearer is on it
constexpr double kAtCorner = 1e-9;
constexpr double kInside = 1e-12;  // of unit speed: slower outwards is along the edge
/// Steps of Runge and Kutta stay near the polynomials' own domain.
constexpr double kFarthestStep = 0.75;
constexpr double kLeastCosine = 0.5;  // of the directions within a step
constexpr double kMostOff = 0.01;     // of a step, at its end
constexpr int kMostHalvings = 10;     // of a step
constexpr double kNoStep = 1e-6;      // of the whole one: leads nowhere

/// From an irregular corner lines start this far inside, since there (s,t) have no derivatives.
constexpr double kFromCorner = 0x1p-12;

bool IsRegular(Far::TopologyLevel const& level, Index vertex, bool isLoop) {
    return level.GetVertexFaces(vertex).size() == (isLoop ? 6 : 4) &&
           far_ext::IsSmoothInterior(level, vertex);
}

}  // namespace

StreamTracer::StreamTracer(FlowSurface const& flow, double step, double leastSpeed)
    : _flow(flow), _sampler(flow), _step(step), _leastSpeed(leastSpeed) {}

StreamPoint StreamTracer::MakeStart(SurfacePlace const& place) {
    _sampler.Bind(place.face);
    return {place, _sampler.Evaluate(place.s, place.t).position, 0.0};
}

std::optional<Velocity> StreamTracer::FindVelocityAt(Coordinates const& at) {
    return FindVelocity(_sampler.Evaluate(at[0], at[1]), _heading, _leastSpeed);
}

/// Where a step of this length ends; none if the field vanishes on the way or turns too much.
std::optional<StreamTracer::Step> StreamTracer::TryStep(Start const& start, double length) {
    Coordinates sum{start.velocity.s, start.velocity.t};
    Step step{{}, start.velocity.direction, length};
    Velocity last = start.velocity;
    constexpr double kParts[3] = {0.5, 0.5, 1.0}, kWeights[3] = {2.0, 2.0, 1.0};
    for (int stage = 0; stage < 3; ++stage) {
        double const part = kParts[stage] * length;
        auto const velocity = FindVelocityAt({_at[0] + part * last.s, _at[1] + part * last.t});
        if (!velocity || velocity->direction.dot(start.velocity.direction) < kLeastCosine)
            return {};
        last = *velocity;
        sum[0] += kWeights[stage] * last.s;
        sum[1] += kWeights[stage] * last.t;
        step.move += kWeights[stage] * last.direction;
    }
    step.end = {_at[0] + length / 6.0 * sum[0], _at[1] + length / 6.0 * sum[1]};
    step.move *= length / 6.0;
    return step;
}

/// Whether a step has led, by the domain, where the directions in space have led: next to an
/// irregular corner, where tangents change by factors, only short steps do.
bool StreamTracer::IsTrue(Start const& start, Step const& step) {
    Eigen::Vector3d const end = _sampler.Evaluate(step.end[0], step.end[1]).position;
    return (end - start.position - step.move).norm() <= kMostOff * step.length;
}

/// A step from the present place within its face; none where the field vanishes.
std::optional<StreamTracer::Step> StreamTracer::MakeStep(Start const& start, double longest,
                                                         bool isAlongEdge) {
    FaceSides const sides(_flow.GetSurface().IsLoop());
    double const speed = std::max(std::abs(start.velocity.s), std::abs(start.velocity.t));
    double length = std::min(longest, kFarthestStep / speed);
    std::optional<Step> step;
    for (int halvings = 0; halvings <= kMostHalvings; ++halvings, length *= 0.5) {
        step = TryStep(start, length);
        if (!step) continue;
        if (isAlongEdge) return step;
        bool const leaves = sides.GetDepth(sides.FindNearest(step->end), step->end) < -kOnEdge;
        if (leaves) step = ShortenToEdge(start, *step);
        if (step && IsTrue(start, *step)) return step;
        if (step) length = std::min(length, step->length);
    }
    return step;
}

/// The step that ends on the edge which a longer one passes: by false position, with the value of
/// an end that stays halved (the Illinois rule), or in the middle where that gets nowhere.
std::optional<StreamTracer::Step> StreamTracer::ShortenToEdge(Start const& start,
                                                              Step const& leaving) {
    FaceSides const sides(_flow.GetSurface().IsLoop());
    auto const findDepth = [&](Coordinates const& at) {
        return sides.GetDepth(sides.FindNearest(at), at);
    };
    Step inside{_at, Eigen::Vector3d::Zero(), 0.0}, outside = leaving;
    double depth = std::max(0.0, findDepth(_at)), beyond = findDepth(leaving.end);
    int lastSide = 0;
    constexpr int kMaxTries = 60;
    for (int i = 0; i < kMaxTries; ++i) {
        double const width = outside.length - inside.length;
        double part = depth / (depth - beyond);
        if (!(part > 1e-6 && part < 1.0 - 1e-6)) part = 0.5;
        auto step = TryStep(start, inside.length + part * width);
        if (!step) return {};
        double const found = findDepth(step->end);
        if (std::abs(found) <= kOnEdge) return step;
        int const side = found < 0.0 ? -1 : 1;
        (side < 0 ? outside : inside) = *step;
        (side < 0 ? beyond : depth) = found;
        if (side == lastSide) (side < 0 ? depth : beyond) *= 0.5;
        lastSide = side;
    }
    return inside.length > 0.0 ? std::optional(inside) : std::nullopt;
}

/// To the neighbour across a side; false where there is none.
bool StreamTracer::CrossEdge(int side) {
    FaceSides const sides(_flow.GetSurface().IsLoop());
    auto const& level = _flow.GetLevel();
    Index const edge = level.GetFaceEdges(_face)[side];
    auto const faces = level.GetEdgeFaces(edge);
    auto const places = level.GetEdgeFaceLocalIndices(edge);
    for (int i = 0; i < faces.size(); ++i) {
        if (faces[i] == _face && places[i] == side) continue;
        if (!_flow.GetSurface().HasLimit(faces[i])) break;
        _at = sides.GetPlace(places[i], 1.0 - sides.GetAlong(side, _at));
        _face = faces[i];
        _sampler.Bind(_face);
        return true;
    }
    return false;
}

/// The field's direction at a corner of the bound face, in the limit's tangent plane, as a u + b v
/// along the corner's sides; none where there is no direction.
std::optional<StreamTracer::Coordinates> StreamTracer::FindShares(int corner) {
    FaceSides const sides(_flow.GetSurface().IsLoop());
    auto const at = sides.GetCorner(corner);
    auto const here = _sampler.Evaluate(at[0], at[1]);
    auto const velocity = FindVelocity(here, _heading, _leastSpeed);
    if (!velocity) return {};
    std::array<Eigen::Vector3d, 2> along;
    auto const directions = sides.GetCornerDirections(corner);
    for (size_t k = 0; k < 2; ++k)
        along[k] = (directions[k][0] * here.ds + directions[k][1] * here.dt).normalized();
    Eigen::Vector3d const normal = along[0].cross(along[1]);
    double const area2 = normal.squaredNorm();
    if (!(area2 > 0.0)) return {};
    return Coordinates{velocity->direction.cross(along[1]).dot(normal) / area2,
                       along[0].cross(velocity->direction).dot(normal) / area2};
}

/// To the face round a vertex whose corner the field points into: (a,b) >= 0, the least of them
/// largest.
StreamTracer::Turn StreamTracer::ChooseFace(Index vertex) {
    auto const& level = _flow.GetLevel();
    auto const faces = level.GetVertexFaces(vertex);
    auto const corners = level.GetVertexFaceLocalIndices(vertex);
    constexpr double kNearlyIn = -1e-3;
    int best = -1;
    Coordinates shares{};
    bool isSingular = false;
    for (int i = 0; i < faces.size(); ++i) {
        if (!_flow.GetSurface().HasLimit(faces[i])) continue;
        _sampler.Bind(faces[i]);
        auto const found = FindShares(corners[i]);
        isSingular |= !found;
        if (!found || !(std::min((*found)[0], (*found)[1]) >= kNearlyIn)) continue;
        if (best >= 0 && std::min((*found)[0], (*found)[1]) <= std::min(shares[0], shares[1]))
            continue;
        best = i;
        shares = *found;
    }
    if (best < 0) {
        bool const isOpen = level.GetVertexEdges(vertex).size() != faces.size();
        return isOpen && !isSingular ? Turn::Boundary : Turn::Singular;
    }
    _face = faces[best];
    _sampler.Bind(_face);
    StartFromCorner(corners[best], IsRegular(level, vertex, _flow.GetSurface().IsLoop()), shares);
    return Turn::Onward;
}

/// \param shares  of the direction, as FindShares has them
void StreamTracer::StartFromCorner(int corner, bool isRegular, Coordinates const& shares) {
    FaceSides const sides(_flow.GetSurface().IsLoop());
    _at = sides.GetCorner(corner);
    if (isRegular) return;
    auto const directions = sides.GetCornerDirections(corner);
    double const a = std::max(shares[0], 0.0), b = std::max(shares[1], 0.0);
    for (size_t c = 0; c < 2; ++c)
        _at[c] += kFromCorner * (a * directions[0][c] + b * directions[1][c]) / (a + b);
}

/// Where the present place is on the face's edge and the field leads out of the face: to the face
/// that it leads into.
StreamTracer::Turn StreamTracer::LeaveFace() {
    FaceSides const sides(_flow.GetSurface().IsLoop());
    for (bool hasCrossed = false;; hasCrossed = true) {
        if (int const corner = sides.FindCorner(_at, kAtCorner); corner >= 0)
            return ChooseFace(_flow.GetLevel().GetFaceVertices(_face)[corner]);
        int const side = sides.FindNearest(_at);
        if (sides.GetDepth(side, _at) > kOnEdge) return Turn::Onward;
        auto const velocity = FindVelocityAt(_at);
        if (!velocity) return Turn::Singular;
        double const speed = std::abs(velocity->s) + std::abs(velocity->t);
        if (sides.GetInward(side, {velocity->s, velocity->t}) >= -kInside * speed)
            return Turn::Onward;
        if (hasCrossed) return Turn::AlongEdge;  // the faces lead into each other
        if (!CrossEdge(side)) return Turn::Boundary;
    }
}

StreamEnd StreamTracer::Walk(SurfacePlace const& start, Heading heading, double longest,
                             Visit const& visit) {
    FaceSides const sides(_flow.GetSurface().IsLoop());
    constexpr int kMaxRests = 8;  // steps in a row that lead nowhere
    _heading = heading;
    _face = start.face;
    _at = {start.s, start.t};
    _sampler.Bind(_face);
    double length = 0.0;
    for (int rests = 0; rests < kMaxRests;) {
        if (longest - length <= kNoStep * _step) return StreamEnd::Length;
        Turn const turn = LeaveFace();
        if (turn == Turn::Boundary) return StreamEnd::Boundary;
        if (turn == Turn::Singular) return StreamEnd::Singular;
        auto const here = _sampler.Evaluate(_at[0], _at[1]);
        auto const velocity = FindVelocity(here, _heading, _leastSpeed);
        if (!velocity) return StreamEnd::Singular;
        auto const step = MakeStep({here.position, *velocity}, std::min(_step, longest - length),
                                   turn == Turn::AlongEdge);
        if (!step) return StreamEnd::Singular;
        length += step->length;
        _at = sides.Clamp(step->end);
        if (step->length <= kNoStep * _step) {
            ++rests;
            continue;
        }
        rests = 0;
        Eigen::Vector3d const position = _sampler.Evaluate(_at[0], _at[1]).position;
        if (!visit({{_face, 0, _at[0], _at[1]}, position, length})) return StreamEnd::Near;
    }
    return StreamEnd::Singular;
}

}  // namespace limn::eval
