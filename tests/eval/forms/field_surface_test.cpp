// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/field_surface.h"

#include <cmath>

#include <gtest/gtest.h>

#include "eval/surface/surface_place.h"
#include "eval/surface/surface_sample.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using Vector = Eigen::Vector3d;

/// Calls visit(place, vector) for places all over the surface.
template <class Visit>
void ForEachPlace(engine::Scene const& scene, eval::FieldSurface const& field, Visit visit) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    eval::LimitSurface const surface(*refiner);
    eval::FaceTree tree(surface, scene.positions, 3);
    eval::FieldSurface::Sampler sampler(field);
    int numFaces = 0;
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (!surface.HasLimit(face)) continue;
        tree.Bind(face);
        ++numFaces;
        eval::ForEachGaussPoint(surface, face, [&](eval::SurfacePlace const& place, double) {
            Vector vector;
            sampler.Evaluate(face, place.domain, {&place.s, 1}, {&place.t, 1}, {&vector, 1});
            visit(eval::EvaluateSample(tree, place.domain, place.s, place.t), vector);
        });
    }
    EXPECT_GT(numFaces, 0);
}

/// The gradient of a coordinate is the axis less its part along the limit normal: the largest
/// deviation from that.
double FindDeviation(engine::Scene const& scene, int levels) {
    double worst = 0.0;
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    for (size_t axis = 0; axis < 3; ++axis) {
        auto const form = test::MakeCoordinateForm(refiner->GetLevel(0), scene.positions, axis);
        eval::FieldSurface const field(scene.cage, scene.positions, form, levels);
        ForEachPlace(scene, field, [&](eval::SurfaceSample const& sample, Vector const& vector) {
            Vector const unit = Vector::Unit(static_cast<Eigen::Index>(axis));
            worst = test::Worse(worst,
                                (vector - (unit - unit.dot(sample.normal) * sample.normal)).norm());
        });
    }
    return worst;
}

TEST(FieldSurface, IsExactInTheRegularInterior) {
    EXPECT_LT(FindDeviation(test::MakeTorus(9, 7), 0), 1e-12);
    EXPECT_LT(FindDeviation(test::MakeTriangleTorus(9, 7), 0), 1e-12);
}

// Elsewhere a few levels make it good: regular faces reach nearer and nearer to what is not.
TEST(FieldSurface, ConvergesEverywhereElse) {
    for (auto const& scene :
         {test::MakeCube(), test::MakeQuadSphere(1), test::MakeIrregularTriangles(7, 6, 2),
          test::MakeIcosphere(1), test::MakeDodecahedron(), test::MakeGridWithHole(5, 4)}) {
        double const coarse = FindDeviation(scene, 2), fine = FindDeviation(scene, 4);
        EXPECT_LT(fine, 2e-3);
        EXPECT_LT(fine, 0.3 * coarse);
    }
}

// A form without pattern, regular faces: the exact values of level 0 are those of level 2.
TEST(FieldSurface, DoesNotDependOnTheLevelWhereItIsExact) {
    for (auto const& scene : {test::MakeTorus(9, 7), test::MakeTriangleTorus(9, 7)}) {
        auto const refiner = test::MakeRefiner(scene, 0);
        auto const form =
            test::MakeNoise(static_cast<size_t>(refiner->GetLevel(0).GetNumEdges()), 4);
        std::vector<Vector> found[2];
        for (int k : {0, 1}) {
            eval::FieldSurface const field(scene.cage, scene.positions, form, 2 * k);
            ForEachPlace(scene, field, [&](eval::SurfaceSample const&, Vector const& vector) {
                found[k].push_back(vector);
            });
        }
        ASSERT_EQ(found[0].size(), found[1].size());
        for (size_t i = 0; i < found[0].size(); ++i)
            EXPECT_LT((found[0][i] - found[1][i]).norm(), 1e-10 * (1.0 + found[0][i].norm()));
    }
}

