// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/interpolate.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "eval/parallel/step_pass.h"
#include "far_ext/limit/limit_matrix.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using eval::InterpolateOptions;
using eval::Interpolator;
using eval::SolveMethod;
using eval::SolveReport;
using far_ext::LimitOptions;

using test::Rows;
using test::ToRows;

struct Fit {
    std::vector<double> P;
    SolveReport report;
};

Fit Solve(engine::Scene const& scene, InterpolateOptions const& options = {},
          LimitOptions const& limit = {}) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    Fit fit{std::vector<double>(scene.positions.size()), {}};
    fit.report = Interpolator(*refiner, 0, limit).Solve(scene.positions, 3, fit.P, options);
    return fit;
}

/// max |M - A P| over the diagonal, by the explicit matrix.
double FindMiss(engine::Scene const& scene, std::vector<double> const& P,
                LimitOptions const& limit = {}) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const A = far_ext::LimitMatrix::Build(*refiner, 0, limit);
    Rows const miss = ToRows(scene.positions) - A.AsMatrix() * ToRows(P);
    return test::LargestOf(miss.rowwise().norm()) / eval::FindSize(scene.positions, 3);
}

/// |P - Q| over |Q - mean of Q|.
double FindError(std::vector<double> const& P, std::vector<double> const& Q) {
    Rows const exact = ToRows(Q);
    Rows const centred = exact.rowwise() - exact.colwise().mean();
    return (ToRows(P) - exact).norm() / centred.norm();
}

engine::Scene Noisy(engine::Scene scene) {
    test::AddNoise(scene, 0.1, 1);
    return scene;
}

engine::Scene MakeIrregularQuads(int n = 40) {
    engine::Scene triangles = test::MakeIrregularTriangles(n, n, 3);
    triangles.cage.scheme = Sdc::SCHEME_CATMARK;
    return test::Refine(triangles, 1);
}

SolveMethod const kAllMethods[] = {SolveMethod::Automatic,          SolveMethod::Progressive,
                                   SolveMethod::Weighted,           SolveMethod::Chebyshev,
                                   SolveMethod::ConjugateGradients, SolveMethod::Direct};

// -------- the operator

TEST(LimitOperator, IsTheLimitMatrixOnEveryKindOfMesh) {
    std::vector<engine::Scene> scenes{test::MakeTorus(7, 5), test::MakeTriangleTorus(7, 5),
                                      MakeIrregularQuads(), test::MakeGridWithHole(7, 6),
                                      test::MakePrism(5)};
    for (std::string const& name : test::ListShapes()) {
        scenes.push_back(test::LoadShape(name));
    }
    for (engine::Scene const& scene : scenes) {
        SCOPED_TRACE(scene.path);
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        auto const A = eval::LimitOperator::Build(*refiner);
        Rows const limit =
            far_ext::LimitMatrix::Build(*refiner).AsMatrix() * ToRows(scene.positions);
        for (int length = 1; length <= 4; ++length) {
            Rows values = Rows::Random(scene.cage.numVertices, length);
            values.leftCols(std::min(length, 3)) =
                ToRows(scene.positions).leftCols(std::min(length, 3));
            std::vector<double> y(static_cast<size_t>(values.size()));
            A.Apply({values.data(), y.size()}, length, y);
            Rows const difference = ToRows(y, length).leftCols(std::min(length, 3)) -
                                    limit.leftCols(std::min(length, 3));
            ASSERT_LT(test::LargestOf(difference), 1e-13 * eval::FindSize(scene.positions, 3));
        }
    }
}

TEST(LimitOperator, TakesThirtyEightBytesPerVertexAmongQuads) {
    engine::Scene const scene = test::MakeTorus(100, 60);
    auto const A = eval::LimitOperator::Build(*far_ext::CreateRefiner(scene.cage));
    EXPECT_LE(static_cast<double>(A.GetNumBytes()) / scene.cage.numVertices, 38.1);
}

// -------- the spectrum [Limit 5]

