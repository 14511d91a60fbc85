// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/differential.h"

#include <gtest/gtest.h>

#include "engine/differential/edit_reader.h"
#include "engine/differential/polyline_file.h"
#include "engine/scene/refine.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/fit_meshes.h"
#include "support/listener.h"
#include "support/refined.h"

namespace limn {
namespace {

using engine::DifferentialOptions;
using far_ext::SubdivisionRule;

/// The result, and what the job was warned of.
struct Refined {
    engine::Scene mesh;
    engine::DifferentialReport report;
    std::vector<std::string> warnings;
};

Refined RefineAndReport(engine::Scene const& scene, int levels, DifferentialOptions options) {
    options.levels = levels;
    engine::Job job;
    auto [mesh, report] = engine::RefineDifferentially(engine::Model::Build(scene), options, job);
    return {std::move(mesh), report, job.GetWarnings()};
}

engine::Scene Refine(engine::Scene const& scene, int levels, DifferentialOptions const& options) {
    return RefineAndReport(scene, levels, options).mesh;
}

engine::Scene LoadBumpy() {  // an irregular, well-shaped sphere
    auto scene = test::LoadDifferential("icosa", Sdc::SCHEME_LOOP);
    scene = test::Refine(scene, 1);
    for (size_t i = 0; i < scene.positions.size(); ++i)
        scene.positions[i] *= 1.0 + 0.1 * std::sin(static_cast<double>(i / 3));
    return scene;
}

// Turning and moving the cage turns and moves the result; growing it grows it.
TEST(Differential, IsTheSameFromEverySide) {
    auto const scene = LoadBumpy();
    auto moved = scene;
    for (size_t i = 0; i < scene.positions.size(); i += 3) {
        moved.positions[i] = 2.0 * scene.positions[i + 1] + 5.0;
        moved.positions[i + 1] = -2.0 * scene.positions[i] - 1.0;
        moved.positions[i + 2] = 2.0 * scene.positions[i + 2];
    }
    for (int dirMagLevels : {0, 1}) {
        DifferentialOptions const options{.dirMagLevels = dirMagLevels, .tolerance = 1e-12};
        auto const a = Refine(scene, 2, options), b = Refine(moved, 2, options);
        for (size_t i = 0; i < a.positions.size(); i += 3) {
            EXPECT_NEAR(b.positions[i], 2.0 * a.positions[i + 1] + 5.0, 1e-9);
            EXPECT_NEAR(b.positions[i + 1], -2.0 * a.positions[i] - 1.0, 1e-9);
            EXPECT_NEAR(b.positions[i + 2], 2.0 * a.positions[i + 2], 1e-9);
        }
    }
}

// The topology, and what goes with it, is that of the refinement in space.
TEST(Differential, AttributesFollow) {
    auto const scene = test::MakeTorus(8, 6);
    auto const spatial = test::Refine(scene, 2), differential = Refine(scene, 2, {});
    EXPECT_EQ(differential.cage.faceVertices, spatial.cage.faceVertices);
    EXPECT_EQ(differential.uvs, spatial.uvs);
}

// Far from the origin nothing is lost but the digits that coordinates lose by their size; 2^-20
// keeps moved points exact.
TEST(Differential, TranslationsCostNothingButTheirDigits) {
    for (auto scene : {LoadBumpy(), test::LoadDifferential("gridholetri", Sdc::SCHEME_LOOP)}) {
        for (double& x : scene.positions) x = std::round(x * 0x1p20) / 0x1p20;
        double const diagonal = test::BoxDiagonal(scene.positions);
        for (double diagonals : {10.0, 125.0, 1e4}) {
            double const offset = std::round(diagonals * diagonal);
            auto moved = scene;
            for (double& x : moved.positions) x += offset;
            for (int dirMagLevels : {0, 1}) {
                DifferentialOptions const options{.dirMagLevels = dirMagLevels, .tolerance = 1e-12};
                auto here = RefineAndReport(scene, 3, options);
                auto const there = RefineAndReport(moved, 3, options);
                EXPECT_TRUE(there.report.converged);
                for (double& x : here.mesh.positions) x += offset;
                EXPECT_LT(test::LargestDifference(here.mesh.positions, there.mesh.positions),
                          0x1p-53 * 16.0 * (offset + diagonal) + 1e-11 * diagonal)
                    << diagonals << " diagonals off";
            }
        }
    }
}

// All levels in space leave nothing to do: the mesh itself has its coordinates.
TEST(Differential, AllLevelsInSpaceChangeNothing) {
    auto const scene = LoadBumpy();
    auto const spatial = test::Refine(scene, 2);
    auto const result = Refine(scene, 2, {.spatialLevels = 2});
    EXPECT_LT(test::LargestDifference(spatial.positions, result.positions), 1e-9);
}

/// Thin-plate energies of a rule in differential space over those in space: the mean's ratio, and
/// the integral's.
std::array<double, 2> CompareEnergies(engine::Scene const& scene,
                                      far_ext::TunedRule const& rule = SubdivisionRule::Butterfly) {
    auto const report = RefineAndReport(scene, 3, {.rule = rule}).report;
    engine::Job job;
    auto const spatial =
        engine::RefineUniformly(engine::Model::Build(scene), {.levels = 3, .rule = rule}, job);
    auto const refiner = far_ext::CreateRefiner(spatial.cage);
    auto const energy = eval::FindThinPlateEnergy(
        eval::MeasureMeshCurvature(refiner->GetLevel(0), spatial.positions));
    return {report.energy.mean / energy.mean, report.energy.integral / energy.integral};
}

// Differential Butterfly is smoother than spatial Butterfly on irregular meshes (surface spec 2.6
// and 4).
TEST(Differential, ButterflyGetsSmoother) {
    auto const [mean, integral] = CompareEnergies(LoadBumpy());
    EXPECT_LE(mean, 0.95);
    EXPECT_LE(integral, 0.8);
}

TEST(Differential, ButterflyGetsMuchSmootherOnIrregularMeshes) {
    for (char const* name : {"tri/eight.off", "tri/spot_low_resolution.obj"}) {
        auto scene = test::LoadAsset(name);
        scene.cage.scheme = Sdc::SCHEME_LOOP;
        auto const [mean, integral] = CompareEnergies(scene);
        EXPECT_LE(mean, 0.75) << name;
        EXPECT_LE(integral, 0.8) << name;
    }
}

// Rules that keep vertices ripple in space; approximating ones have less to gain.
TEST(Differential, RulesThatKeepVerticesGainMost) {
    auto scene = test::LoadAsset("tri/spot_low_resolution.obj");
    scene.cage.scheme = Sdc::SCHEME_LOOP;
    double const ofLoop = CompareEnergies(scene, SubdivisionRule::Scheme)[1];
    for (far_ext::TunedRule const& rule :
         {far_ext::TunedRule(SubdivisionRule::OriginalButterfly),
          far_ext::TunedRule(SubdivisionRule::OriginalButterfly, 1.0 / 32),
          far_ext::TunedRule(SubdivisionRule::Interpolating)})
        EXPECT_LT(CompareEnergies(scene, rule)[1], 0.85 * ofLoop);
    auto const quads = test::LoadAsset("tri/torus_quad.off");
    double const ofCatmark = CompareEnergies(quads, SubdivisionRule::Scheme)[1];
    for (auto rule : {SubdivisionRule::Kobbelt, SubdivisionRule::Interpolating})
        EXPECT_LT(CompareEnergies(quads, rule)[1], 0.95 * ofCatmark);
}

// An edit that changes nothing changes nothing; every other kind does, and leaves finite positions.
TEST(Differential, EditsAct) {
    auto const scene = LoadBumpy();
    auto const plain = Refine(scene, 2, {});
    DifferentialOptions none;
    none.edit.factors = {{3, 1.0}};
    none.edit.rotations = {{3, {0, 0, 2}, 360.0}};
    EXPECT_LT(test::LargestDifference(plain.positions, Refine(scene, 2, none).positions, true),
              1e-7);
    for (int kind = 0; kind < 6; ++kind) {
        DifferentialOptions options;
        if (kind == 0) options.edit.factors = {{3, 1.5}};
        if (kind == 1) options.edit.rotations = {{3, {1, 2, 3}, 40.0}};
        if (kind == 2) options.edit.isPolarised = true;
        if (kind == 3) options.edit.means = {{3, 0.2}};
        if (kind == 4) options.edit.normals = {{3, {1, 2, 3}}};
        if (kind == 5) options.edit.filterPoints = {{0.0, 0.0}, {0.5, 0.1}, {1.0, 1.0}};
        auto const edited = Refine(scene, 2, options);
        EXPECT_GT(test::LargestDifference(plain.positions, edited.positions, true), 1e-3) << kind;
        EXPECT_TRUE(test::AreFinite(edited.positions)) << kind;
    }
}

TEST(Differential, TheFilterIsThePapers) {
    EXPECT_NEAR(engine::PolariseCurvature(0.0), 0.0, 1e-15);
    EXPECT_NEAR(engine::PolariseCurvature(0.5), 0.5, 1e-15);
    EXPECT_NEAR(engine::PolariseCurvature(1.0), 1.0, 1e-15);
    EXPECT_NEAR(engine::PolariseCurvature(0.75), 0.5 + std::pow(0.75 / 8 - 1.0 / 16, 0.25), 1e-15);
}

// Laplacians that depend on the result: what remains of their coordinates is reported, and has
// converged where that is no more than was asked for. The handle stays.
TEST(Differential, AreaLaplaciansAreFittedAsFarAsTheyCan) {
    auto const scene = LoadBumpy();
    for (auto laplacian : {engine::Laplacian::Cotangent, engine::Laplacian::Mesh}) {
        DifferentialOptions options{.laplacian = laplacian, .fitTolerance = 1e-6};
        auto const best = RefineAndReport(scene, 1, options);
        EXPECT_FALSE(best.report.converged);
        EXPECT_TRUE(best.report.hasFitStalled);
        EXPECT_LT(best.report.residual, 0.05);
        EXPECT_TRUE(test::AreFinite(best.mesh.positions));
        options.fitTolerance = 0.2;
        auto const good = RefineAndReport(scene, 1, options);
        EXPECT_TRUE(good.report.converged);
        EXPECT_FALSE(good.report.hasFitStalled);
        EXPECT_LE(good.report.residual, 0.2);
        EXPECT_LT(good.report.fitSteps, best.report.fitSteps);
        auto const spatial = test::Refine(scene, 1);
        for (size_t c = 0; c < 3; ++c) EXPECT_EQ(good.mesh.positions[c], spatial.positions[c]);
    }
}

// Each vertex has some 200 neighbours; what would take many minutes is refused before it begins.
TEST(Differential, TheMeshLaplaceOperatorHasASizeLimit) {
    auto const scene = test::MakeTriangleTorus(16, 13);
    EXPECT_EQ(test::CodeOf([&] { Refine(scene, 4, {.laplacian = engine::Laplacian::Mesh}); }),
              ErrorCode::TooLarge);
}

TEST(Differential, SizeAndTangentialShareAreWarnedOf) {
    auto const shrunk = RefineAndReport(test::MakeBipyramid(3), 2, {});
    ASSERT_EQ(shrunk.warnings.size(), 1u);
    EXPECT_NE(shrunk.warnings[0].find("times the size"), std::string::npos);
    EXPECT_NE(shrunk.warnings[0].find("`spatialLevels` 1"), std::string::npos);
    auto const edited = RefineAndReport(LoadBumpy(), 1, {.edit = {.factors = {{3, 1000.0}}}});
    EXPECT_NE(edited.warnings.back().find("factors of the `edit`"), std::string::npos);
    auto sheared = LoadBumpy();
    for (size_t i = 0; i < sheared.positions.size(); i += 3) sheared.positions[i] *= 40.0;
    auto const other = RefineAndReport(sheared, 2, {.dirMagLevels = 1});
    EXPECT_GT(other.report.tangentialShare, 0.6);
    EXPECT_NE(other.warnings.at(0).find("`dirMagLevels`"), std::string::npos);
    auto const creased = RefineAndReport(test::LoadShape("catmark_cube_creases0"), 1, {});
    EXPECT_NE(creased.warnings.at(0).find("creases get round"), std::string::npos);
}

TEST(Differential, StopsWhereItsHostWants) {
    auto const model = engine::Model::Build(LoadBumpy());
    EXPECT_TRUE(test::StopsHalfway([&](engine::Job& job) {
        engine::RefineDifferentially(model,
                                     {.levels = 2, .laplacian = engine::Laplacian::Cotangent}, job);
    }));
}

// Interior valence 2, isolated vertices, triangles without area: an answer without NaN, or a named
// refusal.
TEST(Differential, HostileMeshesHaveAnAnswer) {
    for (char const* name :
         {"catmark_val2_interior", "catmark_nonman_edges", "catmark_nonman_verts"}) {
        auto const scene = test::LoadShape(name);
        std::vector<double> positions;
        std::string const refusal =
            test::RefusalOf([&] { positions = Refine(scene, 2, {}).positions; });
        EXPECT_NE(positions.empty(), refusal.empty()) << name;
        EXPECT_TRUE(test::AreFinite(positions)) << name;
    }
    auto flat = test::MakeBipyramid(5);
    for (size_t c = 0; c < 3; ++c) flat.positions[6 + c] = flat.positions[9 + c];
    EXPECT_TRUE(test::AreFinite(Refine(flat, 2, {}).positions));
    EXPECT_NE(test::RefusalOf([&] {
                  Refine(flat, 2, {.laplacian = engine::Laplacian::Cotangent});
              }).find("has no area"),
              std::string::npos);
    EXPECT_EQ(test::CodeOf([&] {
                  Refine(test::MakeCube(), 1, {.laplacian = engine::Laplacian::Cotangent});
              }),
              ErrorCode::Unsupported);
    EXPECT_EQ(
        test::CodeOf([&] { Refine(test::MakeCube(), 1, {.dirMagLevels = 1, .spatialLevels = 1}); }),
        ErrorCode::BadOption);
}

TEST(EditReader, WhatItCannotUseIsNamed) {
    test::TemporaryFolder const folder;
    auto const refuse = [&](std::string const& text) {
        std::string const path = folder.Write("edit.json", text);
        return test::RefusalOf([&] { engine::ReadCurvatureEdit(path); });
    };
    EXPECT_EQ(
        refuse(
            R"({"curvature": [{"vertex": 3, "factor": 1.5}], "rotate": [{"vertex": 7, "axis": [0,0,1], "degrees": 20}],
                         "filter": "polarise"})"),
        "");
    EXPECT_EQ(refuse(R"({"set_curvature": [{"vertex": 3, "mean": -0.5}],
                         "set_normal": [{"vertex": 7, "normal": [0,0,2]}],
                         "filter": {"points": [[0, 0], [0.5, 0.2], [1, 1]]}})"),
              "");
    EXPECT_EQ(refuse("{}"), "");
    EXPECT_NE(refuse("{\"curvature\": ").find("no JSON"), std::string::npos);
    EXPECT_NE(refuse(R"({"curve": []})").find("key 'curve' is not known"), std::string::npos);
    EXPECT_NE(refuse(R"({"filter": "smooth"})").find("'polarise' is possible"), std::string::npos);
    EXPECT_NE(refuse(R"({"curvature": [{"vertex": -1, "factor": 1}]})").find("no 0-based index"),
              std::string::npos);
    EXPECT_NE(refuse(R"({"curvature": [{"vertex": 1, "factor": "x"}]})").find("no number 'factor'"),
              std::string::npos);
    EXPECT_NE(
        refuse(R"({"rotate": [{"vertex": 1, "axis": [0,0,0], "degrees": 5}]})").find("no axis"),
        std::string::npos);
    EXPECT_NE(
        refuse(R"({"curvature": [{"vertex": 1, "factor": 1, "size": 2}]})").find("unknown keys"),
        std::string::npos);
    EXPECT_NE(refuse(R"({"curvature": 7})").find("no list"), std::string::npos);
    EXPECT_NE(refuse(R"({"set_curvature": [{"vertex": 1, "factor": 1}]})").find("no number 'mean'"),
              std::string::npos);
    EXPECT_NE(refuse(R"({"set_normal": [{"vertex": 1, "normal": [0,0,0]}]})")
                  .find("no normal: three numbers"),
              std::string::npos);
    EXPECT_NE(refuse(R"({"filter": )" + std::string(60000, '[') + std::string(60000, ']') + "}")
                  .find("nested more than 4 deep"),
              std::string::npos);
    for (std::string const key : {"curvature", "filter", "rotate", "other\n"}) {
        std::string const message =
            refuse("{\"" + key + "\": [{\"vertex\": \"" + std::string(100000, 'x') + "\"}]}");
        EXPECT_LT(message.size(), folder.GetPath().size() + 200) << key;
    }
    EXPECT_NE(refuse("{\n\"curvature\": [}").find("line 2 is no JSON"), std::string::npos);
    EXPECT_NE(refuse(R"({"curvature": 1e999})").find("a number is too large"), std::string::npos);
}

