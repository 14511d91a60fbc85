#include "eval/surface_sampler.h"

#include <algorithm>

namespace limn::eval {

SurfaceSampler::SurfaceSampler(FaceTree& tree, Quantity quantity, float orientation)
    : _tree(tree),
      _quantity(quantity),
      _orientation(orientation),
      _numChannels(eval::GetNumChannels(quantity) + tree.GetLength() - 3),
      _coefficients(static_cast<size_t>(tree.GetLength() * tree.GetNumCoefficients())),
      // Extra channels are evaluated in threes, so that the last group may start early.
      _planes(static_cast<size_t>(_numChannels + 3) * kStride),
      _x(kStride),
      _y(kStride),
      _degenerate(kStride) {}

void SurfaceSampler::Bind(Index face) {
    _face = face;
    _tree.Bind(face);
}

void SurfaceSampler::LoadCoefficients(PatchPoint const& patch) {
    int const n = _tree.GetNumCoefficients();
    for (int c = 0; c < _tree.GetLength(); ++c) {
        for (int i = 0; i < n; ++i) {
            double const origin = i == 0 ? patch.origin[c] : 0.0;
            _coefficients[c * n + i] = static_cast<float>(origin + patch.coefficients[c * n + i]);
        }
    }
}

void SurfaceSampler::EvaluateBlock(PatchRun const& run, size_t first, size_t count, int domain,
                                   std::span<double const> s, std::span<double const> t) {
    double const centre = _tree.GetCentre();
    for (size_t i = 0; i < count; ++i) {
        _x[i] = static_cast<float>(run.s[first + i] - centre);
        _y[i] = static_cast<float>(run.t[first + i] - centre);
    }
    for (size_t i = count; i < (count + kSurfaceLanes - 1) / kSurfaceLanes * kSurfaceLanes; ++i) {
        _x[i] = _x[count - 1];
        _y[i] = _y[count - 1];
    }
    bool const isTriangle = _tree.GetNumCoefficients() == 15;
    SurfaceBatch batch{_coefficients.data(), _x.data(), _y.data(), static_cast<int>(count),
                       static_cast<float>(run.patch.scale), _orientation, _planes.data(), kStride,
                       _degenerate.data()};
    EvaluateSurface(batch, _quantity, isTriangle);

    // Extra channels, three at a time: the kernel's "position" of other coefficients.
    int const numOwn = eval::GetNumChannels(_quantity), length = _tree.GetLength();
    for (int c = 3; c < length; c += 3) {
        int const group = std::min(c, length - 3);  // may repeat channels already done
        SurfaceBatch extra = batch;
        extra.coefficients = _coefficients.data() + group * _tree.GetNumCoefficients();
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
