// SPDX-License-Identifier: Apache-2.0
#include "far_ext/cascade/cascade_level.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "support/cascade_meshes.h"
#include "support/errors.h"
#include "support/form_meshes.h"

namespace limn {
namespace {

using far_ext::BoundaryRule;
using far_ext::BuildCascadeLevel;
using far_ext::CascadeLevel;
using far_ext::CascadeMesh;
using far_ext::MakeCascadeMesh;

/// Calls check(refiner, k, mesh, level) for the first two levels of all meshes.
template <class Check>
void ForAllLevels(BoundaryRule rule, Check const& check) {
    for (auto const& [name, scene] : test::GetCascadeMeshes()) {
        SCOPED_TRACE(name);
        auto const refiner = test::MakeRefiner(scene, 2);
        for (int k = 1; k <= 2; ++k) {
            auto const mesh = MakeCascadeMesh(*refiner, k);
            check(*refiner, k, mesh, BuildCascadeLevel(mesh, {}, rule));
        }
    }
}

std::vector<Index> GetRing(CascadeLevel const& level, Index row) {
    std::vector<Index> ring;
    for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k)
        ring.push_back(level.vertices[level.neighbours[k]]);
    return ring;
}

// ---- rows and rings -----------------------------------------------------------------------------

TEST(CascadeLevel, RowsAreAPermutationOfTheVertices) {
    for (auto rule : {BoundaryRule::Fixed, BoundaryRule::Natural}) {
        ForAllLevels(
            rule, [](auto const&, int, CascadeMesh const& mesh, CascadeLevel const& level) {
                auto sorted = level.vertices;
                std::sort(sorted.begin(), sorted.end());
                std::vector<Index> all(static_cast<size_t>(mesh.numVertices));
                std::iota(all.begin(), all.end(), 0);
                EXPECT_EQ(sorted, all);
                EXPECT_LE(0, level.numClosed);
                EXPECT_LE(level.numClosed, level.numSurface);
                EXPECT_LE(level.numSurface, level.numUnknowns);
                EXPECT_LE(level.numUnknowns, level.GetNumRows());
                EXPECT_EQ(level.offsets.size(), static_cast<size_t>(level.numUnknowns) + 1);
                EXPECT_EQ(level.offsets.back(), static_cast<int>(level.neighbours.size()));
            });
    }
}

// Walking a ring must meet each face at its vertex once, with its corners in the face's own order:
// (v, a, b) of a triangle, (v, a, ab, b) of a quad.
TEST(CascadeLevel, ARingGoesThroughTheFacesOfItsVertex) {
    for (auto rule : {BoundaryRule::Fixed, BoundaryRule::Natural}) {
        ForAllLevels(
            rule, [](auto const&, int, CascadeMesh const& mesh, CascadeLevel const& level) {
                size_t const n = static_cast<size_t>(mesh.faceSize);
                std::vector<std::multiset<std::vector<Index>>> facesAt(
                    static_cast<size_t>(mesh.numVertices));
                for (size_t face = 0; face < mesh.faces.size(); face += n) {
                    std::vector<Index> corners(
                        mesh.faces.begin() + static_cast<std::ptrdiff_t>(face),
                        mesh.faces.begin() + static_cast<std::ptrdiff_t>(face + n));
                    for (size_t k = 0; k < n; ++k) {
                        facesAt[corners.front()].insert(corners);
                        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
                    }
                }
                for (Index row = 0; row < level.numSurface; ++row) {
                    Index const vertex = level.vertices[row];
                    auto ring = GetRing(level, row);
                    if (row < level.numClosed) ring.push_back(ring.front());
                    std::multiset<std::vector<Index>> walked;
                    for (size_t k = 0; k + 1 < ring.size(); k += n - 2) {
                        walked.insert(
                            n == 3 ? std::vector<Index>{vertex, ring[k], ring[k + 1]}
                                   : std::vector<Index>{vertex, ring[k], ring[k + 1], ring[k + 2]});
                    }
                    EXPECT_EQ(walked, facesAt[vertex]) << "vertex " << vertex;
                }
            });
    }
}

// What OpenSubdiv knows of a vertex says what its row is: a boundary stays or is open; two creases
// that meet are a line, more a corner; one that ends there leaves it smooth; a crease that meets a
// boundary, and a sharp vertex, stay.
TEST(CascadeLevel, TagsSayWhatKindARowIs) {
    for (auto rule : {BoundaryRule::Fixed, BoundaryRule::Natural}) {
        std::array<int, 4> counts{};
        ForAllLevels(rule, [&](Far::TopologyRefiner const& refiner, int k, CascadeMesh const&,
                               CascadeLevel const& level) {
            auto const topology = refiner.GetLevel(k);
            for (Index row = 0; row < level.GetNumRows(); ++row) {
                Index const vertex = level.vertices[row];
                std::set<Index> sharp;
                for (Index edge : topology.GetVertexEdges(vertex)) {
                    if (topology.IsEdgeBoundary(edge) || topology.GetEdgeSharpness(edge) <= 0.0f)
                        continue;
                    auto const ends = topology.GetEdgeVertices(edge);
                    sharp.insert(ends[0] + ends[1] - vertex);
                }
                bool const isBoundary = topology.IsVertexBoundary(vertex),
                           isCorner = topology.GetVertexSharpness(vertex) > 0.0f;
                bool const isFixed = topology.GetVertexFaces(vertex).size() == 0 ||
                                     (isBoundary ? rule == BoundaryRule::Fixed || !sharp.empty()
                                                 : isCorner || sharp.size() > 2);
                size_t const kind = isFixed ? 3 : isBoundary ? 1 : sharp.size() == 2 ? 2 : 0;
                size_t const found = row < level.numClosed     ? 0
                                     : row < level.numSurface  ? 1
                                     : row < level.numUnknowns ? 2
                                                               : 3;
                EXPECT_EQ(found, kind) << "level " << k << ", vertex " << vertex;
                ++counts[kind];
                if (kind != 2) continue;
                auto const ring = GetRing(level, row);
                EXPECT_EQ(std::set<Index>(ring.begin(), ring.end()), sharp)
                    << "a line's neighbours lie along it";
                EXPECT_EQ(ring.size(), 2u);
            }
        });
        EXPECT_GT(counts[0], 1000);
        EXPECT_EQ(counts[1] > 100, rule == BoundaryRule::Natural);
        EXPECT_GT(counts[2], 100);
        EXPECT_GT(counts[3], 100);
    }
}

struct Kinds {
    Index closed, open, lines, still;
    bool operator==(Kinds const&) const = default;
};

Kinds CountKinds(engine::Scene const& scene, int k, BoundaryRule rule = BoundaryRule::Fixed) {
    auto const refiner = test::MakeRefiner(scene, k);
    auto const level = BuildCascadeLevel(MakeCascadeMesh(*refiner, k), {}, rule);
    return {level.numClosed, level.numSurface - level.numClosed,
            level.numUnknowns - level.numSurface, level.GetNumRows() - level.numUnknowns};
}

std::ostream& operator<<(std::ostream& out, Kinds const& kinds) {
    return out << kinds.closed << " closed, " << kinds.open << " open, " << kinds.lines
               << " on lines, " << kinds.still << " still";
}

void Crease(engine::Scene& scene, Index a, Index b, float sharpness) {
    scene.cage.creaseVertexPairs.insert(scene.cage.creaseVertexPairs.end(), {a, b});
    scene.cage.creaseSharpness.push_back(sharpness);
}

// A 4 x 4 lattice of 25 vertices; quartered 81: 32 on the boundary. Of quads: 9 x 9; of triangles
// as well.
TEST(CascadeLevel, ABoundaryStaysOrIsOpen) {
    for (auto scheme : {Sdc::SCHEME_LOOP, Sdc::SCHEME_CATMARK}) {
        auto const lattice = test::MakeLattice(4, 4, scheme);
        EXPECT_EQ(CountKinds(lattice, 1, BoundaryRule::Fixed), (Kinds{49, 0, 0, 32}));
        EXPECT_EQ(CountKinds(lattice, 1, BoundaryRule::Natural), (Kinds{49, 32, 0, 0}));
    }
}

// One crease between vertices 6 and 7 inside the lattice: halved, its middle is on a line, its ends
// stay smooth. Sharpness 1.5 lasts to level 1, where it is 0.5, and is gone at level 2; 1 is gone
// at level 1.
TEST(CascadeLevel, ACreasesEndsStaySmoothAndSemiSharpOnesDecay) {
    for (auto scheme : {Sdc::SCHEME_LOOP, Sdc::SCHEME_CATMARK}) {
        auto const make = [&](float sharpness) {
            auto scene = test::MakeLattice(4, 4, scheme);
            Crease(scene, 6, 7, sharpness);
            return scene;
        };
        EXPECT_EQ(CountKinds(make(10), 1), (Kinds{48, 0, 1, 32}));
        EXPECT_EQ(CountKinds(make(10), 2), (Kinds{15 * 15 - 3, 0, 3, 64}));
        EXPECT_EQ(CountKinds(make(1.5f), 1), (Kinds{48, 0, 1, 32}));
        EXPECT_EQ(CountKinds(make(1.5f), 2), (Kinds{15 * 15, 0, 0, 64}));
        EXPECT_EQ(CountKinds(make(1), 1), (Kinds{49, 0, 0, 32}));
    }
}

// 6-7 and 7-8 make a line of 3 vertices at level 1; with 7-12 their meeting point stays, and three
// middles are left.
TEST(CascadeLevel, WhereThreeCreasesMeetAVertexStays) {
    auto scene = test::MakeLattice(4, 4, Sdc::SCHEME_CATMARK);
    Crease(scene, 6, 7, 10);
    Crease(scene, 7, 8, 10);
    EXPECT_EQ(CountKinds(scene, 1), (Kinds{46, 0, 3, 32}));
    Crease(scene, 7, 12, 10);
    EXPECT_EQ(CountKinds(scene, 1), (Kinds{45, 0, 3, 33}));
}

// 5-6 runs from the boundary (5) into the lattice (6): its middle is on a line, 5 stays under
// either rule, 6 is smooth. A crease along the boundary, 0-5, says nothing.
TEST(CascadeLevel, WhereACreaseMeetsABoundaryAVertexStays) {
    auto scene = test::MakeLattice(4, 4, Sdc::SCHEME_CATMARK);
    Crease(scene, 5, 6, 10);
    EXPECT_EQ(CountKinds(scene, 1, BoundaryRule::Fixed), (Kinds{48, 0, 1, 32}));
    EXPECT_EQ(CountKinds(scene, 1, BoundaryRule::Natural), (Kinds{48, 31, 1, 1}));
    auto along = test::MakeLattice(4, 4, Sdc::SCHEME_CATMARK);
    Crease(along, 0, 5, 10);
    EXPECT_EQ(CountKinds(along, 1, BoundaryRule::Natural), (Kinds{49, 32, 0, 0}));
}

TEST(CascadeLevel, ACornerStaysAsLongAsItIsSharp) {
    auto scene = test::MakeLattice(4, 4, Sdc::SCHEME_LOOP);
    scene.cage.cornerVertices = {6, 12};
    scene.cage.cornerSharpness = {10, 1.5f};
    EXPECT_EQ(CountKinds(scene, 1), (Kinds{47, 0, 0, 34}));
    EXPECT_EQ(CountKinds(scene, 2), (Kinds{15 * 15 - 1, 0, 0, 65}));
}

// A torus of 96 x 256 vertices: rows breadth-first have their neighbours nearer than the order of
// the refinement, whose edge points lie far behind.
TEST(CascadeLevel, NeighboursLieNearEachOther) {
    auto const refiner = test::MakeRefiner(test::LoadMesh("torustri"), 4);
    auto const level = BuildCascadeLevel(MakeCascadeMesh(*refiner, 4), {}, BoundaryRule::Fixed);
    double ofRows = 0.0, ofVertices = 0.0;
    for (Index row = 0; row < level.numUnknowns; ++row) {
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
            ofRows += std::abs(row - level.neighbours[k]);
            ofVertices += std::abs(level.vertices[row] - level.vertices[level.neighbours[k]]);
        }
    }
    EXPECT_LT(ofRows, 0.1 * ofVertices);
}

