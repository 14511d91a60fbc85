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

TEST(ControlMesh, ArraysAndRulesThatDoNotBelongAreNamedWithValueAndBound) {
    struct Case {
        void (*damage)(ControlMesh&);
        std::string refusal;
    };
    using Options = Sdc::Options;
    std::vector<Case> const cases{
        {[](ControlMesh& m) { m.scheme = static_cast<Sdc::SchemeType>(3); },
         "scheme 3 is none of OpenSubdiv's, which are 0 to 2"},
        {[](ControlMesh& m) {
             m.options.SetVtxBoundaryInterpolation(
                 static_cast<Options::VtxBoundaryInterpolation>(3));
         },
         "boundary interpolation 3 is none of OpenSubdiv's, which are 0 to 2"},
        {[](ControlMesh& m) {
             m.options.SetFVarLinearInterpolation(static_cast<Options::FVarLinearInterpolation>(6));
         },
         "face-varying interpolation 6 is none of OpenSubdiv's, which are 0 to 5"},
        {[](ControlMesh& m) { m.creaseVertexPairs = {0, 1, 2}; },
         "creases: 3 vertices and 0 sharpnesses; each needs two and one"},
        {[](ControlMesh& m) { m.cornerSharpness = {1, 2}; },
         "corners: 0 vertices and 2 sharpnesses; each needs one and one"},
        {[](ControlMesh& m) { m.fvarChannels = {{4, {0, 1, 2, 3}}}; },
         "face-varying channel 0: 4 indices; 24 are needed, one per corner"},
        {[](ControlMesh& m) {
             m.fvarChannels.assign(2, {24, std::vector<Index>(24, 7)});
             m.fvarChannels[1].valueIndices[9] = 24;
         },
         "face-varying channel 1: face 2 uses value 24; there are 24 values"}};
    for (Case const& damaged : cases) {
        ControlMesh mesh = Cube();
        damaged.damage(mesh);
        EXPECT_EQ(test::RefusalOf([&] { far_ext::Validate(mesh); }), damaged.refusal);
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
