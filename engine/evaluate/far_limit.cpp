// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/far_limit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <opensubdiv/bfr/parameterization.h>
#include <opensubdiv/far/ptexIndices.h>

#include "engine/scene/extent.h"
#include "engine/scene/require_limit.h"

namespace limn::engine {

namespace Bfr = OpenSubdiv::Bfr;

namespace {

std::vector<far_ext::PtexPlace> FindPtexPlaces(Model const& model, PlaceArrays const& places) {
    Far::PtexIndices const numbers(model.GetRefiner());
    std::vector<far_ext::PtexPlace> ptex;
    ptex.reserve(places.faces.size());
    for (eval::SurfacePlace const& place : LocatePlaces(model, places))
        ptex.push_back({numbers.GetFaceId(place.face) + place.domain, place.s, place.t});
    return ptex;
}

size_t CountBytes(far_ext::StencilRows const& rows) {
    size_t const entries = rows.GetControlIndices().size();
    return entries * (sizeof(Index) + far_ext::kMaxWeightSets * sizeof(float)) +
           rows.GetSizes().size() * (sizeof(int) + sizeof(Index));
}

/// Values of all rows, set after set, of positions relative to an origin.
std::vector<float> Apply(eval::StencilEvaluator const& evaluator, std::span<double const> positions,
                         std::array<double, 3> const& origin) {
    std::vector<double> const relative = Subtract(positions, origin);
    std::vector<float> source(relative.size());
    std::transform(relative.begin(), relative.end(), source.begin(),
                   [](double x) { return static_cast<float>(x); });
    if (!std::all_of(source.begin(), source.end(), [](float x) { return std::isfinite(x); }))
        throw Error(ErrorCode::BadMesh, "a position is too large for an evaluator in float");
    eval::Osd::BufferDescriptor const desc(0, 3, 3);
    size_t const size = static_cast<size_t>(evaluator.GetNumStencils()) * 3;
    std::vector<float> results(size * far_ext::kMaxWeightSets);
    eval::SimdEvaluator::Targets targets;
    for (size_t set = 0; set < far_ext::kMaxWeightSets; ++set)
        targets.push_back({results.data() + set * size, desc});
    evaluator.EvalStencils(source.data(), desc, targets, 0, evaluator.GetNumStencils());
    return results;
}

/// Places without a tangent plane have a position and nothing else.
void Put(eval::SurfaceDerivatives const& d, Orientation orientation, size_t place,
         LimitValues& values) {
    auto const put = [place](Eigen::Vector3d const& v, std::vector<double>& to) {
        std::copy_n(v.data(), 3, to.begin() + static_cast<std::ptrdiff_t>(3 * place));
    };
    values.hasLimit[place] = 1;
    put(d.position, values.positions);
    if (!eval::HasTangentPlane(d)) return;
    eval::SurfaceSample const sample = eval::MakeSample(d, orientation);
    put(sample.normal, values.normals);
    put(sample.curvature.direction, values.directions);
    values.mean[place] = sample.curvature.mean;
    values.gaussian[place] = sample.curvature.gaussian;
    values.k1[place] = sample.curvature.k1;
    values.k2[place] = sample.curvature.k2;
}

Bfr::Parameterization MakeParameters(Model const& model, Index face) {
    auto const& cage = model.GetCage();
    return {cage.scheme, cage.faceSizes[face]};
}

void Append(Index face, double const* st, PlaceList& places) {
    places.faces.push_back(face);
    places.s.push_back(st[0]);
    places.t.push_back(st[1]);
}

/// \param differences  NaN where there is nothing to compare
LimitDifference Summarise(std::vector<double> const& differences) {
    LimitDifference result;
    std::vector<double> known;
    double sum = 0.0;
    for (size_t i = 0; i < differences.size(); ++i) {
        double const difference = differences[i];
        if (!std::isfinite(difference)) continue;
        if (known.empty() || difference > result.max) {
            result.max = difference;
            result.place = i;
        }
        sum += difference * difference;
        known.push_back(difference);
    }
    if (known.empty()) return result;
    std::sort(known.begin(), known.end());
    auto const rank = [&](double share) {
        return known[static_cast<size_t>(share * static_cast<double>(known.size() - 1))];
    };
    result.rms = std::sqrt(sum / static_cast<double>(known.size()));
    result.p99 = rank(0.99);
    result.median = rank(0.5);
    return result;
}

}  // namespace

FarLimit EvaluateFarLimit(Model const& model, PlaceArrays const& places, FarLimitRule const& rule,
                          Orientation orientation, Job& job) {
    RequireLimit(model);
    job.Start("building OpenSubdiv's limit stencils");
    auto const start = std::chrono::steady_clock::now();
    auto stencils = far_ext::BuildFarLimitStencils(model.GetCage(), FindPtexPlaces(model, places),
                                                   rule.options);
    FarLimit far;
    far.tableBytes = CountBytes(stencils.rows);
    far.buildSeconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    job.CheckStopped();

    size_t const count = places.faces.size();
    far.values = LimitValues::MakeEmpty(count);
    eval::StencilEvaluator const evaluator(rule.evaluator, std::move(stencils.rows));
    if (evaluator.GetNumStencils() == 0) return far;
    auto const origin = FindOrigin(FindExtent(model.GetPositions()));
    auto const results = Apply(evaluator, model.GetPositions(), origin);
    size_t const size = static_cast<size_t>(evaluator.GetNumStencils()) * 3;
    for (size_t i = 0; i < count; ++i) {
        if (stencils.rowOfPlace[i] < 0) continue;
        auto const get = [&](size_t set) {
            return Eigen::Map<Eigen::Vector3f const>(
                       &results[set * size + 3 * static_cast<size_t>(stencils.rowOfPlace[i])])
                .cast<double>();
        };
        eval::SurfaceDerivatives d{get(0), get(1), get(2), get(3), get(4), get(5)};
        d.position += Eigen::Map<Eigen::Vector3d const>(origin.data());
        Put(d, orientation, i, far.values);
    }
    return far;
}

FarComparison CompareLimits(LimitValues const& exact, LimitValues const& far, double diagonal) {
    size_t const count = exact.hasLimit.size();
    std::vector<double> positions(count), normals(count), curvatures(count);
    FarComparison result;
    far_ext::Points const points(exact.positions), farPoints(far.positions);
    far_ext::Points const directions(exact.normals), farDirections(far.normals);
    for (size_t i = 0; i < count; ++i) {
        if (exact.hasLimit[i] && far.hasLimit[i]) ++result.numPlaces;
        positions[i] = (farPoints[i] - points[i]).norm() / diagonal;
        double const sine = farDirections[i].cross(directions[i]).norm();
        normals[i] =
            std::atan2(sine, farDirections[i].dot(directions[i])) * 180.0 / std::numbers::pi;
        curvatures[i] = std::abs(far.mean[i] - exact.mean[i]) * diagonal;
    }
    result.position = Summarise(positions);
    result.normalDegrees = Summarise(normals);
    result.meanCurvature = Summarise(curvatures);
    return result;
}

std::vector<Index> AddVertexPlaces(Model const& model, PlaceList& places) {
    auto const level = model.GetRefiner().GetLevel(0);
    std::vector<Index> vertices;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        auto const faces = level.GetVertexFaces(vertex);
        for (int k = 0; k < faces.size(); ++k) {
            if (level.IsFaceHole(faces[k])) continue;
            double st[2];
            MakeParameters(model, faces[k])
                .GetVertexCoord(level.GetVertexFaceLocalIndices(vertex)[k], st);
            Append(faces[k], st, places);
            vertices.push_back(vertex);
            break;
        }
    }
    return vertices;
}

void AddFaceCentres(Model const& model, PlaceList& places) {
    auto const level = model.GetRefiner().GetLevel(0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        if (level.IsFaceHole(face)) continue;
        double st[2];
        MakeParameters(model, face).GetCenterCoord(st);
        Append(face, st, places);
    }
}

FarReport CompareFarLimit(Model const& model, PlaceList places, FarLimitRule const& rule,
                          Orientation orientation, Job& job) {
    auto const exact = EvaluateLimit(model, places.GetPlaces(), orientation, job);
    FarReport report{.rule = rule, .places = std::move(places), .far = {}, .comparison = {}};
    report.far = EvaluateFarLimit(model, report.places.GetPlaces(), rule, orientation, job);
    report.comparison =
        CompareLimits(exact, report.far.values, FindExtent(model.GetPositions()).GetDiagonal());
    return report;
}

}  // namespace limn::engine