TEST(EditReader, FiltersThatAreNoCurveAreNamed) {
    test::TemporaryFolder const folder;
    for (auto const& [filter, says] : std::vector<std::pair<std::string, std::string>>{
             {R"({"points": [[0, 0]]})", "needs two points"},
             {R"({"points": []})", "needs two points"},
             {R"({"points": [[0, 0], [0, 1]]})", "x of [0,1] is not in [0, 1], or does not rise"},
             {R"({"points": [[0.5, 0], [0.2, 1]]})", "does not rise"},
             {R"({"points": [[0, 0], [1.5, 1]]})", "is not in [0, 1]"},
             {R"({"points": [[0, 0], [1]]})", "[1] is no point"},
             {R"({"points": [[0, 0], [1, "a"]]})", "is no point"},
             {R"({"points": 3})", "'points' is no list"},
             {R"({"points": [[0, 0], [1, 1]], "more": 1})", "'polarise' is possible, or"},
             {"{}", "'polarise' is possible, or"}}) {
        std::string const path = folder.Write("edit.json", "{\"filter\": " + filter + "}");
        auto const error = test::CatchError([&] { engine::ReadCurvatureEdit(path); });
        ASSERT_TRUE(error) << filter;
        EXPECT_EQ(error->GetCode(), ErrorCode::BadMesh);
        EXPECT_NE(std::string(error->what()).find(says), std::string::npos) << error->what();
    }
}