double SmallestEigenvalue(engine::Scene const& scene, LimitOptions const& limit = {}) {
    auto const A = far_ext::LimitMatrix::Build(*far_ext::CreateRefiner(scene.cage), 0, limit);
    VectorXd const root =
        Eigen::Map<VectorXd const>(A.GetScales().data(), A.GetNumStencils()).cwiseSqrt();
    MatrixXd const S =
        root.asDiagonal() * MatrixXd(A.AsMatrix()) * root.cwiseInverse().asDiagonal();
    return Eigen::SelfAdjointEigenSolver<MatrixXd>(0.5 * (S + S.transpose()),
                                                   Eigen::EigenvaluesOnly)
        .eigenvalues()[0];
}

TEST(Spectrum, HasTheKnownSmallestEigenvalues) {
    EXPECT_NEAR(SmallestEigenvalue(test::MakeTorus(12, 8)), 1.0 / 9.0,
                1e-12);  // even sides: attained
    EXPECT_NEAR(SmallestEigenvalue(test::MakeQuadSphere(1)), 0.0779, 1e-4);
    EXPECT_NEAR(SmallestEigenvalue(test::MakeCube()), 0.0, 1e-14);
    EXPECT_NEAR(SmallestEigenvalue(test::MakePrism(6)), 0.0, 1e-14);
    EXPECT_NEAR(SmallestEigenvalue(test::MakeCube(), {.alpha = 0.5}), 0.125, 1e-12);
    EXPECT_NEAR(SmallestEigenvalue(
                    test::MakeCube(),
                    {.alpha = 0.5, .alphaRule = far_ext::LimitOptions::AlphaRule::Stationary}),
                0.1515, 1e-4);
    EXPECT_NEAR(SmallestEigenvalue(test::MakeTorus(12, 8), {.alpha = 0.5}), 2.0 / 9.0, 1e-12);
    EXPECT_NEAR(SmallestEigenvalue(test::MakeBipyramid(12)), 0.1545, 1e-4);
    EXPECT_NEAR(SmallestEigenvalue(test::MakeTriangleTorus(12, 12)), 0.25, 1e-12);
}

TEST(Spectrum, IsBoundedByValencesAndEstimatedFromAbove) {
    for (engine::Scene const& scene :
         {test::MakeTorus(12, 8), test::MakeQuadSphere(2), MakeIrregularQuads(10),
          test::MakeIcosphere(2), test::MakeBipyramid(7), test::MakePrism(5)}) {
        Interpolator const interpolator(*far_ext::CreateRefiner(scene.cage));
        double const exact = SmallestEigenvalue(scene),
                     estimate = interpolator.EstimateSmallestEigenvalue();
        EXPECT_LE(interpolator.GetOperator().GetEigenvalueBound(), exact + 1e-12);
        EXPECT_GE(estimate, exact - 1e-10);
        EXPECT_LE(estimate, 1.05 * exact);
    }
}

// -------- solving

TEST(Interpolator, EveryMethodMeetsTheDirectSolution) {
    for (engine::Scene const& scene :
         {Noisy(test::MakeTorus(12, 8)), Noisy(test::MakeQuadSphere(2)),
          Noisy(test::MakeIcosphere(2)), Noisy(test::MakeGridWithHole(7, 6)),
          Noisy(test::MakePrism(5))}) {
        Fit const exact = Solve(scene, {.method = SolveMethod::Direct});
        EXPECT_LT(FindMiss(scene, exact.P), 1e-14);
        for (SolveMethod method : kAllMethods) {
            SCOPED_TRACE(GetName(method));
            Fit const fit =
                Solve(scene, {.method = method, .tolerance = 1e-11, .maxIterations = 2000});
            EXPECT_TRUE(fit.report.converged);
            EXPECT_LE(fit.report.residual, 1e-11);
            EXPECT_NEAR(FindMiss(scene, fit.P), fit.report.residual, 1e-13);
            EXPECT_LT(FindError(fit.P, exact.P), 1e-9);
        }
    }
}

TEST(Interpolator, FitsEveryKindOfMesh) {
    std::vector<std::string> names = test::ListShapes();
    for (std::string const& name : names) {
        SCOPED_TRACE(name);
        engine::Scene scene = test::LoadShape(name);
        Fit const fit = Solve(scene, {.tolerance = 1e-10});
        // Single precision has moved the car's boxes off the range of A; what misses is theirs.
        double defect = 0.0;
        for (auto const& component : fit.report.singularComponents)
            defect = std::max(defect, component.defect);
        EXPECT_EQ(fit.report.converged, defect < 0.5e-10)
            << fit.report.residual << " after " << fit.report.iterations;
        EXPECT_LE(FindMiss(scene, fit.P), std::max(1.01e-10, 1.001 * defect));
        EXPECT_TRUE(Solve(scene).report.converged);
    }
}

