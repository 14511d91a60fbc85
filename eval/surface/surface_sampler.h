// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "eval/surface/surface_kernel.h"
#include "eval/surface/surface_sample.h"

namespace limn::eval {

/// Evaluates many samples of one face through the batched kernels, in float, or in double where
/// curvature needs it (deep pieces, triangles); the few that no batch can do (next to an irregular
/// corner, without tangent plane) one by one.
///
/// Channels  those of the quantity (SurfaceChannel), then values: further channels of the tree.
/// Bits      Samplers of Position and of Normal agree in what both have, and so do those of
///           Curvature, Direction and Tangents (SharesBits); between these two kinds they differ by
///           rounding.
/// Threads   one per thread, with its own tree; several samplers may share a tree
/// Errors    BadOption: those of FaceTree, with the number of the place among those given
class SurfaceSampler {
public:
    /// A run of the tree's channels beside the position.
    struct Values {
        int first = 3, count = 0;
    };

    /// \param tree         its first three channels are the position; kept by reference, it must
    ///                     outlive the sampler
    /// \param values       which of the tree's channels to evaluate, too
    SurfaceSampler(FaceTree& tree, Quantity quantity, Orientation orientation, Values values);

    /// With all of the tree's channels.
    SurfaceSampler(FaceTree& tree, Quantity quantity, Orientation orientation)
        : SurfaceSampler(tree, quantity, orientation, {3, tree.GetLength() - 3}) {}

    /// True where samplers of both quantities give the same bits.
    static bool SharesBits(Quantity a, Quantity b) {
        return (a >= Quantity::Curvature) == (b >= Quantity::Curvature);
    }

    struct Counts {
        size_t moved = 0, degenerate = 0;
        std::vector<SurfacePlace> movedPlaces;  ///< the first kMaxPlaces of them
    };
    /// So many that which are kept does not depend on threads.
    static constexpr size_t kMaxPlaces = 1 << 16;

    /// Makes `face` the current one, of the tree as well, unless another sampler has done so.
    void Bind(Index face) {
        if (_tree.GetFace() != face) _tree.Bind(face);
    }

    /// Evaluates samples of a domain of the bound face and hands them over in blocks:
    /// visit(samples, planes, stride): planes[c * stride + i] belongs to sample samples[i].
    template <class Visit>
    void Evaluate(int domain, std::span<double const> s, std::span<double const> t, Visit visit);

    int GetNumChannels() const { return _numChannels; }
    /// Where the values begin among the planes.
    int GetFirstValue() const { return eval::GetNumChannels(_quantity); }
    Counts const& GetCounts() const { return _counts; }

private:
    static constexpr size_t kBlock = 512;  // samples per block: its planes stay in the cache
    static constexpr size_t kStride = kBlock + kSurfaceLanes;

    bool NeedsCurvature() const { return _quantity >= Quantity::Curvature; }
    template <class Real>
    struct Lanes {
        std::vector<Real> coefficients, x, y;
    };

    bool NeedsDouble(PatchPoint const& patch) const;
    template <class Real>
    void LoadCoefficients(PatchPoint const& patch, Lanes<Real>& lanes);
    /// Fills _planes with one block of a run; samples lie at x, y of the loaded piece.
    template <class Real>
    void EvaluateBlock(Lanes<Real>& lanes, PatchRun const& run, size_t first, size_t count,
                       int domain, std::span<double const> s, std::span<double const> t);
    template <class Real>
    void EvaluateValues(Lanes<Real> const& lanes, SurfaceBatch<Real> const& batch);
    void EvaluateExactly(int domain, double s, double t, size_t column);
    /// All but the position and the values.
    SurfaceSample EvaluateFrameExactly(int domain, double s, double t, size_t column);
    /// As a float that is not infinite, whatever it was.
    void Put(int channel, size_t column, double value) {
        constexpr double kLargest = std::numeric_limits<float>::max();
        _planes[channel * kStride + column] =
            static_cast<float>(std::clamp(value, -kLargest, kLargest));
    }
    void PutVector(int channel, size_t column, Eigen::Vector3d const& v) {
        for (int c = 0; c < 3; ++c) Put(channel + c, column, v[c]);
    }

    FaceTree& _tree;
    Quantity _quantity;
    Orientation _orientation;
    Values _values;
    int _numChannels;
    Counts _counts;
    std::vector<float> _planes;
    Lanes<float> _float;
    Lanes<double> _double;
    std::vector<unsigned> _degenerate;
    std::vector<int> _near;
};

template <class Visit>
void SurfaceSampler::Evaluate(int domain, std::span<double const> s, std::span<double const> t,
                              Visit visit) {
    _near.clear();
    int const depth = NeedsCurvature() ? FaceTree::kCurvatureDepth : FaceTree::kLimitDepth;
    _tree.ForEachPiece(
        domain, s, t, depth,
        [&](PatchRun const& run) {
            bool const isDouble = NeedsDouble(run.patch);
            if (isDouble)
                LoadCoefficients(run.patch, _double);
            else
                LoadCoefficients(run.patch, _float);
            for (size_t first = 0; first < run.samples.size(); first += kBlock) {
                size_t const count = std::min(kBlock, run.samples.size() - first);
                if (isDouble)
                    EvaluateBlock(_double, run, first, count, domain, s, t);
                else
                    EvaluateBlock(_float, run, first, count, domain, s, t);
                visit(run.samples.subspan(first, count), _planes.data(), kStride);
            }
        },
        [&](int sample) { _near.push_back(sample); });
    for (int const& sample : _near) {
        EvaluateExactly(domain, s[sample], t[sample], 0);
        visit(std::span(&sample, 1), _planes.data(), kStride);
    }
}

}  // namespace limn::eval