// ---- parents ------------------------------------------------------------------------------------

/// Linear interpolation as OpenSubdiv does it: its bilinear scheme on quads and n-gons, varying
/// data on triangles.
std::vector<double> InterpolateByFar(engine::Scene const& scene, int count) {
    std::vector<double> points = scene.positions;
    if (scene.cage.scheme != Sdc::SCHEME_LOOP) {
        auto bilinear = scene;
        bilinear.cage.scheme = Sdc::SCHEME_BILINEAR;
        auto const refiner = test::MakeRefiner(bilinear, count);
        for (int k = 1; k <= count; ++k) points = eval::RefineValues<3>(*refiner, k, points);
        return points;
    }
    auto const refiner = test::MakeRefiner(scene, count);
    Far::PrimvarRefinerReal<double> const primvars(*refiner);
    for (int k = 1; k <= count; ++k) {
        std::vector<eval::ValueRow<3>> from(points.size() / 3),
            to(static_cast<size_t>(refiner->GetLevel(k).GetNumVertices()));
        std::memcpy(from.data(), points.data(), points.size() * sizeof(double));
        primvars.InterpolateVarying(k, from, to);
        points.resize(3 * to.size());
        std::memcpy(points.data(), to.data(), points.size() * sizeof(double));
    }
    return points;
}

