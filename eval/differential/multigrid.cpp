// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/multigrid.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// a / b per lane; 0 where there is nothing left to divide by.
DoubleLanes Divide(DoubleLanes const& a, DoubleLanes const& b) {
    return (b > 0.0).select(a / (b > 0.0).select(b, 1.0), 0.0);
}

/// What a number is changed by at most, relatively, when it becomes a double.
constexpr double kHalfDigit = 0x1p-53;

/// Row i of G x, and the square of what it changes by when each number of x becomes a double,
/// errors taken for independent ones of the largest size.
struct ImageOfRow {
    DoubleLanes value, rounding;
};

/// Lengths of a projected right-hand side, of a residual, and of what rounding the solution may
/// have put into it.
struct SolutionMisfit {
    double rightSide, residual, rounding;
};

[[noreturn]] void RefuseAnchors() {
    throw Error(ErrorCode::BadOption,
                "Multigrid::SetAnchors: one vertex of each singular block is needed, in their "
                "order");
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
        for (auto const& block : GetFinest().blocks) anchors.push_back(block.begin);
        means.resize(anchors.size());
    }

    MultigridLevel const& GetFinest() const { return levels.back(); }
    bool IsFree(MultigridLevel::Block const& block) const {
        return block.isSingular && areConstantsFree;
    }
    DoubleLanes ReadRow(std::span<double const> values, Index row) const {
        auto const p = far_ext::Points(values)[GetFinest().vertices[row]];
        return {p[0], p[1], p[2], 0.0};
    }

    std::vector<DoubleLanes> FindMeans(std::span<double const> rightSide) const;
    ImageOfRow ApplyByDifferences(Index row) const;
    SolutionMisfit Measure(std::span<double const> rightSide,
                           std::vector<DoubleLanes> const& meansOfRightSide,
                           std::span<double const> solution);
    int FindCorrection(double goal, int maxIterations);
    DoubleLanes Advance(DoubleLanes const& step);
    DoubleLanes Precondition(DoubleLanes const& scale);
    void Turn(DoubleLanes const& scale, DoubleLanes const& momentum);
    void Correct(std::span<double> solution) const;

    std::vector<MultigridLevel> levels;
    VCycle cycle;
    RowWeights<double> weights;  // of the finest level
    bool areConstantsFree = true;
    std::vector<Index> anchors;  // per block, its row
    std::vector<DoubleLanes> x, residual, direction,
        image;                       // per row; those of fixed vertices are zero but in x
    std::vector<DoubleLanes> means;  // per block: of the residual, where constants are free
    DoubleLanes curvature;           // direction . image, last
};

/// Per block, the part of the right-hand side that no solution has: its mean where constants are
/// free.
std::vector<DoubleLanes> Multigrid::Implementation::FindMeans(
    std::span<double const> rightSide) const {
    std::vector<DoubleLanes> found;
    for (auto const& block : GetFinest().blocks) {
        Index const size = block.end - block.begin;
        found.push_back(DoubleLanes::Zero());
        if (IsFree(block))
            found.back() =
                SumRows(size, [&](Index i) { return ReadRow(rightSide, block.begin + i); }) / size;
    }
    return found;
}

/// Row i of G x. Differences of neighbours have no rounding errors but those of x itself, however
/// far from the origin they lie.
ImageOfRow Multigrid::Implementation::ApplyByDifferences(Index row) const {
    MultigridLevel const& level = GetFinest();
    double const diagonal = GetDiagonal(level, weights, row);
    ImageOfRow found{DoubleLanes::Zero(), (diagonal * x[row]).square()};
    double mass = diagonal;
    for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
        DoubleLanes const& other = x[level.neighbours[k]];
        double const weight = weights.entries.empty() ? 1.0 : weights.entries[k];
        found.value += weight * (x[row] - other);
        found.rounding += (weight * other).square();
        mass -= weight;
    }
    if (!areConstantsFree) found.value += mass * x[row];
    found.rounding *= kHalfDigit * kHalfDigit;
    return found;
}