struct Row {
    char const* name;
    engine::Scene scene;
    int chebyshev6, chebyshev10;  ///< most applications for an error of 1e-6 and 1e-10 in P
};

/// Applications of A until P is that near; the solver stops after so many.
int CountApplications(Interpolator const& interpolator, engine::Scene const& scene,
                      std::vector<double> const& exact, SolveMethod method, double error,
                      double lambda) {
    std::vector<double> P(scene.positions.size());
    int low = 1,
        high = 400;  // the error falls with the number, but for ripples that do not matter here
    while (low < high) {
        int const middle = (low + high) / 2;
        interpolator.Solve(
            scene.positions, 3, P,
            {.method = method, .tolerance = 1e-15, .maxIterations = middle, .lambdaMin = lambda});
        if (FindError(P, exact) <= error)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

// What is accepted: Chebyshev and conjugate gradients, noise of 0.1 edge.
TEST(Interpolator, NeedsNoMoreApplicationsThanTheTheorySays) {
    Row const rows[] = {{"quad torus 96", test::MakeTorus(12, 8), 25, 40},
                        {"quad torus 6144", test::MakeTorus(96, 64), 25, 40},
                        {"quad sphere 26", test::MakeQuadSphere(1), 25, 40},
                        {"quad sphere 6146", test::MakeQuadSphere(5), 25, 40},
                        {"irregular quads", MakeIrregularQuads(), 25, 40},
                        {"irregular triangles", test::MakeIrregularTriangles(50, 40, 3), 20, 34},
                        {"icosphere", test::MakeIcosphere(4), 14, 24},
                        {"bipyramid", test::MakeBipyramid(12), 20, 34}};
    for (Row const& row : rows) {
        SCOPED_TRACE(row.name);
        engine::Scene const scene = Noisy(row.scene);
        Interpolator const interpolator(*far_ext::CreateRefiner(scene.cage));
        std::vector<double> exact(scene.positions.size());
        ASSERT_TRUE(interpolator
                        .Solve(scene.positions, 3, exact,
                               {.method = SolveMethod::ConjugateGradients, .tolerance = 1e-14})
                        .converged);
        double const lambda = interpolator.EstimateSmallestEigenvalue();
        double const kappa = 1.0 / lambda, root = std::sqrt(kappa);
        for (auto const& [error, most] :
             {std::pair{1e-6, row.chebyshev6}, {1e-10, row.chebyshev10}}) {
            for (SolveMethod method : {SolveMethod::Automatic, SolveMethod::Chebyshev,
                                       SolveMethod::ConjugateGradients}) {
                int const count = CountApplications(interpolator, scene, exact, method, error, 0.0);
                EXPECT_LE(count, most) << GetName(method) << " to " << error;
                EXPECT_LE(
                    count,
                    std::log(2.0 / error * kappa) / std::log((root + 1.0) / (root - 1.0)) + 2.0)
                    << GetName(method) << " to " << error;
            }
        }
    }
}

// P_{k+1} = P_k + M - A P_k: the slowest mode shrinks by 1 - lambda per step.
TEST(Interpolator, PlainIterationShrinksBySmallestEigenvalue) {
    engine::Scene const scene = Noisy(test::MakeQuadSphere(1));
    Interpolator const interpolator(*far_ext::CreateRefiner(scene.cage));
    std::vector<double> const exact = Solve(scene, {.method = SolveMethod::Direct}).P;
    auto const count = [&](double error) {
        return CountApplications(interpolator, scene, exact, SolveMethod::Progressive, error, 0.0);
    };
    int const early = count(1e-6), late = count(1e-10);
    double const rate = std::pow(1e-4, 1.0 / (late - early));
    EXPECT_NEAR(rate, 1.0 - SmallestEigenvalue(scene), 0.01);
}

/// What the interpolator finds for one of the golden meshes, and its reference.
void ExpectGolden(std::string const& name, std::string const& suffix, Sdc::SchemeType scheme,
                  InterpolateOptions const& options, LimitOptions const& limit, double tolerance) {
    engine::Scene scene = test::LoadData("golden_surface/" + name + ".obj");
    scene.cage.scheme = scheme;
    auto const golden = test::LoadPoints("golden_surface/" + name + "_pi_" + suffix + ".obj");
    EXPECT_LT(test::LargestDifference(Solve(scene, options, limit).P, golden), tolerance)
        << name << " " << suffix;
}

// Steps are taken in float. (Those of the open mesh move its boundary, too, which limn solves
// first.)
TEST(Interpolator, TenPlainStepsMeetTheGoldenOnes) {
    InterpolateOptions const ten{
        .method = SolveMethod::Progressive, .tolerance = 1e-16, .maxIterations = 10};
    for (std::string const name : {"cube", "icosa", "torustri"})
        ExpectGolden(name, "cc_it10", Sdc::SCHEME_CATMARK, ten, {}, 1e-6);
    for (std::string const name : {"icosa", "torustri"})
        ExpectGolden(name, "loop_it10", Sdc::SCHEME_LOOP, ten, {}, 1e-6);
    using Rule = LimitOptions::AlphaRule;
    ExpectGolden("cube", "cc_a50p_it10", Sdc::SCHEME_CATMARK, ten, {0.5, Rule::FirstStep}, 1e-6);
    ExpectGolden("cube", "cc_a50s_it10", Sdc::SCHEME_CATMARK, ten, {0.5, Rule::Stationary}, 1e-6);
}

TEST(Interpolator, FitsMeetTheGoldenOnes) {
    InterpolateOptions const exact{.tolerance = 1e-13};
    for (std::string const name : {"icosa", "torustri", "gridholetri"})
        ExpectGolden(name, "cc_exact", Sdc::SCHEME_CATMARK, exact, {}, 1e-9);
    for (std::string const name : {"icosa", "torustri", "gridholetri"})
        ExpectGolden(name, "loop_exact", Sdc::SCHEME_LOOP, exact, {}, 1e-9);
    using Rule = LimitOptions::AlphaRule;
    ExpectGolden("cube", "cc_a50p_exact", Sdc::SCHEME_CATMARK, exact, {0.5, Rule::FirstStep}, 1e-9);
    ExpectGolden("cube", "cc_a50s_exact", Sdc::SCHEME_CATMARK, exact, {0.5, Rule::Stationary},
                 1e-9);
}

TEST(Interpolator, SolvesAnyNumberOfChannels) {
    engine::Scene const scene = Noisy(test::MakeQuadSphere(2));
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    Interpolator const interpolator(*refiner);
    MatrixXd const inverse = MatrixXd(far_ext::LimitMatrix::Build(*refiner).AsMatrix()).inverse();
    for (int length : {1, 2, 3, 4, 5, 9}) {
        Rows const M = Rows::Random(scene.cage.numVertices, length);
        std::vector<double> P(static_cast<size_t>(M.size()));
        auto const report =
            interpolator.Solve({M.data(), P.size()}, length, P, {.tolerance = 1e-12});
        EXPECT_TRUE(report.converged);
        EXPECT_LT(test::LargestOf(ToRows(P, length) - inverse * M), 1e-9) << length;
    }
}

TEST(Interpolator, SolvesRefinedLevels) {
    engine::Scene const scene = test::LoadShape("catmark_cube_creases2");
    auto const refiner = test::MakeRefiner(scene, 2);
    for (int level = 0; level <= 2; ++level) {
        Interpolator const interpolator(*refiner, level);
        Rows const M = Rows::Random(refiner->GetLevel(level).GetNumVertices(), 1);
        std::vector<double> P(static_cast<size_t>(M.size()));
        EXPECT_TRUE(interpolator.Solve({M.data(), P.size()}, 1, P, {.tolerance = 1e-10}).converged);
        EXPECT_LT(test::LargestOf(ToRows(interpolator.FindLimits(P, 1), 1) - M), 3e-10);
    }
}

TEST(Interpolator, GivesTheSameBitsForAnyNumberOfThreads) {
    engine::Scene const scene = Noisy(MakeIrregularQuads());
    for (SolveMethod method : kAllMethods) {
        std::vector<double> first;
        for (size_t threads : {1, 2, 5}) {
            tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, threads);
            auto const P = Solve(scene, {.method = method}).P;
            if (first.empty()) first = P;
            EXPECT_EQ(P, first) << GetName(method);
        }
    }
}

// On large meshes several steps go over the rows at once, each behind the one before. Against plain
// steps in double, one by one; neighbours lie as far apart as on a torus of 420 x 420.
TEST(Interpolator, StepsTakenTogetherAreThoseOneByOne) {
    engine::Scene const scene = Noisy(test::MakeTorus(420, 420));
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const A = eval::LimitOperator::Build(*refiner);
    auto const& M = scene.positions;
    std::vector<double> P = M, limit(M.size());
    std::vector<double> residuals;
    for (int step = 0; step < 10; ++step) {  // the first application only measures
        A.Apply(P, 3, limit);
        double worst = 0.0;
        for (size_t i = 0; i < M.size(); i += 3)
            worst = test::Worse(worst, std::hypot(M[i] - limit[i], M[i + 1] - limit[i + 1],
                                                  M[i + 2] - limit[i + 2]));
        residuals.push_back(worst / eval::FindSize(M, 3));
        for (size_t i = 0; i < M.size(); ++i) P[i] += M[i] - limit[i];
    }
    Interpolator const interpolator(*refiner);
    ASSERT_GT(
        eval::CountStepsPerPass(scene.cage.numVertices, interpolator.GetOperator().GetBandwidth()),
        1);
    std::vector<double> first;
    for (size_t threads : {1, 2, 5}) {
        tbb::global_control const limitThreads(tbb::global_control::max_allowed_parallelism,
                                               threads);
        std::vector<double> found(M.size());
        auto const report = interpolator.Solve(
            M, 3, found,
            {.method = SolveMethod::Progressive, .tolerance = 1e-16, .maxIterations = 10});
        ASSERT_EQ(report.history.size(), residuals.size());
        for (size_t i = 0; i < residuals.size(); ++i)
            EXPECT_NEAR(report.history[i], residuals[i], 1e-4 * residuals[i]) << i;
        EXPECT_LT(test::LargestDifference(found, P), 1e-6);
        if (first.empty()) first = found;
        EXPECT_EQ(found, first) << threads;
        // Chebyshev the same way: fewer steps, as on small meshes.
        auto const fast = interpolator.Solve(M, 3, found);
        EXPECT_TRUE(fast.converged);
        EXPECT_LE(fast.iterations, 20);
    }
}

// -------- singular components

TEST(Singular, TheCubeItselfIsSolvedByMinimumNorm) {
    for (SolveMethod method : kAllMethods) {
        Fit const fit = Solve(test::MakeCube(), {.method = method, .tolerance = 1e-10});
        ASSERT_TRUE(fit.report.converged) << GetName(method);
        ASSERT_EQ(fit.report.singularComponents.size(), 1u);
        EXPECT_TRUE(fit.report.singularComponents[0].isSolved);
        // The control mesh is twice the cube.
        EXPECT_LT(test::LargestOf(ToRows(fit.P) - 2.0 * ToRows(test::MakeCube().positions)), 1e-8);
    }
}

// One vertex moved by (.1, .2, 0) on a cube of edge 2: the alternating part is (.1, .2, 0) / 8 at
// every vertex.
TEST(Singular, APerturbedCubeKeepsTheAlternatingResidual) {
    engine::Scene scene = test::MakeCube();
    scene.positions[0] += 0.1;
    scene.positions[1] += 0.2;
    double const defect = std::hypot(0.1, 0.2) / 8.0 / eval::FindSize(scene.positions, 3);
    for (SolveMethod method : kAllMethods) {
        Fit const fit = Solve(scene, {.method = method});
        EXPECT_FALSE(fit.report.converged);
        ASSERT_EQ(fit.report.singularComponents.size(), 1u);
        EXPECT_FALSE(fit.report.singularComponents[0].isSolved);
        EXPECT_NEAR(fit.report.singularComponents[0].defect, defect, 1e-12);
        EXPECT_NEAR(fit.report.residual, defect, 1e-5) << GetName(method);
    }
    EXPECT_TRUE(Solve(scene, {.tolerance = 1e-10}, {.alpha = 0.5}).report.converged);
}

/// A cube of which nothing but the alternating part, +-(a, 0, 0) in turn, is out of reach; a is
/// `share` of 1e-6 of the diagonal.
engine::Scene MakeAlternatingCube(double share) {
    engine::Scene scene = test::MakeCube();
    double const part = share * 1e-6 * eval::FindSize(scene.positions, 3);
    for (size_t i = 0; i < scene.positions.size(); i += 3) {
        double const product = scene.positions[i] * scene.positions[i + 1] * scene.positions[i + 2];
        scene.positions[i] += product > 0.0 ? part : -part;
    }
    return scene;
}

// The defect may take the whole of the tolerance; the rest is solved to what it leaves.
TEST(Singular, TheDefectIsMeasuredAgainstTheWholeTolerance) {
    for (double share : {0.1, 0.5, 0.88, 0.99, 1.01, 2.0}) {
        engine::Scene const scene = MakeAlternatingCube(share);
        for (SolveMethod method : kAllMethods) {
            auto const report = Solve(scene, {.method = method, .tolerance = 1e-6}).report;
            ASSERT_EQ(report.singularComponents.size(), 1u);
            EXPECT_NEAR(report.singularComponents[0].defect, share * 1e-6, 1e-11);
            EXPECT_EQ(report.singularComponents[0].isSolved, share < 1.0) << share;
            EXPECT_EQ(report.converged, share < 1.0) << share << ' ' << GetName(method);
        }
    }
}

TEST(Singular, PrismsAreIfTheirSidesAreEven) {
    for (int n = 3; n <= 8; ++n) {
        auto const report = Solve(test::MakePrism(n)).report;
        EXPECT_EQ(report.singularComponents.size(), n % 2 == 0 ? 1u : 0u) << n;
        EXPECT_TRUE(report.converged) << n;
    }
}

TEST(Singular, EachComponentIsJudgedByItself) {
    engine::Scene moved = test::MakeCube();
    moved.positions[0] += 0.3;
    engine::Scene const scene =
        test::Join({Noisy(test::MakeTorus(9, 7)), test::MakeCube(), moved, test::MakePrism(6)});
    auto const report = Solve(scene).report;
    ASSERT_EQ(report.singularComponents.size(), 3u);
    EXPECT_EQ(report.singularComponents[0].firstVertex, 63);
    EXPECT_EQ(report.singularComponents[1].firstVertex, 71);
    EXPECT_TRUE(report.singularComponents[0].isSolved);
    EXPECT_FALSE(report.singularComponents[1].isSolved);
    EXPECT_TRUE(report.singularComponents[2].isSolved);
    EXPECT_FALSE(report.converged);
    EXPECT_GE(report.worstVertex, 71);
    EXPECT_LT(report.worstVertex, 79);
}

// -------- hostile input

TEST(Interpolator, RefusesWhatIsNoNumberAndNamesTheVertex) {
    engine::Scene scene = test::MakeTorus(5, 5);
    scene.positions[3 * 7 + 1] = NAN;
    EXPECT_NE(test::RefusalOf([&] { Solve(scene); }).find("vertex 7 "), std::string::npos);
    scene.positions[3 * 7 + 1] = INFINITY;
    EXPECT_NE(test::RefusalOf([&] { Solve(scene); }).find("vertex 7 "), std::string::npos);
}

TEST(Interpolator, RefusesOptionsThatMakeNoSense) {
    engine::Scene const scene = test::MakeTorus(5, 5);
    EXPECT_NE(test::RefusalOf([&] { Solve(scene, {.tolerance = 0.0}); }), "");
    EXPECT_NE(test::RefusalOf([&] { Solve(scene, {.tolerance = NAN}); }), "");
    EXPECT_NE(test::RefusalOf([&] { Solve(scene, {.maxIterations = 0}); }), "");
    Interpolator const interpolator(*far_ext::CreateRefiner(scene.cage));
    std::vector<double> P(10);
    EXPECT_NE(test::RefusalOf([&] { interpolator.Solve(scene.positions, 3, P); }), "");
}

TEST(Interpolator, IsolatedVerticesStayAndValence2IsSolved) {
    engine::Scene scene = test::LoadShape("catmark_val2_interior");
    scene.positions.insert(scene.positions.end(), {5.0, 6.0, 7.0});
    ++scene.cage.numVertices;
    Fit const fit = Solve(scene);
    EXPECT_TRUE(fit.report.converged);
    EXPECT_EQ(fit.P[fit.P.size() - 2], 6.0);
}

}  // namespace
}  // namespace limn
