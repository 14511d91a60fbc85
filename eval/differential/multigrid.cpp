// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/multigrid.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "eval/differential/v_cycle.h"
#include "eval/parallel/rows.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

/// A bound of the eigenvalues of diag(G)^-1 G. With uniform weights G is a sum over faces: a cycle
/// of n edges that count half each against 1 at each corner, so 3/2 for triangles and at most 2 for
/// others. With weights, Gershgorin's discs; no more than the 3 corners of a triangle can reach.
std::vector<float> BoundEigenvalues(Far::TopologyRefiner const& refiner, int coarsest) {
    std::vector<float> bounds;
    for (int k = coarsest; k <= refiner.GetMaxLevel(); ++k) {
        auto const level = refiner.GetLevel(k);
        bool const hasTriangles = level.GetNumFaceVertices() == 3 * level.GetNumFaces();
        bounds.push_back(hasTriangles ? 1.5f : 2.0f);
    }
    return bounds;
}

float BoundEigenvalues(MultigridLevel const& level, RowWeights<double> const& weights) {
    double largest = 1.0;
    for (Index row = 0; row < level.numUnknowns; ++row) {
        double sum = weights.diagonals[row];
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k)
            sum += std::abs(weights.entries[k]);
        largest = std::max(largest, sum / weights.diagonals[row]);
    }
    return static_cast<float>(std::min(largest, 3.0));
}

RowWeights<double> OrderWeights(Far::TopologyLevel const& topology, MultigridLevel const& level,
                                EdgeWeights const& given) {
    bool const fits = given.edges.size() == static_cast<size_t>(topology.GetNumEdges()) &&
                      (given.masses.empty() ||
                       given.masses.size() == static_cast<size_t>(topology.GetNumVertices()));
    if (!fits)
        throw Error(ErrorCode::BadOption, "Multigrid::SetWeights: weights do not fit the level");
    RowWeights<double> weights;
    for (Index row = 0; row < level.numUnknowns; ++row) {
        Index const vertex = level.vertices[row];
        double diagonal = given.masses.empty() ? 0.0 : given.masses[vertex];
        for (Index edge : topology.GetVertexEdges(vertex)) {
            weights.entries.push_back(given.edges[edge]);
            diagonal += given.edges[edge];
        }
        if (!(diagonal > 0.0)) {
            throw Error(
                ErrorCode::BadMesh,
                fmt::format("the weights round vertex {} add up to {}; more than 0 is needed",
                            vertex, diagonal));
        }
        weights.diagonals.push_back(diagonal);
    }
    return weights;
}

template <class Scalar>
std::vector<Scalar> Cast(std::vector<double> const& values) {
    return {values.begin(), values.end()};
}

}  // namespace

struct Multigrid::Implementation {
    Implementation(Far::TopologyRefiner const& refiner, FixedVertices fixed, int coarsest)
        : levels(BuildMultigridLevels(refiner, fixed, coarsest)), cycle(levels) {
        cycle.SetWeights(std::vector<RowWeights<float>>(levels.size()),
                         BoundEigenvalues(refiner, coarsest), true);
        size_t const numRows = GetFinest().GetNumRows();
        for (auto* rows : {&x, &residual, &direction, &image})
            rows->assign(numRows, DoubleLanes::Zero());
    }

    MultigridLevel const& GetFinest() const { return levels.back(); }
    DoubleLanes ReadRow(std::span<double const> values, Index row) const {
        auto const p = far_ext::Points(values)[GetFinest().vertices[row]];
        return {p[0], p[1], p[2], 0.0};
    }
    DoubleLanes Apply(std::vector<DoubleLanes> const& rows, Index row) const {
        return ApplyRow(GetFinest(), weights, rows.data(), row);
    }

    std::vector<DoubleLanes> FindMeans(std::span<double const> rightSide) const;
    double FormResidual(std::span<double const> rightSide, std::vector<DoubleLanes> const& means);
    DoubleLanes Precondition(DoubleLanes const& scale);
    void Turn(DoubleLanes const& scale, DoubleLanes const& momentum);