/// Loads x and forms residual = b - G x with the projected b.
SolutionMisfit Multigrid::Implementation::Measure(std::span<double const> rightSide,
                                                  std::vector<DoubleLanes> const& meansOfRightSide,
                                                  std::span<double const> solution) {
    ForEachRow(GetFinest().GetNumRows(), [&](Index row) { x[row] = ReadRow(solution, row); });
    using Squares = Eigen::Array<double, 4, 3>;
    Squares sum = Squares::Zero();
    for (size_t k = 0; k < meansOfRightSide.size(); ++k) {
        auto const& block = GetFinest().blocks[k];
        sum += SumRows(block.end - block.begin, [&](Index i) -> Squares {
            Index const row = block.begin + i;
            DoubleLanes const b = ReadRow(rightSide, row) - meansOfRightSide[k];
            ImageOfRow const found = ApplyByDifferences(row);
            residual[row] = b - found.value;
            Squares squares;
            squares << b.square(), residual[row].square(), found.rounding;
            return squares;
        });
    }
    auto const norm = [&](Index column) { return std::sqrt(sum.col(column).sum()); };
    return {norm(0), norm(1), norm(2)};
}

/// x += step * direction, and what that does to the residual. Where constants are free its mean is
/// nothing but rounding, which no step takes away and each one multiplies; it is put aside in
/// `means`. \return what the residual without its means has for sums of squares
DoubleLanes Multigrid::Implementation::Advance(DoubleLanes const& step) {
    DoubleLanes squares = DoubleLanes::Zero();
    using Sums = Eigen::Array<double, 4, 2>;
    for (size_t k = 0; k < means.size(); ++k) {
        auto const& block = GetFinest().blocks[k];
        Index const size = block.end - block.begin;
        Sums const sums = SumRows(size, [&](Index i) -> Sums {
            Index const row = block.begin + i;
            x[row] += step * direction[row];
            residual[row] -= step * image[row];
            Sums terms;
            terms << residual[row], residual[row].square();
            return terms;
        });
        means[k].setZero();
        if (IsFree(block)) means[k] = sums.col(0) / size;
        squares += (sums.col(1) - size * means[k].square()).max(0.0);
    }
    return squares;
}

/// Runs the cycle on the residual times `scale`, which keeps floats in range. \return residual .
/// result / scale
DoubleLanes Multigrid::Implementation::Precondition(DoubleLanes const& scale) {
    auto& scaled = cycle.GetRightSide();
    for (size_t k = 0; k < means.size(); ++k) {
        auto const& block = GetFinest().blocks[k];
        ForEachRow(block.end - block.begin, [&](Index i) {
            Index const row = block.begin + i;
            residual[row] -= means[k];
            scaled[row] = (residual[row] * scale).cast<float>();
        });
    }
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
        image[row] = ApplyRow(GetFinest(), weights, direction.data(), row);
        return image[row] * direction[row];
    });
}

/// Conjugate gradients from x = 0 for the residual, until they have brought it below `goal`. Each
/// coordinate has steps of its own, and rests when it is far below: the others' goal may be less
/// than its rounding errors. \return iterations
int Multigrid::Implementation::FindCorrection(double goal, int maxIterations) {
    constexpr double kRest = 0.1;  // of the goal
    for (auto* rows : {&x, &direction, &image}) {
        ForEachRow(GetFinest().GetNumRows(), [&](Index row) { (*rows)[row].setZero(); });
    }
    DoubleLanes squares = Advance(DoubleLanes::Zero()), product = DoubleLanes::Zero();
    int numIterations = 0;
    while (std::sqrt(squares.sum()) > goal && numIterations < maxIterations) {
        DoubleLanes const moved = (squares.sqrt() > kRest * goal).select(squares, 0.0);
        DoubleLanes const scale = Divide(DoubleLanes::Ones(), moved.sqrt());
        DoubleLanes const nextProduct = Precondition(scale);
        Turn(scale, Divide(nextProduct, product));
        product = nextProduct;
        squares = Advance(Divide(product, curvature));
        ++numIterations;
    }
    return numIterations;
}

