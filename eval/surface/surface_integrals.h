// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "eval/surface/alike_faces.h"
#include "eval/surface/face_tree.h"
#include "eval/surface/graded_points.h"

namespace limn::eval {

/// Sums over places of a surface, each with the area it stands for.
struct SurfaceSums {
    double area = 0.0, volume = 0.0, bending = 0.0, mean = 0.0, meanSquares = 0.0;
    double gaussian = 0.0, gaussianSquares = 0.0, gaussianMagnitude = 0.0;
    double minMean = std::numeric_limits<double>::infinity(), maxMean = -minMean;
    double minGaussian = minMean, maxGaussian = -minMean;
    size_t count = 0;

    /// Adds a place; its volume is for the caller to add.
    void AddCurvature(double share, double k1, double k2);
    void Add(SurfaceSums const& other);
};

/// Integrates the limit surface over faces, at their GradedPoints. Faces with equal rings are taken
/// side by side; places without a safe tangent plane, and those deeper than second derivatives are
/// taken, one by one.
///
/// Bits     of a face's sums: whatever faces are taken with it, on every CPU
/// Threads  one per thread; what is shared (a cache of rings) guards itself
class SurfaceIntegrator {
public:
    /// \param surface    of vertices; kept by reference, as are the others
    /// \param positions  of the control points
    /// \param rings      of the surface's scheme
    SurfaceIntegrator(LimitSurface const& surface, std::span<double const> positions,
                      Orientation orientation, RingCache& rings);

    /// \param sums  per face from `begin` to `end`; those without a limit keep what they have
    void Integrate(Index begin, Index end, std::span<SurfaceSums> sums);

private:
    /// A face that waits for others with the same ring.
    struct Gathered {
        RingNode const* ring;
        Index face;
        int numPoints;
        size_t firstPoint;  // into _points
    };
    using Lanes = std::span<Gathered const>;

    void Gather(Index begin, Index end);
    void IntegrateAlike(Lanes lanes, std::span<SurfaceSums*> sums);
    void AddPiece(Lanes lanes, int domain, GradedPoints::Piece const& piece, LaneSums& sums,
                  std::span<SurfaceSums*> single);
    void AddSingle(Index face, int domain, double s, double t, double weight, SurfaceSums& sums);

    LimitSurface const& _surface;
    std::span<double const> _positions;
    Orientation _orientation;
    GradedPoints _gradedPoints;
    RingCache& _ringCache;
    std::shared_ptr<RingStore> _rings;
    far_ext::FaceRingGatherer _gatherer;
    AlikeFaces _alike;
    FaceTree _tree;                   // for places one by one
    std::vector<Gathered> _gathered;  // scratch from here on
    std::vector<Index> _points, _pointsOfFace;
    far_ext::FaceRing _ring;
};

}  // namespace limn::eval