TEST(EditReader, KeysThatStandTwiceInOneObjectAreNamed) {
    test::TemporaryFolder const folder;
    auto const refuse = [&](std::string const& text) {
        std::string const path = folder.Write("edit.json", text);
        return test::RefusalOf([&] { engine::ReadCurvatureEdit(path); }).substr(path.size());
    };
    EXPECT_EQ(refuse(R"({"curvature": [], "curvature": []})"),
              ": key 'curvature' stands twice in one object");
    EXPECT_EQ(refuse(R"({"curvature": [{"vertex": 1, "vertex": 2, "factor": 1}]})"),
              ": key 'vertex' stands twice in one object");
    EXPECT_EQ(refuse(R"({"filter": {"points": [[0, 0], [1, 1]], "points": 3}})"),
              ": key 'points' stands twice in one object");
    std::string const apart = folder.Write("apart.json",
                                           R"({"curvature": [{"vertex": 1, "factor": 1},
                                                             {"vertex": 2, "factor": 1}]})");
    EXPECT_EQ(engine::ReadCurvatureEdit(apart).factors.size(), 2u);
}

TEST(EditReader, AVertexIsSetOnceAndChangedAnyNumberOfTimes) {
    test::TemporaryFolder const folder;
    auto const refuse = [&](std::string const& key, std::string const& value) {
        std::string const entry = "{\"vertex\": 3, " + value + "}";
        std::string const path =
            folder.Write("edit.json", "{\"" + key + "\": [" + entry + ", " + entry + "]}");
        std::string const message = test::RefusalOf([&] { engine::ReadCurvatureEdit(path); });
        return message.substr(std::min(path.size(), message.size()));
    };
    EXPECT_EQ(refuse("set_curvature", R"("mean": 1)"), ": 'set_curvature' names vertex 3 twice");
    EXPECT_EQ(refuse("set_normal", R"("normal": [0, 0, 1])"),
              ": 'set_normal' names vertex 3 twice");
    EXPECT_EQ(refuse("curvature", R"("factor": 2)"), "");
    EXPECT_EQ(refuse("rotate", R"("axis": [0, 0, 1], "degrees": 5)"), "");
}