TEST(CascadeLevel, ParentsInterpolateLinearlyAsOpenSubdivDoes) {
    for (auto const& [name, scene] : test::GetCascadeMeshes()) {
        if (scene.cage.GetNumFaces() > 300) continue;
        auto const refiner = test::MakeRefiner(scene, 3);
        auto points = scene.positions;
        for (int k = 1; k <= 3; ++k) {
            auto const mesh = MakeCascadeMesh(*refiner, k);
            points = test::ApplyParents(mesh.parentOffsets, mesh.parents, points);
        }
        EXPECT_LT(test::LargestDifference(points, InterpolateByFar(scene, 3)),
                  1e-13 * test::BoxDiagonal(scene.positions))
            << name;
    }
}

// The rows' parents are rows of the coarser level: the same interpolation in another order.
TEST(CascadeLevel, RowsHaveTheirParentsAmongTheCoarserRows) {
    for (auto const& [name, scene] : test::GetCascadeMeshes()) {
        if (scene.cage.GetNumFaces() > 300) continue;
        auto const levels = test::QuarterLevels(scene, 3, BoundaryRule::Fixed);
        auto rows = scene.positions;
        for (auto const& level : levels)
            rows = test::ApplyParents(level.parentOffsets, level.parents, rows);
        std::vector<double> points(rows.size());
        for (size_t row = 0; row < levels.back().vertices.size(); ++row) {
            std::copy_n(&rows[3 * row], 3,
                        &points[3 * static_cast<size_t>(levels.back().vertices[row])]);
        }
        EXPECT_LT(test::LargestDifference(points, InterpolateByFar(scene, 3)),
                  1e-13 * test::BoxDiagonal(scene.positions))
            << name;
    }
}

