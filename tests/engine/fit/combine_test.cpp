// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/combine.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::Carry;
using engine::CombineOptions;
using engine::Model;
using test::Rows;
using test::ToRows;

Model MakeNoisyTorus(unsigned seed, double bend = 0.0) {
    engine::Scene torus = test::MakeTorus(14, 10);
    test::AddNoise(torus, 0.2, seed);
    for (size_t i = 0; i < torus.positions.size(); i += 3)
        torus.positions[i + 2] += bend * torus.positions[i] * torus.positions[i];
    return Model::Build(torus);
}

Rows Combine(Model const& model, CombineOptions const& options) {
    engine::Job job;
    return ToRows(engine::Combine(model, options, job).mesh.positions);
}

// Turning the mesh turns the result where offsets are carried in its local frames.
TEST(Combine, InLocalFramesTurnsWithTheMesh) {
    Model const mesh = MakeNoisyTorus(1, 0.4), from = MakeNoisyTorus(2), to = MakeNoisyTorus(3);
    Eigen::Matrix3d const R =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
    Rows const turned = ToRows(mesh.GetPositions()) * R.transpose();
    Model const turnedMesh = mesh.WithPoints({turned.data(), turned.data() + turned.size()});
    auto const miss = [&](Carry carry) {
        CombineOptions const options{.offsets = {{from, to, 0.8}}, .carry = carry};
        Rows const before = Combine(mesh, options) * R.transpose();
        return test::LargestOf(Combine(turnedMesh, options) - before);
    };
    EXPECT_LT(miss(Carry::Local), 1e-12);
    EXPECT_GT(miss(Carry::Object), 1e-2);
}

TEST(Combine, OffsetsAddUpInTheOrderOfNothing) {
    Model const mesh = MakeNoisyTorus(1), from = MakeNoisyTorus(2), to = MakeNoisyTorus(3);
    Rows const both = Combine(mesh, {.offsets = {{from, to, 2.0}, {from, mesh, -0.5}}});
    Rows const one = Combine(mesh, {.offsets = {{from, to, 2.0}}}),
               other = Combine(mesh, {.offsets = {{from, mesh, -0.5}}});
    EXPECT_LT(test::LargestOf(both - (one + other - ToRows(mesh.GetPositions()))), 1e-13);
}

TEST(Combine, RefusesWeightsThatAreNoNumbersAndSumsBeyondThem) {
    Model const mesh = MakeNoisyTorus(1);
    for (double const bad : {std::nan(""), static_cast<double>(INFINITY)}) {
        for (CombineOptions const& options :
             {CombineOptions{.scale = bad}, CombineOptions{.added = {{mesh, bad}}},
              CombineOptions{.offsets = {{mesh, mesh, bad}}}})
            EXPECT_EQ(test::CodeOf([&] { Combine(mesh, options); }), ErrorCode::BadOption) << bad;
    }
    engine::Scene coloured = test::MakeTorus(9, 7);
    coloured.primvars = {{"heat", 1, std::vector<float>(coloured.positions.size() / 3, 1e30f)}};
    Model const hot = Model::Build(coloured);
    std::string const why =
        test::RefusalOf([&] { Combine(hot, {.scale = 1e20, .added = {{hot, 1.0}}}); });
    EXPECT_NE(why.find("values of 'heat'"), std::string::npos) << why;
}

TEST(Combine, OffsetPrimvarsNeedAPositionPerVertex) {
    Model const mesh = MakeNoisyTorus(1);
    EXPECT_EQ(test::CodeOf([&] { engine::MakeOffsetPrimvars("d", mesh, {1.0, 2.0}); }),
              ErrorCode::BadOption);
}

// A scalar is added where all have it; colours, and what one lacks, stay the first's.
TEST(Combine, AddsOnlyScalarsThatAllHave) {
    engine::Scene scene = test::MakeTorus(9, 7);
    size_t const count = scene.positions.size() / 3;
    scene.primvars = {{"weight", 1, std::vector<float>(count, 2.0f)},
                      {"own", 1, std::vector<float>(count, 3.0f)},
                      {"color", 3, std::vector<float>(3 * count, 0.5f)}};
    engine::Scene other = scene;
    other.primvars.erase(other.primvars.begin() + 1);
    engine::Job job;
    auto const sum = engine::Combine(Model::Build(scene),
                                     {.scale = 3.0, .added = {{Model::Build(other), -0.5}}}, job);
    ASSERT_EQ(sum.mesh.primvars.size(), 3u);
    EXPECT_EQ(sum.mesh.primvars[0].values, std::vector<float>(count, 5.0f));
    EXPECT_EQ(sum.mesh.primvars[1].values, scene.primvars[1].values);
    EXPECT_EQ(sum.mesh.primvars[2].values, scene.primvars[2].values);
    auto const alone = engine::Combine(Model::Build(scene), {.scale = 3.0}, job);
    EXPECT_EQ(alone.mesh.primvars[0].values, scene.primvars[0].values);
}

TEST(Combine, RefusesOtherFacesAndNamesTheirFile) {
    Model const mesh = MakeNoisyTorus(1);
    engine::Scene turned = mesh.MakeScene();
    turned.path = "other.obj";
    std::swap(turned.cage.faceVertices[21], turned.cage.faceVertices[22]);
    Model const other = Model::Build(turned);
    engine::Job job;
    for (CombineOptions const& options : {CombineOptions{.added = {{other, 1.0}}},
                                          {.offsets = {{mesh, other, 1.0}}},
                                          {.offsets = {{other, mesh, 1.0}}}}) {
        auto const error = test::CatchError([&] { engine::Combine(mesh, options, job); });
        ASSERT_TRUE(error.has_value());
        EXPECT_EQ(error->GetCode(), ErrorCode::BadMesh);
        EXPECT_NE(std::string(error->what()).find("other.obj"), std::string::npos);
        EXPECT_NE(std::string(error->what()).find("face 5 "), std::string::npos);
    }
}

TEST(Combine, StopsWhereItsHostWants) {
    Model const mesh = MakeNoisyTorus(1);
    EXPECT_TRUE(test::StopsHalfway(
        [&](engine::Job& job) { engine::Combine(mesh, {.offsets = {{mesh, mesh, 1.0}}}, job); }));
}

}  // namespace
}  // namespace limn
