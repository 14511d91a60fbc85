// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/smooth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "engine/smooth/adaptive_marks.h"
#include "engine/smooth/cascade_space.h"
#include "engine/smooth/critical_factor.h"
#include "engine/smooth/smooth_checks.h"
#include "eval/cascade/critical_width.h"
#include "eval/cascade/enclosed_volume.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/boundary.h"

namespace limn::engine {

namespace {

using far_ext::CascadeLevel;
using far_ext::CascadeMesh;

constexpr double kLargestWidth =
    1e6;  // of the mesh's size: anything closed collapses long before, and squares must fit a float
constexpr int kMaxIterations = 20000;  // of conjugate gradients on a level
constexpr int kMaxSettling = 30;       // solves

/// The share of what an adaptive mesh may be off that a triangle's sagitta may have [Cascade 13].
constexpr double kSagittaShare = 0.4;

/// The width of one step, of a width of 1: what adds up is variances or, in order 4, their squares.
double GetStepWidth(SmoothOptions const& options) {
    double const root = std::sqrt(static_cast<double>(options.steps));
    return 1.0 / (options.order == 4 ? std::sqrt(root) : root);
}

/// How far the closed component that shrank most did; 1 where none did.
double GetRadiusRatio(SmoothReport const& report) {
    return report.shrinkage ? report.shrinkage->radiusRatio : 1.0;
}

/// Runs one cascade.
template <class Scalar>
class SmoothRun {
public:
    /// \param isAgain  the input's warnings have been given
    SmoothRun(Model const& model, ScaledWidths const& widths, SmoothOptions const& options,
              bool isAgain, Job& job)
        : _model(model),
          _widths(widths),
          _options(options),
          _isAgain(isAgain),
          _job(job),
          _components(model.GetLevel()),
          _ofVertex(_components.ofVertex),
          _start(model.GetPositions()),
          _levels(model, options.levels, options.refinement, options.keepsCreases),
          _startMesh(_levels.GetMesh()),
          _diagonal(FindExtent(model.GetPositions()).GetDiagonal()),
          _unit(FindUnit(model.GetPositions())),
          _widthUnit(_unit / GetStepWidth(options)),
          _origin(FindFloatOrigin(FindExtent(model.GetPositions()))),
          _cascade(ToCascade(model.GetPositions(), _origin, _unit),
                   Times(1.0 / _widthUnit, widths.GetStart(model)), MakeCascadeOptions()) {}

    /// \return without a mesh where a component collapsed
    SmoothResult Run() {
        _report.meanEdge = far_ext::FindMeanEdgeLength(_model.GetLevel(), _model.GetPositions());
        _report.largestWidth = _widths.GetLargest();
        size_t total = static_cast<size_t>(_options.steps - 1) * GetEffort(_options.levels);
        for (int level = FirstLevel(); level <= _options.levels; ++level) total += GetEffort(level);
        _job.Start("smooth", total);
        bool isDone = (_options.adaptive ? RunPasses() : RunLevels()) && Settle();
        for (_step = 2; isDone && _step <= _options.steps; ++_step) {
            _job.CheckStopped();
            _cascade.StartHere();
            _start = Times(_unit, _cascade.GetPositions());
            AddSolve(_cascade.Repeat(CountIterations()));
            isDone = Settle();
        }
        if (_options.adaptive && isDone) DescribeAdaption();
        _job.Finish();
        return {isDone ? std::optional(MakeRoundedScene()) : std::nullopt, std::move(_report),
                std::move(_sweeps)};
    }

private:
    eval::CascadeOptions MakeCascadeOptions() {
        auto const constant = _widths.GetConstant();
        auto const* const stop = std::get_if<StopAtResidual>(&_options.stop);
        return {.solver = _options.solver,
                .tolerance = stop ? stop->residual : 0.0,
                .width = constant ? *constant / _widthUnit : -1.0,
                .isGraph = IsGraph(),
                .progress =
                    [this](double share) {
                        _job.CheckStopped();
                        if (!_isSettling) AdvanceTo(share);
                    },
                .order = _options.order,
                .features = ScaleFeatures(_model, _options, _unit),
                .evaluator = _options.evaluator};
    }

    int FirstLevel() const { return std::min(1, _options.levels); }

