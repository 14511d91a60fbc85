// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/field_match.h"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "eval/forms/field_designer.h"
#include "eval/forms/field_index.h"
#include "eval/forms/vertex_covectors.h"
#include "far_ext/forms/face_vectors.h"
#include "far_ext/forms/form_stencils.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using Values = std::vector<double>;
using Wanted = std::vector<eval::WantedVector>;

// -------- fields

/// A form on a mesh.
struct Field {
    engine::Scene scene;
    Values form;
};

/// A source, a sink and two vortices, or harmonic circulations.
enum class Made { BySources, BySourcesAndVortices, ByHarmonics };

Values Design(engine::Scene const& scene, Made made) {
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const level = refiner->GetLevel(0);
    eval::FieldDesigner designer(level, scene.positions, eval::AtBoundary::Tangent);
    Values form(static_cast<size_t>(level.GetNumEdges()), 0.0);
    auto const add = [&](Values const& part) {
        for (size_t i = 0; i < form.size(); ++i) form[i] += part[i];
    };
    if (made == Made::ByHarmonics) {
        for (Values const& harmonic : designer.GetHarmonics()) add(harmonic);
        return form;
    }
    Values sources(static_cast<size_t>(level.GetNumVertices()), 0.0),
        vortices(static_cast<size_t>(level.GetNumFaces()), 0.0);
    sources[0] = 1.0;
    sources[sources.size() / 2] = -1.0;
    add(designer.MakeGradient(sources));
    if (made == Made::BySources) return form;
    vortices[vortices.size() / 3] = 2.0;
    vortices[2 * vortices.size() / 3] = -2.0;
    add(designer.MakeVortex(vortices));
    return form;
}

/// The field, subdivided: on the refined mesh, whose edges have numbers of their own.
Field Subdivide(Field const& field, int levels) {
    auto const refiner = test::MakeRefiner(field.scene, levels);
    Values form = field.form;
    for (int level = 1; level <= levels; ++level)
        form = far_ext::BuildFormStencils(*refiner, level).s1.Apply(form);
    Field fine{test::Refine(field.scene, levels), Values(form.size())};
    auto const fineRefiner = test::MakeRefiner(fine.scene, 0);
    auto const from = refiner->GetLevel(levels), to = fineRefiner->GetLevel(0);
    for (Index face = 0; face < to.GetNumFaces(); ++face) {
        for (int j = 0; j < to.GetFaceEdges(face).size(); ++j) {
            fine.form[static_cast<size_t>(to.GetFaceEdges(face)[j])] =
                form[static_cast<size_t>(from.GetFaceEdges(face)[j])];
        }
    }
    return fine;
}

/// Of quads and of triangles, closed and open, regular and not.
std::vector<engine::Scene> MakeMeshes() {
    return {test::Refine(test::LoadSpot(), 1),
            test::MakeQuadSphere(2),
            test::MakeTorus(9, 7),
            test::MakeTorus(16, 8),
            test::MakeIcosphere(2),
            test::MakeGridWithHole(7, 5),
            test::MakeIrregularTriangles(9, 8, 2)};
}

// -------- vectors

Wanted FindVertexVectors(Field const& field) {
    auto const refiner = test::MakeRefiner(field.scene, 0);
    eval::VertexCovectors const covectors(*refiner, 0);
    Wanted vectors;
    for (Index vertex = 0; vertex < field.scene.cage.numVertices; ++vertex) {
        Eigen::Vector3d const v =
            covectors.Find(vertex, field.form, field.scene.positions).GetVector();
        vectors.push_back({false, vertex, {v[0], v[1], v[2]}});
    }
    return vectors;
}

Wanted FindFaceVectors(Field const& field) {
    auto const refiner = test::MakeRefiner(field.scene, 0);
    auto const rows = far_ext::BuildFaceVectors(refiner->GetLevel(0), field.scene.positions);
    Values const values = rows.Apply(field.form);
    Wanted vectors;
    for (Index face = 0; face < field.scene.cage.GetNumFaces(); ++face) {
        size_t const at = 3 * static_cast<size_t>(face);
        vectors.push_back({true, face, {values[at], values[at + 1], values[at + 2]}});
    }
    return vectors;
}

Values Match(engine::Scene const& scene, Wanted const& wanted) {
    return eval::MatchVectors(*test::MakeRefiner(scene, 0), scene.positions, wanted);
}

