// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/smooth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

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

std::vector<double> Times(double factor, std::vector<double> values) {
    for (double& value : values) value *= factor;
    return values;
}

/// A length of the scene's size, so that the fourth powers of all others fit a float; a power of
/// two, which costs no digit.
double FindUnit(Scene const& scene) {
    double size = 0.0;
    for (size_t i = 3; i < scene.positions.size(); ++i)
        size = std::max(size, std::abs(scene.positions[i] - scene.positions[i % 3]));
    return size > 0.0 && std::isfinite(size) ? std::exp2(std::ilogb(size)) : 1.0;
}

/// Values of the coarser mesh' vertices, each finer one taking its first parent's.
std::vector<int> Inherit(CascadeMesh const& mesh, std::vector<int> const& coarse) {
    std::vector<int> fine(mesh.numVertices);
    for (size_t vertex = 0; vertex < fine.size(); ++vertex)
        fine[vertex] = coarse[mesh.parents[mesh.parentOffsets[vertex]]];
    return fine;
}

/// Positions of the coarser mesh, interpolated linearly as the cascade does.
std::vector<double> Interpolate(CascadeMesh const& mesh, std::vector<double> const& coarse) {
    std::vector<double> fine(size_t{3} * mesh.numVertices, 0.0);
    far_ext::Points const parents(coarse);
    far_ext::MutablePoints const points(fine);
    for (Index vertex = 0; vertex < mesh.numVertices; ++vertex) {
        int const begin = mesh.parentOffsets[vertex], end = mesh.parentOffsets[vertex + 1];
        for (int k = begin; k < end; ++k) points[vertex] += parents[mesh.parents[k]];
        points[vertex] /= end - begin;
    }
    return fine;
}

/// Widths at the control mesh' vertices: 0 where they are given anew on every level, none where
/// they are constant.
std::vector<double> GetStartWidths(Scene const& scene, FilterWidths const& widths) {
    if (widths.IsConstant()) return {};
    return widths.GetAtVertices().empty() ? std::vector<double>(scene.positions.size() / 3, 0.0)
                                          : widths.GetAtVertices();
}

/// Runs one cascade.
template <class Scalar>
class SmoothRun {
public:
    /// \param isAgain  the input's warnings have been given
    SmoothRun(Scene const& scene, Far::TopologyLevel const& base, FilterWidths const& widths,
              SmoothOptions const& options, bool isAgain, Job& job)
        : _scene(scene),
          _base(base),
          _widths(widths),
          _options(options),
          _isAgain(isAgain),
          _job(job),
          _components(base),
          _ofVertex(_components.ofVertex),
          _start(scene.positions),
          _levels(scene, options.levels, options.refinement, options.keepsCreases),
          _unit(FindUnit(scene)),
          _cascade(Times(1.0 / _unit, scene.positions),
                   Times(1.0 / _unit, GetStartWidths(scene, widths)), MakeCascadeOptions()) {}

    /// \return the last level, or nothing where a component collapsed
    Scene Run(SmoothReport& report) {
        size_t total = 0;
        for (int level = 1; level <= _options.levels; ++level) total += GetEffort(level);
        _job.Start("smooth", total);
        for (_level = 1; _level <= _options.levels; ++_level) {
            Step(report);
            AdvanceTo(1.0);
            _shown = 0;
            report.hasCollapsed |= report.shrinkage.radiusRatio < eval::kLeastRadiusRatio;
            if (report.hasCollapsed && !_options.keepsResult) break;
        }
        _job.Finish();
        if (report.hasCollapsed && !_options.keepsResult) return {};
        Scene fine = _levels.MakeScene();
        fine.positions = Times(_unit, _cascade.GetPositions());
        auto const widths = Times(_unit, _cascade.GetWidths());
        std::erase_if(fine.primvars,
                      [](Primvar const& primvar) { return primvar.name == "width"; });
        fine.primvars.push_back({"width", 1, std::vector<float>(widths.begin(), widths.end())});
        return fine;
    }

private:
    eval::CascadeOptions MakeCascadeOptions() {
        return {.solver = _options.solver,
                .tolerance = IsByTolerance() ? _options.tolerance : 0.0,
                .width = _widths.IsConstant() ? _widths.GetConstant() / _unit : -1.0,
                .isGraph = _options.isGraph,
                .progress = [this](double share) {
                    CheckInterrupted();
                    AdvanceTo(share);
                }};
    }

