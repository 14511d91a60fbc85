// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/smooth.h"

#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "engine/fit/bands.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::ConstantWidth;
using engine::Job;
using engine::Model;
using engine::OnCollapse;
using engine::SmoothConstraint;
using engine::SmoothOptions;

Model MakeIcosahedron() {  // of radius 1; mean edge 1.05
    return Model::Build(test::MakeIcosphere(0));
}

Model MakeNamedCube() {
    engine::Scene scene = test::MakeCube();
    scene.name = "cube";
    return Model::Build(std::move(scene));
}

engine::SmoothResult Smooth(Model const& model, engine::FilterWidths const& widths,
                            SmoothOptions const& options = {}) {
    Job job;
    return engine::Smooth(model, widths, options, job);
}

double MeasureVolume(engine::Scene const& mesh) {
    auto const model = Model::Build(mesh);
    return engine::MeasureExtent(model, model.GetPositions()).volume.value();
}

TEST(Smooth, RoundsACubeInwards) {
    auto const result = Smooth(MakeNamedCube(), ConstantWidth{0.3});
    ASSERT_TRUE(result.mesh);
    EXPECT_EQ(result.mesh->cage.numVertices, 98);
    EXPECT_TRUE(result.report.HasConverged());
    EXPECT_EQ(result.report.largestWidth, 0.3);
    EXPECT_DOUBLE_EQ(result.report.meanEdge, 2.0);
    EXPECT_FALSE(result.report.limitedBy);
    EXPECT_LT(MeasureVolume(*result.mesh), 8.0);
    ASSERT_EQ(result.mesh->primvars.size(), 1u);
    EXPECT_EQ(result.mesh->primvars[0].name, "width");
    for (float width : result.mesh->primvars[0].values) EXPECT_EQ(width, 0.3f);
}

TEST(Smooth, KeepsTheVolumeOfClosedComponentsWhereAsked) {
    SmoothOptions const options{.constraint = SmoothConstraint::Volume};
    auto const kept = Smooth(MakeIcosahedron(), ConstantWidth{0.3}, options);
    ASSERT_TRUE(kept.mesh);
    ASSERT_EQ(kept.report.volumes.size(), 1u);
    auto const& volume = kept.report.volumes[0];
    EXPECT_TRUE(volume.isMet);
    EXPECT_NEAR(volume.end, volume.start, 1e-9 * volume.start);
    EXPECT_NEAR(MeasureVolume(*kept.mesh), MeasureVolume(test::MakeIcosphere(0)), 1e-9);
    EXPECT_TRUE(Smooth(MakeIcosahedron(), ConstantWidth{0.3}).report.volumes.empty());
    auto const open =
        Smooth(Model::Build(test::MakeGridWithHole(6, 5)), ConstantWidth{0.1}, options);
    EXPECT_TRUE(open.report.volumes.empty());
}

// A sphere of radius 1 carries no filter of width 1: what shrinks has no fixed point.
TEST(Smooth, ACollapseIsReportedAndHasNoMesh) {
    auto const result = Smooth(MakeIcosahedron(), ConstantWidth{1.5});
    EXPECT_FALSE(result.mesh);
    EXPECT_TRUE(result.report.hasCollapsed);
    EXPECT_FALSE(result.report.HasConverged());
    ASSERT_TRUE(result.report.shrinkage);
    EXPECT_LT(result.report.shrinkage->radiusRatio, 0.5);
    EXPECT_EQ(result.report.shrinkage->firstVertex, 0);
    ASSERT_TRUE(result.report.criticalFactor);
    EXPECT_LT(*result.report.criticalFactor, 1.0);
    EXPECT_DOUBLE_EQ(result.report.GetCriticalWidth(), 1.5 * *result.report.criticalFactor);
}

TEST(Smooth, ACollapseThatIsToBeKeptHasAMesh) {
    auto const result =
        Smooth(MakeIcosahedron(), ConstantWidth{1.5}, {.onCollapse = OnCollapse::KeepResult});
    EXPECT_TRUE(result.report.hasCollapsed);
    ASSERT_TRUE(result.mesh);
    EXPECT_EQ(result.report.levels.size(), 2u);
    EXPECT_TRUE(test::AreFinite(result.mesh->positions));
}

