// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/curve.h"

#include <cmath>

namespace limn::eval {

namespace {

double LengthOf(DoubleLanes const& row) {
    return std::sqrt(row.square().sum());
}

/// A point by its place in the order; beyond an end, the reflection of what lies inside.
DoubleLanes GetPoint(Curve const& curve, int i) {
    int const size = static_cast<int>(curve.points.size());
    if (curve.isClosed) return curve.points[(i + size) % size];
    if (i < 0) return 2.0 * curve.points.front() - curve.points[-i];
    if (i >= size) return 2.0 * curve.points.back() - curve.points[2 * size - 2 - i];
    return curve.points[i];
}

bool IsEnd(Curve const& curve, int i) {
    return !curve.isClosed && (i == 0 || i + 1 == static_cast<int>(curve.points.size()));
}

}  // namespace

Curve SubdivideCurve(Curve const& coarse, CurveRule rule) {
    Curve fine{{}, coarse.isClosed};
    int const size = static_cast<int>(coarse.points.size());
    for (int i = 0; i < size; ++i) {
        DoubleLanes const before = GetPoint(coarse, i - 1), at = GetPoint(coarse, i),
                          after = GetPoint(coarse, i + 1);
        bool const stays = rule == CurveRule::FourPoint || IsEnd(coarse, i);
        fine.points.push_back(stays ? at : DoubleLanes(0.125 * before + 0.75 * at + 0.125 * after));
        if (i + 1 == size && !coarse.isClosed) break;
        if (rule == CurveRule::FourPoint) {
            fine.points.push_back((9.0 * (at + after) - before - GetPoint(coarse, i + 2)) / 16.0);
        } else {
            fine.points.push_back(0.5 * (at + after));
        }
    }
    return fine;
}

std::vector<DoubleLanes> FindCurveDeltas(Curve const& curve) {
    std::vector<DoubleLanes> deltas;
    deltas.reserve(curve.points.size());
    int const size = static_cast<int>(curve.points.size());
    for (int i = 0; i < size; ++i) {
        DoubleLanes const point = GetPoint(curve, i);
        // Differences: the same digits however far from the origin the curve lies.
        deltas.push_back(0.5 *
                         ((point - GetPoint(curve, i - 1)) + (point - GetPoint(curve, i + 1))));
    }
    if (!curve.isClosed && size > 2) {
        deltas.front() = deltas[1];
        deltas.back() = deltas[deltas.size() - 2];
    }
    return deltas;
}

double SolveClosedCurve(std::vector<DoubleLanes> const& deltas, std::vector<DoubleLanes>& points) {
    auto const size = static_cast<double>(deltas.size());
    DoubleLanes sum = DoubleLanes::Zero();
    double lengths = 0.0;
    for (DoubleLanes const& delta : deltas) {
        sum += delta;
        lengths += LengthOf(delta);
    }
    DoubleLanes const mean = sum / size;
    DoubleLanes edge = DoubleLanes::Zero(), drift = DoubleLanes::Zero();
    for (DoubleLanes const& delta : deltas) {  // an edge differs from the one before by twice delta
        edge -= 2.0 * (delta - mean);
        drift += edge;
    }
    edge = -drift / size;  // so that edges add up to 0
    points.assign(deltas.size(), DoubleLanes::Zero());
    for (size_t i = 0; i + 1 < deltas.size(); ++i) {
        edge -= 2.0 * (deltas[i] - mean);
        points[i + 1] = points[i] + edge;
    }
    return lengths > 0.0 ? LengthOf(sum) / lengths : 0.0;
}

void SolveOpenCurve(std::vector<DoubleLanes> const& deltas, DoubleLanes const& first,
                    DoubleLanes const& last, std::vector<DoubleLanes>& points) {
    size_t const numEdges = deltas.size() - 1;
    DoubleLanes edge = DoubleLanes::Zero(), drift = DoubleLanes::Zero();
    for (size_t i = 1; i < numEdges; ++i) {
        edge -= 2.0 * deltas[i];
        drift += edge;
    }
    edge = (last - first - drift) / static_cast<double>(numEdges);
    points.assign(deltas.size(), first);
    for (size_t i = 1; i < numEdges; ++i) {
        points[i] = points[i - 1] + edge;
        edge -= 2.0 * deltas[i];
    }
    points.back() = last;
}

CurveResult RefineCurveDifferentially(Curve const& coarse, CurveRule rule, int levels) {
    Curve spatial = coarse, deltas{FindCurveDeltas(coarse), coarse.isClosed};
    for (int level = 0; level < levels; ++level) {
        spatial = SubdivideCurve(spatial, rule);
        deltas = SubdivideCurve(deltas, rule);
        for (DoubleLanes& delta : deltas.points) delta *= 0.25;
    }
    Curve fine{{}, coarse.isClosed};
    CurveReport found;
    DoubleLanes mean = DoubleLanes::Zero();
    if (coarse.isClosed) {
        found.compatibilityDefect = SolveClosedCurve(deltas.points, fine.points);
        for (DoubleLanes& point : fine.points) point += spatial.points.front();
        for (DoubleLanes const& delta : deltas.points)
            mean += delta / static_cast<double>(deltas.points.size());
    } else {
        SolveOpenCurve(deltas.points, spatial.points.front(), spatial.points.back(), fine.points);
    }
    double misfit = 0.0, size = 0.0;
    auto const result = FindCurveDeltas(fine);
    for (size_t i = 0; i < result.size(); ++i) {
        if (IsEnd(fine, static_cast<int>(i))) continue;
        misfit += (result[i] - deltas.points[i] + mean).square().sum();
        size += deltas.points[i].square().sum();
    }
    found.residual = size > 0.0 ? std::sqrt(misfit / size) : 0.0;
    return {std::move(fine), found};
}

}  // namespace limn::eval