    std::vector<MultigridLevel> levels;
    VCycle cycle;
    RowWeights<double> weights;  // of the finest level
    bool areConstantsFree = true;
    std::vector<DoubleLanes> x, residual, direction,
        image;              // per row; those of fixed vertices are zero but in x
    DoubleLanes curvature;  // direction . image, last
};

namespace {

/// a / b per lane; 0 where there is nothing left to divide by.
DoubleLanes Divide(DoubleLanes const& a, DoubleLanes const& b) {
    return (b > 0.0).select(a / (b > 0.0).select(b, 1.0), 0.0);
}

}  // namespace

/// Per block, the part of the right-hand side that no solution has: its mean where constants are
/// free.
std::vector<DoubleLanes> Multigrid::Implementation::FindMeans(
    std::span<double const> rightSide) const {
    std::vector<DoubleLanes> means;
    for (auto const& block : GetFinest().blocks) {
        Index const size = block.end - block.begin;
        bool const isProjected = block.isSingular && areConstantsFree;
        means.push_back(DoubleLanes::Zero());
        if (isProjected)
            means.back() =
                SumRows(size, [&](Index i) { return ReadRow(rightSide, block.begin + i); }) / size;
    }
    return means;
}

/// residual = b - G x with the projected b. \return |b|
double Multigrid::Implementation::FormResidual(std::span<double const> rightSide,
                                               std::vector<DoubleLanes> const& means) {
    DoubleLanes norm = DoubleLanes::Zero();
    for (size_t k = 0; k < means.size(); ++k) {
        auto const& block = GetFinest().blocks[k];
        norm += SumRows(block.end - block.begin, [&](Index i) -> DoubleLanes {
            DoubleLanes const b = ReadRow(rightSide, block.begin + i) - means[k];
            residual[block.begin + i] = b - Apply(x, block.begin + i);
            return b * b;
        });
    }
    return std::sqrt(norm.sum());
}

/// Runs the cycle on the residual times `scale`, which keeps floats in range. \return residual .
/// result / scale
DoubleLanes Multigrid::Implementation::Precondition(DoubleLanes const& scale) {
    auto& scaled = cycle.GetRightSide();
    ForEachRow(GetFinest().numUnknowns,
               [&](Index row) { scaled[row] = (residual[row] * scale).cast<float>(); });
    auto const& z = cycle.Run();
    return Divide(
        SumRows(GetFinest().numUnknowns,
                [&](Index row) -> DoubleLanes { return residual[row] * z[row].cast<double>(); }),
        scale);
}

/// The next direction, conjugate to those before, and its image.
void Multigrid::Implementation::Turn(DoubleLanes const& scale, DoubleLanes const& momentum) {
    auto const& z = cycle.GetResult();
    DoubleLanes const unscale = Divide(DoubleLanes::Ones(), scale);
    ForEachRow(GetFinest().numUnknowns, [&](Index row) {
        direction[row] = unscale * z[row].cast<double>() + momentum * direction[row];
    });
    curvature = SumRows(GetFinest().numUnknowns, [&](Index row) -> DoubleLanes {
        image[row] = Apply(direction, row);
        return image[row] * direction[row];
    });
}