TEST(Smooth, ALimitedWidthIsThatWidthToTheBit) {
    test::Listener host;
    Job job(host.MakeHost());
    auto const limited = engine::Smooth(MakeIcosahedron(), ConstantWidth{1.5},
                                        {.onCollapse = OnCollapse::LimitWidth}, job);
    ASSERT_TRUE(limited.mesh);
    ASSERT_TRUE(limited.report.limitedBy);
    EXPECT_FALSE(limited.report.hasCollapsed);
    EXPECT_DOUBLE_EQ(*limited.report.limitedBy, 0.95 * *limited.report.criticalFactor);
    EXPECT_EQ(limited.report.largestWidth, 1.5 * *limited.report.limitedBy);
    auto const direct = Smooth(MakeIcosahedron(), ConstantWidth{1.5 * *limited.report.limitedBy});
    ASSERT_TRUE(direct.mesh);
    EXPECT_EQ(limited.mesh->positions, direct.mesh->positions);
    ASSERT_EQ(host.warnings.size(), 1u);
    EXPECT_NE(host.warnings[0].find("the width was reduced"), std::string::npos);
}

TEST(Smooth, AGraphKeepsXAndY) {
    engine::Scene scene = test::MakeGridWithHole(8, 7);
    auto const options = SmoothOptions{.levels = 1, .constraint = SmoothConstraint::Graph};
    for (size_t i = 0; i < scene.positions.size(); i += 3)
        scene.positions[i + 2] = std::sin(2.0 * scene.positions[i]);
    auto const model = Model::Build(scene);
    auto const found = Smooth(model, ConstantWidth{0.5}, options),
               start = Smooth(model, ConstantWidth{0.0}, options);
    ASSERT_TRUE(found.mesh && start.mesh);
    double highest = 0.0;
    for (size_t i = 0; i < found.mesh->positions.size(); ++i) {
        if (i % 3 < 2) {
            EXPECT_EQ(found.mesh->positions[i], start.mesh->positions[i]);
        } else {
            highest =
                test::Worse(highest, std::abs(found.mesh->positions[i] - start.mesh->positions[i]));
        }
    }
    EXPECT_GT(highest, 0.01);
    EXPECT_NE(test::RefusalOf([&] {
                  Smooth(MakeNamedCube(), ConstantWidth{0.1}, options);
              }).find("is folded"),
              std::string::npos);
}

TEST(Smooth, EachStoppingRuleCountsAsItSays) {
    auto const sweepsOf = [](engine::SmoothStop const& stop, eval::CascadeSolver solver) {
        std::vector<int> sweeps;
        for (auto const& level :
             Smooth(MakeIcosahedron(), ConstantWidth{0.2}, {.solver = solver, .stop = stop})
                 .report.levels)
            sweeps.push_back(level.sweeps);
        return sweeps;
    };
    auto const jacobi = eval::CascadeSolver::Jacobi;
    EXPECT_EQ(sweepsOf(engine::IterationsPerLevel{5}, jacobi), (std::vector<int>{5, 5}));
    EXPECT_EQ(sweepsOf(engine::SweepsOnFinest{2}, jacobi), (std::vector<int>{8, 2}));
    auto const cg = eval::CascadeSolver::ConjugateGradients;
    auto const coarse = Smooth(MakeIcosahedron(), ConstantWidth{0.2},
                               {.solver = cg, .stop = engine::StopAtResidual{1e-2}}),
               fine = Smooth(MakeIcosahedron(), ConstantWidth{0.2},
                             {.solver = cg, .stop = engine::StopAtResidual{1e-10}});
    for (size_t level = 0; level < 2; ++level) {
        EXPECT_LT(fine.report.levels[level].residual, 1e-10);
        EXPECT_LT(coarse.report.levels[level].sweeps, fine.report.levels[level].sweeps);
    }
}

TEST(Smooth, JacobiSweepsMustBeCounted) {
    EXPECT_EQ(test::CodeOf([] {
                  Smooth(MakeNamedCube(), ConstantWidth{0.1},
                         {.solver = eval::CascadeSolver::Jacobi});
              }),
              ErrorCode::BadOption);
}

