// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/cascade_operator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "eval/cascade/cascade_kernel.h"
#include "eval/kernels/dispatch.h"
#include "eval/parallel/rows.h"

namespace limn::eval {

namespace {

using far_ext::CascadeLevel;

/// What is known of the triangles at a block of surface rows.
struct BlockShapes {
    double maxCotangent = -std::numeric_limits<double>::max(),
           minArea = std::numeric_limits<double>::max();
    double sumMasses = 0.0, numTriangles = 0.0;
};

template <class Scalar>
BlockShapes BuildBlock(CascadeLevel const& level, CascadeBuildJob<Scalar> const& job, Index begin,
                       Index end) {
    CascadeFunctions<Scalar> const& kernel = GetKernel<CascadeKernel>();
    auto const [maxCotangent, minArea] = kernel.buildRows(job, begin, end);
    BlockShapes shapes{static_cast<double>(maxCotangent), static_cast<double>(minArea)};
    end = std::min(end, level.numSurface);
    for (Index row = begin; row < end; ++row)
        shapes.sumMasses += static_cast<double>(job.masses[row]);
    if (begin < end) {
        int const numEntries = level.offsets[end] - level.offsets[begin],
                  numOpen = end - std::max(begin, std::min(end, level.numClosed));
        shapes.numTriangles = level.faceSize == 3
                                  ? numEntries - numOpen
                                  : 1.5 * (numEntries - numOpen);  // 3 in the corner of a quad
    }
    return shapes;
}

template <class Scalar>
MetricQuality Build(CascadeLevel const& level, CascadeRows<Scalar> const& metric, Scalar width,
                    CascadeOperator<Scalar>& op) {
    op.edges.resize(level.neighbours.size());
    op.masses.resize(level.numUnknowns);
    op.diagonals.resize(level.numUnknowns);
    CascadeBuildJob<Scalar> const job{
        GetRings(level), metric.data()->data(), width < Scalar(0),  Scalar(0.5) * width * width,
        op.edges.data(), op.masses.data(),      op.diagonals.data()};
    auto const blocks = MapBlocks(level.numUnknowns, kRowsPerBlock, [&](Index begin, Index end) {
        return BuildBlock(level, job, begin, end);
    });
    BlockShapes all;
    for (BlockShapes const& block : blocks) {
        all.maxCotangent = std::max(all.maxCotangent, block.maxCotangent);
        all.minArea = std::min(all.minArea, block.minArea);
        all.sumMasses += block.sumMasses;
        all.numTriangles += block.numTriangles;
    }
    if (!(all.sumMasses > 0.0)) return {};
    // A mass is a third of a row's triangles, of the four of a quad each with half of its weight.
    double const meanArea = (level.faceSize == 3 ? 6.0 : 12.0) * all.sumMasses / all.numTriangles;
    return {std::atan2(1.0, all.maxCotangent), all.minArea / meanArea, all.sumMasses};
}

}  // namespace

CascadeRings GetRings(CascadeLevel const& level) {
    return {level.offsets.data(), level.neighbours.data(), level.faceSize, level.numClosed,
            level.numSurface};
}

MetricQuality BuildOperator(CascadeLevel const& level, CascadeRows<float> const& metric,
                            float width, CascadeOperator<float>& op) {
    return Build(level, metric, width, op);
}

MetricQuality BuildOperator(CascadeLevel const& level, CascadeRows<double> const& metric,
                            double width, CascadeOperator<double>& op) {
    return Build(level, metric, width, op);
}

}  // namespace limn::eval
