// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <Eigen/Core>
#include <fmt/format.h>

#include "engine/io/mesh_writer.h"
#include "engine/scene/refine.h"
#include "engine/scene/require_limit.h"
#include "engine/scene/scene_checks.h"
#include "eval/fit/alpha_steps.h"
#include "eval/surface/vertex_limits.h"
#include "far_ext/error.h"
#include "far_ext/option_checks.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/refiner.h"

namespace limn::engine {

namespace {

using AlphaRule = far_ext::LimitOptions::AlphaRule;

/// One step of generalised Catmull-Clark. A vertex's child has its own number (OpenSubdiv's order).
Scene RefineWithAlpha(Model const& control, double alpha, Job& job) {
    eval::AlphaSteps const steps(control.GetRefiner(), 0, alpha);
    Scene fine = RefineUniformly(control, {.levels = 1}, job);
    steps.Add(0, control.GetPositions(), 3, fine.positions);
    for (size_t i = 0; i < control.GetPrimvars().size(); ++i) {
        auto const& from = control.GetPrimvars()[i];
        std::vector<double> const values(from.values.begin(), from.values.end());
        std::vector<double> children(fine.primvars[i].values.begin(),
                                     fine.primvars[i].values.end());
        steps.Add(0, values, from.numChannels, children);
        std::transform(children.begin(), children.end(), fine.primvars[i].values.begin(),
                       [](double x) { return static_cast<float>(x); });
    }
    return fine;
}

constexpr double kLeft = 0.01;  // of the tolerance: how well the certificate is known

/// Refinements towards a vertex that leave a hundredth of the tolerance: each brings the place
/// evaluated nearer by 1/2, at vertices of high valence only by 0.66.
int ChooseDepth(Scene const& mesh, double size, double tolerance) {
    auto const& cage = mesh.cage;
    double longest = 0.0;
    size_t corner = 0;
    far_ext::Points const points(mesh.positions);
    auto const point = [&](size_t k) { return points[cage.faceVertices[k]]; };
    for (int faceSize : cage.faceSizes) {
        size_t const n = faceSize;
        for (size_t i = 0; i < n; ++i)
            longest = std::max(longest, (point(corner + i) - point(corner + (i + 1) % n)).norm());
        corner += n;
    }
    double const share = longest / size / (kLeft * tolerance);
    return std::clamp(static_cast<int>(std::ceil(1.7 * std::log2(std::max(share, 1.0)))), 8,
                      eval::FaceTree::kLimitDepth);
}

/// \param reached   limits, those of the data's vertices first
/// \param hasLimit  per vertex
Certificate JudgeMisses(std::vector<double> const& reached, std::vector<char> const& hasLimit,
                        std::span<double const> data, double tolerance) {
    double const size = eval::FindSize(data, 3);
    Certificate certificate;
    double sum = 0.0;
    far_ext::Points const limits(reached), wanted(data);
    size_t count = 0;
    for (size_t i = 0; i < wanted.GetCount(); ++i) {
        if (!hasLimit[i]) continue;  // alpha moves it all the same
        ++count;
        double const miss = (limits[i] - wanted[i]).norm() / size;
        sum += miss * miss;
        if (miss <= certificate.max && certificate.worstVertex >= 0) continue;
        certificate.max = miss;
        certificate.worstVertex = static_cast<Index>(i);
    }
    certificate.rms = std::sqrt(sum / static_cast<double>(std::max<size_t>(count, 1)));
    certificate.isMet = certificate.max <= (1.0 + kLeft) * tolerance;
    return certificate;
}

/// The limit's points as OpenSubdiv has them.
eval::VertexLimits FindFarLimits(FarReport const& report, std::span<Index const> vertices,
                                 std::vector<double> const& positions) {
    eval::VertexLimits limits{positions, std::vector<char>(positions.size() / 3, 0)};
    auto const& values = report.far.values;
    for (size_t i = 0; i < vertices.size(); ++i) {
        if (!values.hasLimit[i]) continue;
        limits.hasLimit[vertices[i]] = 1;
        std::copy_n(&values.positions[3 * i], 3, &limits.values[3 * vertices[i]]);
    }
    return limits;
}

/// Vertices whose limits are found without A, by refining towards them: all of a small mesh, of a
/// large one so many, spread evenly, and the one that A's rows find worst.
std::vector<Index> ChooseWitnesses(Index numVertices, Index worst) {
    constexpr Index kMostWitnesses = 4096;
    Index const step = numVertices / kMostWitnesses + 1;
    std::vector<Index> witnesses;
    for (Index vertex = 0; vertex < numVertices; vertex += step) witnesses.push_back(vertex);
    if (worst >= 0 && worst % step != 0) witnesses.push_back(worst);
    return witnesses;
}

/// \param mesh     whose vertex i, for those of `data`, must have its limit at the data
/// \param refiner  the mesh's
Certificate Certify(Scene const& mesh, Far::TopologyRefiner const& refiner,
                    std::span<double const> data, FitOptions const& options, Job& job,
                    FitResult& result) {
    job.Start("certifying");
    if (options.farLimit) {
        PlaceList places;
        Model const model = Model::Build(mesh);
        auto const vertices = AddVertexPlaces(model, places);
        result.far =
            CompareFarLimit(model, std::move(places), *options.farLimit, Orientation::Right, job);
        auto const limits = FindFarLimits(*result.far, vertices, mesh.positions);
        return JudgeMisses(limits.values, limits.hasLimit, data, options.tolerance);
    }
    auto const check = [&] { job.CheckStopped(); };
    auto limits = eval::FindVertexLimits(refiner, 0, mesh.positions, 3, check);
    Index const worst =
        JudgeMisses(limits.values, limits.hasLimit, data, options.tolerance).worstVertex;
    eval::LimitSurface const surface(refiner);
    eval::EvaluateVertexLimitsAt(
        ChooseWitnesses(refiner.GetLevel(0).GetNumVertices(), worst), surface, mesh.positions, 3,
        limits, ChooseDepth(mesh, eval::FindSize(data, 3), options.tolerance), check);
    return JudgeMisses(limits.values, limits.hasLimit, data, options.tolerance);
}

/// Per vertex: some face round it has a limit.
std::vector<char> FindVerticesWithLimit(Far::TopologyLevel const& level) {
    std::vector<char> hasLimit(static_cast<size_t>(level.GetNumVertices()));
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        auto const faces = level.GetVertexFaces(vertex);
        hasLimit[vertex] = std::any_of(faces.begin(), faces.end(),
                                       [&](Index face) { return !level.IsFaceHole(face); });
    }
    return hasLimit;
}

/// The same of a control mesh of the scheme with alpha in all steps.
Certificate CertifyStationary(Scene const& mesh, Model const& data, FitOptions const& options,
                              Job& job) {
    job.Start("certifying");
    Scene const fine = RefineUniformly(Model::Build(mesh),
                                       {.levels = 1, .toLimit = true, .alpha = options.alpha}, job);
    return JudgeMisses(fine.positions, FindVerticesWithLimit(data.GetLevel()), data.GetPositions(),
                       options.tolerance);
}

/// Turns the result's control mesh, in double, into what the file will hold, and certifies that.
void RoundAndCertify(Precision precision, Model const& model, FitOptions const& options, Job& job,
                     FitResult& result) {
    result.precision = precision;
    auto const round = [&] {
        if (options.target) RoundAsWritten(options.target->path, precision, result.mesh.positions);
    };
    auto const certify = [&](Scene const& mesh, Far::TopologyRefiner const& refiner) {
        return Certify(mesh, refiner, model.GetPositions(), options, job, result);
    };
    if (options.alpha == 0.0) {
        round();
        result.certificate = certify(result.mesh, model.GetRefiner());
        return;
    }
    if (options.alphaRule == AlphaRule::Stationary) {
        round();
        result.certificate = CertifyStationary(result.mesh, model, options, job);
        return;
    }
    if (options.keepsTopology) round();
    Scene fine = RefineWithAlpha(Model::Build(result.mesh), options.alpha, job);
    if (!options.keepsTopology) {
        std::swap(result.mesh, fine);
        round();
    }
    Scene const& limit = options.keepsTopology ? fine : result.mesh;
    result.certificate = certify(limit, *far_ext::CreateRefiner(limit.cage));
}

/// The same in the precision of the file. Floats that nobody has asked for give way to doubles
/// where only these meet the tolerance.
void Finish(Model const& model, FitOptions const& options, Job& job, FitResult& result) {
    if (!options.target) return RoundAndCertify(Precision::Double, model, options, job, result);
    MeshTarget const& target = *options.target;
    Precision const precision = ChoosePrecision(target, FindExtent(result.mesh.positions), job,
                                                std::min(options.tolerance, kMostRounded));
    bool const mayGiveWay = precision == Precision::Float && !target.precision;
    Scene const control = mayGiveWay ? result.mesh : Scene{};
    RoundAndCertify(precision, model, options, job, result);
    if (!mayGiveWay || !result.report.converged || result.certificate.isMet) return;

    Certificate const inFloats = result.certificate;
    result.mesh = control;
    RoundAndCertify(Precision::Double, model, options, job, result);
    job.Warn(
        fmt::format("{}: in double, for in floats its limit misses vertex {} by {:.3g} of the "
                    "diagonal; the tolerance is {:.2g}",
                    target.path, inFloats.worstVertex, inFloats.max, options.tolerance));
}

/// Solves for primvars as for positions.
void FitPrimvars(eval::Interpolator const& interpolator, eval::InterpolateOptions const& solve,
                 Job& job, FitResult& result) {
    for (Primvar& primvar : result.mesh.primvars) {
        std::vector<double> const data(primvar.values.begin(), primvar.values.end());
        std::vector<double> fitted(data.size());
        job.Start("solving for " + primvar.name);
        auto const report = NamingMesh(
            fmt::format("{}: primvar '{}'", result.mesh.path, primvar.name),
            [&] { return interpolator.Solve(data, primvar.numChannels, fitted, solve); });
        result.primvars.push_back(report);
        std::transform(fitted.begin(), fitted.end(), primvar.values.begin(),
                       [](double x) { return static_cast<float>(x); });
    }
}

/// A mesh that grew shows an eigenvalue that the estimate missed where A is not symmetric: A takes
/// it to data so much smaller.
void MeasureGrowth(Model const& model, FitResult& result) {
    result.growth = FindGrowth(FindExtent(model.GetPositions()), FindExtent(result.mesh.positions));
    if (result.growth > kMostGrown)
        result.lambdaMin = std::min(result.lambdaMin, 1.0 / result.growth);
}

/// Where A is nearly singular its inverse multiplies what alternates from vertex to vertex.
void WarnOfGrowth(Model const& model, FitResult const& result, Job& job) {
    if (!(result.growth > kMostGrown) || result.HasRunAway()) return;
    job.Warn(
        fmt::format("{}: the control mesh reaches {:.3g} times as far as the vertices that its "
                    "limit passes through, for the smallest eigenvalue of the limit matrix is "
                    "about {:.2g}; `alpha` 0.5 keeps it nearer",
                    model.GetPath(), result.growth, result.lambdaMin));
}

}  // namespace