double FindRelativeDifference(Values const& found, Values const& expected) {
    Eigen::Map<Eigen::VectorXd const> const a(found.data(),
                                              static_cast<Eigen::Index>(found.size())),
        b(expected.data(), static_cast<Eigen::Index>(expected.size()));
    return (a - b).norm() / b.norm();
}

double FindRelativeDifference(Wanted const& found, Wanted const& expected) {
    auto const flatten = [](Wanted const& vectors) {
        Values values;
        for (auto const& at : vectors)
            values.insert(values.end(), at.vector.begin(), at.vector.end());
        return values;
    };
    return FindRelativeDifference(flatten(found), flatten(expected));
}

void ExpectSameSingularities(engine::Scene const& scene, Values const& found,
                             Values const& expected) {
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const a = eval::FindFieldIndices(refiner->GetLevel(0), found),
               b = eval::FindFieldIndices(refiner->GetLevel(0), expected);
    ASSERT_EQ(a.singularities.size(), b.singularities.size());
    for (size_t i = 0; i < a.singularities.size(); ++i) {
        EXPECT_EQ(a.singularities[i].isFace, b.singularities[i].isFace);
        EXPECT_EQ(a.singularities[i].element, b.singularities[i].element);
        EXPECT_EQ(a.singularities[i].index, b.singularities[i].index);
    }
}

// -------- a designed field from its own vectors

// Also where vectors do not determine the form: on a torus of even sides alternating values have no
// vectors, on triangles a third of the forms has none.
TEST(FieldMatch, OwnVectorsAtVerticesGiveADesignedFieldBack) {
    for (auto const& scene : MakeMeshes()) {
        for (Made made : {Made::BySources, Made::BySourcesAndVortices, Made::ByHarmonics}) {
            Field const field{scene, Design(scene, made)};
            if (made == Made::ByHarmonics &&
                test::LargestDifference(field.form, Values(field.form.size())) == 0.0)
                continue;
            SCOPED_TRACE(scene.name + ", " + std::to_string(field.form.size()) + " edges");
            Wanted const wanted = FindVertexVectors(field);
            Values const found = Match(scene, wanted);
            EXPECT_LT(FindRelativeDifference(FindVertexVectors({scene, found}), wanted), 1e-10);
            EXPECT_LT(FindRelativeDifference(found, field.form), 1e-5);
            ExpectSameSingularities(scene, found, field.form);
        }
    }
}

TEST(FieldMatch, OwnVectorsAtFacesGiveADesignedFieldBack) {
    for (auto const& scene : MakeMeshes()) {
        Field const field{scene, Design(scene, Made::BySourcesAndVortices)};
        SCOPED_TRACE(scene.name + ", " + std::to_string(field.form.size()) + " edges");
        Wanted const wanted = FindFaceVectors(field);
        Values const found = Match(scene, wanted);
        EXPECT_LT(FindRelativeDifference(FindFaceVectors({scene, found}), wanted), 1e-10);
        EXPECT_LT(FindRelativeDifference(found, field.form), 1e-5);
        ExpectSameSingularities(scene, found, field.form);
    }
}

// A subdivided field has sources and vortices all about those of the control mesh.
TEST(FieldMatch, OwnVectorsAtVerticesGiveASubdividedFieldBack) {
    for (auto const& scene : {test::LoadSpot(), test::MakeTorus(16, 8), test::MakeIcosphere(1),
                              test::MakeGridWithHole(7, 5)}) {
        for (Made made : {Made::BySources, Made::BySourcesAndVortices}) {
            Field const field = Subdivide({scene, Design(scene, made)}, 1);
            SCOPED_TRACE(scene.name + ", " + std::to_string(field.form.size()) + " edges");
            Wanted const wanted = FindVertexVectors(field);
            Values const found = Match(field.scene, wanted);
            EXPECT_LT(FindRelativeDifference(FindVertexVectors({field.scene, found}), wanted),
                      1e-10);
            EXPECT_LT(FindRelativeDifference(found, field.form), 0.1);
            ExpectSameSingularities(field.scene, found, field.form);
        }
    }
}

// Polygons have no vectors at their vertices; those of the first refinement count.
TEST(FieldMatch, OwnVectorsOfARefinementGiveAFieldOnPolygonsBack) {
    for (auto const& scene : {test::LoadSpot(), test::MakeDodecahedron()}) {
        Field const field{scene, Design(scene, Made::BySourcesAndVortices)};
        // Refinement numbers the vertices of the cage first.
        Wanted wanted = FindVertexVectors(Subdivide(field, 1));
        wanted.resize(static_cast<size_t>(scene.cage.numVertices));
        Values const found = Match(scene, wanted);
        EXPECT_LT(FindRelativeDifference(found, field.form), 1e-5) << scene.name;
        ExpectSameSingularities(scene, found, field.form);
    }
}

