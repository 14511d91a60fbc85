// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/interpolate.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "eval/fit/decompose.h"
#include "eval/fit/limit_application.h"
#include "eval/parallel/rows.h"
#include "far_ext/error.h"
#include "far_ext/rows/large_array.h"

namespace limn::eval {

namespace {

/// Where neither valences nor the caller give a bound. Valence-3 vertices among others hardly go
/// below it, and Chebyshev lowers it where they do.
constexpr double kUsualLambda = 0.09;

/// Below this conjugate gradients, which adapt to a few small eigenvalues, are faster than
/// Chebyshev.
constexpr double kSmallLambda = 0.03;

/// A bound from valences that is as good as the eigenvalue: 1/9 is that of regular quads.
constexpr double kSharpBound = 0.11;

/// Up to so many vertices the eigenvalue is estimated first; it takes milliseconds, and saves
/// steps.
constexpr Index kMaxEstimated = 50000;

/// Up to so many unknowns a factorisation is tried where nothing else converges: 10 s, 0.3 GB.
constexpr Index kMaxFactorised = 200000;

void Validate(LimitOperator const& A, std::span<double const> M, int length, std::span<double> P,
              InterpolateOptions const& options) {
    size_t const count =
        static_cast<size_t>(A.GetNumVertices()) * static_cast<size_t>(std::max(length, 0));
    if (length < 1 || M.size() != count || P.size() != count) {
        throw Error(
            ErrorCode::BadOption,
            "interpolation: data and solution need as many numbers per vertex as the length says");
    }
    if (!(options.tolerance > 0.0))
        throw Error(ErrorCode::BadOption, "interpolation: the tolerance must be above 0");
    if (options.maxIterations < 1)
        throw Error(ErrorCode::BadOption, "interpolation: at least one iteration is needed");
    RequireFinite(M, length);
}

/// Numbers without pattern, the same everywhere.
std::vector<double> MakeNoise(size_t count) {
    std::vector<double> noise(count);
    uint64_t state = 0x9e3779b97f4a7c15u;
    for (double& value : noise) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        value = static_cast<double>(state >> 11) * 0x1p-52 - 1.0;
    }
    return noise;
}

void Join(SolveReport& report, SolveReport const& block) {
    bool const isWorst =
        report.method == SolveMethod::Automatic || block.residual > report.residual;
    if (isWorst) {
        report.method = block.method;
        report.residual = block.residual;
        report.worstVertex = block.worstVertex;
        report.history = block.history;
    }
    report.iterations = std::max(report.iterations, block.iterations);
    report.converged &= block.converged;
    if (report.lambdaMin == 0.0 || (block.lambdaMin > 0.0 && block.lambdaMin < report.lambdaMin))
        report.lambdaMin = block.lambdaMin;
    for (size_t i = 0; i < block.singularComponents.size(); ++i) {
        if (report.singularComponents.size() <= i)
            report.singularComponents.push_back(block.singularComponents[i]);
        auto& known = report.singularComponents[i];
        known.defect = std::max(known.defect, block.singularComponents[i].defect);
        known.isSolved &= block.singularComponents[i].isSolved;
    }
}

/// Channels `first` to `first` + count of rows of `length`, 1 to 4 of them: rows[i] =
/// values[vertices[i]].
void Gather(std::span<double const> values, int length, int first, int count,
            std::vector<Index> const& vertices, std::span<double> rows) {
    size_t const stride = length;
    WithLength(count, [&]<int Count>() {
        ForEachRow(static_cast<Index>(vertices.size()), [&](Index row) {
            double const* const from = &values[vertices[row] * stride + first];
            DoubleRow<Count>::Load(from, 0).Store(rows.data(), row);
        });
    });
}

/// The reverse.
void Scatter(std::span<double const> rows, int length, int first, int count,
             std::vector<Index> const& vertices, std::span<double> values) {
    size_t const stride = length;
    WithLength(count, [&]<int Count>() {
        ForEachRow(static_cast<Index>(vertices.size()), [&](Index row) {
            double* const to = &values[vertices[row] * stride + first];
            DoubleRow<Count>::Load(rows.data(), row).Store(to, 0);
        });
    });
}

/// Calls work(first, count) for blocks of at most four channels.
template <class Work>
void ForEachBlockOfChannels(int length, Work const& work) {
    constexpr int kMaxBlock = 4;
    for (int first = 0; first < length; first += kMaxBlock)
        work(first, std::min(kMaxBlock, length - first));
}

}  // namespace

