// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/cascade_operator.h"

#include <array>
#include <map>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "eval/cascade/cascade.h"
#include "support/cascade_meshes.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"

namespace limn {
namespace {

using eval::CascadeSolver;
using far_ext::BoundaryRule;
using far_ext::CascadeLevel;
using far_ext::CascadeMesh;
using test::kPi;
using test::LoadMesh;
using test::MinAngleDegrees;
using test::PointAt;
using test::QuarterLevels;
using test::Transform;
using Points = std::vector<double>;

/// A mesh as its own only level, with the operator of its own metric.
struct SameLevel {
    SameLevel(engine::Scene const& scene, BoundaryRule rule, double width,
              std::vector<double> const& widths = {})
        : mesh(test::MakeSameMesh(scene)),
          level(far_ext::BuildCascadeLevel(mesh, {}, rule)),
          cascade(scene.positions, widths, {.solver = CascadeSolver::Jacobi, .width = width}) {
        cascade.Step(level, 0);
    }
    SameLevel(SameLevel const&) = delete;
    SameLevel& operator=(SameLevel const&) = delete;

    /// u^T L u for values u of the vertices.
    double GetEnergy(Eigen::VectorXd const& u) const {
        auto const& op = cascade.GetOperator();
        double energy = 0.0;
        for (Index row = 0; row < level.numUnknowns; ++row) {
            double const own = u[level.vertices[row]];
            for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
                energy += own * op.edges[k] * (own - u[level.vertices[level.neighbours[k]]]);
            }
        }
        return energy;
    }

    CascadeMesh mesh;
    CascadeLevel level;
    eval::Cascade<double> cascade;
};

Eigen::VectorXd TakeHeights(Points const& points, Eigen::Vector3d const& gradient) {
    Eigen::VectorXd u(static_cast<Eigen::Index>(points.size() / 3));
    for (Index i = 0; i < static_cast<Index>(u.size()); ++i)
        u[i] = gradient.dot(PointAt(points, i));
    return u;
}

// M + L has the entries of a symmetric matrix, and L 1 = 0: what is left of a diagonal is the mass.
TEST(CascadeOperator, IsSymmetricAndItsStiffnessKeepsConstants) {
    for (auto const& [name, scene] : test::MakeFormMeshes()) {
        for (auto rule : {BoundaryRule::Fixed, BoundaryRule::Natural}) {
            auto const levels = QuarterLevels(scene, 1, rule);
            auto const& level = levels.back();
            eval::Cascade<double> cascade(scene.positions, {},
                                          {.solver = CascadeSolver::Jacobi, .width = 0.3});
            cascade.Step(level, 0);
            auto const& op = cascade.GetOperator();
            std::map<std::pair<Index, Index>, double> entries;
            double largest = 0.0;
            for (Index row = 0; row < level.numUnknowns; ++row) {
                double sum = op.diagonals[row] - op.masses[row];
                for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
                    sum -= op.edges[k];
                    entries[{row, level.neighbours[k]}] += op.edges[k];
                    largest = std::max(largest, std::abs(op.edges[k]));
                }
                EXPECT_NEAR(sum, 0.0, 1e-12 * op.diagonals[row]) << name;
                EXPECT_GT(op.masses[row], 0.0) << name;
            }
            for (auto const& [rows, entry] : entries) {
                bool const areAlike =
                    (rows.first < level.numSurface) == (rows.second < level.numSurface);
                if (areAlike && rows.second < level.numUnknowns) {
                    EXPECT_NEAR(entry, (entries[{rows.second, rows.first}]), 1e-12 * largest)
                        << name;
                }
            }
        }
    }
}

// l_ij = -a cot(60 deg) / 2 from each of two triangles: -a / sqrt(3).
TEST(CascadeOperator, EquilateralTrianglesHaveTheirFigure) {
    auto const scene = LoadMesh("icosa");
    auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
    eval::Cascade<double> cascade(scene.positions, {},
                                  {.solver = CascadeSolver::Jacobi, .width = 0.4});
    for (auto const& level : levels) cascade.Step(level, 0);  // no sweep: the metric stays flat
    for (double edge : cascade.GetOperator().edges) EXPECT_NEAR(edge, 0.08 / std::sqrt(3.0), 1e-13);
}