    bool RunLevels() {
        bool isDone = true;
        for (int level = FirstLevel(); isDone && level <= _options.levels; ++level) {
            _level = level;
            _job.CheckStopped();
            StepTo(level == 0 ? _levels.MakeUnrefined() : _levels.MakeNext());
            isDone = MayGoOn();
        }
        return isDone;
    }

    /// Cuts what is bent too much until nothing is. \return as MayGoOn
    bool RunPasses() {
        SmoothAdaption& adaption = _report.adaption.emplace();
        AdaptiveMarks marks = MarkBent();
        bool isDone = true;
        do {  // at least one solve, on the start mesh where nothing is to be cut
            _job.CheckStopped();
            if (marks.IsAny()) _level = ++adaption.passes;
            StepTo(_levels.MakeNext(marks.isMarked));
            isDone = MayGoOn();
            marks = MarkBent();
        } while (isDone && marks.IsAny() && adaption.passes < _options.levels);
        if (isDone && marks.IsAny()) {
            _job.Warn(fmt::format(
                "{}: {} passes of bisection leave an error of about {:.2g} of the "
                "diagonal where {:.2g} is asked for; more `levels`, or a larger "
                "width, reach it",
                _model.GetPath(), adaption.passes, EstimateError(marks), *_options.adaptive));
        }
        return isDone;
    }

    AdaptiveMarks MarkBent() {
        std::vector<double> sigmas;
        if (_report.levels.empty()) sigmas = _widths.SampleLevel(_levels, _start);
        if (sigmas.empty()) sigmas = Times(_widthUnit, _cascade.GetWidths());
        return MarkBentTriangles(_levels.GetMesh(), Times(_unit, _cascade.GetPositions()), sigmas,
                                 _widths, kSagittaShare * *_options.adaptive * _diagonal);
    }

    double EstimateError(AdaptiveMarks const& marks) const {
        return marks.largest > 0.0 ? marks.largest / (kSagittaShare * _diagonal) : 0.0;
    }

    void DescribeAdaption() {
        SmoothAdaption& adaption = *_report.adaption;
        adaption.estimated = EstimateError(MarkBent());
        adaption.vertices = _levels.GetMesh().numVertices;
        adaption.smallestEdge =
            FindShortestEdge(_levels.GetMesh(), Times(_unit, _cascade.GetPositions()));
        adaption.uniformVertices = CountAfterQuarterings(_startMesh, (adaption.passes + 1) / 2);
    }

    /// How far vertices will still go: moves shrink by about the same factor each time, so that the
    /// rest is a geometric series.
    double EstimateRest() const {
        std::vector<double> const& moves = _report.settleMoves;
        double const ratio =
            moves.size() == 1 ? 0.9 : std::min(0.95, moves.back() / moves[moves.size() - 2]);
        return moves.back() * ratio / (1.0 - ratio);
    }

    bool HasSettled() const {
        return _options.adaptive ? EstimateRest() < *_options.adaptive / 5.0
                                 : _report.settleMoves.back() < *_options.settle;
    }

    /// Solves on the last mesh until it hardly moves. \return as MayGoOn
    bool Settle() {
        if (!_options.settle && !_options.adaptive) return true;
        _job.Start("settling");
        _isSettling = true;
        bool isDone = true, isSettled = false;
        for (int solve = 0; isDone && !isSettled && solve < kMaxSettling; ++solve) {
            _report.settleMoves.push_back(Repeat());
            isSettled = HasSettled();
            isDone = MayGoOn();
        }
        // Of an adaptive run a part of the error may be left; what matters is all of it.
        bool const isNear = _options.adaptive && EstimateRest() < *_options.adaptive;
        if (isDone && !isSettled && !isNear) {
            _job.Warn(
                fmt::format("{}: after {} more solves vertices still move by {:.2g} of the "
                            "bounding box's diagonal",
                            _model.GetPath(), kMaxSettling, _report.settleMoves.back()));
        }
        _isSettling = false;
        return isDone;
    }

    /// Solves again with the metric of what came out. \return  the largest move over the diagonal
    double Repeat() {
        _job.CheckStopped();
        auto const before = _cascade.GetPositions();
        auto const again = _cascade.Repeat(CountIterations());
        SmoothSolve& solve = _report.levels.back();
        bool const wasFrozen = solve.isMetricFrozen;
        int const sweeps = solve.sweeps + again.sweeps;
        bool const converged = solve.converged && again.converged;
        static_cast<eval::CascadeStepReport&>(solve) = again;
        solve.sweeps = sweeps;
        solve.converged = converged;
        LookAfter(wasFrozen);
        double const move = FindLargestMove(before, _cascade.GetPositions());
        return move > 0.0 ? _unit * move / _diagonal : 0.0;
    }