double FindSize(std::span<double const> values, int length) {
    if (values.empty()) return 1.0;
    size_t const n = length;
    std::vector<double> low(values.begin(), values.begin() + length), high(low);
    for (size_t i = n; i < values.size(); i += n) {
        for (size_t c = 0; c < n; ++c) {
            low[c] = std::min(low[c], values[i + c]);
            high[c] = std::max(high[c], values[i + c]);
        }
    }
    double square = 0.0;
    for (size_t c = 0; c < n; ++c) square += (high[c] - low[c]) * (high[c] - low[c]);
    return square > 0.0 ? std::sqrt(square) : 1.0;
}

Interpolator::Interpolator(Far::TopologyRefiner const& refiner, int level,
                           far_ext::LimitOptions const& options)
    : _operator(LimitOperator::Build(refiner, level, options).Reorder(_vertices)),
      _singular(_operator) {}

std::vector<double> Interpolator::FindLimits(std::span<double const> values, int length) const {
    std::vector<double> result(values.size());
    ForEachBlockOfChannels(length, [&](int first, int count) {
        far_ext::LargeArray<double> rows(_vertices.size() * count), limits(rows.size());
        Gather(values, length, first, count, _vertices, rows);
        _operator.Apply(rows, count, limits);
        Scatter(limits, length, first, count, _vertices, result);
    });
    return result;
}

FixedTable Interpolator::MakeTable(TableEvaluator& evaluator) const {
    far_ext::StencilRows rows(_operator.GetNumVertices(), 1);
    for (Index row = 0; row < _operator.GetNumVertices(); ++row) {
        _operator.ForEachEntry(row, [&](Index column, double weight) {
            auto const rounded = static_cast<float>(weight);
            rows.AddEntry(column, &rounded);
        });
        rows.EndRow();
    }
    return evaluator.Make(LimitApplication::kTable, std::move(rows));
}

SolveReport Interpolator::Solve(std::span<double const> M, int length, std::span<double> P,
                                InterpolateOptions const& options) const {
    Validate(_operator, M, length, P, options);
    SolveReport report;
    report.converged = true;
    double const size = FindSize(M, length);
    ForEachBlockOfChannels(length, [&](int first, int count) {
        far_ext::LargeArray<double> data(_vertices.size() * count),
            own(count < length ? data.size() : 0);
        std::span<double> const solution =
            count < length ? std::span<double>(own) : P;  // P serves as memory until the end
        Gather(M, length, first, count, _vertices, data);
        std::copy(data.begin(), data.end(), solution.begin());
        LimitProblem problem{_operator,
                             count,
                             data.data(),
                             solution.data(),
                             size,
                             options.tolerance,
                             options.maxIterations,
                             options.onIteration,
                             options.table};
        Join(report, SolveBlock(problem, options));
        std::copy(solution.begin(), solution.end(), data.begin());
        Scatter(data, length, first, count, _vertices, P);
    });
    if (report.worstVertex >= 0) report.worstVertex = _vertices[report.worstVertex];
    return report;
}

Index Interpolator::FindFirstVertex(SingularComponents::Component const& component) const {
    Index first = _vertices[component.vertices.front()];
    for (Index row : component.vertices) first = std::min(first, _vertices[row]);
    return first;
}

double Interpolator::ChooseLambda(InterpolateOptions const& options) const {
    if (options.lambdaMin > 0.0) return options.lambdaMin;
    double const bound = _operator.GetEigenvalueBound();
    if (options.method == SolveMethod::Progressive ||
        options.method == SolveMethod::ConjugateGradients ||
        options.method == SolveMethod::Direct || bound >= kSharpBound) {
        return std::max(bound, kSmallLambda);
    }
    if (_operator.GetNumVertices() > kMaxEstimated) return std::max(bound, kUsualLambda);
    return std::max(EstimateSmallestEigenvalue(), kSmallLambda);
}