    bool IsByTolerance() const { return _options.sweeps == 0 && _options.iterations == 0; }

    /// What a level costs: a number of unknowns, and of iterations, which about doubles with each
    /// quartering.
    size_t GetEffort(int level) const {
        int const doublings = IsByTolerance() && _options.solver != eval::CascadeSolver::Exact
                                  ? 3 * level
                                  : 2 * level;
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
        if (_options.iterations > 0) return _options.iterations;
        if (_options.sweeps == 0) return kMaxIterations;
        return eval::CountSweeps(_options.solver, _options.sweeps, _options.levels - _level,
                                 _options.refinement == SmoothRefinement::Bisect);
    }

    void Step(SmoothReport& report) {
        CheckInterrupted();
        CascadeMesh const& mesh = _levels.MakeNext();
        std::vector<Index> const coarse = std::move(_rows.vertices);
        _rows = far_ext::BuildCascadeLevel(mesh, coarse, _options.boundary);
        _ofVertex = Inherit(mesh, _ofVertex);
        _start = Interpolate(mesh, _start);
        auto const given = _widths.SampleLevel(_levels, _start);
        if (_level == 1 && !_options.isGraph && !_isAgain)
            WarnOfSharpCorners(_scene, _base, _rows,
                               given.empty() ? _widths.GetAtVertices() : given, _job);
        CheckInterrupted();
        bool const wasFrozen = !report.levels.empty() && report.levels.back().isMetricFrozen;
        report.levels.push_back(_cascade.Step(_rows, CountIterations(), Times(1.0 / _unit, given)));
        auto const& step = report.levels.back();
        if (step.isMetricFrozen && !wasFrozen) {
            _job.Warn(
                fmt::format("{}: from level {} on the filter keeps the metric of the level before: "
                            "its smallest angle would be {:.2g} degrees, its "
                            "smallest area {:.2g} of the mean. A smaller width, or less sharp "
                            "corners, avoid it",
                            _scene.path, _level, step.minAngleRadians * 180.0 / std::numbers::pi,
                            step.areaRatio));
        }
        if (_options.preservesVolume)
            RestoreVolumes(mesh, report);
        else if (!_options.isGraph)
            WatchRadii(report);
    }

    /// Adds to the equation a force along the normals that keeps the volume: (M + L) X = M (X0 + c
    /// sigma^2 / 2 n), with c per component. As that is linear in c, it takes one more solve.
    void RestoreVolumes(CascadeMesh const& mesh, SmoothReport& report) {
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
        report.volumes.clear();
        for (size_t component = 0; component < isMet.size(); ++component) {
            if (!_components.isClosed[component]) continue;
            report.volumes.push_back({_components.firstVertex[component], wanted[component],
                                      reached[component], isMet[component] != 0});
        }
    }

    void WatchRadii(SmoothReport& report) {
        auto const start = eval::FindMeanRadii(_start, _ofVertex, _components.count);
        auto const present =
            eval::FindMeanRadii(_cascade.GetPositions(), _ofVertex, _components.count);
        for (size_t component = 0; component < start.size(); ++component) {
            if (!_components.isClosed[component] || !(start[component] > 0.0)) continue;
            double const ratio = _unit * present[component] / start[component];
            if (ratio < report.shrinkage.radiusRatio)
                report.shrinkage = {_components.firstVertex[component], _level, ratio};
        }
    }

    Scene const& _scene;
    Far::TopologyLevel const& _base;
    FilterWidths const& _widths;
    SmoothOptions const& _options;
    bool _isAgain;
    Job& _job;
    SmoothComponents _components;
    std::vector<int> _ofVertex;
    std::vector<double> _start;  // the start surface on the present level
    SmoothLevels _levels;
    double _unit;  // of the cascade's lengths
    CascadeLevel _rows;
    eval::Cascade<Scalar> _cascade;
    int _level = 0;
    size_t _shown = 0;  // of the level's effort
};

constexpr double kMaxVertices = 10000.0;  // of a grid to measure the critical width on