/// A mesh in the order of [Limit 1]: its faces, and its edges in their order.
struct OrderedMesh {
    std::vector<std::vector<Index>> faces;
    std::vector<std::array<Index, 2>> edges;
    Index numVertices;
};

OrderedMesh OrderBase(engine::Scene const& scene) {
    OrderedMesh mesh{{}, {}, scene.cage.numVertices};
    std::set<std::array<Index, 2>> seen;
    auto corner = scene.cage.faceVertices.begin();
    for (int size : scene.cage.faceSizes) {
        mesh.faces.emplace_back(corner, corner + size);
        corner += size;
        for (size_t i = 0; i < mesh.faces.back().size(); ++i) {
            Index const a = mesh.faces.back()[i],
                        b = mesh.faces.back()[(i + 1) % static_cast<size_t>(size)];
            if (seen.insert({std::min(a, b), std::max(a, b)}).second) mesh.edges.push_back({a, b});
        }
    }
    return mesh;
}

// [Limit 1], level after level: vertex points, face points (of quads and n-gons), edge points.
// Base edges by first appearance along the faces; refined ones first within each parent face, (face
// point, edge point i) of quads and (e0, e2), (e1, e0), (e2, e1) of triangles, then (m, a), (m, b)
// of each parent edge.
TEST(CascadeLevel, VerticesComeInTheOrderOfTheSpecification) {
    for (auto const& [name, scene] : test::GetCascadeMeshes()) {
        if (scene.cage.GetNumFaces() > 300) continue;
        SCOPED_TRACE(name);
        auto const refiner = test::MakeRefiner(scene, 3);
        auto coarse = OrderBase(scene);
        for (int k = 1; k <= 3; ++k) {
            auto const mesh = MakeCascadeMesh(*refiner, k);
            bool const isLoop = mesh.faceSize == 3;
            Index const firstFace = coarse.numVertices,
                        firstEdge =
                            firstFace + (isLoop ? 0 : static_cast<Index>(coarse.faces.size()));
            ASSERT_EQ(mesh.numVertices, firstEdge + static_cast<Index>(coarse.edges.size()));
            std::map<std::set<Index>, Index> edgePoints;
            for (Index i = 0; i < mesh.numVertices; ++i) {
                std::multiset<Index> const parents(
                    mesh.parents.begin() + mesh.parentOffsets[i],
                    mesh.parents.begin() + mesh.parentOffsets[i + 1]);
                std::multiset<Index> expected{i};
                if (i >= firstEdge) {
                    auto const& edge = coarse.edges[i - firstEdge];
                    expected = {edge[0], edge[1]};
                    edgePoints[{edge[0], edge[1]}] = i;
                } else if (i >= firstFace) {
                    expected = {coarse.faces[i - firstFace].begin(),
                                coarse.faces[i - firstFace].end()};
                }
                ASSERT_EQ(parents, expected) << "level " << k << ", vertex " << i;
            }
            OrderedMesh fine{{}, {}, mesh.numVertices};
            for (size_t f = 0; f < mesh.faces.size(); f += static_cast<size_t>(mesh.faceSize)) {
                fine.faces.emplace_back(
                    mesh.faces.begin() + static_cast<std::ptrdiff_t>(f),
                    mesh.faces.begin() + static_cast<std::ptrdiff_t>(f) + mesh.faceSize);
            }
            for (size_t face = 0; face < coarse.faces.size(); ++face) {
                auto const& v = coarse.faces[face];
                std::vector<Index> e;
                for (size_t i = 0; i < v.size(); ++i)
                    e.push_back(edgePoints.at({v[i], v[(i + 1) % v.size()]}));
                if (isLoop)
                    fine.edges.insert(fine.edges.end(), {{e[0], e[2]}, {e[1], e[0]}, {e[2], e[1]}});
                else
                    for (Index point : e)
                        fine.edges.push_back({firstFace + static_cast<Index>(face), point});
            }
            for (size_t edge = 0; edge < coarse.edges.size(); ++edge) {
                Index const middle = firstEdge + static_cast<Index>(edge);
                fine.edges.insert(fine.edges.end(), {{middle, coarse.edges[edge][0]},
                                                     {middle, coarse.edges[edge][1]}});
            }
            coarse = fine;
        }
    }
}

