// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/surface_sampler.h"

#include <algorithm>
#include <cmath>

namespace limn::eval {

SurfaceSampler::SurfaceSampler(FaceTree& tree, Quantity quantity, float orientation)
    : _tree(tree),
      _quantity(quantity),
      _orientation(orientation),
      _numChannels(eval::GetNumChannels(quantity) + tree.GetLength() - 3),
      // Extra channels are evaluated in threes, so that the last group may start early.
      _planes(static_cast<size_t>(_numChannels + 3) * kStride),
      _degenerate(kStride) {
    auto const prepare = [&](auto& lanes) {
        lanes.coefficients.resize(
            static_cast<size_t>(tree.GetLength() * tree.GetNumCoefficients()));
        lanes.x.resize(kStride);
        lanes.y.resize(kStride);
    };
    prepare(_float);
    prepare(_double);
}

/// From level to level second derivatives shrink against the first ones, by up to 4 times at
/// valence 3: what is left of them in float is enough for 1e-6 only down to depth 1. On triangles
/// the quartic's longer sums cost a factor of 2 everywhere.
bool SurfaceSampler::NeedsDouble(PatchPoint const& patch) const {
    bool const isTriangle = _tree.GetNumCoefficients() == 15;
    return NeedsCurvature() && (isTriangle || std::abs(patch.scale) >= 4.0);
}

void SurfaceSampler::Bind(Index face) {
    _face = face;
    _tree.Bind(face);
}

template <class Real>
void SurfaceSampler::LoadCoefficients(PatchPoint const& patch, Lanes<Real>& lanes) {
    int const n = _tree.GetNumCoefficients();
    for (int c = 0; c < _tree.GetLength(); ++c) {
        for (int i = 0; i < n; ++i) {
            double const origin = i == 0 ? patch.origin[c] : 0.0;
            lanes.coefficients[c * n + i] =
                static_cast<Real>(origin + patch.coefficients[c * n + i]);
        }
    }
}

template <class Real>
void SurfaceSampler::EvaluateBlock(Lanes<Real>& lanes, PatchRun const& run, size_t first,
                                   size_t count, int domain, std::span<double const> s,
                                   std::span<double const> t) {
    double const centre = _tree.GetCentre();
    for (size_t i = 0; i < count; ++i) {
        lanes.x[i] = static_cast<Real>(run.s[first + i] - centre);
        lanes.y[i] = static_cast<Real>(run.t[first + i] - centre);
    }
    for (size_t i = count; i < (count + kSurfaceLanes - 1) / kSurfaceLanes * kSurfaceLanes; ++i) {
        lanes.x[i] = lanes.x[count - 1];
        lanes.y[i] = lanes.y[count - 1];
    }
    bool const isTriangle = _tree.GetNumCoefficients() == 15;
    SurfaceBatch<Real> const batch{lanes.coefficients.data(),
                                   lanes.x.data(),
                                   lanes.y.data(),
                                   static_cast<int>(count),
                                   static_cast<float>(run.patch.scale),
                                   _orientation,
                                   _planes.data(),
                                   kStride,
                                   _degenerate.data()};
    EvaluateSurface(batch, _quantity, isTriangle);

    // Extra channels, three at a time: the kernel's "position" of other coefficients.
    int const numOwn = eval::GetNumChannels(_quantity), length = _tree.GetLength();
    for (int c = 3; c < length; c += 3) {
        int const group = std::min(c, length - 3);  // may repeat channels already done
        SurfaceBatch<Real> extra = batch;
        extra.coefficients = lanes.coefficients.data() + group * _tree.GetNumCoefficients();
        if (group == c) {
            extra.out = _planes.data() + static_cast<size_t>(numOwn + group - 3) * kStride;
            EvaluateSurface(extra, Quantity::Position, isTriangle);
            continue;
        }
        extra.out = _planes.data() + static_cast<size_t>(_numChannels) * kStride;
        EvaluateSurface(extra, Quantity::Position, isTriangle);
        for (int k = c; k < length; ++k) {
            std::copy_n(extra.out + static_cast<size_t>(k - group) * kStride, count,
                        _planes.data() + static_cast<size_t>(numOwn + k - 3) * kStride);
        }
    }
    if (_quantity == Quantity::Position) return;
    for (size_t i = 0; i < count; ++i) {
        if (_degenerate[i]) {
            int const sample = run.samples[first + i];
            EvaluateExactly(domain, s[sample], t[sample], i);
        }
    }
}

template void SurfaceSampler::LoadCoefficients(PatchPoint const&, Lanes<float>&);
template void SurfaceSampler::LoadCoefficients(PatchPoint const&, Lanes<double>&);
template void SurfaceSampler::EvaluateBlock(Lanes<float>&, PatchRun const&, size_t, size_t, int,
                                            std::span<double const>, std::span<double const>);
template void SurfaceSampler::EvaluateBlock(Lanes<double>&, PatchRun const&, size_t, size_t, int,
                                            std::span<double const>, std::span<double const>);

void SurfaceSampler::EvaluateExactly(int domain, double s, double t, size_t column) {
    SurfaceSample const sample = EvaluateSample(_tree, domain, s, t, _orientation);
    auto const put = [&](int channel, double value) {
        _planes[static_cast<size_t>(channel) * kStride + column] = static_cast<float>(value);
    };
    auto const putVector = [&](int channel, Eigen::Vector3d const& v) {
        for (int c = 0; c < 3; ++c) put(channel + c, v[c]);
    };
    putVector(kPositionX, sample.position);
    if (_quantity != Quantity::Position) putVector(kNormalX, sample.normal);
    if (_quantity == Quantity::Tangents) {
        putVector(kTangentSX, sample.tangentS);
        putVector(kTangentTX, sample.tangentT);
    }
    if (NeedsCurvature()) {
        put(kMean, sample.curvature.mean);
        put(kGaussian, sample.curvature.gaussian);
        put(kK1, sample.curvature.k1);
        put(kK2, sample.curvature.k2);
        if (sample.isMoved) {
            ++_counts.moved;
            if (_counts.movedPlaces.size() < kMaxPlaces) {
                _counts.movedPlaces.push_back({_face, domain, s, t});
            }
        }
    }
    if (_quantity >= Quantity::Direction) putVector(kDirectionX, sample.curvature.direction);
    if (sample.isDegenerate) ++_counts.degenerate;
    int const numOwn = eval::GetNumChannels(_quantity);
    for (int c = 3; c < _tree.GetLength(); ++c) {
        put(numOwn + c - 3, EvaluateChannel(_tree, domain, s, t, c));
    }
}

}  // namespace limn::eval
