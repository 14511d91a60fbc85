// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/same_faces.h"

#include <gtest/gtest.h>

namespace limn::engine {
namespace {

using Kind = FaceDifference::Kind;

/// A quad and a triangle at its side.
far_ext::ControlMesh MakeMesh() {
    far_ext::ControlMesh mesh;
    mesh.numVertices = 5;
    mesh.faceSizes = {4, 3};
    mesh.faceVertices = {0, 1, 2, 3, 1, 4, 2};
    return mesh;
}

TEST(SameFaces, AMeshHasItsOwnFaces) {
    EXPECT_TRUE(HaveSameFaces(MakeMesh(), MakeMesh()));
    EXPECT_FALSE(FindFaceDifference(MakeMesh(), MakeMesh()));
}

TEST(SameFaces, VerticesWithoutFacesLeaveTheFacesTheSame) {
    auto other = MakeMesh();
    other.numVertices = 6;
    EXPECT_TRUE(HaveSameFaces(MakeMesh(), other));
    auto const found = FindFaceDifference(MakeMesh(), other).value();
    EXPECT_EQ(found.kind, Kind::NumVertices);
    EXPECT_EQ(found.a, 5);
    EXPECT_EQ(found.b, 6);
}

TEST(SameFaces, AMissingFaceIsADifference) {
    auto other = MakeMesh();
    other.faceSizes = {4};
    other.faceVertices.resize(4);
    EXPECT_FALSE(HaveSameFaces(MakeMesh(), other));
    EXPECT_EQ(FindFaceDifference(MakeMesh(), other).value().kind, Kind::NumFaces);
}

TEST(SameFaces, TheFirstFaceOfAnotherSizeIsNamed) {
    auto other = MakeMesh();
    other.faceSizes = {3, 4};  // the same vertices in a row
    EXPECT_FALSE(HaveSameFaces(MakeMesh(), other));
    auto const found = FindFaceDifference(MakeMesh(), other).value();
    EXPECT_EQ(found.kind, Kind::FaceSize);
    EXPECT_EQ(found.face, 0);
    EXPECT_EQ(found.a, 4);
    EXPECT_EQ(found.b, 3);
}

TEST(SameFaces, TheFirstOtherVertexIsNamed) {
    auto other = MakeMesh();
    other.faceVertices = {0, 1, 2, 3, 2, 1, 4};  // the triangle begins elsewhere
    EXPECT_FALSE(HaveSameFaces(MakeMesh(), other));
    auto const found = FindFaceDifference(MakeMesh(), other).value();
    EXPECT_EQ(found.kind, Kind::Vertex);
    EXPECT_EQ(found.face, 1);
    EXPECT_EQ(found.corner, 0);
    EXPECT_EQ(found.a, 1);
    EXPECT_EQ(found.b, 2);
}

}  // namespace
}  // namespace limn::engine