TEST(EditReader, DeepAndLongValuesAreRefusedInAShortLine) {
    test::TemporaryFolder const folder;
    auto const refuse = [&](std::string const& text) {
        std::string const path = folder.Write("edit.json", text);
        std::string const message =
            test::RefusalOf([&] { engine::ReadCurvatureEdit(path); }).substr(path.size());
        EXPECT_LT(message.size(), 200u);
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message;
    };
    std::string const deep(60000, '['), end(60000, ']');
    EXPECT_EQ(refuse("{\"filter\": " + deep + end + "}"), ": values are nested more than 4 deep");
    EXPECT_EQ(refuse(deep), ": values are nested more than 4 deep");
    std::string numbers = "1";
    for (int i = 0; i < 10000; ++i) numbers += ", 1";
    EXPECT_NE(refuse("{\"curvature\": [[" + numbers + "]]}").find("has no number 'vertex'"),
              std::string::npos);
    refuse("{\"" + std::string(10000, 'k') + "\": 1}");
    refuse("{\"filter\": \"a\\nb\"}");
}

// The solve makes errors of the coordinates larger.
TEST(Differential, AnEvaluatorIsNearTheDoubles) {
    auto const scene = LoadBumpy();
    for (auto rule : {SubdivisionRule::Scheme, SubdivisionRule::Butterfly}) {
        auto const expected = Refine(scene, 2, {.rule = rule});
        eval::TableEvaluator door(eval::EvaluatorKind::OsdCpu);
        auto const found = Refine(scene, 2, {.rule = rule, .evaluator = &door});
        EXPECT_LT(test::LargestDifference(found.positions, expected.positions),
                  2e-6 * test::BoxDiagonal(scene.positions));
        ASSERT_FALSE(door.GetUses().empty());
        EXPECT_EQ(door.GetUses()[0].what, "S0");
        EXPECT_EQ(door.GetUses()[0].applications, 4u);  // in space and on coordinates
    }
}

}  // namespace
}  // namespace limn