    /// Whether the filter is repeated with the metric of its result, which needs a fixed point.
    bool IsIterated() const { return _options.levels > 0 || _options.settle; }

    bool MayGoOn() {
        _report.hasCollapsed |= IsIterated() && GetRadiusRatio(_report) < eval::kLeastRadiusRatio;
        return !_report.hasCollapsed || _options.onCollapse == OnCollapse::KeepResult;
    }

    bool IsGraph() const { return _options.constraint == SmoothConstraint::Graph; }

    /// With the coordinates that its file will hold.
    Scene MakeRoundedScene() {
        Scene scene = MakeScene();
        if (!_options.target) return scene;
        _report.precision = FindPrecision(*_options.target, FindExtent(scene.positions));
        RoundAsWritten(_options.target->path, _report.precision, scene.positions);
        if (_report.volumes.empty()) return scene;
        auto const volumes =
            eval::MeasureVolumes(_levels.GetMesh(), _ofVertex, _components.count, scene.positions);
        auto entry = _report.volumes.begin();
        for (size_t component = 0; component < volumes.size(); ++component) {
            if (_components.isClosed[component]) (entry++)->end = volumes[component];
        }
        return scene;
    }

    Scene MakeScene() {
        Scene fine = _levels.MakeScene(_job);
        fine.positions = Times(_unit, _cascade.GetPositions());
        for (size_t i = 0; i < fine.positions.size(); ++i) {
            if (_origin[i % 3] != 0.0) fine.positions[i] += _origin[i % 3];  // -0 stays
        }
        auto const widths = Times(_widthUnit, _cascade.GetWidths());
        std::erase_if(fine.primvars,
                      [](Primvar const& primvar) { return primvar.name == "width"; });
        fine.primvars.push_back({"width", 1, std::vector<float>(widths.begin(), widths.end())});
        return fine;
    }

    /// What a level costs: a number of unknowns, and of iterations, which about doubles with each
    /// quartering.
    size_t GetEffort(int level) const {
        bool const isByResidual = std::holds_alternative<StopAtResidual>(_options.stop) &&
                                  _options.solver != eval::CascadeSolver::Exact;
        int const doublings = isByResidual ? 3 * level : 2 * level;
        return size_t{1000} << (_options.refinement == SmoothRefinement::Quadrisect
                                    ? doublings
                                    : doublings / 2);
    }

    /// Shows a share of the present level as done.
    void AdvanceTo(double share) {
        size_t const done = static_cast<size_t>(share * static_cast<double>(GetEffort(_level)));
        if (done <= _shown) return;
        _job.Advance(done - _shown);
        _shown = done;
    }

    int CountIterations() const {
        if (auto const* const each = std::get_if<IterationsPerLevel>(&_options.stop))
            return each->count;
        if (auto const* const sweeps = std::get_if<SweepsOnFinest>(&_options.stop)) {
            return eval::CountSweeps(_options.solver, sweeps->count, _options.levels - _level,
                                     _options.refinement == SmoothRefinement::Bisect);
        }
        return kMaxIterations;
    }

    /// Goes to a finer mesh and solves there.
    void StepTo(CascadeMesh const& mesh) {
        std::vector<Index> const coarse = std::move(_rows.vertices);
        _rows = far_ext::BuildCascadeLevel(mesh, coarse, _options.boundary);
        _ofVertex = Inherit(mesh, _ofVertex);
        _start = Interpolate(mesh, _start);
        auto const given = _widths.SampleLevel(_levels, _start);
        if (_report.levels.empty() && IsIterated() && !IsGraph() && !_isAgain)
            WarnOfSharpCorners(_model, _rows, given.empty() ? _widths.GetStart(_model) : given,
                               _job);
        _job.CheckStopped();
        AddSolve(_cascade.Step(_rows, CountIterations(), Times(1.0 / _widthUnit, given)));
        if (!_options.keepsSweeps) return;
        auto const matrices = eval::MakeSweepMatrices(_rows, _cascade.GetOperator());
        _sweeps.push_back({_level, eval::ToPublicOrder(_rows, matrices)});
    }