// -------- vectors from elsewhere

/// A rotation's vectors at vertices, or at faces' middles.
Wanted MakeRotation(engine::Scene const& scene, Eigen::Vector3d const& axis, bool isFace) {
    Wanted vectors;
    auto const add = [&](Index element, Eigen::Vector3d const& place) {
        Eigen::Vector3d const v = axis.cross(place);
        vectors.push_back({isFace, element, {v[0], v[1], v[2]}});
    };
    auto const points = test::ToRows(scene.positions);
    if (!isFace) {
        for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex)
            add(vertex, points.row(vertex));
        return vectors;
    }
    auto corner = scene.cage.faceVertices.begin();
    for (Index face = 0; face < scene.cage.GetNumFaces(); ++face) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        int const size = scene.cage.faceSizes[static_cast<size_t>(face)];
        for (int j = 0; j < size; ++j) sum += points.row(*corner++).transpose();
        add(face, sum / size);
    }
    return vectors;
}

// Two middles, wherever the axis goes through: a vertex, an edge, a face.
TEST(FieldMatch, ARotationOfTheSphereHasTwoSingularities) {
    std::vector<Eigen::Vector3d> const axes{
        {0, 0, 1}, {1, 0, 0}, {1, 1, 1}, {1, 1, 0}, {0.3, -0.5, 0.8}};
    for (auto const& scene : {test::MakeQuadSphere(2), test::MakeQuadSphere(3),
                              test::MakeIcosphere(2), test::MakeIcosphere(3)}) {
        auto const refiner = test::MakeRefiner(scene, 0);
        for (Eigen::Vector3d const& axis : axes) {
            for (bool isFace : {true, false}) {
                Values const form = Match(scene, MakeRotation(scene, axis.normalized(), isFace));
                auto const indices = eval::FindFieldIndices(refiner->GetLevel(0), form);
                EXPECT_EQ(indices.singularities.size(), 2u)
                    << scene.cage.numVertices << " vertices, axis " << axis.transpose()
                    << (isFace ? ", by faces" : ", by vertices");
                EXPECT_EQ(indices.sum, 2.0);
            }
        }
    }
}

// One vector alone is met, and the rest of the field is there.
TEST(FieldMatch, FillsInWhatOneVectorLeavesOpen) {
    for (auto const& scene :
         {test::MakeIrregularTriangles(9, 8, 2), test::MakeIcosphere(2), test::MakeTorus(9, 7)}) {
        for (bool isFace : {true, false}) {
            Wanted const one{{isFace, 3, {0.3, -0.2, 0.7}}};
            Field const field{scene, Match(scene, one)};
            Wanted const all = isFace ? FindFaceVectors(field) : FindVertexVectors(field);
            Eigen::Vector3d const wanted(0.3, -0.2, 0.7), found(all[3].vector.data());
            // What is across the surface cannot be met.
            EXPECT_NEAR(found.dot(wanted), found.squaredNorm(), 1e-9) << scene.name;
            EXPECT_GT(found.norm(), 0.1);
            for (auto const& at : all) {
                double const length = Eigen::Vector3d(at.vector.data()).norm();
                EXPECT_GT(length, 0.0);
                EXPECT_LT(length, 1e3);
            }
        }
    }
}

TEST(FieldMatch, NoVectorsMakeNoField) {
    auto const scene = test::MakeIcosphere(1);
    Wanted wanted;
    for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex)
        wanted.push_back({false, vertex, {0.0, 0.0, 0.0}});
    Values const form = Match(scene, wanted);
    EXPECT_EQ(form, Values(form.size(), 0.0));
}

TEST(FieldMatch, PlacesThatAreNotThereAreRefused) {
    auto const scene = test::MakeCube();
    EXPECT_EQ(test::RefusalOf([&] { Match(scene, {{true, 6, {}}}); }),
              "face 6 does not exist; there are 0 to 5");
    EXPECT_EQ(test::RefusalOf([&] { Match(scene, {{false, -1, {}}}); }),
              "vertex -1 does not exist; there are 0 to 7");
}

}  // namespace
}  // namespace limn
