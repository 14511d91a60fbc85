// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/fit.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "engine/scene/refine.h"
#include "eval/surface/vertex_limits.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/fit_meshes.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/scan_meshes.h"
#include "support/values.h"

namespace limn {
namespace {

engine::FitResult FitToLimit(engine::Scene const& scene, engine::FitOptions const& options) {
    engine::Job job;
    return engine::FitToLimit(engine::Model::Build(scene), options, job);
}

/// Largest distance of a mesh's plain limit from the points of `data`, over their diagonal, by deep
/// refinement.
double FindMiss(engine::Scene const& mesh, std::vector<double> const& data) {
    auto const refiner = far_ext::CreateRefiner(mesh.cage);
    eval::LimitSurface const surface(*refiner);
    auto const limits = eval::EvaluateVertexLimits(surface, mesh.positions, 3);
    double miss = 0.0;
    for (size_t i = 0; i < data.size(); ++i)
        miss = test::Worse(miss, std::abs(limits.values[i] - data[i]));
    return miss / eval::FindSize(data, 3);
}

std::vector<engine::Scene> MakeScenes() {
    std::vector<engine::Scene> scenes;
    for (char const* name :
         {"catmark_bishop", "catmark_nonquads", "catmark_pyramid_creases0", "catmark_dart_edgeonly",
          "catmark_cubes_semisharp", "catmark_torus_creases0", "catmark_edgeonly",
          "catmark_hole_test1", "catmark_smoothtris0", "catmark_toroidal_tet"}) {
        scenes.push_back(test::LoadShape(name));
    }
    for (char const* name :
         {"loop_cubes_semisharp", "loop_saddle_edgecorner", "loop_pole8", "loop_chaikin0"}) {
        scenes.push_back(test::LoadShape(name));
    }
    scenes.push_back(test::MakeGridWithHole(7, 6));
    scenes.push_back(
        test::Join({test::MakeTorus(9, 7), test::MakeQuadSphere(1), test::MakePrism(5)}));
    return scenes;
}

TEST(Fit, TheLimitPassesThroughTheVertices) {
    for (engine::Scene const& scene : MakeScenes()) {
        SCOPED_TRACE(scene.path);
        auto const result = FitToLimit(scene, {.tolerance = 1e-10});
        ASSERT_TRUE(result.HasConverged());
        double const miss = FindMiss(result.mesh, scene.positions);
        EXPECT_LE(miss, 1.01e-10);
        EXPECT_NEAR(result.certificate.max, result.report.residual, 2e-11);
        EXPECT_LE(result.certificate.rms, result.certificate.max);
        EXPECT_EQ(result.mesh.cage.faceVertices, scene.cage.faceVertices);
    }
}

// A sample of the vertices bears witness for all.
TEST(Fit, TheCertificateOfAMeshOfManyVerticesIsThatOfAll) {
    engine::Scene const scan = test::MakeScan(70);
    auto const result = FitToLimit(scan, {});
    ASSERT_TRUE(result.HasConverged());
    double const miss = FindMiss(result.mesh, scan.positions);  // of one coordinate
    EXPECT_GE(result.certificate.max, miss - 1e-8);             // known to a hundredth of 1e-6
    EXPECT_LE(result.certificate.max, std::sqrt(3.0) * miss + 1e-8);
}

// Of an odd prism A is regular, but only just; what alternates round it is multiplied.
TEST(Fit, AControlMeshThatOutgrowsItsDataIsWarnedOf) {
    engine::Scene scene = test::MakePrism(101);
    auto const warnings = [&](double alpha) {
        test::Listener listener;
        engine::Job job(listener.MakeHost());
        EXPECT_TRUE(
            engine::FitToLimit(engine::Model::Build(scene), {.alpha = alpha}, job).HasConverged());
        return listener.warnings;
    };
    EXPECT_TRUE(warnings(0.0).empty());
    for (size_t i = 0; i < scene.positions.size(); ++i) {
        size_t const vertex = i / 3;  // even ones below, each with the next one above
        bool const isOdd = (vertex / 2 + vertex % 2) % 2 == 1;
        if (i % 3 < 2) scene.positions[i] *= isOdd ? 0.7 : 1.3;
    }
    auto const grown = warnings(0.0);
    ASSERT_EQ(grown.size(), 1u);
    EXPECT_NE(grown[0].find("times as far as the vertices"), std::string::npos) << grown[0];
    EXPECT_NE(grown[0].find("`alpha` 0.5"), std::string::npos) << grown[0];
    EXPECT_TRUE(warnings(0.5).empty());
}

// Where creases end in vertices of valence 3 the alternating vector is still taken to nothing, but
// A is not symmetric, which hides it from the estimate: the solution runs off along it.
TEST(Fit, AControlMeshThatRunsAwayIsNoResult) {
    engine::Scene cube = test::MakeCube();
    auto const& face = cube.cage.faceVertices;
    cube.cage.creaseVertexPairs = {face[0], face[1]};
    for (float sharpness : {2.0f, 5.0f, 10.0f}) {
        cube.cage.creaseSharpness = {sharpness};
        auto const fit = FitToLimit(
            cube, {.method = eval::SolveMethod::Direct, .tolerance = 1.0});  // any residual's
        EXPECT_TRUE(fit.HasRunAway()) << sharpness;
        EXPECT_FALSE(fit.HasConverged()) << sharpness;
        EXPECT_LT(fit.lambdaMin, 1e-8) << sharpness;
    }
    EXPECT_TRUE(FitToLimit(cube, {.alpha = 0.5}).HasConverged());
}

TEST(Fit, RefusesOptionsOutOfRange) {
    struct Case {
        engine::FitOptions options;
        char const* message;
    };
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (auto const& [options, message] : std::vector<Case>{
             {{.method = static_cast<eval::SolveMethod>(77)}, "`method`: '77' is not one of"},
             {{.tolerance = kInfinity}, "`tolerance`: inf is no finite number above 0"},
             {{.tolerance = std::nan("")}, "`tolerance`: nan is"},
             {{.maxIterations = 0}, "`maxIterations`: 0 is not 1 or more"},
             {{.alphaRule = static_cast<far_ext::LimitOptions::AlphaRule>(2)}, "`alphaRule`: 2 is"},
             {{.target = {{"x.zzz"}}}, "x.zzz"}}) {
        auto const error = test::CatchError([&] { FitToLimit(test::MakeTorus(9, 7), options); });
        ASSERT_TRUE(error) << message;
        EXPECT_EQ(error->GetCode(), ErrorCode::BadOption);
        EXPECT_NE(std::string(error->what()).find(message), std::string::npos) << error->what();
    }
}

// The whole miss belongs to the certificate: the solver's, and that of rounding to what the file
// holds, which may be neither the doubles nor the floats.
TEST(Fit, TheCertificateIsOfTheFile) {
    test::TemporaryFolder const folder;
    for (double distance : {0.0, 1e3, 1e6}) {
        engine::Scene data = test::MakeTorus(9, 7);
        for (double& x : data.positions) x += distance;
        for (std::string const name : {"a.obj", "a.ply"}) {
            for (auto precision : {std::optional<Precision>(), std::optional(Precision::Float)}) {
                auto const fit = FitToLimit(data, {.target = {{folder / name, precision}}});
                engine::WriteMesh(folder / name, fit.mesh, fit.precision);
                engine::Scene const written = engine::ReadMesh(folder / name);
                EXPECT_EQ(written.positions, fit.mesh.positions);
                double const miss = FindMiss(written, data.positions);
                EXPECT_LE(miss, fit.certificate.max + 1e-9);
                EXPECT_GE(miss, 0.5 * fit.certificate.max);
                EXPECT_EQ(fit.HasConverged(), precision == std::nullopt || distance == 0.0);
                EXPECT_EQ(fit.precision, precision == std::nullopt && distance > 0.0
                                             ? Precision::Double
                                             : Precision::Float);
            }
        }
    }
}

TEST(Fit, WithoutATargetNothingIsRounded) {
    engine::Scene data = test::MakeTorus(9, 7);
    auto const fit = FitToLimit(data, {});
    EXPECT_EQ(fit.precision, Precision::Double);
    EXPECT_NE(static_cast<float>(fit.mesh.positions[0]), fit.mesh.positions[0]);
    EXPECT_NEAR(fit.certificate.max, fit.report.residual, 1e-12);
}

// A solver that stops just within the tolerance leaves no room for rounding.
TEST(Fit, FloatsGiveWayWhereOnlyDoublesMeetTheTolerance) {
    engine::Scene const data = test::MakeTorus(9, 7);
    double const residual = FitToLimit(data, {.tolerance = 3e-7}).report.residual;
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    auto const model = engine::Model::Build(data);
    engine::FitOptions options{.tolerance = 1.0001 * residual, .target = {{"a.obj"}}};
    auto const fit = engine::FitToLimit(model, options, job);
    EXPECT_TRUE(fit.HasConverged());
    EXPECT_EQ(fit.precision, Precision::Double);
    ASSERT_EQ(listener.warnings.size(), 1u);
    EXPECT_TRUE(
        listener.warnings[0].starts_with("a.obj: in double, for in floats its limit misses"))
        << listener.warnings[0];

    options.target->precision = Precision::Float;
    auto const inFloats = engine::FitToLimit(model, options, job);
    EXPECT_FALSE(inFloats.HasConverged());
    EXPECT_TRUE(inFloats.report.converged);
    options.target->precision.reset();
    options.tolerance = 2.0 * residual;
    EXPECT_EQ(engine::FitToLimit(model, options, job).precision, Precision::Float);
}

TEST(Fit, FindsTheControlMeshThatMadeTheData) {
    engine::Scene const control = test::LoadShape("catmark_bishop");
    auto const refiner = far_ext::CreateRefiner(control.cage);
    eval::LimitSurface const surface(*refiner);
    engine::Scene data = control;
    data.positions = eval::EvaluateVertexLimits(surface, control.positions, 3).values;
    auto const fit = FitToLimit(data, {.tolerance = 1e-12});
    double const size = eval::FindSize(control.positions, 3);
    for (size_t i = 0; i < control.positions.size(); ++i)
        EXPECT_NEAR(fit.mesh.positions[i], control.positions[i], 1e-9 * size);
}

// With alpha the result is one level finer, and its plain limit passes through the data; so do
// primvars.
TEST(Fit, AlphaGivesAFinerMeshWhoseLimitPassesThroughTheVertices) {
    engine::Scene scene = test::MakeCube();
    scene.positions[0] += 0.1;
    scene.positions[1] += 0.2;
    for (engine::Scene const& data : {scene, test::MakePrism(6), test::MakeGridWithHole(5, 5),
                                      test::LoadShape("catmark_nonquads")}) {
        for (double alpha : {0.5, 1.0}) {
            auto const result = FitToLimit(data, {.tolerance = 1e-10, .alpha = alpha});
            EXPECT_TRUE(result.HasConverged());
            EXPECT_GT(result.mesh.cage.numVertices, data.cage.numVertices);
            EXPECT_LE(FindMiss(result.mesh, data.positions), 1.01e-10);
            EXPECT_LE(result.certificate.max, 1.1e-10);
        }
    }
    auto const kept = FitToLimit(scene, {.tolerance = 1e-10, .alpha = 0.5, .keepsTopology = true});
    EXPECT_EQ(kept.mesh.cage.numVertices, 8);
    EXPECT_GT(FindMiss(kept.mesh, scene.positions), 1e-3);
    EXPECT_LE(kept.certificate.max, 1.1e-10);
}

// With alpha in all steps the result has the data's faces, and the limit of that scheme passes
// through the data; that of plain Catmull-Clark does not.
TEST(Fit, StationaryAlphaGivesTheControlMeshOfItsScheme) {
    engine::Job job;
    engine::FitOptions const options{.tolerance = 1e-10,
                                     .alpha = 0.5,
                                     .alphaRule = far_ext::LimitOptions::AlphaRule::Stationary};
    engine::Scene cube = test::MakeCube();
    cube.positions[0] += 0.1;
    for (engine::Scene const& data : {cube, test::MakePrism(6), test::MakeGridWithHole(5, 5),
                                      test::LoadShape("catmark_cubes_semisharp")}) {
        auto const result = FitToLimit(data, options);
        EXPECT_TRUE(result.HasConverged());
        EXPECT_LE(result.certificate.max, 1.01e-10);
        ASSERT_EQ(result.mesh.positions.size(), data.positions.size());
        EXPECT_GT(FindMiss(result.mesh, data.positions), 1e-4);
        auto const fine = engine::RefineUniformly(
            engine::Model::Build(result.mesh), {.levels = 3, .toLimit = true, .alpha = 0.5}, job);
        double miss = 0.0;
        for (size_t i = 0; i < data.positions.size(); ++i)
            miss = test::Worse(miss, std::abs(fine.positions[i] - data.positions[i]));
        EXPECT_LT(miss, 1e-9 * test::BoxDiagonal(data.positions));
    }
}

// Without a rule for boundaries only vertices round faces with a limit have one; alpha moves the
// others, too, and where to is nobody's business.
TEST(Fit, WhatHasNoLimitIsNoMissOfACertificate) {
    engine::Scene scene = test::MakeGridWithHole(7, 6);
    scene.cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_NONE);
    using Rule = far_ext::LimitOptions::AlphaRule;
    for (Rule rule : {Rule::FirstStep, Rule::Stationary}) {
        auto const result = FitToLimit(scene, {.tolerance = 1e-9, .alpha = 0.5, .alphaRule = rule});
        EXPECT_TRUE(result.report.converged);
        EXPECT_LE(result.certificate.max, 1.01e-9);
    }
}

TEST(Fit, PrimvarsAreFittedToo) {
    engine::Scene scene = test::MakeQuadSphere(2);
    engine::Primvar colour{"color", 3, {}}, height{"height", 1, {}};
    for (Index i = 0; i < scene.cage.numVertices; ++i) {
        height.values.push_back(std::sin(0.3f * static_cast<float>(i)));
        for (int c = 0; c < 3; ++c)
            colour.values.push_back(0.5f + 0.5f * std::cos(static_cast<float>(i + 2 * c)));
    }
    scene.primvars = {colour, height};
    for (double alpha : {0.0, 0.5}) {
        auto const result = FitToLimit(scene, {.alpha = alpha});
        ASSERT_EQ(result.primvars.size(), 2u);
        auto const refiner = far_ext::CreateRefiner(result.mesh.cage);
        eval::LimitSurface const surface(*refiner);
        for (size_t p = 0; p < 2; ++p) {
            EXPECT_TRUE(result.primvars[p].converged);
            auto const& fitted = result.mesh.primvars[p];
            std::vector<double> const values(fitted.values.begin(), fitted.values.end());
            auto const limits = eval::EvaluateVertexLimits(surface, values, fitted.numChannels);
            for (size_t i = 0; i < scene.primvars[p].values.size(); ++i)
                ASSERT_NEAR(limits.values[i], scene.primvars[p].values[i], 1e-5);
        }
    }
}

TEST(Fit, ASingularComponentOffTheRangeDoesNotConvergeAndKeepsItsDefect) {
    engine::Scene scene = test::MakeCube();
    scene.positions[0] += 0.1;
    auto const result = FitToLimit(scene, {});
    EXPECT_FALSE(result.HasConverged());
    EXPECT_EQ(result.lambdaMin, 0.0);
    EXPECT_NEAR(result.certificate.max, result.report.residual, 1e-7);
}

TEST(Fit, StopsWhereItsHostWants) {
    auto const model = engine::Model::Build(test::MakeTorus(24, 18));
    EXPECT_TRUE(test::StopsHalfway([&](engine::Job& job) {
        engine::FitToLimit(model, {.tolerance = 1e-10, .alpha = 0.5}, job);
    }));
}

class FitOf : public testing::TestWithParam<char const*> {};

TEST_P(FitOf, ConvergesWithACertificate) {
    std::string const path = GetParam();
    engine::Scene scene = path == "spot" ? test::LoadSpot() : test::LoadAsset(path);
    if (path.starts_with("tri/")) scene.cage.scheme = Sdc::SCHEME_LOOP;
    auto const result = FitToLimit(scene, {.tolerance = 1e-10});
    EXPECT_TRUE(result.HasConverged());
    EXPECT_LE(result.certificate.max, 1.05e-10);
}

INSTANTIATE_TEST_SUITE_P(Assets, FitOf,
                         testing::Values("spot", "control/penguin_control_mesh.obj",
                                         "tri/mechpart_loop_control.obj",
                                         "tri/spot_low_resolution.obj"));

#ifdef LIMN_ASSETS
INSTANTIATE_TEST_SUITE_P(Larger, FitOf,
                         testing::Values("control/ict_head_skin.obj", "control/fancy_teapot.obj",
                                         "tri/kitten.obj"));
#endif

TEST(Fit, AnEvaluatorMeetsTheToleranceByEveryMethodThatAppliesA) {
    using eval::SolveMethod;
    engine::Scene const scene = test::LoadSpot();
    for (auto method : {SolveMethod::Automatic, SolveMethod::Progressive, SolveMethod::Weighted,
                        SolveMethod::Chebyshev, SolveMethod::ConjugateGradients}) {
        for (auto kind : {eval::EvaluatorKind::OsdCpu, eval::EvaluatorKind::Simd}) {
            SCOPED_TRACE(eval::GetName(method));
            eval::TableEvaluator door(kind);
            auto const result =
                FitToLimit(scene, {.method = method, .tolerance = 1e-6, .evaluator = &door});
            EXPECT_TRUE(result.HasConverged());
            EXPECT_LT(FindMiss(result.mesh, scene.positions), 1.02e-6);
            auto const uses = door.GetUses();
            ASSERT_EQ(uses.size(), 1u);
            EXPECT_EQ(uses[0].what, "A");
            EXPECT_EQ(uses[0].rows, scene.positions.size() / 3);
            EXPECT_GT(uses[0].applications, 3u);
        }
    }
}

TEST(Fit, AnEvaluatorMeetsTheToleranceOnAnyMesh) {
    for (engine::Scene const& scene : MakeScenes()) {
        eval::TableEvaluator door(eval::EvaluatorKind::OsdCpu);
        auto const expected = FitToLimit(scene, {.tolerance = 1e-6});
        auto const found = FitToLimit(scene, {.tolerance = 1e-6, .evaluator = &door});
        EXPECT_EQ(found.HasConverged(), expected.HasConverged()) << scene.path;
        if (!found.HasConverged()) continue;
        EXPECT_LE(found.certificate.max, 1.01e-6) << scene.path;
    }
}

TEST(Fit, AFactorisationHasNoTableForAnEvaluator) {
    eval::TableEvaluator door(eval::EvaluatorKind::Simd);
    EXPECT_EQ(test::CodeOf([&] {
                  FitToLimit(test::LoadSpot(),
                             {.method = eval::SolveMethod::Direct, .evaluator = &door});
              }),
              ErrorCode::BadOption);
}

}  // namespace
}  // namespace limn