// Sweeps in float keep about 7 digits; other solvers do not know of it.
TEST(Smooth, PrecisionIsThatOfJacobiSweeps) {
    SmoothOptions options{.solver = eval::CascadeSolver::Jacobi, .stop = engine::SweepsOnFinest{2}};
    auto const smooth = [&](Precision precision) {
        options.precision = precision;
        return Smooth(MakeNamedCube(), ConstantWidth{0.3}, options).mesh.value().positions;
    };
    double const difference =
        test::LargestDifference(smooth(Precision::Float), smooth(Precision::Double));
    EXPECT_GT(difference, 0.0);
    EXPECT_LT(difference, 1e-5);
    options.solver = eval::CascadeSolver::ConjugateGradients;
    EXPECT_EQ(smooth(Precision::Float), smooth(Precision::Double));
}

TEST(Smooth, WarningsReachTheHost) {
    engine::Scene spike = test::MakeScene({1, 0, 0, 0, 1, 0, -1, -1, 0, 0, 0, 9, 5, 5, 5},
                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                                          Sdc::SCHEME_LOOP);  // vertex 4 has no faces
    spike.path = "spike";
    test::Listener host;
    Job job(host.MakeHost());
    engine::Smooth(Model::Build(spike), ConstantWidth{0.05}, {.levels = 1}, job);
    ASSERT_EQ(host.warnings.size(), 2u);
    EXPECT_EQ(host.warnings, job.GetWarnings());
    EXPECT_NE(host.warnings[0].find("spike: "), std::string::npos) << host.warnings[0];
    EXPECT_NE(host.warnings[0].find("vertex 4"), std::string::npos) << host.warnings[0];
    EXPECT_NE(host.warnings[1].find("at vertex 3 the faces' angles"), std::string::npos)
        << host.warnings[1];
}

TEST(Smooth, RefusesWhatIsNoManifold) {
    auto const fin = test::MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1},
                                     {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, Sdc::SCHEME_LOOP);
    auto const error = test::CatchError([&] { Smooth(Model::Build(fin), ConstantWidth{0.1}); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->GetCode(), ErrorCode::BadMesh);
    EXPECT_NE(std::string(error->what()).find("needs a manifold"), std::string::npos);
}

TEST(Smooth, ProgressGoesFromNothingToAll) {
    test::Listener host;
    Job job(host.MakeHost());
    engine::Smooth(MakeIcosahedron(), ConstantWidth{0.2}, {.levels = 3}, job);
    ASSERT_GE(host.progress.size(), 2u);
    EXPECT_EQ(host.progress.front().done, 0u);
    EXPECT_EQ(host.progress.back().done, host.progress.back().total);
    EXPECT_TRUE(host.progress.back().isFinished);
    for (auto const& progress : host.progress) EXPECT_LE(progress.done, progress.total);
}

TEST(Smooth, StopsWhereItsHostWants) {
    EXPECT_TRUE(test::StopsHalfway([](Job& job) {
        engine::Smooth(MakeIcosahedron(), ConstantWidth{0.3}, {.levels = 4}, job);
    }));
    EXPECT_TRUE(test::StopsHalfway([](Job& job) {  // while it measures what the shape carries
        engine::Smooth(MakeIcosahedron(), ConstantWidth{1.5}, {.levels = 1}, job);
    }));
}

TEST(Smooth, OfTwoAtOnceOneIsStoppedAndTheOtherStaysTheSame) {
    SmoothOptions const options{.levels = 5};
    auto const alone = Smooth(MakeIcosahedron(), ConstantWidth{0.2}, options);
    test::Listener hasty, patient;
    hasty.stopAt = 20;
    bool wasStopped = false;
    engine::SmoothResult other;
    {
        std::jthread const first([&] {
            Job job(hasty.MakeHost());
            try {
                engine::Smooth(MakeIcosahedron(), ConstantWidth{0.2}, options, job);
            } catch (engine::Stopped const&) {
                wasStopped = true;
            }
        });
        std::jthread const second([&] {
            Job job(patient.MakeHost());
            other = engine::Smooth(MakeIcosahedron(), ConstantWidth{0.2}, options, job);
        });
    }
    EXPECT_TRUE(wasStopped);
    ASSERT_TRUE(other.mesh && alone.mesh);
    EXPECT_EQ(other.mesh->positions, alone.mesh->positions);
    EXPECT_TRUE(patient.progress.back().isFinished);
    EXPECT_FALSE(hasty.progress.back().isFinished);
}

}  // namespace
}  // namespace limn
