// SPDX-License-Identifier: Apache-2.0
#include "engine/field/field.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::Field;
using engine::FieldOptions;
using engine::Job;
using engine::Model;

Field Design(Model const& model, FieldOptions const& options) {
    Job job;
    return engine::DesignField(model, options, job);
}

Model MakeSphere() {
    return Model::Build(test::MakeQuadSphere(1));
}

TEST(Field, KeepsItsLawsOnASphere) {
    auto const field =
        Design(MakeSphere(), {.sources = {{0, 1.0}, {5, -1.0}}, .vortices = {{2, 2.0}, {9, -2.0}}});
    EXPECT_LT(field.audit.maxCurlOfGradient, 1e-12);
    EXPECT_LT(field.audit.maxDivergenceOfVortex, 1e-12);
    EXPECT_GT(field.audit.gradientNorm, 0.1);
    EXPECT_GT(field.audit.vortexNorm, 0.1);
    EXPECT_LT(field.audit.harmonicNorm, 1e-10);
    EXPECT_EQ(field.audit.numGenerators, 0);
    EXPECT_EQ(field.audit.eulerCharacteristic, 2);
    EXPECT_EQ(field.audit.indices.sum, 2.0);
}

// d1 S1 = S2 d1 and d0 S0 = S1 d0 on every level.
TEST(Field, IsSubdividedWithTheSurface) {
    auto const field = Design(MakeSphere(), {.sources = {{0, 1.0}, {5, -1.0}}, .levels = 2});
    EXPECT_EQ(field.refined->GetMaxLevel(), 2);
    EXPECT_EQ(field.form.size(), static_cast<size_t>(field.refined->GetLevel(2).GetNumEdges()));
    EXPECT_EQ(field.mesh.cage.numVertices, field.refined->GetLevel(2).GetNumVertices());
    EXPECT_EQ(field.faceVectors.size(), field.mesh.cage.faceSizes.size());
    EXPECT_LT(field.audit.commutationD0, 1e-14);
    EXPECT_LT(field.audit.commutationD1, 1e-14);
}

// The gradient of the coordinate y is the axis, projected to the tangent plane.
TEST(Field, OfGivenEdgesIsTheirs) {
    Model const model = MakeSphere();
    auto const form = test::MakeCoordinateForm(model.GetLevel(), model.GetPositions(), 1);
    auto const field = Design(model, {.edges = form, .levels = 1});
    ASSERT_EQ(field.vectors.size(), static_cast<size_t>(field.mesh.cage.numVertices));
    for (size_t i = 0; i < field.vectors.size(); ++i) {
        double const* const n = &field.mesh.normals[3 * i];
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(field.vectors[i][c], (c == 1 ? 1.0 : 0.0) - n[1] * n[c], 1e-9);
    }
}

TEST(Field, HasVectorsAtVerticesOnlyWhereAskedFor) {
    FieldOptions options{.sources = {{0, 1.0}, {5, -1.0}}};
    options.hasVertexVectors = false;
    auto const field = Design(MakeSphere(), options);
    EXPECT_TRUE(field.vectors.empty());
    EXPECT_TRUE(field.mesh.normals.empty());
    EXPECT_EQ(field.refined->GetMaxLevel(), 0);
}

// A pentagon has no limit vectors at its vertices: a level more.
TEST(Field, PolygonsAreRefinedForVectorsAtVertices) {
    Model const model = Model::Build(test::MakeDodecahedron());
    FieldOptions options{.sources = {{0, 1.0}, {5, -1.0}}};
    EXPECT_EQ(Design(model, options).refined->GetMaxLevel(), 1);
    options.hasVertexVectors = false;
    EXPECT_EQ(Design(model, options).refined->GetMaxLevel(), 0);
}

TEST(Field, HarmonicFieldsAreNeitherGradientNorVortex) {
    auto const field =
        Design(Model::Build(test::MakeTorus(7, 5)), {.harmonics = std::vector<double>{1.0, 0.5}});
    EXPECT_EQ(field.audit.numGenerators, 2);
    EXPECT_GT(field.audit.harmonicNorm, 0.1);
    EXPECT_LT(field.audit.gradientNorm + field.audit.vortexNorm, 1e-9);
    EXPECT_EQ(field.audit.indices.sum, 0.0);
}

TEST(Field, StrengthsThatHaveNowhereToGoAreRefusedOrBalanced) {
    FieldOptions options{.sources = {{0, 1.0}}};
    auto const refusal = test::RefusalOf([&] { Design(MakeSphere(), options); });
    EXPECT_NE(refusal.find("the sources and sinks on the component of face 0 add up to 1"),
              std::string::npos)
        << refusal;
    options.isBalanced = true;
    EXPECT_GT(Design(MakeSphere(), options).audit.gradientNorm, 0.1);
    FieldOptions const vortex{.vortices = {{3, 1.0}}};
    EXPECT_NE(test::RefusalOf([&] { Design(MakeSphere(), vortex); }).find("the vortices on"),
              std::string::npos);
}

TEST(Field, WhatIsNotThereIsRefused) {
    auto const code = [](FieldOptions const& options) {
        return test::CodeOf([&] { Design(MakeSphere(), options); });
    };
    EXPECT_EQ(code({.sources = {{-1, 1.0}}}), ErrorCode::BadMesh);
    EXPECT_EQ(code({.sources = {{26, 1.0}}}), ErrorCode::BadMesh);
    EXPECT_EQ(code({.vortices = {{24, 1.0}}}), ErrorCode::BadMesh);
    EXPECT_EQ(code({.harmonics = std::vector<double>{1.0}}), ErrorCode::BadMesh);
    EXPECT_EQ(code({.edges = std::vector<double>(47, 0.0)}), ErrorCode::BadMesh);
    EXPECT_FALSE(code({.edges = std::vector<double>(48, 0.0)}));
}

TEST(Field, StopsWhereItsHostWants) {
    EXPECT_TRUE(test::StopsHalfway([](Job& job) {
        engine::DesignField(MakeSphere(), {.sources = {{0, 1.0}, {5, -1.0}}, .levels = 2}, job);
    }));
}

}  // namespace
}  // namespace limn
