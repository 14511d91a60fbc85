// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/differential.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "engine/scene/refine.h"
#include "eval/differential/area_fit.h"
#include "eval/differential/dirmag.h"
#include "eval/differential/reconstruct.h"
#include "eval/differential/value_refiner.h"
#include "far_ext/differential/laplacian.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/boundary.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;
using Rows = std::vector<double>;

/// Adds the time that it lives for.
class StageClock {
public:
    explicit StageClock(double& seconds) : _seconds(seconds) {}
    StageClock(StageClock const&) = delete;
    StageClock& operator=(StageClock const&) = delete;
    ~StageClock() { _seconds += std::chrono::duration<double>(Clock::now() - _start).count(); }

private:
    using Clock = std::chrono::steady_clock;

    double& _seconds;
    Clock::time_point const _start = Clock::now();
};

/// A boundary vertex has no mean curvature of its own; it takes the mean of its inner neighbours'.
void ExtendToBoundary(Level const& level, Rows& deltas) {
    far_ext::MutablePoints const points(deltas);
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (!level.IsVertexBoundary(vertex)) continue;
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        int count = 0;
        for (Index edge : level.GetVertexEdges(vertex)) {
            Index const other = far_ext::GetOtherEnd(level, edge, vertex);
            if (level.IsVertexBoundary(other)) continue;
            sum += points[other];
            ++count;
        }
        points[vertex] = sum / std::max(1, count);
    }
}

/// The angle between two directions.
double FindDegrees(Eigen::Vector3d const& a, Eigen::Vector3d const& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::acos(-1.0);
}

double FindSize(Rows const& positions) {
    double mean[3] = {0, 0, 0}, sum = 0.0, count = static_cast<double>(positions.size()) / 3.0;
    for (size_t i = 0; i < positions.size(); ++i) mean[i % 3] += positions[i] / count;
    for (size_t i = 0; i < positions.size(); ++i)
        sum += (positions[i] - mean[i % 3]) * (positions[i] - mean[i % 3]);
    return std::sqrt(sum / count);
}

class DifferentialRefinement {
public:
    DifferentialRefinement(Model const& model, DifferentialOptions const& options, Job& job)
        : _model(model), _options(options), _job(job), _spatial(model.GetPositions()) {
        job.Start("refining topology");
        far_ext::ControlMesh curved = model.GetCage();
        curved.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        _refiner = MakeUniformRefiner(curved, model.GetPath(), options.levels);
        _values.emplace(*_refiner, options.evaluator);
    }

    DifferentialResult Run();

private:
    void CheckSize() const;
    Level GetStart() const { return _refiner->GetLevel(_options.spatialLevels); }
    Level GetLast() const { return _refiner->GetLevel(_refiner->GetMaxLevel()); }

    Rows FindAreaDeltas(Rows const& positions) const;
    Rows FindStartDeltas(Laplacian laplacian);
    Rows FindPositions();
    Rows Subdivide(Rows deltas);
    void RefineInSpace();
    Rows Reconstruct(Rows const& deltas, Rows const& areaDeltas);
    void Measure(Rows const& positions);
    void FitAreas(eval::Reconstructor& reconstructor, Rows const& deltas, Rows& positions);

    Model const& _model;
    DifferentialOptions const& _options;
    Job& _job;
    DifferentialReport _report;
    std::unique_ptr<Far::TopologyRefiner> _refiner;
    std::optional<eval::ValueRefiner> _values;
    Rows _spatial;  // positions of the level reached in space
    Rows _start;    // those where differential coordinates begin
};

Rows DifferentialRefinement::FindAreaDeltas(Rows const& positions) const {
    auto const laplacian = _options.laplacian == Laplacian::Mesh
                               ? far_ext::BuildHeatLaplacian(GetStart(), positions)
                               : far_ext::BuildCotangentLaplacian(GetStart(), positions);
    Rows deltas = far_ext::FindDeltas(laplacian.rows, positions);
    for (size_t i = 0; i < deltas.size(); ++i) deltas[i] /= laplacian.areas[i / 3];
    ExtendToBoundary(GetStart(), deltas);
    return deltas;
}

/// Coordinates of the start level, edited. Those by areas are twice the mean curvature.
Rows DifferentialRefinement::FindStartDeltas(Laplacian laplacian) {
    StageClock const clock(_report.seconds.coordinates);
    bool const knowsAreas = laplacian != Laplacian::Combinatorial;
    Rows deltas =
        knowsAreas ? FindAreaDeltas(_start)
                   : far_ext::FindDeltas(far_ext::BuildCombinatorialLaplacian(GetStart()), _start);
    auto const lengths =
        knowsAreas ? Rows(deltas.size() / 3, 2.0) : FindCombinatorialLengths(GetStart(), _start);
    _report.edits.clear();
    for (EditTarget const& target :
         ApplyEdit(_options.edit, {GetStart(), _start, lengths, _options.orientation},
                   _model.GetPath(), deltas))
        _report.edits.push_back({target});
    return deltas;
}

