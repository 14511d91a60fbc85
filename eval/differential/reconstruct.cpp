// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/reconstruct.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "eval/differential/curve.h"
#include "eval/parallel/rows.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/boundary.h"

namespace limn::eval {

namespace {

DoubleLanes Get(far_ext::Points values, Index vertex) {
    auto const p = values[vertex];
    return {p[0], p[1], p[2], 0.0};
}

void Set(far_ext::MutablePoints values, Index vertex, DoubleLanes const& row) {
    values[vertex] = row.head<3>();
}

double RelativeDefect(DoubleLanes const& sum, double sumOfLengths) {
    return sumOfLengths > 0.0 ? std::sqrt(sum.square().sum()) / sumOfLengths : 0.0;
}

Index FindDescendant(Far::TopologyRefiner const& refiner, Index vertex) {
    for (int level = 0; level < refiner.GetMaxLevel(); ++level)
        vertex = refiner.GetLevel(level).GetVertexChildVertex(vertex);
    return vertex;
}

}  // namespace

Reconstructor::Reconstructor(Far::TopologyRefiner const& refiner, std::span<Index const> handles,
                             int coarsest)
    : _multigrid(refiner, FixedVertices::Boundary, coarsest) {
    auto const last = refiner.GetLevel(refiner.GetMaxLevel());
    far_ext::CheckBoundary(last);
    _loops = far_ext::FindBoundaryLoops(last);
    ChooseHandles(refiner, handles);
}

void Reconstructor::ChooseHandles(Far::TopologyRefiner const& refiner,
                                  std::span<Index const> handles) {
    MultigridLevel const& finest = _multigrid.GetLevels().back();
    std::vector<Index> owners(finest.vertices.size(), -1);
    for (auto const& loop : _loops) {
        for (Index vertex : loop) owners[vertex] = static_cast<Index>(_handles.size());
        _handles.push_back(loop.front());
    }
    for (auto const& block : finest.blocks) {
        if (!block.isSingular) continue;
        auto const begin = finest.vertices.begin() + block.begin,
                   end = finest.vertices.begin() + block.end;
        std::for_each(begin, end,
                      [&](Index vertex) { owners[vertex] = static_cast<Index>(_handles.size()); });
        _handles.push_back(*std::min_element(begin, end));
    }
    std::vector<Index> chosen(_handles.size(), -1);
    for (Index handle : handles) {
        if (handle < 0 || handle >= refiner.GetLevel(0).GetNumVertices()) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("handle {}: there are vertices 0 to {}", handle,
                                    refiner.GetLevel(0).GetNumVertices() - 1));
        }
        Index const descendant = FindDescendant(refiner, handle), owner = owners[descendant];
        if (owner < 0) {
            throw Error(
                ErrorCode::BadOption,
                fmt::format("handle {} lies inside a boundary, which places the component; name a "
                            "vertex of each boundary loop instead",
                            handle));
        }
        if (chosen[owner] >= 0) {
            throw Error(
                ErrorCode::BadOption,
                fmt::format(
                    "handles {} and {} are of one component or boundary loop; one is enough",
                    chosen[owner], handle));
        }
        chosen[owner] = handle;
        _handles[owner] = descendant;
    }
    _multigrid.SetAnchors(std::span(_handles).subspan(_loops.size()));
}

/// A boundary loop as a curve, moved so that its handle stays. \return the compatibility defect
double Reconstructor::SolveLoop(std::vector<Index> const& loop, Index handle,
                                std::span<double const> deltas, std::span<double> positions) const {
    std::vector<DoubleLanes> ofLoop, points;
    for (Index vertex : loop) ofLoop.push_back(Get(deltas, vertex));
    double const defect = SolveClosedCurve(ofLoop, points);
    DoubleLanes const place = Get(positions, handle);
    size_t const at = std::find(loop.begin(), loop.end(), handle) - loop.begin();
    for (size_t i = 0; i < loop.size(); ++i)
        Set(positions, loop[i], points[i] - points[at] + place);
    return defect;
}

/// Delta - d (d . Delta) / (d . d) for the degrees d, the left null vector; rightSide holds d
/// Delta. \return the defect
double Reconstructor::ProjectBlock(MultigridLevel::Block const& block,
                                   std::span<double> rightSide) const {
    MultigridLevel const& level = _multigrid.GetLevels().back();
    Index const size = block.end - block.begin;
    auto const degree = [&](Index row) {
        return static_cast<double>(level.offsets[row + 1] - level.offsets[row]);
    };
    DoubleLanes const sum =
        SumRows(size, [&](Index i) { return Get(rightSide, level.vertices[block.begin + i]); });
    DoubleLanes const sums = SumRows(size, [&](Index i) -> DoubleLanes {
        Index const row = block.begin + i;
        double const length = std::sqrt(Get(rightSide, level.vertices[row]).square().sum());
        return {length, degree(row) * degree(row), 0.0, 0.0};
    });
    ForEachRow(size, [&](Index i) {
        Index const row = block.begin + i, vertex = level.vertices[row];
        Set(rightSide, vertex, Get(rightSide, vertex) - degree(row) * degree(row) / sums[1] * sum);
    });
    return RelativeDefect(sum, sums[0]);
}

ReconstructReport Reconstructor::Solve(std::span<double const> deltas, std::span<double> positions,
                                       MultigridOptions const& options) {
    MultigridLevel const& level = _multigrid.GetLevels().back();
    ReconstructReport report;
    for (size_t i = 0; i < _loops.size(); ++i) {
        report.compatibilityDefect = std::max(report.compatibilityDefect,
                                              SolveLoop(_loops[i], _handles[i], deltas, positions));
    }
    std::vector<double> rightSide(positions.size(), 0.0);
    ForEachRow(level.numUnknowns, [&](Index row) {
        Index const vertex = level.vertices[row];
        Set(rightSide, vertex,
            static_cast<double>(level.offsets[row + 1] - level.offsets[row]) * Get(deltas, vertex));
    });
    for (auto const& block : level.blocks) {
        if (block.isSingular)
            report.compatibilityDefect =
                std::max(report.compatibilityDefect, ProjectBlock(block, rightSide));
    }
    MultigridReport const solve = _multigrid.Solve(rightSide, positions, options);
    report.iterations = solve.iterations;
    report.residual = solve.residual;
    report.rounding = solve.rounding;
    report.converged = solve.converged;
    return report;
}

}  // namespace limn::eval