// What a texture's seams ask for: the two faces at an edge have one vector there, of any field
// and on any level, since the refined faces on either side are as near to an extraordinary vertex.
TEST(FieldSurface, IsTheSameFromBothSidesOfAnEdge) {
    auto const findJump = [](engine::Scene const& scene, int levels) {
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        eval::LimitSurface const surface(*refiner);
        auto const level = refiner->GetLevel(0);
        eval::FieldSurface const field(scene.cage, scene.positions,
                                       test::MakeNoise(static_cast<size_t>(level.GetNumEdges()), 4),
                                       levels);
        eval::FieldSurface::Sampler sampler(field);
        double jump = 0.0;
        int numEdges = 0;
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            auto const faces = level.GetEdgeFaces(edge);
            if (faces.size() != 2 || level.IsEdgeInfSharp(edge)) continue;
            ++numEdges;
            auto const locals = level.GetEdgeFaceLocalIndices(edge);
            for (double tau : {0.11, 0.4, 0.83}) {
                Vector sides[2];
                for (int k : {0, 1}) {
                    auto const place = eval::GetEdgePlace(surface, faces[k],
                                                          level.GetFaceVertices(faces[k]).size(),
                                                          locals[k], k == 0 ? tau : 1.0 - tau);
                    sampler.Evaluate(faces[k], place.domain, {&place.s, 1}, {&place.t, 1},
                                     {&sides[k], 1});
                }
                jump = test::Worse(jump, (sides[0] - sides[1]).norm() / (1.0 + sides[0].norm()));
            }
        }
        EXPECT_GT(numEdges, 0);
        return jump;
    };
    for (auto const& scene :
         {test::MakeTorus(9, 7), test::MakeTriangleTorus(9, 7), test::MakeCube(),
          test::MakeQuadSphere(1), test::MakeIrregularTriangles(7, 6, 2), test::MakeDodecahedron(),
          test::MakeGridWithHole(5, 4)}) {
        for (int levels : {1, 3}) EXPECT_LT(findJump(scene, levels), 1e-11);
    }
}

TEST(FieldSurface, WhatIsOutOfRangeIsRefused) {
    auto const cube = test::MakeCube();
    std::vector<double> const form(12, 1.0), six(6);
    EXPECT_EQ(test::RefusalOf([&] { eval::FieldSurface(cube.cage, six, form, 1); }),
              "positions: 6 values are too few for 8 vertices of 3");
    EXPECT_EQ(test::RefusalOf([&] { eval::FieldSurface(cube.cage, cube.positions, six, 1); }),
              "form: 6 values are too few for 12 edges of 1");
    eval::FieldSurface const field(cube.cage, cube.positions, form, 1);
    eval::FieldSurface::Sampler sampler(field);
    std::vector<double> const s{0.5, 0.5}, t{0.5, -3.0};
    std::vector<Vector> vectors(2);
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(77, 0, s, s, vectors); }),
              "face 77 does not exist; the surface has 6 faces, 0 to 5");
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(0, 1, s, s, vectors); }),
              "domain 1 does not exist; face 0 has domains 0 to 0");
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(0, 0, s, t, vectors); }),
              "place 1: (0.5, -3) lies outside domain 0 of face 0");
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(0, 0, s, s, std::span(vectors).first(1)); }),
              "results: room for 1 is too little for 2 places");
}

TEST(FieldSurface, AnEvaluatorIsNearTheDoubles) {
    auto const scene = test::MakeQuadSphere(1);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const form = test::MakeCoordinateForm(refiner->GetLevel(0), scene.positions, 1);
    eval::FieldSurface const expected(scene.cage, scene.positions, form, 1);
    eval::TableEvaluator door(eval::EvaluatorKind::OsdCpu);
    eval::FieldSurface const found(scene.cage, scene.positions, form, 1, &door);
    std::vector<Vector> vectors;
    double largest = 0.0, worst = 0.0;
    ForEachPlace(scene, expected, [&](eval::SurfaceSample const&, Vector const& vector) {
        vectors.push_back(vector);
        largest = test::Worse(largest, vector.norm());
    });
    size_t place = 0;
    ForEachPlace(scene, found, [&](eval::SurfaceSample const&, Vector const& vector) {
        worst = test::Worse(worst, (vector - vectors[place++]).norm());
    });
    EXPECT_LT(worst, 1e-5 * largest);
    std::vector<std::string> names;
    for (auto const& use : door.GetUses()) names.push_back(use.what);
    EXPECT_EQ(names, (std::vector<std::string>{"S0", "S1", "covectors"}));
}

}  // namespace
}  // namespace limn
