// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/surface_sampler.h"

#include <algorithm>
#include <cmath>

#include "eval/kernels/dispatch.h"

namespace limn::eval {

namespace {

/// Has no branch per flag, so that compilers take several at once.
bool IsAnySet(std::span<unsigned const> flags) {
    unsigned any = 0;
    for (unsigned const flag : flags) any |= flag;
    return any != 0;
}

}  // namespace

SurfaceSampler::SurfaceSampler(FaceTree& tree, Quantity quantity, Orientation orientation,
                               Values values)
    : _tree(tree),
      _quantity(quantity),
      _orientation(orientation),
      _values(values),
      _numChannels(eval::GetNumChannels(quantity) + values.count),
      // Values are evaluated in threes, so that the last group may start early.
      _planes((_numChannels + 3) * kStride),
      _degenerate(kStride) {
    tree.CheckChannel(2);  // the position's last
    if (values.count > 0) {
        tree.CheckChannel(values.first);
        tree.CheckChannel(values.first + values.count - 1);
    }
    auto const prepare = [&](auto& lanes) {
        size_t const numCoefficients = tree.GetNumCoefficients();
        lanes.coefficients.resize(numCoefficients * tree.GetLength());
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
                                   static_cast<float>(GetSign(_orientation)),
                                   _planes.data(),
                                   kStride,
                                   _degenerate.data()};
    SurfaceFunctions<Real> const& kernel = GetKernel<SurfaceKernel>();
    kernel.evaluate(batch, _quantity, isTriangle);
    if (_values.count > 0) EvaluateValues(lanes, batch);
    if (_quantity == Quantity::Position || !IsAnySet({_degenerate.data(), count})) return;
    for (size_t i = 0; i < count; ++i) {
        if (!_degenerate[i]) continue;
        int const sample = run.samples[first + i];
        EvaluateFrameExactly(domain, s[sample], t[sample], i);  // position and values are right
    }
}

/// Three at a time: the kernel's "position" of other coefficients.
template <class Real>
void SurfaceSampler::EvaluateValues(Lanes<Real> const& lanes, SurfaceBatch<Real> const& batch) {
    SurfaceFunctions<Real> const& kernel = GetKernel<SurfaceKernel>();
    bool const isTriangle = _tree.GetNumCoefficients() == 15;
    float* const values = _planes.data() + GetFirstValue() * kStride;
    int const end = _values.first + _values.count;
    for (int c = _values.first; c < end; c += 3) {
        int const group = std::min(c, end - 3);  // may begin with channels that are not asked for
        SurfaceBatch<Real> part = batch;
        part.coefficients = lanes.coefficients.data() + group * _tree.GetNumCoefficients();
        if (group == c) {
            part.out = values + (c - _values.first) * kStride;
            kernel.evaluate(part, Quantity::Position, isTriangle);
            continue;
        }
        part.out = _planes.data() + _numChannels * kStride;
        kernel.evaluate(part, Quantity::Position, isTriangle);
        for (int k = c; k < end; ++k) {
            std::copy_n(part.out + (k - group) * kStride, batch.count,
                        values + (k - _values.first) * kStride);
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
    PutVector(kPositionX, column, EvaluateFrameExactly(domain, s, t, column).position);
    for (int k = 0; k < _values.count; ++k) {
        Put(GetFirstValue() + k, column, EvaluateChannel(_tree, domain, s, t, _values.first + k));
    }
}

SurfaceSample SurfaceSampler::EvaluateFrameExactly(int domain, double s, double t, size_t column) {
    SurfaceSample const sample = EvaluateSample(_tree, domain, s, t, _orientation);
    if (sample.isDegenerate) ++_counts.degenerate;
    if (_quantity == Quantity::Position) return sample;
    PutVector(kNormalX, column, sample.normal);
    if (_quantity == Quantity::Tangents) {
        PutVector(kTangentSX, column, sample.tangentS);
        PutVector(kTangentTX, column, sample.tangentT);
    }
    if (!NeedsCurvature()) return sample;
    Put(kMean, column, sample.curvature.mean);
    Put(kGaussian, column, sample.curvature.gaussian);
    Put(kK1, column, sample.curvature.k1);
    Put(kK2, column, sample.curvature.k2);
    if (_quantity >= Quantity::Direction) {
        PutVector(kDirectionX, column, sample.curvature.direction);
    }
    if (!sample.isMoved) return sample;
    ++_counts.moved;
    if (_counts.movedPlaces.size() < kMaxPlaces) {
        _counts.movedPlaces.push_back({_tree.GetFace(), domain, s, t});
    }
    return sample;
}

}  // namespace limn::eval
