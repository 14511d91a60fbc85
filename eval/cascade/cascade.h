// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "eval/cascade/cascade_operator.h"
#include "eval/cascade/cascade_solve.h"
#include "eval/cascade/cascade_sweep.h"
#include "eval/cascade/cascade_tables.h"

namespace limn::eval {

enum class CascadeSolver { Exact, ConjugateGradients, Jacobi };

/// A filter that keeps features, see eval::KeepFeatures.
struct KeptFeatures {
    double lambda = 0.0;        ///< in 1/length: where normals turn by more over a length, it stops
    double normalsWidth = 0.0;  ///< of the plain step whose result has the normals
};

struct CascadeOptions {
    CascadeSolver solver = CascadeSolver::ConjugateGradients;
    double tolerance = 0.0;  ///< of the residual, where conjugate gradients stop
    double width = -1.0;   ///< sigma of all rows; negative: that of each vertex, solved along with
                           ///< the positions
    bool isGraph = false;  ///< filters heights z over the plane: its metric, x and y stay
    std::function<void(double)> progress{};  ///< called now and then, but for Exact, with the share
                                             ///< of a solve that is done; may throw
    bool measuresResidual = true;            ///< of Jacobi sweeps, at the cost of about one
    int order = 2;  ///< 4: (M + L M^-1 L) X = M X0, with L X = 0 on rows that stay; not by Jacobi
    std::optional<KeptFeatures> features{};  ///< on triangles, not by Jacobi
    TableEvaluator* evaluator = nullptr;  ///< of Jacobi sweeps and interpolation: these are rounded
                                          ///< to float, all else is in double. Outlives the cascade
};

/// What a step did.
struct CascadeStepReport {
    Index unknowns = 0;
    int sweeps = 0;         ///< sweeps or iterations; 1 for the exact solver
    double residual = 0.0;  ///< as CascadeSolve's; NaN where not measured
    bool converged = true;
    double minAngleRadians = 0.0;  ///< of the metric the level was given, before any freezing
    double areaRatio = 0.0;
    bool isMetricFrozen = false;
};

/// The cascadic geometric filter. Each level starts from the coarser one, linearly interpolated,
/// takes its metric from there, and solves (M + L) X = M X0 for a surface X near the start mesh X0.
///
/// Metric   Where it degenerates (an angle below a degree, or half of the start mesh's smallest if
///          that is less; an area below 1e-8 of the mean, all of it below 1e-12 of the start
///          mesh's), the level and all finer ones keep that of the level before, interpolated.
/// Widths   of vertices are filtered like positions, but 0 stays 0: where none was painted, nothing
///          ever moves.
/// Scalar   float: Jacobi only, without an evaluator. All sums and solves have the same bits
/// whatever the threads. Source   [Diewald02] Sec. 5 to 8
template <class Scalar>
class Cascade {
public:
    /// \param positions  3 per vertex of the start mesh
    /// \param widths     sigma per vertex; empty with a width for all
    /// \throws Error     BadOption: sizes that do not fit, a solver that Scalar does not have.
    ///                   BadMesh: what is no number, or beyond 1e48 (in float 1e9)
    Cascade(std::span<double const> positions, std::span<double const> widths,
            CascadeOptions const& options);

    /// Goes to the next level. \param level  kept by reference until the next call
    ///
    /// \param givenWidths  sigma per vertex of the level: used as they are, and not filtered.
    ///                     Empty: those of the level before, interpolated, and solved along with
    ///                     the positions
    CascadeStepReport Step(far_ext::CascadeLevel const& level, int iterations,
                           std::span<double const> givenWidths = {});

    /// Solves once more on the same level, with the metric of the present surface.
    CascadeStepReport Repeat(int iterations);

    /// Takes the present surface and widths for the start of what follows: another step of the
    /// filter, not another level of the same one.
    void StartHere() { _x0 = _x; }

    /// Per vertex of the level, in the public order.
    std::vector<double> GetPositions() const;
    std::vector<double> GetStartPositions() const;
    std::vector<double> GetWidths() const;

    /// The filter of the level reached, on other values: solves (M + L) Y = M Y0 with the operator
    /// of the last step.
    ///
    /// \param values  Y0, 3 per vertex; rows that stay keep theirs. \param iterations  as Step's
    std::vector<double> Filter(std::span<double const> values, int iterations) const;

    /// Replaces the surface, e.g. by one of the right volume: the next level starts there. \param
    /// positions  as GetPositions
    void SetPositions(std::span<double const> positions);

    // Rows of the level, for those that go on from them.
    CascadeRows<Scalar> const& GetRows() const { return _x; }
    CascadeRows<Scalar> const& GetStartRows() const { return _x0; }
    CascadeOperator<Scalar> const& GetOperator() const { return _operator; }

private:
    CascadeStepReport Solve(int iterations);
    CascadeRows<Scalar> Prolong(CascadeRows<Scalar> const& coarse) const;
    void BuildEquation(CascadeRows<Scalar> const& metric, int iterations);
    CascadeSolve SolveRows(CascadeOperator<Scalar> const& op, CascadeRows<Scalar> const& x0,
                           CascadeRows<Scalar>& x, int iterations) const;
    void Sweep(int iterations);
    void SweepByTables(CascadeRows<Scalar> const& x0, CascadeRows<Scalar>& x, int iterations) const;
    void SweepInParts(CascadeRows<Scalar> const& from, CascadeRows<Scalar> const& x0,
                      CascadeRows<Scalar>& next, CascadeRows<Scalar>& x, int iterations) const;
    /// The vertex of a row; before the first level rows are in the public order.
    size_t GetVertex(size_t row) const { return _level ? _level->vertices[row] : row; }
    std::vector<double> GetPublic(CascadeRows<Scalar> const& rows) const;
    CascadeRows<Scalar> MakeRows(std::span<double const> values) const;
    bool IsDegenerate(MetricQuality const& quality) const;

    CascadeOptions _options;
    far_ext::CascadeLevel const* _level = nullptr;
    CascadeRows<Scalar> _x, _x0;
    CascadeRows<Scalar> _metric;  // the last one not degenerate; of the coarser level until that is
                                  // known of this one's
    CascadeRows<Scalar> _next;    // the other buffer of sweeps
    CascadeRows<Scalar> _plane;   // of a graph: x and y
    CascadeOperator<Scalar> _operator;
    std::optional<CascadeTables> _tables;  // of an evaluator
    bool _isFrozen = false, _hasGivenWidths = false;
    double _leastAngle = -1.0, _leastAreaRatio = 0.0, _startArea = 0.0;
};

/// Sweeps on a level so that all together cost about as much as the finest: n 2^(2 (kmax - k)) for
/// Jacobi, n 2^(1.5 (kmax - k)) for conjugate gradients; half of the exponents for bisection. At
/// most 1e6.
///
/// \param levelsLeft  kmax - k
/// Source  [Diewald02] Sec. 6, step 5
int CountSweeps(CascadeSolver solver, int finest, int levelsLeft, bool isBisection);

}  // namespace limn::eval
