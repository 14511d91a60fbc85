// SPDX-License-Identifier: Apache-2.0
#include "far_ext/cascade/cascade_level.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "far_ext/cascade/bisection.h"
#include "far_ext/cascade/cascade_stencils.h"
#include "support/cascade_meshes.h"
#include "support/form_meshes.h"

namespace limn {
namespace {

using far_ext::Bisection;
using far_ext::BoundaryRule;
using far_ext::BuildCascadeLevel;
using far_ext::CascadeLevel;
using far_ext::CascadeMesh;
using far_ext::MakeCascadeMesh;
using test::PointAt;

engine::Scene LoadCage(std::string const& name) {
    engine::Scene scene = test::LoadData("opensubdiv_shapes/" + name);
    scene.cage.scheme = name.starts_with("loop")       ? Sdc::SCHEME_LOOP
                        : name.starts_with("bilinear") ? Sdc::SCHEME_BILINEAR
                                                       : Sdc::SCHEME_CATMARK;
    return scene;
}

bool IsManifold(engine::Scene const& scene) {
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const base = refiner->GetLevel(0);
    for (Index i = 0; i < base.GetNumVertices(); ++i) {
        if (base.IsVertexNonManifold(i)) return false;
    }
    return true;
}

/// Meshes with names: made ones of valence 2 to 12, open and closed, n-gons, creases of any
/// sharpness, several components, genus 0 to 2; and those of Pixar's cages that are manifolds.
std::vector<std::pair<std::string, engine::Scene>> const& GetMeshes() {
    static auto const meshes = [] {
        auto all = test::MakeFormMeshes();
        for (auto const& name : test::ListData("opensubdiv_shapes")) {
            auto const scene = LoadCage(name);
            if (IsManifold(scene)) all.emplace_back(name, scene);
        }
        return all;
    }();
    return meshes;
}

/// Calls check(refiner, k, mesh, level) for the first two levels of all meshes.
template <class Check>
void ForAllLevels(BoundaryRule rule, Check const& check) {
    for (auto const& [name, scene] : GetMeshes()) {
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
                size_t kind = 0;
                if (topology.GetVertexFaces(vertex).size() == 0)
                    kind = 3;
                else if (isBoundary)
                    kind = rule == BoundaryRule::Fixed || !sharp.empty() ? 3 : 1;
                else if (isCorner || sharp.size() > 2)
                    kind = 3;
                else if (sharp.size() == 2)
                    kind = 2;
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

std::vector<double> ApplyParents(std::vector<int> const& offsets, std::vector<Index> const& parents,
                                 std::vector<double> const& coarse) {
    std::vector<double> fine(3 * (offsets.size() - 1), 0.0);
    for (size_t i = 0; i + 1 < offsets.size(); ++i) {
        for (int k = offsets[i]; k < offsets[i + 1]; ++k) {
            for (size_t c = 0; c < 3; ++c)
                fine[3 * i + c] +=
                    coarse[3 * static_cast<size_t>(parents[k]) + c] / (offsets[i + 1] - offsets[i]);
        }
    }
    return fine;
}

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
    for (auto const& [name, scene] : GetMeshes()) {
        if (scene.cage.GetNumFaces() > 300) continue;
        auto const refiner = test::MakeRefiner(scene, 3);
        auto points = scene.positions;
        for (int k = 1; k <= 3; ++k) {
            auto const mesh = MakeCascadeMesh(*refiner, k);
            points = ApplyParents(mesh.parentOffsets, mesh.parents, points);
        }
        EXPECT_LT(test::LargestDifference(points, InterpolateByFar(scene, 3)),
                  1e-13 * test::BoxDiagonal(scene.positions))
            << name;
    }
}

// The rows' parents are rows of the coarser level: the same interpolation in another order.
TEST(CascadeLevel, RowsHaveTheirParentsAmongTheCoarserRows) {
    for (auto const& [name, scene] : GetMeshes()) {
        if (scene.cage.GetNumFaces() > 300) continue;
        auto const levels = test::QuarterLevels(scene, 3, BoundaryRule::Fixed);
        auto rows = scene.positions;
        for (auto const& level : levels)
            rows = ApplyParents(level.parentOffsets, level.parents, rows);
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
    for (auto const& [name, scene] : GetMeshes()) {
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

int CodeOfFaces(std::vector<Index> faces, int faceSize = 3) {
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
    int const bad = static_cast<int>(ErrorCode::BadMesh), good = -1;
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
    for (auto const& name : test::ListData("opensubdiv_shapes")) {
        auto const scene = LoadCage(name);
        int const code = test::CodeOf([&] { test::QuarterLevels(scene, 1, BoundaryRule::Fixed); });
        EXPECT_EQ(code, IsManifold(scene) ? -1 : static_cast<int>(ErrorCode::BadMesh)) << name;
        numRefused += code >= 0;
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

// ---- bisection ----------------------------------------------------------------------------------

std::vector<std::pair<std::string, engine::Scene>> const& GetTriangleMeshes() {
    static auto const meshes = [] {
        std::vector<std::pair<std::string, engine::Scene>> all;
        for (auto const& mesh : GetMeshes()) {
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
        auto const points = ApplyParents(fine.parentOffsets, fine.parents, coarsePoints);
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
        auto const measure = [&, name = name](CascadeMesh const& mesh,
                                              std::vector<double> const& points) {
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
                         EXPECT_NO_THROW(BuildCascadeLevel(fine, {}, BoundaryRule::Fixed));
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
            [&, name = name, scene = scene](auto const&, auto const&, CascadeMesh const& fine,
                                            std::vector<double> const& points,
                                            Bisection const& bisection) {
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
            [&, name = name, scene = scene](auto const&, auto const&, CascadeMesh const& fine,
                                            std::vector<double> const& points,
                                            Bisection const& bisection) {
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
                     [&, name = name, scene = scene](
                         CascadeMesh const& coarse, std::vector<double> const& coarsePoints,
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
                     [&, name = name](CascadeMesh const& coarse, auto const&,
                                      CascadeMesh const& fine, auto const&, auto const&) {
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
        ForAllPasses(
            scene, 4,
            [&, name = name, scene = scene](auto const&, auto const&, CascadeMesh const& fine,
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

// ---- sweeps as stencils -------------------------------------------------------------------------

// 1 - s (m + sum e) + s sum e + s m = 1 in every row, whatever the weights: X = X0 = constant
// stays. Rows that stay are themselves.
TEST(CascadeStencils, RowsAddUpToOne) {
    for (auto rule : {BoundaryRule::Fixed, BoundaryRule::Natural}) {
        for (auto const& [name, scene] : GetMeshes()) {
            if (scene.cage.GetNumFaces() > 300) continue;
            auto const levels = test::QuarterLevels(scene, 1, rule);
            auto const& level = levels.back();
            std::mt19937 random(3);
            auto const draw = [&](size_t count) {
                std::vector<float> values(count);
                for (float& value : values) value = static_cast<float>(random()) * 0x1p-32f;
                return values;
            };
            far_ext::CascadeStencils table(level);
            auto const edges = draw(level.neighbours.size());
            auto scales = draw(static_cast<size_t>(level.numUnknowns));
            if (!scales.empty()) scales[0] = 0.0f;  // one that nothing moves
            table.SetWeights(level, edges, draw(scales.size()), scales);
            ASSERT_EQ(table.GetNumStencils(), level.GetNumRows());
            ASSERT_EQ(table.GetNumControlVertices(), 2 * level.GetNumRows());
            size_t at = 0;
            for (Index row = 0; row < table.GetNumStencils(); ++row) {
                ASSERT_EQ(table.GetOffsets()[row], static_cast<Index>(at)) << name;
                double sum = 0.0, largest = 0.0;
                bool isItself = true;
                for (int k = 0; k < table.GetSizes()[row]; ++k, ++at) {
                    double const weight = table.GetWeights()[at];
                    Index const index = table.GetControlIndices()[at];
                    ASSERT_GE(index, 0);
                    ASSERT_LT(index, table.GetNumControlVertices());
                    sum += weight;
                    largest = std::max(largest, std::abs(weight));
                    isItself = isItself && weight == (index == row ? 1.0 : 0.0);
                }
                EXPECT_NEAR(sum, 1.0, 1e-6 * largest) << name;
                EXPECT_EQ(isItself, row >= level.numUnknowns || row == 0) << name;
            }
            EXPECT_EQ(at, table.GetWeights().size());
        }
    }
}

}  // namespace
}  // namespace limn
