// SPDX-License-Identifier: Apache-2.0
#include "far_ext/topology/control_mesh.h"

#include <cmath>

#include <gtest/gtest.h>

#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/meshes.h"

namespace limn {
namespace {

using far_ext::ControlMesh;

ControlMesh Cube() {
    return test::MakeCube().cage;
}

TEST(ControlMesh, ACubeIsValid) {
    EXPECT_NO_THROW(far_ext::Validate(Cube()));
}

TEST(ControlMesh, AnIndexBeyondTheVerticesIsRefused) {
    ControlMesh mesh = Cube();
    mesh.faceVertices[5] = 8;
    EXPECT_EQ(test::CodeOf([&] { far_ext::Validate(mesh); }), ErrorCode::BadMesh);
}

TEST(ControlMesh, LoopRefusesAQuadAndNamesIt) {
    ControlMesh mesh = Cube();
    mesh.scheme = Sdc::SCHEME_LOOP;
    std::string const refusal = test::RefusalOf([&] { far_ext::Validate(mesh); });
    EXPECT_NE(refusal.find("face 0 has 4 corners"), std::string::npos) << refusal;
}

TEST(ControlMesh, TagsOutOfRangeOrNotANumberAreRefused) {
    ControlMesh crease = Cube(), corner = Cube(), hole = Cube();
    crease.creaseVertexPairs = {0, 1};
    crease.creaseSharpness = {std::nanf("")};
    corner.cornerVertices = {9};
    corner.cornerSharpness = {1.0f};
    hole.holes = {6};
    for (ControlMesh const* mesh : {&crease, &corner, &hole}) {
        EXPECT_EQ(test::CodeOf([&] { far_ext::Validate(*mesh); }), ErrorCode::BadMesh);
    }
}

TEST(ControlMesh, MoreCornersThanOpenSubdivHoldsAreRefused) {
    ControlMesh mesh;
    mesh.numVertices = 70000;
    mesh.faceSizes = {70000};
    for (Index v = 0; v < 70000; ++v) mesh.faceVertices.push_back(v);
    EXPECT_EQ(test::CodeOf([&] { far_ext::Validate(mesh); }), ErrorCode::TooLarge);
}

// A crease between vertices that no edge joins makes OpenSubdiv warn; the guard must hand that over
// rather than let it print.
TEST(Refiner, WhatOpenSubdivRemarksIsHandedOver) {
    ControlMesh mesh = Cube();
    mesh.creaseVertexPairs = {0, 6};
    mesh.creaseSharpness = {2.0f};
    std::vector<std::string> warnings;
    EXPECT_NE(far_ext::CreateRefiner(mesh, &warnings), nullptr);
    EXPECT_FALSE(warnings.empty());
}

}  // namespace
}  // namespace limn
