// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <map>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "eval/cascade/cascade.h"
#include "support/cascade_meshes.h"
#include "support/form_meshes.h"

namespace limn {
namespace {

using eval::CascadeOptions;
using eval::CascadeSolver;
using far_ext::BoundaryRule;
using far_ext::CascadeLevel;
using far_ext::CascadeMesh;
using test::AreFinite;
using test::Filter;
using test::kPi;
using test::kSolvers;
using test::LoadMesh;
using test::MeasureEdges;
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

// ---- the operator -------------------------------------------------------------------------------

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

// ---- motions ------------------------------------------------------------------------------------

TEST(CascadeLaws, RotateThenFilterIsFilterThenRotate) {
    Eigen::Matrix3d const rotation =
        Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    Eigen::Vector3d const shift(3, -2, 5);
    for (bool isQuads : {false, true}) {
        auto scene = isQuads ? test::MakeGridWithHole(6, 5) : LoadMesh("gridholetri");
        auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
        CascadeOptions const options{.solver = CascadeSolver::Exact, .width = 0.3};
        auto const rotated = Transform(Filter(scene, levels, options), rotation, shift);
        scene.positions = Transform(scene.positions, rotation, shift);
        EXPECT_LT(test::LargestDifference(Filter(scene, levels, options), rotated),
                  1e-13 * test::BoxDiagonal(scene.positions));
    }
}

// M grows by s^2, and L by the square of the width.
TEST(CascadeLaws, ScaledPointsWithAScaledWidthScaleTheResult) {
    auto scene = LoadMesh("torustri");
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    auto const points = Filter(scene, levels, {.solver = CascadeSolver::Exact, .width = 0.1});
    for (double s : {1e-6, 3.7, 1e6}) {
        auto scaled = scene;
        scaled.positions =
            Transform(scene.positions, s * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
        auto const expected =
            Transform(points, s * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
        auto const found =
            Filter(scaled, levels, {.solver = CascadeSolver::Exact, .width = 0.1 * s});
        EXPECT_LT(test::LargestDifference(found, expected),
                  1e-13 * test::BoxDiagonal(scaled.positions));
    }
}

// The residual is to |M (X0 - centroid)|: where a mesh lies does not matter. Far off, points have
// fewer digits: 1e3 of the box leaves 13.
TEST(CascadeLaws, IterationsDoNotDependOnWhereAMeshLies) {
    auto const scene = LoadMesh("torustri");
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    std::vector<std::array<double, 2>> found;
    for (double shift : {0.0, 3e3}) {
        auto const points =
            Transform(scene.positions, Eigen::Matrix3d::Identity(), {shift, -shift, shift});
        eval::Cascade<double> cascade(points, {}, {.tolerance = 1e-6, .width = 0.1});
        eval::CascadeStepReport report;
        for (auto const& level : levels) report = cascade.Step(level, 1000);
        found.push_back({static_cast<double>(report.sweeps), report.residual});
    }
    EXPECT_EQ(found[0][0], found[1][0]);
    EXPECT_NEAR(found[0][1], found[1][1], 1e-2 * found[0][1]);
}

// Float has 7 digits; the differences that sweeps add lose some of them.
TEST(CascadeLaws, SweepsInSinglePrecisionAreThoseInDouble) {
    for (bool isQuads : {false, true}) {
        auto const scene = isQuads ? test::MakeGridWithHole(6, 5) : LoadMesh("torustri");
        auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
        CascadeOptions const options{.solver = CascadeSolver::Jacobi, .width = 0.2};
        eval::Cascade<float> single(scene.positions, {}, options);
        eval::Cascade<double> twice(scene.positions, {}, options);
        for (auto const& level : levels) {
            auto const a = single.Step(level, 3), b = twice.Step(level, 3);
            EXPECT_NEAR(a.residual, b.residual, 1e-6);
            EXPECT_GT(b.residual, 1e-5);
        }
        EXPECT_LT(test::LargestDifference(single.GetPositions(), twice.GetPositions()),
                  2e-6 * test::BoxDiagonal(scene.positions));
        EXPECT_GT(test::LargestDifference(twice.GetPositions(), twice.GetStartPositions()), 1e-2);
    }
}

// ---- fixed points -------------------------------------------------------------------------------

// On a polyhedron whose vertices are all alike, L X points along X. X . L X over all vertices is a
// times twice the area (the area's gradient, and Euler on a function of degree 2), X . M X is r^2
// times the area: (r_k^2 + sigma^2) r = r_k^2 r0.
TEST(CascadeLaws, RegularPolyhedraFollowTheRecursionOfASphere) {
    for (auto scene :
         {test::MakeTetrahedron(), test::MakeBipyramid(4), LoadMesh("icosa"), test::MakeCube()}) {
        double const r0 = PointAt(scene.positions, 0).norm();
        for (double share : {0.1, 0.3, 0.45, 0.5, 0.7}) {
            double const sigma = share * r0;
            CascadeLevel const level =
                far_ext::BuildCascadeLevel(test::MakeSameMesh(scene), {}, BoundaryRule::Fixed);
            eval::Cascade<double> cascade(scene.positions, {},
                                          {.solver = CascadeSolver::Exact, .width = sigma});
            double r = r0;
            for (int k = 0; k < 60; ++k) {
                if (k == 0)
                    cascade.Step(level, 1);
                else
                    cascade.Repeat(1);
                double const next = r0 / (1 + sigma * sigma / (r * r));
                if (next < 1e-6 * r0) break;  // gone
                r = next;
                EXPECT_NEAR(test::MeanRadius(cascade.GetPositions()), r, 1e-10 * r0)
                    << share << " step " << k;
            }
            // The fixed point, where there is one; at 0.45 a step leaves 2 sigma^2 / (r r0) = 0.56
            // of the distance to it.
            if (share < 0.5) {
                EXPECT_NEAR(r, (r0 + std::sqrt(r0 * r0 - 4 * sigma * sigma)) / 2, 1e-10 * r0);
            }
            if (share > 0.5) {
                EXPECT_LT(r, 1e-3 * r0);
            }
        }
    }
}

// The middle of a tube between fixed rims. Area per ring of vertices: 2 n sin(pi / n) r h; its
// radial derivative gives r (r0 - r) = a: the cylinder's fixed point, exactly. What the rims do
// decays as exp(-distance sqrt(2) / sigma).
TEST(CascadeLaws, ATubeSettlesAtTheFixedPointOfACylinder) {
    constexpr int n = 12, m = 60;
    double const sigma = 0.3, h = 0.15;
    for (bool isQuads : {false, true}) {
        Points positions;
        std::vector<std::vector<Index>> faces;
        for (int j = 0; j <= m; ++j) {
            for (int i = 0; i < n; ++i) {
                positions.insert(positions.end(),
                                 {std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), h * j});
                if (j == m) continue;
                int const a = j * n + i, b = j * n + (i + 1) % n;
                if (isQuads) {
                    faces.push_back({a, b, b + n, a + n});
                } else {
                    faces.push_back({a, b, b + n});
                    faces.push_back({a, b + n, a + n});
                }
            }
        }
        auto const scene =
            test::MakeScene(positions, faces, isQuads ? Sdc::SCHEME_CATMARK : Sdc::SCHEME_LOOP);
        CascadeLevel const level =
            far_ext::BuildCascadeLevel(test::MakeSameMesh(scene), {}, BoundaryRule::Fixed);
        eval::Cascade<double> cascade(positions, {},
                                      {.solver = CascadeSolver::Exact, .width = sigma});
        cascade.Step(level, 1);
        for (int repeat = 0; repeat < 30; ++repeat) EXPECT_FALSE(cascade.Repeat(1).isMetricFrozen);
        auto const points = cascade.GetPositions();
        for (Index i = n * m / 2; i < n * m / 2 + n; ++i) {
            auto const point = PointAt(points, i);
            EXPECT_NEAR(std::hypot(point[0], point[1]), (1 + std::sqrt(1 - 2 * sigma * sigma)) / 2,
                        1e-9);
            EXPECT_NEAR(point[2], h * m / 2, 1e-9);
        }
    }
}

// On a sphere of many triangles the fixed point is met, in the mean, to the square of the edges.
TEST(CascadeLaws, ASphereMeetsItsFixedPointToSecondOrder) {
    double const sigma = 0.3, fixedPoint = (1 + std::sqrt(1 - 4 * sigma * sigma)) / 2;
    std::vector<double> errors;
    for (int k = 1; k <= 3; ++k) {
        auto const scene = test::MakeIcosphere(k);
        CascadeLevel const level =
            far_ext::BuildCascadeLevel(test::MakeSameMesh(scene), {}, BoundaryRule::Fixed);
        eval::Cascade<double> cascade(scene.positions, {}, {.tolerance = 1e-12, .width = sigma});
        cascade.Step(level, 1000);
        for (int repeat = 0; repeat < 60; ++repeat) cascade.Repeat(1000);
        errors.push_back(std::abs(test::MeanRadius(cascade.GetPositions()) - fixedPoint));
    }
    EXPECT_LT(errors[0], 1e-3);
    for (size_t k = 0; k < 2; ++k) EXPECT_NEAR(std::log2(errors[k] / errors[k + 1]), 2.0, 0.3);
}

// ---- local widths -------------------------------------------------------------------------------

/// Runs a cascade with widths and counts vertices that are not where they started, to the bit: of
/// all, and of `marked`.
template <class Scalar>
std::pair<int, int> CountMoved(engine::Scene const& scene, std::list<CascadeLevel> const& levels,
                               std::vector<double> const& widths, CascadeOptions const& options,
                               std::vector<char> const& marked) {
    eval::Cascade<Scalar> cascade(scene.positions, widths, options);
    for (auto const& level : levels) cascade.Step(level, 12);
    auto const points = cascade.GetPositions(), start = cascade.GetStartPositions();
    std::pair<int, int> moved{0, 0};
    for (size_t i = 0; i < points.size() / 3; ++i) {
        bool const hasMoved = points[3 * i] != start[3 * i] ||
                              points[3 * i + 1] != start[3 * i + 1] ||
                              points[3 * i + 2] != start[3 * i + 2];
        moved.first += hasMoved;
        moved.second += hasMoved && marked[i];
    }
    return moved;
}

/// All solvers, in double and where they can in float: marked vertices stay to the bit, more than
/// `atLeast` others move.
void ExpectStill(engine::Scene const& scene, std::list<CascadeLevel> const& levels,
                 std::vector<double> const& widths, std::vector<char> const& marked, int atLeast) {
    for (auto const& [solver, tolerance] : kSolvers) {
        auto const moved = CountMoved<double>(scene, levels, widths,
                                              {.solver = solver, .tolerance = tolerance}, marked);
        EXPECT_GT(moved.first, atLeast);
        EXPECT_EQ(moved.second, 0);
    }
    auto const moved =
        CountMoved<float>(scene, levels, widths, {.solver = CascadeSolver::Jacobi}, marked);
    EXPECT_GT(moved.first, atLeast);
    EXPECT_EQ(moved.second, 0);
}

/// Vertices of level `count` in faces of the start mesh that the filter leaves alone. Widths are
/// filtered, too, and enter a ring of neighbours at each level, 1/4 + 1/8 + ... of an edge of the
/// start mesh: less than the ring that is left out here.
std::vector<char> MarkStill(engine::Scene const& scene, int count,
                            std::vector<double> const& widths) {
    auto const refiner = test::MakeRefiner(scene, count);
    auto const base = refiner->GetLevel(0);
    auto const allOf = [](auto const& indices, auto const& holds) {
        return std::all_of(indices.begin(), indices.end(), holds);
    };
    std::vector<char> isFar(widths.size()), isStill;
    for (Index i = 0; i < base.GetNumVertices(); ++i) {
        isFar[i] = allOf(base.GetVertexFaces(i), [&](Index face) {
            return allOf(base.GetFaceVertices(face), [&](Index j) { return widths[j] == 0.0; });
        });
    }
    for (Index face = 0; face < base.GetNumFaces(); ++face)
        isStill.push_back(allOf(base.GetFaceVertices(face), [&](Index i) { return isFar[i]; }));
    for (int k = 1; k <= count; ++k) {
        auto const level = refiner->GetLevel(k);
        std::vector<char> fine;
        for (Index face = 0; face < level.GetNumFaces(); ++face)
            fine.push_back(isStill[level.GetFaceParentFace(face)]);
        isStill = fine;
    }
    auto const last = refiner->GetLevel(count);
    std::vector<char> marked(static_cast<size_t>(last.GetNumVertices()), 0);
    for (Index face = 0; face < last.GetNumFaces(); ++face) {
        for (Index vertex : last.GetFaceVertices(face)) marked[vertex] |= isStill[face];
    }
    return marked;
}

// Widths on the edges of a cube alone, on faces of two triangles or one quad each that have been
// refined before: all that lies in faces away from the edges stays, to the bit, by every solver, in
// both precisions.
TEST(CascadeLaws, OnlyEdgesOfACubeAreFiltered) {
    for (bool isQuads : {false, true}) {
        engine::Scene cube = test::MakeCube();
        if (!isQuads) {
            std::vector<std::vector<Index>> faces;
            for (size_t f = 0; f < 24; f += 4) {
                auto const& v = cube.cage.faceVertices;
                faces.push_back({v[f], v[f + 1], v[f + 2]});
                faces.push_back({v[f], v[f + 2], v[f + 3]});
            }
            cube = test::MakeScene(cube.positions, faces, Sdc::SCHEME_LOOP);
        }
        // Three levels of linear interpolation make the start mesh.
        auto const refiner = test::MakeRefiner(cube, 3);
        eval::Cascade<double> flat(cube.positions, {},
                                   {.solver = CascadeSolver::Jacobi, .width = 0.0});
        auto const flatLevels = QuarterLevels(cube, 3, BoundaryRule::Fixed);
        for (auto const& level : flatLevels) flat.Step(level, 0);
        std::vector<std::vector<Index>> faces;
        for (Index face = 0; face < refiner->GetLevel(3).GetNumFaces(); ++face) {
            auto const corners = refiner->GetLevel(3).GetFaceVertices(face);
            faces.emplace_back(corners.begin(), corners.end());
        }
        auto const scene = test::MakeScene(flat.GetPositions(), faces, cube.cage.scheme);
        std::vector<double> widths;
        for (Index i = 0; i < scene.cage.numVertices; ++i) {
            Eigen::Vector3d const point = PointAt(scene.positions, i);
            widths.push_back((point.array().abs() == 1.0).count() >= 2 ? 0.2 : 0.0);
        }
        auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
        auto const marked = MarkStill(scene, 2, widths);
        // The middle 4 x 4 of the 8 x 8 parts of each face, quartered twice.
        EXPECT_EQ(std::count(marked.begin(), marked.end(), 1), 6 * 17 * 17);
        ExpectStill(scene, levels, widths, marked, 100);
    }
}

// An open mesh, and widths zero in a part of it that is no straight one.
TEST(CascadeLaws, WithoutWidthOnATriangleItStaysToTheBit) {
    for (auto rule : {BoundaryRule::Fixed, BoundaryRule::Natural}) {
        auto const scene = LoadMesh("gridholetri");
        std::vector<double> widths;
        for (Index i = 0; i < scene.cage.numVertices; ++i)
            widths.push_back(PointAt(scene.positions, i)[0] > 3.5 ? 0.2 : 0.0);
        auto const levels = QuarterLevels(scene, 3, rule);
        auto const marked = MarkStill(scene, 3, widths);
        ASSERT_GT(std::count(marked.begin(), marked.end(), 1), 300);
        ExpectStill(scene, levels, widths, marked, 300);
    }
}

// A width that is the same everywhere stays so (constants are kept), and is the width for all.
TEST(CascadeLaws, EqualLocalWidthsAreAWidthForAll) {
    auto const scene = LoadMesh("torustri");
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    eval::Cascade<double> local(
        scene.positions, std::vector<double>(static_cast<size_t>(scene.cage.numVertices), 0.1),
        {.solver = CascadeSolver::Exact});
    for (auto const& level : levels) local.Step(level, 1);
    for (double width : local.GetWidths()) EXPECT_NEAR(width, 0.1, 1e-13);
    auto const global = Filter(scene, levels, {.solver = CascadeSolver::Exact, .width = 0.1});
    EXPECT_LT(test::LargestDifference(local.GetPositions(), global), 1e-12);
}

// ---- threads ------------------------------------------------------------------------------------

template <class Scalar>
void ExpectSameBits(engine::Scene const& scene, std::list<CascadeLevel> const& levels,
                    std::vector<double> const& widths, CascadeOptions const& options) {
    Points first;
    double residual = 0.0;
    for (int threads : {1, 4}) {
        tbb::global_control const limit(tbb::global_control::max_allowed_parallelism,
                                        static_cast<size_t>(threads));
        tbb::task_arena arena(threads);
        eval::Cascade<Scalar> cascade(scene.positions, widths, options);
        eval::CascadeStepReport report;
        arena.execute([&] {
            for (auto const& level : levels) report = cascade.Step(level, 20);
        });
        if (threads == 1) {
            first = cascade.GetPositions();
            residual = report.residual;
        }
        EXPECT_EQ(cascade.GetPositions(), first);
        EXPECT_EQ(report.residual, residual);
    }
}

// 24576 rows: a dozen of blocks.
TEST(CascadeLaws, ThreadsDoNotChangeABit) {
    auto const scene = LoadMesh("torustri");
    auto const levels = QuarterLevels(scene, 4, BoundaryRule::Fixed);
    ASSERT_EQ(levels.back().GetNumRows(), 96 * 256);
    std::vector<double> widths;
    for (double length : MeasureEdges(scene).atVertices) widths.push_back(0.12 * length);
    for (auto const& [solver, tolerance] : kSolvers) {
        ExpectSameBits<double>(scene, levels, {},
                               {.solver = solver, .tolerance = tolerance, .width = 0.1});
        ExpectSameBits<double>(scene, levels, widths, {.solver = solver, .tolerance = tolerance});
    }
    ExpectSameBits<float>(scene, levels, {}, {.solver = CascadeSolver::Jacobi, .width = 0.1});
    ExpectSameBits<float>(scene, levels, widths, {.solver = CascadeSolver::Jacobi});
}

// ---- graphs -------------------------------------------------------------------------------------

TEST(CascadeGraph, TheBaseStaysToTheBitAndHeightsMove) {
    auto const scene = LoadMesh("gridholetri");
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    for (auto const& [solver, tolerance] : kSolvers) {
        eval::Cascade<double> cascade(
            scene.positions, {},
            {.solver = solver, .tolerance = tolerance, .width = 0.3, .isGraph = true});
        eval::Cascade<double> start(scene.positions, {},
                                    {.solver = CascadeSolver::Jacobi, .width = 0.0});
        for (auto const& level : levels) {
            cascade.Step(level, 20);
            start.Step(level, 0);
        }
        auto const points = cascade.GetPositions(), flat = start.GetPositions();
        double moved = 0.0;
        for (size_t i = 0; i < points.size(); i += 3) {
            EXPECT_EQ(points[i], flat[i]);
            EXPECT_EQ(points[i + 1], flat[i + 1]);
            moved = std::max(moved, std::abs(points[i + 2] - flat[i + 2]));
        }
        EXPECT_GT(moved, 1e-3);
    }
}

TEST(CascadeGraph, APlaneWithAFixedBoundaryStays) {
    for (bool isQuads : {false, true}) {
        auto scene = isQuads ? test::MakeGridWithHole(6, 5) : LoadMesh("gridholetri");
        for (size_t i = 0; i < scene.positions.size(); i += 3)
            scene.positions[i + 2] = 0.7 * scene.positions[i] - 1.3 * scene.positions[i + 1] + 2;
        auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
        for (auto const& [solver, tolerance] : kSolvers) {
            eval::Cascade<double> cascade(
                scene.positions, {},
                {.solver = solver, .tolerance = tolerance, .width = 0.5, .isGraph = true});
            for (auto const& level : levels) cascade.Step(level, 20);
            EXPECT_LT(test::LargestDifference(cascade.GetPositions(), cascade.GetStartPositions()),
                      1e-12);
            auto const points = cascade.GetPositions();
            for (size_t i = 0; i < points.size(); i += 3)
                EXPECT_NEAR(points[i + 2], 0.7 * points[i] - 1.3 * points[i + 1] + 2, 1e-12);
        }
    }
}

// (M + L) z = M z0 on the plane is one linear problem per level: assembled triangle by triangle and
// solved densely it gives the exact cascade's heights; another step has the same operator and the
// same answer; all levels have the same angles.
TEST(CascadeGraph, IsADirectSolveOnThePlanesMetric) {
    auto const scene = LoadMesh("gridholetri");
    auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
    auto const refiner = test::MakeRefiner(scene, 2);
    auto const mesh = far_ext::MakeCascadeMesh(*refiner, 2);
    double const sigma = 0.5, a = sigma * sigma / 2;
    eval::Cascade<double> cascade(
        scene.positions, {}, {.solver = CascadeSolver::Exact, .width = sigma, .isGraph = true});
    eval::Cascade<double> start(scene.positions, {},
                                {.solver = CascadeSolver::Jacobi, .width = 0.0});
    std::vector<double> angles;
    for (auto const& level : levels) {
        auto const report = cascade.Step(level, 1);
        EXPECT_EQ(report.sweeps, 1);
        angles.push_back(report.minAngleRadians);
        start.Step(level, 0);
    }
    EXPECT_NEAR(angles[1], angles[0], 1e-12);

    auto const x0 = start.GetPositions();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(mesh.numVertices, mesh.numVertices);
    Eigen::VectorXd rightSide = Eigen::VectorXd::Zero(mesh.numVertices);
    for (size_t face = 0; face < mesh.faces.size(); face += 3) {
        std::array<Eigen::Vector3d, 3> p;
        for (size_t k = 0; k < 3; ++k) {
            p[k] = PointAt(x0, mesh.faces[face + k]);
            p[k][2] = 0.0;
        }
        double const area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
        for (size_t i = 0; i < 3; ++i) {
            Index const vertex = mesh.faces[face + i];
            A(vertex, vertex) += area / 3;
            rightSide[vertex] += area / 3 * PointAt(x0, vertex)[2];
            for (size_t j = 0; j < 3; ++j) {
                A(vertex, mesh.faces[face + j]) +=
                    a * (p[(i + 2) % 3] - p[(i + 1) % 3]).dot(p[(j + 2) % 3] - p[(j + 1) % 3]) /
                    (4 * area);
            }
        }
    }
    for (Index vertex = 0; vertex < mesh.numVertices; ++vertex) {
        if (!refiner->GetLevel(2).IsVertexBoundary(vertex)) continue;
        A.row(vertex).setZero();
        A(vertex, vertex) = 1.0;
        rightSide[vertex] = PointAt(x0, vertex)[2];
    }
    Eigen::VectorXd const heights = A.partialPivLu().solve(rightSide);
    auto const points = cascade.GetPositions();
    for (Index vertex = 0; vertex < mesh.numVertices; ++vertex)
        EXPECT_NEAR(PointAt(points, vertex)[2], heights[vertex], 1e-12);

    auto const edges = cascade.GetOperator().edges, masses = cascade.GetOperator().masses;
    cascade.Repeat(1);
    EXPECT_EQ(cascade.GetOperator().edges, edges);
    EXPECT_EQ(cascade.GetOperator().masses, masses);
    EXPECT_EQ(cascade.GetPositions(), points);
}

// Widths are filtered along: those of level 1 are the ones that level 2 starts from, over the
// plane.
TEST(CascadeGraph, FilteredWidthsEnterTheNextLevel) {
    auto const scene = LoadMesh("gridholetri");
    std::vector<double> widths;
    for (Index i = 0; i < scene.cage.numVertices; ++i) widths.push_back(i % 3 == 0 ? 0.6 : 0.1);
    auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
    eval::Cascade<double> cascade(scene.positions, widths,
                                  {.solver = CascadeSolver::Exact, .isGraph = true});
    cascade.Step(levels.front(), 1);
    auto flat = cascade.GetPositions();
    auto const filtered = cascade.GetWidths();
    for (size_t i = 2; i < flat.size(); i += 3) flat[i] = 0.0;
    cascade.Step(levels.back(), 1);

    auto const refiner = test::MakeRefiner(scene, 2);
    CascadeLevel const level =
        far_ext::BuildCascadeLevel(far_ext::MakeCascadeMesh(*refiner, 2), {}, BoundaryRule::Fixed);
    eval::Cascade<double> again(flat, filtered, {.solver = CascadeSolver::Jacobi});
    again.Step(level, 0);
    ASSERT_EQ(level.vertices, levels.back().vertices);
    auto const &found = cascade.GetOperator(), &expected = again.GetOperator();
    for (size_t k = 0; k < expected.edges.size(); ++k)
        EXPECT_NEAR(found.edges[k], expected.edges[k], 1e-14);
    for (size_t i = 0; i < expected.masses.size(); ++i)
        EXPECT_NEAR(found.masses[i], expected.masses[i], 1e-14);
}

// ---- creases ------------------------------------------------------------------------------------

void CreaseEdges(engine::Scene& scene, std::vector<std::array<Index, 2>> const& edges) {
    for (auto const& edge : edges) {
        scene.cage.creaseVertexPairs.insert(scene.cage.creaseVertexPairs.end(), edge.begin(),
                                            edge.end());
        scene.cage.creaseSharpness.push_back(far_ext::kInfiniteSharpness);
    }
}

// Corners have three creases and stay; along an edge equal steps of a straight line cancel; a
// coordinate across a plane face is constant or linear on it. So the whole cube stays, which
// without creases loses a good part of its corners.
TEST(CascadeCreases, ACubeOfCreasesStays) {
    auto const smooth = test::MakeCube();
    auto creased = test::MakeCube();
    CreaseEdges(creased, {{0, 1},
                          {1, 2},
                          {2, 3},
                          {3, 0},
                          {4, 5},
                          {5, 6},
                          {6, 7},
                          {7, 4},
                          {0, 4},
                          {1, 5},
                          {2, 6},
                          {3, 7}});
    for (auto const& [solver, tolerance] : kSolvers) {
        CascadeOptions const options{.solver = solver, .tolerance = tolerance, .width = 0.3};
        for (engine::Scene const* scene : {&smooth, static_cast<engine::Scene const*>(&creased)}) {
            auto const levels = QuarterLevels(*scene, 4, BoundaryRule::Fixed);
            eval::Cascade<double> cascade(scene->positions, {}, options);
            for (auto const& level : levels) cascade.Step(level, 20);
            double const moved =
                test::LargestDifference(cascade.GetPositions(), cascade.GetStartPositions());
            if (scene == &creased)
                EXPECT_LT(moved, 1e-13);
            else
                EXPECT_GT(moved, 0.05);
        }
    }
}

// A regular n-gon as a crease: edges l = 2 r sin(pi / n), M = l, L X = a / l * 4 sin^2(pi / n) X,
// hence (1 + a / r_k^2) r = r0, whatever n and whatever surfaces meet there: the cylinder's fixed
// point.
TEST(CascadeCreases, ARegularRimFollowsTheRecursionOfACircle) {
    for (int n : {3, 7, 64}) {
        auto scene = test::MakeBipyramid(n);
        scene.positions[2] = 1.7;
        auto mesh = test::MakeSameMesh(scene);
        for (Index i = 0; i < n; ++i) mesh.creases.push_back({2 + i, 2 + (i + 1) % n});
        CascadeLevel const level = far_ext::BuildCascadeLevel(mesh, {}, BoundaryRule::Fixed);
        double const sigma = 0.4, a = sigma * sigma / 2;
        for (auto solver : {CascadeSolver::Exact, CascadeSolver::ConjugateGradients}) {
            eval::Cascade<double> cascade(scene.positions, {},
                                          {.solver = solver, .tolerance = 1e-14, .width = sigma});
            double r = 1.0;
            for (int k = 0; k < 30; ++k) {
                if (k == 0)
                    cascade.Step(level, 100);
                else
                    cascade.Repeat(100);
                r = 1 / (1 + a / (r * r));
                for (Index i = 2; i < n + 2; ++i) {
                    EXPECT_NEAR(PointAt(cascade.GetPositions(), i).norm(), r, 1e-11);
                    EXPECT_NEAR(PointAt(cascade.GetPositions(), i)[2], 0.0, 1e-11);
                }
            }
            EXPECT_NEAR(r, (1 + std::sqrt(1 - 2 * sigma * sigma)) / 2, 1e-11);
        }
    }
}

// A closed crease cuts a surface in two: what is done to one side, the crease and the other side do
// not feel. (Sums of conjugate gradients run over both sides; sweeps and the factorisation do not.)
TEST(CascadeCreases, BothSidesOfAClosedCreaseAreSmoothedOnTheirOwn) {
    auto scene = test::MakeBipyramid(7);
    std::vector<std::array<Index, 2>> rim;
    for (Index i = 0; i < 7; ++i) rim.push_back({2 + i, 2 + (i + 1) % 7});
    CreaseEdges(scene, rim);
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    auto changed = scene;
    changed.positions[0] = 0.3;  // the upper tip
    changed.positions[2] = 1.5;
    for (auto [solver, tolerance] : {std::pair{CascadeSolver::Jacobi, 0.0},
                                     {CascadeSolver::Exact, 1e-14},
                                     {CascadeSolver::ConjugateGradients, 1e-9}}) {
        std::array<Points, 2> found;
        for (size_t i = 0; i < 2; ++i) {
            auto const& own = i == 0 ? scene : changed;
            eval::Cascade<double> cascade(
                own.positions, {},
                {.solver = solver, .tolerance = tolerance > 1e-10 ? 1e-12 : 0.0, .width = 0.2});
            for (auto const& level : levels)
                cascade.Step(level, solver == CascadeSolver::Jacobi ? 20 : 1000);
            EXPECT_TRUE(AreFinite(cascade.GetPositions()));
            found[i] = cascade.GetPositions();
        }
        int numLower = 0, numUpper = 0;
        for (size_t i = 0; i < found[0].size(); i += 3) {
            bool const isUpper = found[0][i + 2] > 1e-9;
            for (size_t c = 0; c < 3 && !isUpper; ++c)
                EXPECT_NEAR(found[0][i + c], found[1][i + c], tolerance);
            isUpper ? ++numUpper : ++numLower;
        }
        EXPECT_GT(numLower, numUpper);  // the rim counts as lower
        EXPECT_GT(test::LargestDifference(found[0], found[1]), 0.1);
    }
}

// Surfaces see their creases solved, not as they were before: the residual mode meets the
// factorisation.
TEST(CascadeCreases, SolversAgreeOnSurfacesWithCreases) {
    for (auto const& [name, scene] : test::MakeFormMeshes()) {
        if (scene.cage.creaseSharpness.empty()) continue;
        auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
        eval::Cascade<double> cascade(scene.positions, {}, {.tolerance = 1e-11, .width = 0.15});
        for (auto const& level : levels) EXPECT_TRUE(cascade.Step(level, 1000).converged) << name;
        auto const exact = Filter(scene, levels, {.solver = CascadeSolver::Exact, .width = 0.15});
        EXPECT_LT(test::LargestDifference(cascade.GetPositions(), exact),
                  1e-9 * test::BoxDiagonal(scene.positions))
            << name;
    }
}

// Creases of every kind and sharpness on triangles and quads, open and closed.
TEST(CascadeCreases, NothingIsNotANumber) {
    for (auto const& [name, scene] : test::MakeFormMeshes()) {
        if (scene.cage.creaseSharpness.empty()) continue;
        auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
        for (auto const& [solver, tolerance] : kSolvers) {
            eval::Cascade<double> cascade(scene.positions, {},
                                          {.solver = solver, .tolerance = tolerance, .width = 0.2});
            for (auto const& level : levels)
                EXPECT_TRUE(std::isfinite(cascade.Step(level, 10).residual)) << name;
            EXPECT_TRUE(AreFinite(cascade.GetPositions())) << name;
        }
    }
}

}  // namespace
}  // namespace limn