/// Adds the correction x, less that of its anchor where constants are free. Sums are made near the
/// anchor: whatever its distance from the origin, numbers are rounded to it once.
void Multigrid::Implementation::Correct(std::span<double> solution) const {
    far_ext::MutablePoints const points(solution);
    for (size_t k = 0; k < anchors.size(); ++k) {
        auto const& block = GetFinest().blocks[k];
        DoubleLanes place = DoubleLanes::Zero(), shift = DoubleLanes::Zero();
        if (IsFree(block)) {
            place = ReadRow(solution, anchors[k]);
            shift = x[anchors[k]];
        }
        ForEachRow(block.end - block.begin, [&](Index i) {
            Index const row = block.begin + i;
            DoubleLanes const offset = (ReadRow(solution, row) - place) + (x[row] - shift);
            points[GetFinest().vertices[row]] = (place + offset).head<3>();
        });
    }
}

MultigridReport Multigrid::Solve(std::span<double const> rightSide, std::span<double> solution,
                                 MultigridOptions const& options) {
    auto& self = *_implementation;
    auto const means = self.FindMeans(rightSide);
    SolutionMisfit misfit = self.Measure(rightSide, means, solution);
    // Where b = 0 relative to where it started.
    double const unit = misfit.rightSide > 0.0 ? misfit.rightSide : misfit.residual;
    MultigridReport report;
    auto const judge = [&] {
        report.residual = unit > 0.0 ? misfit.residual / unit : 0.0;
        report.rounding = unit > 0.0 ? misfit.rounding / unit : 0.0;
        report.converged = report.residual <= std::max(options.tolerance, report.rounding);
    };
    judge();
    bool isDone = report.residual <= options.tolerance;
    double goal = options.tolerance, before = std::numeric_limits<double>::infinity();
    // The residual that conjugate gradients carry along drifts from the solution's own, which
    // decides: where it has gained and is not there yet they start again from it.
    while (!isDone && report.iterations < options.maxIterations && report.residual < 0.5 * before) {
        before = report.residual;
        report.iterations +=
            self.FindCorrection(goal * unit, options.maxIterations - report.iterations);
        self.Correct(solution);
        misfit = self.Measure(rightSide, means, solution);
        judge();
        isDone = report.converged;
        goal = 0.3 * std::max(options.tolerance, report.rounding);  // leaves room for rounding
    }
    return report;
}

void Multigrid::Precondition(std::vector<DoubleLanes> const& rightSide,
                             std::vector<DoubleLanes>& result) {
    auto& self = *_implementation;
    MultigridLevel const& level = self.GetFinest();
    DoubleLanes const squares = SumRows(
        level.numUnknowns, [&](Index row) -> DoubleLanes { return rightSide[row].square(); });
    DoubleLanes const scale = Divide(DoubleLanes::Ones(), squares.sqrt());  // keeps floats in range
    auto& scaled = self.cycle.GetRightSide();
    ForEachRow(level.numUnknowns,
               [&](Index row) { scaled[row] = (rightSide[row] * scale).cast<float>(); });
    auto const& z = self.cycle.Run();
    DoubleLanes const unscale = squares.sqrt();
    ForEachRow(level.numUnknowns,
               [&](Index row) { result[row] = unscale * z[row].cast<double>(); });
}

void Multigrid::HoldAnchors(std::vector<DoubleLanes>& rows) const {
    auto const& self = *_implementation;
    for (size_t k = 0; k < self.anchors.size(); ++k) {
        auto const& block = self.GetFinest().blocks[k];
        if (!self.IsFree(block)) continue;
        DoubleLanes const shift = rows[self.anchors[k]];
        ForEachRow(block.end - block.begin, [&](Index i) { rows[block.begin + i] -= shift; });
    }
}

void Multigrid::SetAnchors(std::span<Index const> vertices) {
    auto& self = *_implementation;
    auto const& rows = self.GetFinest().vertices;
    size_t next = 0;
    for (size_t k = 0; k < self.anchors.size(); ++k) {
        auto const& block = self.GetFinest().blocks[k];
        if (!block.isSingular) continue;
        if (next == vertices.size()) RefuseAnchors();
        auto const begin = rows.begin() + block.begin, end = rows.begin() + block.end;
        auto const found = std::find(begin, end, vertices[next++]);
        if (found == end) RefuseAnchors();
        self.anchors[k] = static_cast<Index>(found - rows.begin());
    }
    if (next != vertices.size()) RefuseAnchors();
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
