// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "eval/surface/limit_surface.h"
#include "eval/surface/surface_kernel.h"
#include "eval/surface/surface_sample.h"

namespace limn::eval {

/// Evaluates many samples of one face through the batched kernels, in float, or in double where
/// curvature needs it (deep pieces, triangles); the few that no batch can do (next to an irregular
/// corner, without tangent plane) one by one.
///
/// Channels  those of the quantity (SurfaceChannel), then the tree's channels from 3 on as values.
/// Threads   one per thread, with its own tree
class SurfaceSampler {
public:
    /// \param tree         its first three channels are the position; kept by reference
    /// \param orientation  +1, or -1 to turn normals round
    SurfaceSampler(FaceTree& tree, Quantity quantity, float orientation);

    struct Place {
        Index face;
        int domain;
        double s, t;
    };
    struct Counts {
        size_t moved = 0, degenerate = 0;
        std::vector<Place> movedPlaces;  ///< the first kMaxPlaces of them
    };
    static constexpr size_t kMaxPlaces =
        1 << 16;  // so many that which are kept does not depend on threads

    void Bind(Index face);

    /// Evaluates samples of a domain of the bound face and hands them over in blocks:
    /// visit(samples, planes, stride): planes[c * stride + i] belongs to sample samples[i].
    template <class Visit>
    void Evaluate(int domain, std::span<double const> s, std::span<double const> t, Visit visit);

    int GetNumChannels() const { return _numChannels; }
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
    void EvaluateExactly(int domain, double s, double t, size_t column);

    FaceTree& _tree;
    Quantity _quantity;
    float _orientation;
    int _numChannels;
    Index _face = -1;
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