engine::Scene MakeShearedLattice(Sdc::SchemeType scheme) {
    engine::Scene scene = test::MakeLattice(5, 4, scheme);
    Eigen::Matrix3d shear;
    shear << 1, 0.4, 0, 0.1, 0.9, 0, 0.3, -0.2,
        1;  // columns of the plane: (1, .1, .3) and (.4, .9, -.2)
    scene.positions = Transform(scene.positions, shear, {3, 1, 2});
    return scene;
}

double const kLatticeArea =
    20 * Eigen::Vector3d(1, 0.1, 0.3).cross(Eigen::Vector3d(0.4, 0.9, -0.2)).norm();

TEST(CascadeOperator, MassesAddUpToTheArea) {
    for (auto scheme : {Sdc::SCHEME_LOOP, Sdc::SCHEME_CATMARK}) {
        SameLevel const same(MakeShearedLattice(scheme), BoundaryRule::Natural, 0.3);
        double sum = 0.0;
        for (double mass : same.cascade.GetOperator().masses) sum += mass;
        EXPECT_NEAR(sum, kLatticeArea, 1e-12 * kLatticeArea);
    }
}

// u^T L u = a times the integral of |grad u|^2, and the gradient of a linear function is known.
TEST(CascadeOperator, ALinearFunctionHasItsDirichletEnergy) {
    for (auto scheme : {Sdc::SCHEME_LOOP, Sdc::SCHEME_CATMARK}) {
        auto const scene = MakeShearedLattice(scheme);
        SameLevel const same(scene, BoundaryRule::Natural, 0.3);
        Eigen::Vector3d const normal =
            Eigen::Vector3d(1, 0.1, 0.3).cross(Eigen::Vector3d(0.4, 0.9, -0.2)).normalized();
        Eigen::Vector3d gradient(0.7, -1.1, 0.4);
        gradient -= normal.dot(gradient) * normal;
        double const expected = 0.045 * gradient.squaredNorm() * kLatticeArea;
        EXPECT_NEAR(same.GetEnergy(TakeHeights(scene.positions, gradient)), expected,
                    1e-12 * expected);
    }
}

// The same with a linear width on each triangle: the integral of sigma^2 / 2 by Gauss points, (2,
// 1, 1) / 6 and its permutations, which are exact for squares of linear functions. A quad is the
// mean of its two pairs of triangles.
TEST(CascadeOperator, ALinearWidthEntersByItsExactMean) {
    for (auto scheme : {Sdc::SCHEME_LOOP, Sdc::SCHEME_CATMARK}) {
        auto const scene = MakeShearedLattice(scheme);
        std::mt19937 random(7);
        std::vector<double> widths(static_cast<size_t>(scene.cage.numVertices));
        for (double& width : widths) width = static_cast<double>(random()) * 0x1p-32;
        SameLevel const same(scene, BoundaryRule::Natural, -1.0, widths);
        double integral = 0.0;
        auto const add = [&](std::array<Index, 3> const& t, double share) {
            double const area =
                0.5 * (PointAt(scene.positions, t[1]) - PointAt(scene.positions, t[0]))
                          .cross(PointAt(scene.positions, t[2]) - PointAt(scene.positions, t[0]))
                          .norm();
            for (size_t i = 0; i < 3; ++i) {
                double const h =
                    (4 * widths[t[i]] + widths[t[(i + 1) % 3]] + widths[t[(i + 2) % 3]]) / 6;
                integral += share * area / 3 * h * h / 2;
            }
        };
        size_t const n = static_cast<size_t>(same.mesh.faceSize);
        for (size_t face = 0; face < same.mesh.faces.size(); face += n) {
            Index const* const f = &same.mesh.faces[face];
            if (n == 3)
                add({f[0], f[1], f[2]}, 1.0);
            else
                for (size_t k = 0; k < 4; ++k) add({f[k], f[(k + 1) % 4], f[(k + 2) % 4]}, 0.5);
        }
        Eigen::Vector3d const gradient(1, 0.1, 0.3);  // in the plane
        double const expected = gradient.squaredNorm() * integral;
        EXPECT_NEAR(same.GetEnergy(TakeHeights(scene.positions, gradient)), expected,
                    1e-12 * expected);
    }
}