    void AddSolve(eval::CascadeStepReport const& solve) {
        bool const wasFrozen = !_report.levels.empty() && _report.levels.back().isMetricFrozen;
        _report.levels.push_back({solve, _level, _step});
        _job.Note(fmt::format("level {}: {} unknowns, {} sweeps, residual {:.2g}", _level,
                              solve.unknowns, solve.sweeps, solve.residual));
        LookAfter(wasFrozen);
        AdvanceTo(1.0);
        _shown = 0;
    }

    /// What is to be kept and told after a solve.
    void LookAfter(bool wasFrozen) {
        SmoothSolve const& solve = _report.levels.back();
        if (solve.isMetricFrozen && !wasFrozen) {
            _job.Warn(
                fmt::format("{}: from level {} on the filter keeps the metric of the level before: "
                            "its smallest angle would be {:.2g} degrees, its "
                            "smallest area {:.2g} of the mean. A smaller width, or less sharp "
                            "corners, avoid it",
                            _model.GetPath(), _level,
                            solve.minAngleRadians * 180.0 / std::numbers::pi, solve.areaRatio));
        }
        if (_options.constraint == SmoothConstraint::Volume)
            RestoreVolumes(_levels.GetMesh());
        else if (!IsGraph())
            WatchRadii();
    }

    /// Adds to the equation a force along the normals that keeps the volume: (M + L) X = M (X0 + c
    /// sigma^2 / 2 n), with c per component. As that is linear in c, it takes one more solve.
    void RestoreVolumes(CascadeMesh const& mesh) {
        auto positions = Times(_unit, _cascade.GetPositions());
        auto const widths = _cascade.GetWidths();
        std::vector<double> force = eval::FindVolumeNormals(mesh, positions);
        far_ext::MutablePoints const forces(force);
        for (Index row = 0; row < _rows.GetNumRows(); ++row) {
            Index const vertex = _rows.vertices[row];
            double const share = row < _rows.numSurface ? widths[vertex] * widths[vertex] / 2 : 0.0;
            forces[vertex] *= share;
        }
        auto const directions = _cascade.Filter(force, CountIterations());
        auto const wanted = eval::MeasureVolumes(mesh, _ofVertex, _components.count, _start);
        auto const isMet = eval::RestoreVolumes(mesh, _ofVertex, _components.isClosed, wanted,
                                                directions, positions);
        _cascade.SetPositions(Times(1.0 / _unit, positions));
        auto const reached = eval::MeasureVolumes(mesh, _ofVertex, _components.count, positions);
        _report.volumes.clear();
        for (size_t component = 0; component < isMet.size(); ++component) {
            if (!_components.isClosed[component]) continue;
            _report.volumes.push_back({_components.firstVertex[component], wanted[component],
                                       reached[component], isMet[component] != 0});
        }
    }

    void WatchRadii() {
        auto const start = eval::FindMeanRadii(_start, _ofVertex, _components.count);
        auto const present =
            eval::FindMeanRadii(_cascade.GetPositions(), _ofVertex, _components.count);
        for (size_t component = 0; component < start.size(); ++component) {
            if (!_components.isClosed[component] || !(start[component] > 0.0)) continue;
            double const ratio = _unit * present[component] / start[component];
            if (ratio < GetRadiusRatio(_report))
                _report.shrinkage = {_components.firstVertex[component], _level, ratio};
        }
    }