void FitOptions::Check() const {
    RequireKnown(eval::kSolveMethodWords, method);
    RequireEnumerator("alphaRule", alphaRule, AlphaRule::Stationary);
    RequireAboveZero("tolerance", tolerance);
    RequireAtLeast("maxIterations", maxIterations, 1);
    if (target) RequireMeshEnding(target->path);
    if (evaluator && method == eval::SolveMethod::Direct) {
        throw Error(ErrorCode::BadOption,
                    "`evaluator` and `method` direct exclude each other: a factorisation applies "
                    "no table");
    }
}

bool FitResult::HasRunAway() const {
    constexpr double kMost = 1e8;  // about 1 / sqrt(epsilon): half of double's digits are lost
    return !(growth <= kMost);
}

bool FitResult::HasConverged() const {
    return report.converged && certificate.isMet && !HasRunAway() &&
           std::all_of(primvars.begin(), primvars.end(),
                       [](auto const& primvar) { return primvar.converged; });
}

FitResult FitToLimit(Model const& model, FitOptions const& options, Job& job) {
    options.Check();
    auto const start = std::chrono::steady_clock::now();
    if (options.alpha == 0.0) RequireLimit(model);  // else n-gons are subdivided first
    job.Start("building the limit matrix");
    eval::Interpolator const interpolator(model.GetRefiner(), 0,
                                          {.alpha = options.alpha, .alphaRule = options.alphaRule});
    std::optional<eval::FixedTable> table;
    if (options.evaluator) table = interpolator.MakeTable(*options.evaluator);
    eval::InterpolateOptions const solve{.method = options.method,
                                         .tolerance = options.tolerance,
                                         .maxIterations = options.maxIterations,
                                         .onIteration = [&](int, double) { job.CheckStopped(); },
                                         .table = table ? &*table : nullptr};
    FitResult result;
    result.mesh = model.MakeScene();
    job.Start("solving for positions");
    result.report = interpolator.Solve(model.GetPositions(), 3, result.mesh.positions, solve);
    FitPrimvars(interpolator, solve, job, result);
    std::chrono::duration<double> const elapsed = std::chrono::steady_clock::now() - start;
    result.solveSeconds = elapsed.count();
    job.Note(fmt::format("method {}: {} applications of the limit matrix, residual {:.2g}",
                         GetName(result.report.method), result.report.iterations,
                         result.report.residual));
    job.Start("estimating the smallest eigenvalue");
    result.lambdaMin =
        result.report.singularComponents.empty() ? interpolator.EstimateSmallestEigenvalue() : 0.0;
    Finish(model, options, job, result);
    MeasureGrowth(model, result);
    WarnOfGrowth(model, result, job);
    return result;
}

}  // namespace limn::engine