MultigridReport Multigrid::Solve(std::span<double const> rightSide, std::span<double> solution,
                                 MultigridOptions const& options) {
    auto& self = *_implementation;
    MultigridLevel const& level = self.GetFinest();
    ForEachRow(level.GetNumRows(), [&](Index row) { self.x[row] = self.ReadRow(solution, row); });
    auto const means = self.FindMeans(rightSide);
    double const size = self.FormResidual(rightSide, means);
    DoubleLanes squares = SumRows(
        level.numUnknowns, [&](Index row) -> DoubleLanes { return self.residual[row].square(); });
    double const unit =
        size > 0.0 ? size : std::sqrt(squares.sum());  // b = 0: relative to where it started
    double const goal = options.tolerance * unit;

    MultigridReport report;
    report.converged = std::sqrt(squares.sum()) <= goal;
    ForEachRow(level.GetNumRows(), [&](Index row) { self.direction[row].setZero(); });
    DoubleLanes product = DoubleLanes::Zero();
    while (!report.converged && report.iterations < options.maxIterations) {
        DoubleLanes const scale = Divide(DoubleLanes::Ones(), squares.sqrt());
        DoubleLanes const nextProduct = self.Precondition(scale);
        self.Turn(scale, Divide(nextProduct, product));
        product = nextProduct;
        DoubleLanes const step = Divide(product, self.curvature);
        squares = SumRows(level.numUnknowns, [&](Index row) -> DoubleLanes {
            self.x[row] += step * self.direction[row];
            self.residual[row] -= step * self.image[row];
            return self.residual[row].square();
        });
        ++report.iterations;
        report.converged = std::sqrt(squares.sum()) <= goal;
    }
    self.FormResidual(rightSide, means);
    squares = SumRows(level.numUnknowns,
                      [&](Index row) -> DoubleLanes { return self.residual[row].square(); });
    report.residual = unit > 0.0 ? std::sqrt(squares.sum()) / unit : 0.0;
    far_ext::MutablePoints const points(solution);
    ForEachRow(level.numUnknowns,
               [&](Index row) { points[level.vertices[row]] = self.x[row].head<3>(); });
    return report;
}

Multigrid::Multigrid(Far::TopologyRefiner const& refiner, FixedVertices fixed, int coarsest)
    : _implementation(std::make_unique<Implementation>(refiner, fixed, coarsest)) {}
Multigrid::~Multigrid() = default;
Multigrid::Multigrid(Multigrid&&) noexcept = default;

std::vector<MultigridLevel> const& Multigrid::GetLevels() const {
    return _implementation->levels;
}

void Multigrid::SetWeights(Far::TopologyRefiner const& refiner,
                           std::vector<EdgeWeights> const& weights) {
    auto& self = *_implementation;
    if (weights.size() != self.levels.size()) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("Multigrid::SetWeights: {} levels of weights for {} levels",
                                weights.size(), self.levels.size()));
    }
    int const coarsest = refiner.GetMaxLevel() + 1 - static_cast<int>(weights.size());
    std::vector<RowWeights<float>> ordered;
    std::vector<float> bounds;
    for (size_t k = 0; k < weights.size(); ++k) {
        auto rows = OrderWeights(refiner.GetLevel(coarsest + static_cast<int>(k)), self.levels[k],
                                 weights[k]);
        ordered.push_back({Cast<float>(rows.entries), Cast<float>(rows.diagonals)});
        bounds.push_back(BoundEigenvalues(self.levels[k], rows));
        if (k + 1 == weights.size()) self.weights = std::move(rows);
    }
    self.areConstantsFree = weights.back().masses.empty();
    self.cycle.SetWeights(std::move(ordered), std::move(bounds), self.areConstantsFree);
}

size_t Multigrid::GetNumBytes() const {
    auto const sizeOf = [](auto const& values) { return values.size() * sizeof(values[0]); };
    auto const& self = *_implementation;
    size_t bytes =
        self.cycle.GetNumBytes() + sizeOf(self.weights.entries) + sizeOf(self.weights.diagonals);
    for (auto const* rows : {&self.x, &self.residual, &self.direction, &self.image})
        bytes += sizeOf(*rows);
    for (MultigridLevel const& level : self.levels) {
        bytes += sizeOf(level.vertices) + sizeOf(level.offsets) + sizeOf(level.neighbours) +
                 sizeOf(level.parents) + sizeOf(level.children);
    }
    return bytes;
}

}  // namespace limn::eval