/// Measures what factor on the widths the closed components carry.
double MeasureCriticalFactor(Scene const& scene, Far::TopologyLevel const& base,
                             FilterWidths const& widths, SmoothOptions const& options) {
    bool const isBisection = options.refinement == SmoothRefinement::Bisect;
    int maxLevels = isBisection ? 6 : 3;
    while (maxLevels > 1 &&
           base.GetNumVertices() * std::pow(isBisection ? 2.0 : 4.0, maxLevels) > kMaxVertices)
        --maxLevels;
    SmoothLevels levels(scene, maxLevels, options.refinement, options.keepsCreases);
    SmoothComponents const components(base);
    std::vector<int> ofVertex = components.ofVertex;
    std::vector<double> start = scene.positions;
    std::vector<CascadeLevel> rows;
    double const unit = FindUnit(scene);
    eval::CascadeWidths scaled;
    if (widths.IsConstant())
        scaled.constant = widths.GetConstant() / unit;
    else
        scaled.atVertices = Times(1.0 / unit, GetStartWidths(scene, widths));
    for (int level = 1; level <= maxLevels; ++level) {
        CascadeMesh const& mesh = levels.MakeNext();
        rows.push_back(far_ext::BuildCascadeLevel(
            mesh, rows.empty() ? std::vector<Index>{} : rows.back().vertices, options.boundary));
        ofVertex = Inherit(mesh, ofVertex);
        start = Interpolate(mesh, start);
        auto given = widths.SampleLevel(levels, start);
        if (!given.empty()) scaled.atLevels.push_back(Times(1.0 / unit, std::move(given)));
    }
    return eval::FindCriticalFactor(rows, Times(1.0 / unit, scene.positions), scaled, ofVertex,
                                    components.isClosed, CheckInterrupted);
}

Scene RunOnce(Scene const& scene, Far::TopologyLevel const& base, FilterWidths const& widths,
              SmoothOptions const& options, bool isAgain, Job& job, SmoothReport& report) {
    report = {};
    report.meanEdge = far_ext::FindMeanEdgeLength(base, scene.positions);
    report.largestWidth = widths.GetLargest();
    bool const isSingle = options.isSingle && options.solver == eval::CascadeSolver::Jacobi;
    return isSingle ? SmoothRun<float>(scene, base, widths, options, isAgain, job).Run(report)
                    : SmoothRun<double>(scene, base, widths, options, isAgain, job).Run(report);
}

}  // namespace

bool SmoothReport::HasConverged() const {
    return !hasCollapsed && std::all_of(levels.begin(), levels.end(),
                                        [](auto const& level) { return level.converged; });
}

Scene Smooth(Scene const& scene, Far::TopologyRefiner const& refiner, FilterWidths const& widths,
             SmoothOptions const& options, Job& job, SmoothReport& report) {
    auto const base = refiner.GetLevel(0);
    RefuseDefects(scene, base, job);
    if (double const unit = FindUnit(scene); widths.GetLargest() > kLargestWidth * unit) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: a filter width of {:.4g} is more than {:.0e} times the mesh's "
                                "size of about {:.4g}; give less",
                                scene.path, widths.GetLargest(), kLargestWidth, unit));
    }
    if (options.isGraph) RequireGraph(scene, base);
    Scene fine = RunOnce(scene, base, widths, options, false, job, report);
    // A sphere is at 0.72 of its radius where the width is 0.9 of the critical one. On a large mesh
    // it costs too much to be sure.
    constexpr double kSuspiciousRatio = 0.75;
    double const suspicious =
        4.0 * base.GetNumVertices() <= kMaxVertices ? kSuspiciousRatio : eval::kLeastRadiusRatio;
    if (report.shrinkage.radiusRatio < suspicious) {
        double const factor = MeasureCriticalFactor(scene, base, widths, options);
        report.hasCollapsed |= factor < 1.0;
        if (report.hasCollapsed && options.limitsWidth && factor > 0.0) {
            Index const vertex = report.shrinkage.firstVertex;
            double const limit =
                0.95 * factor;  // a fixed point near the critical width takes many levels
            fine = RunOnce(scene, base, widths.Scaled(limit), options, true, job, report);
            report.limitedBy = limit;
            job.Warn(
                fmt::format("{}: the width was reduced to {:.4g} of what was asked for; the "
                            "component of vertex {} carries {:.4g}",
                            scene.path, limit, vertex, factor));
        }
        report.criticalFactor = factor;
        if (report.hasCollapsed && !options.keepsResult) fine = {};
    }
    for (SmoothVolume const& volume : report.volumes) {
        if (!volume.isMet) {
            job.Warn(fmt::format(
                "{}: the component of vertex {} could not keep its volume: {:.6g} of {:.6g}",
                scene.path, volume.firstVertex, volume.end, volume.start));
        }
    }
    return fine;
}

}  // namespace limn::engine