// ---- what is no surface -------------------------------------------------------------------------

std::optional<ErrorCode> CodeOfFaces(std::vector<Index> const& faces, int faceSize = 3) {
    return test::CodeOf([&] {
        CascadeMesh mesh;
        mesh.faceSize = faceSize;
        mesh.numVertices = *std::max_element(faces.begin(), faces.end()) + 1;
        mesh.faces = faces;
        for (Index i = 0; i < mesh.numVertices; ++i) {
            mesh.parents.push_back(i);
            mesh.parentOffsets.push_back(i + 1);
        }
        BuildCascadeLevel(mesh, {}, BoundaryRule::Fixed);
    });
}

TEST(CascadeLevel, WhatIsNoDiscAtAVertexIsRefused) {
    std::optional<ErrorCode> const bad = ErrorCode::BadMesh, good = {};
    EXPECT_EQ(CodeOfFaces({0, 1, 2, 0, 2, 3}), good);
    EXPECT_EQ(CodeOfFaces({0, 1, 2, 1, 0, 3, 0, 1, 4}), bad) << "three faces at an edge";
    EXPECT_EQ(CodeOfFaces({0, 1, 2, 0, 1, 3}), bad) << "two faces of opposite orientations";
    EXPECT_EQ(CodeOfFaces({0, 1, 2, 0, 3, 4}), bad) << "two triangles that share a vertex alone";
    EXPECT_EQ(CodeOfFaces({0, 1, 2, 0, 2, 3, 0, 3, 1, 0, 4, 5}), bad)
        << "a closed ring and a triangle";
    EXPECT_EQ(CodeOfFaces({0, 0, 1}), bad) << "a vertex twice";
    EXPECT_EQ(CodeOfFaces({0, 1, 2, 0, 2, 1}), good)
        << "two sides of a triangle are a closed surface";
    EXPECT_EQ(CodeOfFaces({0, 1, 2, 3, 0, 3, 4, 5}, 4), good);
    EXPECT_EQ(CodeOfFaces({0, 1, 2, 3, 0, 1, 4, 5}, 4), bad) << "opposite orientations";
    EXPECT_EQ(CodeOfFaces({0, 1, 2, 3, 0, 4, 5, 6}, 4), bad) << "a vertex alone";
    EXPECT_EQ(CodeOfFaces({0, 1, 0, 2}, 4), bad) << "a vertex twice";
    // A strip of five triangles, closed with a twist.
    EXPECT_EQ(CodeOfFaces({0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 0, 4, 0, 1}), bad);
}