/// Takes coordinates of the start level to the last.
Rows DifferentialRefinement::Subdivide(Rows deltas) {
    StageClock const clock(_report.seconds.subdivision);
    int level = _options.spatialLevels;
    auto split = eval::SplitDirMag(GetStart(), _start, deltas);
    _report.tangentialShare = split.tangentialShare;
    if (_options.dirMagLevels > 0) {
        for (int end = level + _options.dirMagLevels; level < end; ++level) {
            _job.CheckStopped();
            split = eval::SubdivideDirMag(
                far_ext::BuildSubdivisionRows(*_refiner, level + 1, _options.rule), split);
        }
        deltas = eval::JoinDirMag(split);
    }
    for (; level < _refiner->GetMaxLevel(); ++level) {
        _job.CheckStopped();
        deltas = _values->Refine<3>(level + 1, deltas, _options.rule);
    }
    return deltas;
}

void DifferentialRefinement::RefineInSpace() {
    StageClock const clock(_report.seconds.subdivision);
    _start = _spatial;
    for (int level = 1; level <= _refiner->GetMaxLevel(); ++level) {
        _job.CheckStopped();
        _spatial = _values->Refine<3>(level, _spatial, _options.rule);
        if (level == _options.spatialLevels) _start = _spatial;
    }
}

void DifferentialRefinement::FitAreas(eval::Reconstructor& reconstructor, Rows const& deltas,
                                      Rows& positions) {
    auto const kind = _options.laplacian == Laplacian::Mesh ? eval::AreaLaplacianKind::Heat
                                                            : eval::AreaLaplacianKind::Cotangent;
    auto const fit = eval::FitAreaLaplacian(
        *_refiner, reconstructor.GetMultigrid(), kind, deltas, positions,
        {.tolerance = _options.fitTolerance, .onWork = [&] { _job.CheckStopped(); }});
    _report.iterations += fit.iterations;
    _report.residual = fit.residual;
    _report.rounding = 0.0;
    _report.converged = fit.converged;
    _report.fitSteps = fit.steps;
    _report.hasFitStalled = fit.hasStalled && !fit.converged;
}

Rows DifferentialRefinement::Reconstruct(Rows const& deltas, Rows const& areaDeltas) {
    StageClock const clock(_report.seconds.reconstruction);
    Rows positions = _spatial;
    bool const isCholesky = _options.solver == DifferentialSolver::Cholesky;
    _job.Start(isCholesky ? "factorising" : "building levels");
    eval::Reconstructor reconstructor(*_refiner, _options.handles,
                                      isCholesky ? _refiner->GetMaxLevel() : 0);
    _job.Start("solving");
    auto const solve = reconstructor.Solve(deltas, positions, {.tolerance = _options.tolerance});
    _report.unknowns = reconstructor.GetMultigrid().GetLevels().back().numUnknowns;
    _report.iterations = solve.iterations;
    _report.residual = solve.residual;
    _report.rounding = solve.rounding;
    _report.compatibilityDefect = solve.compatibilityDefect;
    _report.converged = solve.converged;
    if (!areaDeltas.empty()) FitAreas(reconstructor, areaDeltas, positions);
    return positions;
}

/// What the mesh as it is written has of size, energy and edits.
void DifferentialRefinement::Measure(Rows const& positions) {
    _job.Start("measuring energy");
    double const size = FindSize(_spatial);
    _report.sizeRatio = size > 0.0 ? FindSize(positions) / size : 1.0;
    auto const curvature = eval::MeasureMeshCurvature(GetLast(), positions, _options.orientation);
    _report.energy = eval::FindThinPlateEnergy(curvature);
    if (_report.edits.empty()) return;
    Rows const normals = eval::FindAngleNormals(GetLast(), positions);
    for (auto& [target, reached] : _report.edits) {
        auto const vertex = static_cast<size_t>(target.vertex);
        if (auto const* const asked = std::get_if<std::array<double, 3>>(&target.asked)) {
            Eigen::Vector3d const normal =
                GetSign(_options.orientation) * far_ext::Points(normals)[vertex];
            reached = FindDegrees(normal, Eigen::Vector3d(asked->data()));
        } else if (curvature.areas[vertex] > 0.0) {
            reached = curvature.GetMean(vertex);
        }
    }
}