/// Chooses and runs methods; `used` receives the last one.
IterationResult Interpolator::Run(LimitProblem const& problem, InterpolateOptions const& options,
                                  SolveMethod& used) const {
    bool const isAutomatic = options.method == SolveMethod::Automatic;
    double const lambda = std::min(ChooseLambda(options), 0.9);
    std::vector<Index> pinned;
    for (auto const& component : _singular.Get()) pinned.push_back(component.vertices.front());
    used = isAutomatic ? SolveMethod::Chebyshev : options.method;
    switch (used) {
        case SolveMethod::Progressive:
            return RunStationary(problem, StationaryMethod::Progressive, lambda);
        case SolveMethod::Weighted:
            return RunStationary(problem, StationaryMethod::Weighted, lambda);
        case SolveMethod::ConjugateGradients:
            return RunConjugateGradients(problem);
        case SolveMethod::Direct:
            return SolveDirectly(problem, pinned);
        default:
            break;
    }
    IterationResult result = RunStationary(problem, StationaryMethod::Chebyshev, lambda,
                                           isAutomatic ? kSmallLambda : 1e-6);
    auto const goOn = [&](SolveMethod method, auto const& run) {
        used = method;
        // What diverged is no start.
        if (!(result.residual < 1.0))
            std::copy_n(problem.data,
                        static_cast<size_t>(_operator.GetNumVertices()) * problem.length,
                        problem.solution);
        if (!(result.residual < 1.0)) SolveCurves(problem);
        IterationResult next = run();
        result.history.insert(result.history.end(), next.history.begin(), next.history.end());
        next.history = std::move(result.history);
        next.applications += result.applications;
        result = std::move(next);
    };
    if (isAutomatic && result.isStuck && result.applications < problem.maxApplications) {
        LimitProblem rest = problem;
        rest.maxApplications -= result.applications;
        goOn(SolveMethod::ConjugateGradients, [&] { return RunConjugateGradients(rest); });
    }
    bool const isSmallEnough = _operator.GetNumRows(LimitOperator::Stage::Rest) <= kMaxFactorised;
    if (isAutomatic && !result.converged && isSmallEnough)
        goOn(SolveMethod::Direct, [&] { return SolveDirectly(problem, pinned); });
    return result;
}

SolveReport Interpolator::SolveBlock(LimitProblem& problem,
                                     InterpolateOptions const& options) const {
    SolveReport report;
    std::vector<double> projected;
    double const* const data = problem.data;
    double worstDefect = 0.0;
    for (auto const& component : _singular.Get()) {
        double const defect =
            SingularComponents::FindDefect(component, data, problem.length) / problem.size;
        bool const isInReach = defect < problem.tolerance;
        report.singularComponents.push_back({FindFirstVertex(component),
                                             static_cast<Index>(component.vertices.size()), defect,
                                             isInReach});
        if (isInReach) worstDefect = std::max(worstDefect, defect);
    }
    if (!_singular.Get().empty()) {
        projected.assign(data,
                         data + static_cast<size_t>(_operator.GetNumVertices()) * problem.length);
        _singular.Project(projected.data(), problem.length);
        std::copy(projected.begin(), projected.end(), problem.solution);
        problem.data = projected.data();
        problem.tolerance -= worstDefect;  // what cannot be reached comes on top
    }
    SolveCurves(problem);
    report.method =
        options.method == SolveMethod::Automatic ? SolveMethod::Chebyshev : options.method;
    IterationResult result;
    if (_operator.GetNumRows(LimitOperator::Stage::Rest) > 0)
        result = Run(problem, options, report.method);
    _singular.Project(problem.solution, problem.length);

    problem.data = data;
    report.iterations = result.applications;
    report.history = std::move(result.history);
    report.lambdaMin = result.lambdaMin;
    report.residual = result.residual;  // found in double by what converged
    if (!result.converged || !projected.empty() || problem.table)
        report.residual = FindResidual(problem, &report.worstVertex);
    report.converged = report.residual <= options.tolerance;
    return report;
}

double Interpolator::EstimateSmallestEigenvalue(int steps) const {
    if (_operator.GetNumRows(LimitOperator::Stage::Rest) == 0) return 1.0;
    size_t const count = _operator.GetNumVertices();
    std::vector<double> noise = MakeNoise(count);
    _singular.Project(noise.data(), 1);
    std::vector<double> solution(count, 0.0);
    LimitProblem const problem{_operator, 1,     noise.data(), solution.data(),
                               1.0,       1e-14, steps + 1,    {}};
    return RunConjugateGradients(problem).lambdaMin;
}

}  // namespace limn::eval