// A crease of a straight line has M = half of its two edges, and for linear u the integral of
// sigma^2 / 2 |u'|^2 along it with linear sigma; two Gauss points are exact for it.
TEST(CascadeOperator, ACreaseIsALineOfItsOwn) {
    engine::Scene const scene =
        test::MakeLattice(4, 4, Sdc::SCHEME_CATMARK);  // 10 to 14 is the middle line
    auto mesh = test::MakeSameMesh(scene);
    for (Index i = 10; i < 14; ++i) mesh.creases.push_back({i, i + 1});
    CascadeLevel const level = far_ext::BuildCascadeLevel(mesh, {}, BoundaryRule::Fixed);
    auto positions = scene.positions;
    for (Index i = 10; i < 15; ++i)
        positions[3 * static_cast<size_t>(i)] = 0.1 * (i - 10) * (i - 10);  // edges .1, .3, .5, .7
    std::vector<double> widths(25, 0.4);
    for (Index i = 10; i < 15; ++i) widths[static_cast<size_t>(i)] = 0.1 * (i - 9);
    eval::Cascade<double> cascade(positions, widths, {.solver = CascadeSolver::Jacobi});
    cascade.Step(level, 0);
    auto const& op = cascade.GetOperator();
    ASSERT_EQ(level.numUnknowns - level.numSurface, 3);
    for (Index row = level.numSurface; row < level.numUnknowns; ++row) {
        Index const vertex = level.vertices[row];
        double mass = 0.0;
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
            Index const other = level.vertices[level.neighbours[k]];
            double const length = (PointAt(positions, vertex) - PointAt(positions, other)).norm();
            double integral = 0.0;
            for (double sign : {-1.0, 1.0}) {
                double const t = 0.5 + sign * 0.5 / std::sqrt(3.0),
                             h = (1 - t) * widths[static_cast<size_t>(vertex)] +
                                 t * widths[static_cast<size_t>(other)];
                integral += 0.5 * length * h * h / 2;
            }
            EXPECT_NEAR(op.edges[k], integral / (length * length), 1e-14);  // u' = 1 / length
            mass += length / 2;
        }
        EXPECT_NEAR(op.masses[row], mass, 1e-14);
    }
}

// Of all triangles (of a quad those of both diagonals): the least angle, and the least area to the
// mean one.
TEST(CascadeOperator, TellsTheShapesOfItsTriangles) {
    for (auto const& scene : {test::MakeIrregularTriangles(9, 8, 3), test::MakeTorus(9, 7)}) {
        auto const mesh = test::MakeSameMesh(scene);
        CascadeLevel const level = far_ext::BuildCascadeLevel(mesh, {}, BoundaryRule::Fixed);
        eval::Cascade<double> cascade(scene.positions, {},
                                      {.solver = CascadeSolver::Jacobi, .width = 0.1});
        auto const report = cascade.Step(level, 0);
        CascadeMesh triangles;
        for (size_t face = 0; face < mesh.faces.size();
             face += static_cast<size_t>(mesh.faceSize)) {
            Index const* const f = &mesh.faces[face];
            if (mesh.faceSize == 3)
                triangles.faces.insert(triangles.faces.end(), f, f + 3);
            else
                for (size_t k = 0; k < 4; ++k)
                    triangles.faces.insert(triangles.faces.end(),
                                           {f[k], f[(k + 1) % 4], f[(k + 2) % 4]});
        }
        double least = 1e300, sum = 0.0;
        for (size_t face = 0; face < triangles.faces.size(); face += 3) {
            auto const at = [&](size_t k) -> Eigen::Vector3d {
                return PointAt(scene.positions, triangles.faces[face + k]);
            };
            double const area = (at(1) - at(0)).cross(at(2) - at(0)).norm();
            least = std::min(least, area);
            sum += area;
        }
        EXPECT_NEAR(report.minAngleRadians, MinAngleDegrees(scene.positions, triangles) * kPi / 180,
                    1e-12);
        EXPECT_NEAR(report.areaRatio, least * triangles.GetNumFaces() / sum, 1e-12);
    }
    // A hub of 64 triangles within a fixed rim: the least angle is the hub's own.
    Points positions{0, 0, 0};
    std::vector<std::vector<Index>> faces;
    for (Index i = 0; i < 64; ++i) {
        positions.insert(positions.end(),
                         {std::cos(2 * kPi * i / 64), std::sin(2 * kPi * i / 64), 0});
        faces.push_back({0, 1 + i, 1 + (i + 1) % 64});
    }
    SameLevel same(test::MakeScene(positions, faces, Sdc::SCHEME_LOOP), BoundaryRule::Fixed, 0.1);
    EXPECT_NEAR(same.cascade.Repeat(0).minAngleRadians, 2 * kPi / 64, 1e-12);
}

}  // namespace
}  // namespace limn
