// SPDX-License-Identifier: Apache-2.0
#include "far_ext/cascade/bisection.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "support/cascade_meshes.h"
#include "support/form_meshes.h"

namespace limn {
namespace {

using far_ext::Bisection;
using far_ext::BoundaryRule;
using far_ext::CascadeMesh;
using test::PointAt;

std::vector<std::pair<std::string, engine::Scene>> const& GetTriangleMeshes() {
    static auto const meshes = [] {
        std::vector<std::pair<std::string, engine::Scene>> all;
        for (auto const& mesh : test::GetCascadeMeshes()) {
            if (mesh.second.cage.scheme == Sdc::SCHEME_LOOP) all.push_back(mesh);
        }
        for (auto const* name : {"icosa", "torustri", "gridholetri"})
            all.emplace_back(name, test::LoadMesh(name));
        return all;
    }();
    return meshes;
}

Bisection MakeBisection(engine::Scene const& scene) {
    std::vector<std::array<Index, 2>> creases;
    for (size_t i = 0; i < scene.cage.creaseSharpness.size(); ++i)
        creases.push_back(
            {scene.cage.creaseVertexPairs[2 * i], scene.cage.creaseVertexPairs[2 * i + 1]});
    return Bisection(scene.cage.numVertices, scene.cage.faceVertices, scene.positions, creases,
                     scene.cage.cornerVertices);
}

/// Calls check(coarse, coarsePoints, fine, points, bisection) for each of some passes over a mesh.
template <class Check>
void ForAllPasses(engine::Scene const& scene, int count, Check const& check) {
    auto bisection = MakeBisection(scene);
    CascadeMesh coarse = test::MakeSameMesh(scene);
    auto coarsePoints = scene.positions;
    for (int pass = 0; pass < count; ++pass) {
        CascadeMesh const fine = bisection.Refine();
        auto const points = test::ApplyParents(fine.parentOffsets, fine.parents, coarsePoints);
        check(coarse, coarsePoints, fine, points, bisection);
        coarse = fine;
        coarsePoints = points;
    }
}

double FindArea(std::vector<double> const& points, Index const* face) {
    return 0.5 * (PointAt(points, face[1]) - PointAt(points, face[0]))
                     .cross(PointAt(points, face[2]) - PointAt(points, face[0]))
                     .norm();
}

double FindLength(std::vector<double> const& points, Index a, Index b) {
    return (PointAt(points, a) - PointAt(points, b)).norm();
}

/// Undirected edges and how many faces they have; sorted pairs.
std::map<std::array<Index, 2>, int> CountFacesAtEdges(CascadeMesh const& mesh) {
    std::map<std::array<Index, 2>, int> counts;
    for (size_t face = 0; face < mesh.faces.size(); face += 3) {
        for (size_t k = 0; k < 3; ++k) {
            Index const a = mesh.faces[face + k], b = mesh.faces[face + (k + 1) % 3];
            ++counts[{std::min(a, b), std::max(a, b)}];
        }
    }
    return counts;
}

// A hanging vertex would leave an edge with one face inside: the boundary keeps its length.
// BuildCascadeLevel looks at the rest, a disc of one orientation at each vertex. Euler's number
// stays.
TEST(Bisection, LeavesNoHangingVertex) {
    for (auto const& [name, scene] : GetTriangleMeshes()) {
        double length = -1.0;
        Index euler = 0;
        auto const measure = [&](CascadeMesh const& mesh, std::vector<double> const& points) {
            double sum = 0.0;
            auto const edges = CountFacesAtEdges(mesh);
            for (auto const& [edge, count] : edges) {
                EXPECT_LE(count, 2) << name;
                if (count == 1) sum += FindLength(points, edge[0], edge[1]);
            }
            Index const number =
                mesh.numVertices - static_cast<Index>(edges.size()) + mesh.GetNumFaces();
            if (length < 0.0) {
                length = sum;
                euler = number;
            }
            EXPECT_NEAR(sum, length, 1e-12 * length) << name;
            EXPECT_EQ(number, euler) << name;
        };
        measure(test::MakeSameMesh(scene), scene.positions);
        ForAllPasses(scene, 5,
                     [&](auto const&, auto const&, CascadeMesh const& fine,
                         std::vector<double> const& points, auto const&) {
                         measure(fine, points);
                         EXPECT_NO_THROW(far_ext::BuildCascadeLevel(fine, {}, BoundaryRule::Fixed));
                     });
    }
}

// Each pass cuts a triangle once, or its halves again: areas are A / 2^m of the first triangle's, m
// at least the number of passes, they add up to A, and normals stay.
TEST(Bisection, HalvesTheAreasOfTheTrianglesItComesFrom) {
    for (auto const& [name, scene] : GetTriangleMeshes()) {
        int pass = 0;
        ForAllPasses(
            scene, 5,
            [&](auto const&, auto const&, CascadeMesh const& fine,
                std::vector<double> const& points, Bisection const& bisection) {
                ++pass;
                ASSERT_EQ(static_cast<Index>(bisection.GetBaseFaces().size()), fine.GetNumFaces());
                std::vector<double> sums(scene.cage.faceSizes.size(), 0.0);
                for (Index face = 0; face < fine.GetNumFaces(); ++face) {
                    Index const* const f = &fine.faces[3 * static_cast<size_t>(face)];
                    Index const base = bisection.GetBaseFaces()[face];
                    Index const* const b = &scene.cage.faceVertices[3 * static_cast<size_t>(base)];
                    double const whole = FindArea(scene.positions, b), area = FindArea(points, f);
                    double const halvings = std::log2(whole / area);
                    EXPECT_NEAR(halvings, std::round(halvings), 1e-6) << name;
                    EXPECT_GE(std::round(halvings), pass) << name;
                    EXPECT_LE(std::round(halvings), 2 * pass) << name;
                    sums[base] += area;
                    Eigen::Vector3d const normal =
                        (PointAt(points, f[1]) - PointAt(points, f[0]))
                            .cross(PointAt(points, f[2]) - PointAt(points, f[0]));
                    Eigen::Vector3d const baseNormal =
                        (PointAt(scene.positions, b[1]) - PointAt(scene.positions, b[0]))
                            .cross(PointAt(scene.positions, b[2]) - PointAt(scene.positions, b[0]));
                    EXPECT_NEAR(normal.normalized().dot(baseNormal.normalized()), 1.0, 1e-9)
                        << name;
                }
                for (size_t base = 0; base < sums.size(); ++base) {
                    double const whole =
                        FindArea(scene.positions, &scene.cage.faceVertices[3 * base]);
                    EXPECT_NEAR(sums[base], whole, 1e-12 * whole) << name;
                }
            });
    }
}

// On a lattice the longest edges are the diagonals, which two triangles share: nothing is ever cut
// twice in a pass.
TEST(Bisection, DoublesALatticesTriangles) {
    Index count = 40;
    ForAllPasses(test::MakeLattice(5, 4, Sdc::SCHEME_LOOP), 6,
                 [&](auto const&, auto const&, CascadeMesh const& fine, auto const&, auto const&) {
                     EXPECT_EQ(fine.GetNumFaces(), count *= 2);
                 });
}

// Cutting opposite the newest vertex again and again makes triangles of four shapes, however often.
TEST(Bisection, HasAtMostFourShapesInATriangle) {
    for (auto const& [name, scene] : GetTriangleMeshes()) {
        int pass = 0;
        ForAllPasses(
            scene, 6,
            [&](auto const&, auto const&, CascadeMesh const& fine,
                std::vector<double> const& points, Bisection const& bisection) {
                if (++pass < 6) return;
                std::vector<std::set<std::array<int, 2>>> shapes(
                    scene.cage.faceSizes.size());  // by the two shorter sides to the longest
                for (Index face = 0; face < fine.GetNumFaces(); ++face) {
                    Index const* const f = &fine.faces[3 * static_cast<size_t>(face)];
                    std::array<double, 3> sides{FindLength(points, f[0], f[1]),
                                                FindLength(points, f[1], f[2]),
                                                FindLength(points, f[2], f[0])};
                    std::sort(sides.begin(), sides.end());
                    shapes[bisection.GetBaseFaces()[face]].insert(
                        {static_cast<int>(std::lround(1e4 * sides[0] / sides[2] + 0.317)),
                         static_cast<int>(std::lround(1e4 * sides[1] / sides[2] + 0.317))});
                }
                for (auto const& found : shapes) EXPECT_LE(found.size(), 4u) << name;
            });
    }
}

// Exactly the longest edges of the first mesh are cut first, of equal ones that with the smallest
// pair of vertices. Then, of triangles with one new vertex, the edge opposite it, which is the one
// without it.
TEST(Bisection, CutsTheLongestEdgesAndThenThoseOppositeTheNewestVertices) {
    for (auto const& [name, scene] : GetTriangleMeshes()) {
        int pass = 0;
        ForAllPasses(scene, 2,
                     [&](CascadeMesh const& coarse, std::vector<double> const& coarsePoints,
                         CascadeMesh const& fine, auto const&, auto const&) {
                         ++pass;
                         std::set<std::array<Index, 2>> cut, expected;
                         for (Index i = coarse.numVertices; i < fine.numVertices; ++i) {
                             Index const a = fine.parents[fine.parentOffsets[i]],
                                         b = fine.parents[fine.parentOffsets[i] + 1];
                             cut.insert({std::min(a, b), std::max(a, b)});
                         }
                         for (size_t face = 0; face < coarse.faces.size(); face += 3) {
                             std::vector<std::tuple<double, Index, Index>> edges;
                             for (size_t k = 0; k < 3; ++k) {
                                 Index const a = coarse.faces[face + k],
                                             b = coarse.faces[face + (k + 1) % 3];
                                 bool const isNew = std::max(a, b) >= scene.cage.numVertices;
                                 // Squares as sums of squares of differences in the order x, y, z,
                                 // so that equal edges are equal to the bit.
                                 Eigen::Vector3d const d = PointAt(coarsePoints, std::max(a, b)) -
                                                           PointAt(coarsePoints, std::min(a, b));
                                 double const square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                                 if (pass == 1 || !isNew)
                                     edges.emplace_back(-square, std::min(a, b), std::max(a, b));
                             }
                             if (edges.empty()) continue;  // two or three new vertices
                             auto const first = *std::min_element(edges.begin(), edges.end());
                             expected.insert({std::get<1>(first), std::get<2>(first)});
                         }
                         if (pass == 1)
                             EXPECT_EQ(cut, expected) << name;
                         else
                             EXPECT_TRUE(std::includes(cut.begin(), cut.end(), expected.begin(),
                                                       expected.end()))
                                 << name;
                     });
    }
}

TEST(Bisection, PutsNewVerticesInTheOrderOfTheirEdges) {
    for (auto const& [name, scene] : GetTriangleMeshes()) {
        ForAllPasses(scene, 3,
                     [&](CascadeMesh const& coarse, auto const&, CascadeMesh const& fine,
                         auto const&, auto const&) {
                         std::map<std::set<Index>, int> numbers;
                         for (size_t face = 0; face < coarse.faces.size(); face += 3) {
                             for (size_t k = 0; k < 3; ++k) {
                                 numbers.try_emplace(
                                     {coarse.faces[face + k], coarse.faces[face + (k + 1) % 3]},
                                     static_cast<int>(numbers.size()));
                             }
                         }
                         int last = -1;
                         for (Index i = 0; i < fine.numVertices; ++i) {
                             std::set<Index> const parents(
                                 fine.parents.begin() + fine.parentOffsets[i],
                                 fine.parents.begin() + fine.parentOffsets[i + 1]);
                             if (i < coarse.numVertices) {
                                 EXPECT_EQ(parents, std::set<Index>{i}) << name;
                             } else {
                                 EXPECT_GT(numbers.at(parents), last) << name;
                                 last = numbers.at(parents);
                             }
                         }
                     });
    }
}

// Pieces of a crease are edges of the mesh, as long as the crease; corners are the same vertices.
TEST(Bisection, CarriesCreasesAndCorners) {
    int numCreased = 0;
    for (auto const& [name, scene] : GetTriangleMeshes()) {
        if (scene.cage.creaseSharpness.empty()) continue;
        ++numCreased;
        double length = 0.0;
        for (size_t i = 0; i < scene.cage.creaseVertexPairs.size(); i += 2)
            length += FindLength(scene.positions, scene.cage.creaseVertexPairs[i],
                                 scene.cage.creaseVertexPairs[i + 1]);
        ForAllPasses(scene, 4,
                     [&](auto const&, auto const&, CascadeMesh const& fine,
                         std::vector<double> const& points, auto const&) {
                         auto const edges = CountFacesAtEdges(fine);
                         double sum = 0.0;
                         for (auto const& [a, b] : fine.creases) {
                             EXPECT_TRUE(edges.count({std::min(a, b), std::max(a, b)})) << name;
                             sum += FindLength(points, a, b);
                         }
                         EXPECT_NEAR(sum, length, 1e-12 * length) << name;
                         EXPECT_EQ(fine.corners, scene.cage.cornerVertices) << name;
                     });
    }
    EXPECT_GT(numCreased, 5);
}

// ---- marked triangles ---------------------------------------------------------------------------

/// Passes that cut a third of the triangles each, chosen at random.
template <class Check>
void ForRandomPasses(engine::Scene const& scene, int count, Check const& check) {
    std::mt19937 random(17);
    auto bisection = MakeBisection(scene);
    auto points = scene.positions;
    for (int pass = 0; pass < count; ++pass) {
        std::vector<char> isMarked(bisection.GetBaseFaces().size());
        for (char& mark : isMarked) mark = random() % 3 == 0;
        CascadeMesh const coarse = bisection.GetMesh();
        CascadeMesh const fine = bisection.Refine(isMarked);
        points = test::ApplyParents(fine.parentOffsets, fine.parents, points);
        check(coarse, isMarked, fine, points, bisection.GetBaseFaces());
    }
}

/// Squares of a triangle's edges, sorted, over the longest: its shape.
std::array<double, 2> FindShape(std::vector<double> const& points, Index const* face) {
    std::array<double, 3> squares;
    for (size_t k = 0; k < 3; ++k)
        squares[k] = (PointAt(points, face[(k + 1) % 3]) - PointAt(points, face[k])).squaredNorm();
    std::sort(squares.begin(), squares.end());
    return {squares[0] / squares[2], squares[1] / squares[2]};
}

TEST(Bisection, OfMarkedTrianglesIsConforming) {
    for (auto const& [name, scene] : GetTriangleMeshes()) {
        auto const start = CountFacesAtEdges(test::MakeSameMesh(scene));
        auto const countBoundary = [](auto const& edges) {
            return std::count_if(edges.begin(), edges.end(),
                                 [](auto const& edge) { return edge.second == 1; });
        };
        ForRandomPasses(
            scene, 5,
            [&](auto const&, auto const&, CascadeMesh const& fine, auto const&, auto const&) {
                auto const edges = CountFacesAtEdges(fine);
                for (auto const& [edge, count] : edges) EXPECT_LE(count, 2) << name;
                // A vertex on the edge of a triangle would leave both sides of it with one face.
                EXPECT_EQ(countBoundary(start) == 0, countBoundary(edges) == 0) << name;
            });
    }
}

TEST(Bisection, CutsAllMarkedTrianglesAndKeepsTheSurface) {
    for (auto const& [name, scene] : GetTriangleMeshes()) {
        double const area = [&] {
            double sum = 0.0;
            auto const& f = scene.cage.faceVertices;
            for (size_t face = 0; face < f.size(); face += 3)
                sum += (PointAt(scene.positions, f[face + 1]) - PointAt(scene.positions, f[face]))
                           .cross(PointAt(scene.positions, f[face + 2]) -
                                  PointAt(scene.positions, f[face]))
                           .norm();
            return sum;
        }();
        ForRandomPasses(
            scene, 4,
            [&](CascadeMesh const& coarse, std::vector<char> const& isMarked,
                CascadeMesh const& fine, std::vector<double> const& points, auto const&) {
                std::set<std::set<Index>> kept;
                double sum = 0.0;
                for (size_t face = 0; face < fine.faces.size(); face += 3) {
                    Index const* const f = &fine.faces[face];
                    kept.insert({f[0], f[1], f[2]});
                    sum += (PointAt(points, f[1]) - PointAt(points, f[0]))
                               .cross(PointAt(points, f[2]) - PointAt(points, f[0]))
                               .norm();
                }
                EXPECT_NEAR(sum, area, 1e-12 * area) << name;
                for (size_t face = 0; face < isMarked.size(); ++face) {
                    Index const* const f = &coarse.faces[3 * face];
                    EXPECT_TRUE(!isMarked[face] || kept.count({f[0], f[1], f[2]}) == 0) << name;
                }
            });
    }
}

TEST(Bisection, LeavesAtMostFourShapesOfEachTriangle) {
    for (auto const& [name, scene] : GetTriangleMeshes()) {
        std::vector<std::vector<std::array<double, 2>>> shapes(scene.cage.faceVertices.size() / 3);
        ForRandomPasses(scene, 6,
                        [&](auto const&, auto const&, CascadeMesh const& fine,
                            std::vector<double> const& points, std::vector<Index> const& base) {
                            for (size_t face = 0; face < base.size(); ++face) {
                                auto const shape = FindShape(points, &fine.faces[3 * face]);
                                auto& known = shapes[static_cast<size_t>(base[face])];
                                bool const isKnown =
                                    std::any_of(known.begin(), known.end(), [&](auto const& other) {
                                        return std::abs(other[0] - shape[0]) +
                                                   std::abs(other[1] - shape[1]) <
                                               1e-9;
                                    });
                                if (!isKnown) known.push_back(shape);
                            }
                        });
        for (auto const& known : shapes) EXPECT_LE(known.size(), 4u) << name;
    }
}

TEST(Bisection, WithoutMarksNothingIsCut) {
    auto const scene = test::LoadMesh("torustri");
    auto bisection = MakeBisection(scene);
    std::vector<char> const none(scene.cage.faceVertices.size() / 3, 0);
    EXPECT_EQ(bisection.Refine(none).numVertices, scene.cage.numVertices);
    EXPECT_EQ(bisection.GetMesh().faces.size(), scene.cage.faceVertices.size());
}

}  // namespace
}  // namespace limn
