// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/surface_integrals.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "eval/kernels/dispatch.h"
#include "eval/surface/surface_sample.h"

namespace limn::eval {

namespace {

constexpr size_t kNumLanes = AlikeFaces::kLanes;

LaneSums MakeEmptySums() {
    LaneSums sums{};
    for (size_t l = 0; l < kNumLanes; ++l) {
        sums.minMean[l] = sums.minGaussian[l] = std::numeric_limits<double>::infinity();
        sums.maxMean[l] = sums.maxGaussian[l] = -sums.minMean[l];
    }
    return sums;
}

SurfaceSums GetLane(LaneSums const& sums, size_t l) {
    return {sums.area[l],
            sums.volume[l],
            sums.bending[l],
            sums.mean[l],
            sums.meanSquares[l],
            sums.gaussian[l],
            sums.gaussianSquares[l],
            sums.gaussianMagnitude[l],
            sums.minMean[l],
            sums.maxMean[l],
            sums.minGaussian[l],
            sums.maxGaussian[l],
            static_cast<size_t>(sums.count[l])};
}

}  // namespace

void SurfaceSums::AddCurvature(double share, double k1, double k2) {
    double const h = 0.5 * (k1 + k2), k = k1 * k2;
    area += share;
    bending += share * (k1 * k1 + k2 * k2);
    mean += share * h;
    meanSquares += share * h * h;
    gaussian += share * k;
    gaussianSquares += share * k * k;
    gaussianMagnitude += share * std::abs(k);
    minMean = std::min(minMean, h);
    maxMean = std::max(maxMean, h);
    minGaussian = std::min(minGaussian, k);
    maxGaussian = std::max(maxGaussian, k);
    ++count;
}

void SurfaceSums::Add(SurfaceSums const& other) {
    area += other.area;
    volume += other.volume;
    bending += other.bending;
    mean += other.mean;
    meanSquares += other.meanSquares;
    gaussian += other.gaussian;
    gaussianSquares += other.gaussianSquares;
    gaussianMagnitude += other.gaussianMagnitude;
    minMean = std::min(minMean, other.minMean);
    maxMean = std::max(maxMean, other.maxMean);
    minGaussian = std::min(minGaussian, other.minGaussian);
    maxGaussian = std::max(maxGaussian, other.maxGaussian);
    count += other.count;
}

SurfaceIntegrator::SurfaceIntegrator(LimitSurface const& surface, std::span<double const> positions,
                                     Orientation orientation, RingCache& rings)
    : _surface(surface),
      _positions(positions),
      _orientation(orientation),
      _gradedPoints(surface),
      _ringCache(rings),
      _gatherer(surface.GetRefiner().GetLevel(0), surface.GetRefiner().GetSchemeOptions(), -1),
      _alike(surface.IsLoop()),
      _tree(surface, positions, 3) {}

/// The rings and points of faces, those with one ring next to each other.
void SurfaceIntegrator::Gather(Index begin, Index end) {
    _ringCache.Renew(_rings);
    _gathered.clear();
    _points.clear();
    for (Index face = begin; face < end; ++face) {
        if (!_surface.HasLimit(face)) continue;
        _gatherer.Gather(face, _ring, _pointsOfFace);
        _gathered.push_back(
            {_rings->Find(_ring), face, static_cast<int>(_pointsOfFace.size()), _points.size()});
        _points.insert(_points.end(), _pointsOfFace.begin(), _pointsOfFace.end());
    }
    // Where rings lie in memory decides who is taken with whom, and on no bit of a face's sums.
    std::sort(_gathered.begin(), _gathered.end(), [](Gathered const& a, Gathered const& b) {
        if (a.ring != b.ring) return std::less<>()(a.ring, b.ring);
        return a.face < b.face;
    });
}

void SurfaceIntegrator::Integrate(Index begin, Index end, std::span<SurfaceSums> sums) {
    Gather(begin, end);
    std::vector<SurfaceSums*> ofLanes;
    for (size_t first = 0; first < _gathered.size(); first += ofLanes.size()) {
        ofLanes.clear();
        while (ofLanes.size() < kNumLanes && first + ofLanes.size() < _gathered.size() &&
               _gathered[first + ofLanes.size()].ring == _gathered[first].ring)
            ofLanes.push_back(&sums[_gathered[first + ofLanes.size()].face - begin]);
        IntegrateAlike(Lanes(_gathered).subspan(first, ofLanes.size()), ofLanes);
    }
}

void SurfaceIntegrator::IntegrateAlike(Lanes lanes, std::span<SurfaceSums*> sums) {
    std::array<Index const*, kNumLanes> points{};
    for (size_t l = 0; l < kNumLanes; ++l)  // lanes that are left over do what the last one does
        points[l] = &_points[lanes[std::min(l, lanes.size() - 1)].firstPoint];
    _alike.Bind(*_rings, *lanes[0].ring, lanes[0].numPoints, points, _positions);
    LaneSums inLanes = MakeEmptySums();
    _gradedPoints.ForEachPiece(lanes[0].face, [&](int domain, GradedPoints::Piece const& piece) {
        AddPiece(lanes, domain, piece, inLanes, sums);
    });
    for (size_t l = 0; l < lanes.size(); ++l) sums[l]->Add(GetLane(inLanes, l));
}

void SurfaceIntegrator::AddPiece(Lanes lanes, int domain, GradedPoints::Piece const& piece,
                                 LaneSums& sums, std::span<SurfaceSums*> single) {
    constexpr size_t kCount = GradedPoints::kPointsPerPiece;
    std::array<double, kCount> x{}, y{};
    std::array<unsigned char, kCount * kNumLanes> isUnsafe{};
    for (size_t first = 0, end = 0; first < kCount; first = end) {
        auto const place = _alike.Find(domain, piece.s[first], piece.t[first]);
        x[first] = place.x;
        y[first] = place.y;
        for (end = first + 1; end < kCount; ++end) {
            auto const next = _alike.Find(domain, piece.s[end], piece.t[end]);
            if (next.piece != place.piece) break;
            x[end] = next.x;
            y[end] = next.y;
        }
        if (place.piece < 0) {
            std::fill(&isUnsafe[first * kNumLanes], isUnsafe.data() + end * kNumLanes, 1);
            continue;
        }
        auto const at = _alike.GetPiece(place.piece);
        GetKernel<IntegralKernel>().accumulate(
            {at.coefficients, at.origin, _surface.IsLoop(), static_cast<int>(end - first),
             &x[first], &y[first], &piece.weights[first], at.scale, GetSign(_orientation)},
            sums, &isUnsafe[first * kNumLanes]);
    }
    for (size_t i = 0; i < kCount; ++i) {
        for (size_t l = 0; l < lanes.size(); ++l) {
            if (isUnsafe[i * kNumLanes + l])
                AddSingle(lanes[l].face, domain, piece.s[i], piece.t[i], piece.weights[i],
                          *single[l]);
        }
    }
}

void SurfaceIntegrator::AddSingle(Index face, int domain, double s, double t, double weight,
                                  SurfaceSums& sums) {
    if (_tree.GetFace() != face) _tree.Bind(face);
    auto const x = EvaluateSample(_tree, domain, s, t, _orientation);
    double const area = weight * x.tangentS.cross(x.tangentT).norm();
    sums.volume += area * x.position.dot(x.normal) / 3.0;
    if (area > 0.0 && !x.isDegenerate) sums.AddCurvature(area, x.curvature.k1, x.curvature.k2);
}

}  // namespace limn::eval