Rows DifferentialRefinement::FindPositions() {
    _job.Start("subdividing coordinates");
    RefineInSpace();
    Rows deltas = Subdivide(FindStartDeltas(Laplacian::Combinatorial)), areaDeltas;
    double const scale = std::pow(0.25, _refiner->GetMaxLevel() - _options.spatialLevels);
    for (double& delta : deltas) delta *= scale;
    if (_options.laplacian != Laplacian::Combinatorial)
        areaDeltas = Subdivide(FindStartDeltas(_options.laplacian));

    _job.CheckStopped();
    Rows positions = Reconstruct(deltas, areaDeltas);
    if (_options.target) {
        _report.precision = ChoosePrecision(*_options.target, FindExtent(positions), _job);
        RoundAsWritten(_options.target->path, _report.precision, positions);
    }
    Measure(positions);
    return positions;
}

/// The mesh Laplace operator joins each vertex to some 200 others.
void DifferentialRefinement::CheckSize() const {
    constexpr Index kMost = 20000;
    Index const numVertices = GetLast().GetNumVertices();
    if (_options.laplacian != Laplacian::Mesh || numVertices <= kMost) return;
    throw Error(
        ErrorCode::TooLarge,
        fmt::format("`laplacian` mesh: the result has {} vertices, and for more than {} this "
                    "Laplacian takes many minutes; use cotangent",
                    numVertices, kMost));
}

DifferentialResult DifferentialRefinement::Run() {
    CheckSize();
    Scene fine = RefineAllButPositions(_model, *_values, _job);
    fine.positions = FindPositions();
    return {std::move(fine), _report};
}

void CheckOptions(Model const& model, DifferentialOptions const& options) {
    far_ext::CheckTension(options.rule);
    if (options.spatialLevels + options.dirMagLevels > options.levels) {
        throw Error(
            ErrorCode::BadOption,
            fmt::format("`levels` {} holds no {} levels in space and {} by direction and magnitude",
                        options.levels, options.spatialLevels, options.dirMagLevels));
    }
    if (options.laplacian != Laplacian::Combinatorial &&
        options.solver == DifferentialSolver::Cholesky) {
        throw Error(
            ErrorCode::BadOption,
            "`solver` cholesky: only the combinatorial Laplacian stays the same from step to step; "
            "use multigrid");
    }
    Index const numVertices = model.GetCage().numVertices;
    auto const check = [&](Index vertex) {
        if (vertex >= 0 && vertex < numVertices) return;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: the edit names vertex {}; there are 0 to {}", model.GetPath(),
                                vertex, numVertices - 1));
    };
    for (Index vertex : options.edit.ListVertices()) check(vertex);
}

/// The combinatorial Laplacian takes edges at a vertex for equally long and evenly spread.
void WarnOfMissedMeans(DifferentialOptions const& options, DifferentialReport const& report,
                       Job& job) {
    constexpr double kMissed = 0.2;
    if (options.laplacian != Laplacian::Combinatorial) return;
    for (auto const& [target, reached] : report.edits) {
        auto const* const asked = std::get_if<double>(&target.asked);
        if (!asked || !reached || std::abs(*reached - *asked) <= kMissed * std::abs(*asked))
            continue;
        job.Warn(fmt::format(
            "vertex {}: mean curvature {:.3g} was asked for and {:.3g} reached: "
            "the combinatorial Laplacian sees no lengths, so that uneven edges, "
            "and neighbours' curvature, change what comes out; the report has all vertices",
            target.vertex, *asked, *reached));
        return;
    }
}

void Warn(Model const& model, DifferentialOptions const& options, DifferentialReport const& report,
          Job& job) {
    if (!model.GetCage().creaseSharpness.empty()) {
        job.Warn(
            "creases get round: differential coordinates hold no tangents; refine this mesh in "
            "space");
    }
    if (report.tangentialShare > eval::kDirMagLimit && options.dirMagLevels > 0) {
        job.Warn(
            fmt::format("tangential parts are {:.2f} of the differential coordinates, more than "
                        "{}: `dirMagLevels` "
                        "takes them for normals; leave it out",
                        report.tangentialShare, eval::kDirMagLimit));
    }
    WarnOfMissedMeans(options, report, job);
    if (std::abs(report.sizeRatio - 1.0) > 0.1) {
        bool const isScaled = !options.edit.factors.empty();
        job.Warn(fmt::format("the result has {:.2f} times the size of the spatial refinement; {}",
                             report.sizeRatio,
                             isScaled ? "factors of the `edit` that are nearer to 1 change it less"
                                      : "`spatialLevels` 1 brings coarse cages nearer"));
    }
}

}  // namespace

DifferentialResult RefineDifferentially(Model const& model, DifferentialOptions const& options,
                                        Job& job) {
    CheckOptions(model, options);
    WarnOfRoughVertices(model, options.rule, job);
    DifferentialResult result = DifferentialRefinement(model, options, job).Run();
    Warn(model, options, result.report, job);
    return result;
}

}  // namespace limn::engine