// OpenSubdiv refines them; it calls their vertices non-manifold.
TEST(CascadeLevel, CagesThatAreNoManifoldAreRefused) {
    int numRefused = 0;
    for (auto const& name : test::ListShapes()) {
        auto const scene = test::LoadShape(name);
        auto const code = test::CodeOf([&] { test::QuarterLevels(scene, 1, BoundaryRule::Fixed); });
        EXPECT_EQ(code.has_value(), !test::IsManifold(scene)) << name;
        EXPECT_EQ(code.value_or(ErrorCode::BadMesh), ErrorCode::BadMesh) << name;
        numRefused += code.has_value();
    }
    EXPECT_GE(numRefused, 6);  // edges of more faces, vertices alone, a fan, a doubled edge
}

TEST(CascadeLevel, AVertexWithoutFacesStays) {
    CascadeMesh mesh;
    mesh.numVertices = 5;
    mesh.faces = {1, 2, 4, 1, 4, 2};  // two sides of a triangle; 0 and 3 are alone
    mesh.parents = {0, 1, 2, 3, 4};
    mesh.parentOffsets = {0, 1, 2, 3, 4, 5};
    auto const level = BuildCascadeLevel(mesh, {}, BoundaryRule::Natural);
    EXPECT_EQ(level.numUnknowns, 3);
    EXPECT_EQ((std::set<Index>{level.vertices.begin() + 3, level.vertices.end()}),
              (std::set<Index>{0, 3}));
}

}  // namespace
}  // namespace limn