    Model const& _model;
    ScaledWidths const& _widths;
    SmoothOptions const& _options;
    bool _isAgain;
    Job& _job;
    SmoothComponents _components;
    std::vector<int> _ofVertex;
    std::vector<double> _start;  // the start surface on the present level
    SmoothLevels _levels;
    CascadeMesh _startMesh;         // of bisection
    double _diagonal;               // of the start surface
    double _unit, _widthUnit;       // of the cascade's lengths and, with steps, of its widths
    std::array<double, 3> _origin;  // what its positions are relative to
    CascadeLevel _rows;
    eval::Cascade<Scalar> _cascade;
    int _level = 0, _step = 1;
    bool _isSettling = false;
    size_t _shown = 0;  // of the level's effort
    SmoothReport _report;
    std::vector<LevelSweep> _sweeps;
};

SmoothResult RunOnce(Model const& model, ScaledWidths const& widths, SmoothOptions const& options,
                     bool isAgain, Job& job) {
    bool const isSingle = options.precision == Precision::Float &&
                          options.solver == eval::CascadeSolver::Jacobi && !options.evaluator;
    return isSingle ? SmoothRun<float>(model, widths, options, isAgain, job).Run()
                    : SmoothRun<double>(model, widths, options, isAgain, job).Run();
}

/// Options as the run takes them: passes of bisection for levels where these are adaptive.
SmoothOptions CountPasses(SmoothOptions options) {
    if (!options.adaptive) return options;
    options.refinement = SmoothRefinement::Bisect;
    options.levels *= 2;
    return options;
}

void CheckInput(Model const& model, FilterWidths const& widths, SmoothOptions const& options,
                Job& job) {
    CheckOptions(options);
    RefuseDefects(model, job);
    CheckWidths(widths, model);
    double const unit = FindUnit(model.GetPositions()),
                 largest = ScaledWidths(widths, 1.0).GetLargest();
    if (largest > kLargestWidth * unit) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: a filter width of {:.4g} is more than {:.0e} times the mesh's "
                                "size of about {:.4g}; give less",
                                model.GetPath(), largest, kLargestWidth, unit));
    }
    if (options.constraint == SmoothConstraint::Graph) RequireGraph(model);
    if (options.keptFeatures) RequireTriangles(model, "keptFeatures");
    if (options.adaptive) RequireTriangles(model, "adaptive");
}

/// Where a component shrank suspiciously, measures what it carries, and limits the width to that
/// where asked for.
SmoothResult WatchCollapse(Model const& model, FilterWidths const& widths,
                           SmoothOptions const& options, Job& job, SmoothResult result) {
    // A sphere is at 0.72 of its radius where the width is 0.9 of the critical one. On a large mesh
    // it costs too much to be sure.
    constexpr double kSuspiciousRatio = 0.75;
    double const suspicious = 4.0 * model.GetLevel().GetNumVertices() <= kMaxCriticalVertices
                                  ? kSuspiciousRatio
                                  : eval::kLeastRadiusRatio;
    bool const isIterated = options.levels > 0 || options.settle;
    if (!isIterated || GetRadiusRatio(result.report) >= suspicious) return result;
    job.Start("measuring the critical width");
    double const factor =
        MeasureCriticalFactor(model, ScaledWidths(widths, GetStepWidth(options)), options, job);
    result.report.hasCollapsed |= factor < 1.0;
    if (result.report.hasCollapsed && options.onCollapse == OnCollapse::LimitWidth &&
        factor > 0.0) {
        Index const vertex = result.report.shrinkage->firstVertex;
        double const limit =
            0.95 * factor;  // a fixed point near the critical width takes many levels
        result = RunOnce(model, ScaledWidths(widths, limit), options, true, job);
        result.report.limitedBy = limit;
        job.Warn(
            fmt::format("{}: the width was reduced to {:.4g} of what was asked for; the "
                        "component of vertex {} carries {:.4g}",
                        model.GetPath(), limit, vertex, factor));
    }
    result.report.criticalFactor = factor;
    if (result.report.hasCollapsed && options.onCollapse != OnCollapse::KeepResult)
        result.mesh.reset();
    return result;
}

}  // namespace

bool SmoothReport::HasConverged() const {
    return !hasCollapsed && std::all_of(levels.begin(), levels.end(),
                                        [](auto const& level) { return level.converged; });
}

SmoothResult Smooth(Model const& model, FilterWidths const& widths, SmoothOptions const& asked,
                    Job& job) {
    CheckInput(model, widths, asked, job);
    SmoothOptions const options = CountPasses(asked);
    SmoothResult result =
        WatchCollapse(model, widths, options, job,
                      RunOnce(model, ScaledWidths(widths, 1.0), options, false, job));
    if (result.mesh && options.target)
        WarnOfPrecision(*options.target, FindExtent(result.mesh->positions), job);
    for (SmoothVolume const& volume : result.report.volumes) {
        if (volume.isMet) continue;
        job.Warn(fmt::format(
            "{}: the component of vertex {} could not keep its volume: {:.6g} of {:.6g}",
            model.GetPath(), volume.firstVertex, volume.end, volume.start));
    }
    return result;
}

}  // namespace limn::engine
