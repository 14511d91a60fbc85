// SPDX-License-Identifier: Apache-2.0
//
// Semi-sharp creases under Chaikin's rule: the sharpness of an edge's halves depends on all edges
// at its ends, those of other faces among them. OpenSubdiv's uniform refinement is the judge.

#include <optional>
#include <set>

#include <Eigen/Core>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "eval/surface/surface_place.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/limit/limit_matrix.h"
#include "support/chaikin_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

constexpr Sdc::SchemeType kCatmark = Sdc::SCHEME_CATMARK, kLoop = Sdc::SCHEME_LOOP;
constexpr int kSide = 5;  // vertices of a side of the grid

struct Crease {
    int from[2], to[2];
    float sharpness;
};

/// Creases that two values of sharpness make on the grid.
struct Pattern {
    std::string name;
    std::vector<Crease> (*make)(float a, float b);

    friend void PrintTo(Pattern const& pattern, std::ostream* out) { *out << pattern.name; }
};

std::vector<Pattern> MakePatterns() {
    return {{"Pair",
             [](float a, float b) -> std::vector<Crease> {
                 return {{{1, 2}, {2, 2}, a}, {{2, 2}, {3, 2}, b}};
             }},
            {"ChainFromSideToSide",
             [](float a, float b) -> std::vector<Crease> {
                 return {{{0, 2}, {1, 2}, a},
                         {{1, 2}, {2, 2}, b},
                         {{2, 2}, {3, 2}, a},
                         {{3, 2}, {4, 2}, b}};
             }},
            {"Bend",
             [](float a, float b) -> std::vector<Crease> {
                 return {{{2, 0}, {2, 1}, b}, {{2, 1}, {2, 2}, a}, {{2, 2}, {3, 2}, b}};
             }},
            {"Loop",
             [](float a, float b) -> std::vector<Crease> {
                 return {{{2, 2}, {3, 2}, a},
                         {{3, 2}, {3, 3}, b},
                         {{3, 3}, {2, 3}, a},
                         {{2, 3}, {2, 2}, b}};
             }},
            {"ThreeAtAVertex",
             [](float a, float b) -> std::vector<Crease> {
                 return {{{1, 2}, {2, 2}, a}, {{2, 2}, {3, 2}, b}, {{2, 2}, {2, 3}, 2.7f}};
             }},
            {"FourAtAVertexAndItsNeighbour",
             [](float a, float b) -> std::vector<Crease> {
                 return {{{1, 2}, {2, 2}, a}, {{2, 2}, {3, 2}, b},    {{2, 1}, {2, 2}, 1.9f},
                         {{2, 2}, {2, 3}, b}, {{3, 2}, {3, 3}, 3.3f}, {{3, 1}, {3, 2}, a}};
             }},
            {"IntoACorner", [](float a, float b) -> std::vector<Crease> {
                 return {{{2, 2}, {3, 2}, a},
                         {{3, 2}, {3, 1}, b},
                         {{3, 2}, {3, 3}, 10.0f},
                         {{3, 3}, {3, 4}, 1.1f}};
             }}};
}

Index VertexAt(int const place[2]) {
    return static_cast<Index>(kSide * place[1] + place[0]);
}

engine::Scene MakeCreasedGrid(Sdc::SchemeType scheme, std::vector<Crease> const& creases) {
    engine::Scene scene = test::MakeLattice(kSide - 1, kSide - 1, scheme);
    auto const heights = test::MakeNoise(static_cast<size_t>(scene.cage.numVertices), 3);
    for (size_t v = 0; v < heights.size(); ++v) scene.positions[3 * v + 2] = heights[v];
    scene.cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    scene.cage.options.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN);
    for (Crease const& crease : creases) {
        scene.cage.creaseVertexPairs.insert(scene.cage.creaseVertexPairs.end(),
                                            {VertexAt(crease.from), VertexAt(crease.to)});
        scene.cage.creaseSharpness.push_back(crease.sharpness);
    }
    return scene;
}

// -------- the judge

bool HasSemiSharpEdges(Far::TopologyLevel const& level) {
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        if (level.IsEdgeSemiSharp(edge)) return true;
    }
    return false;
}

/// The faces within two of a vertex.
std::vector<Index> FindFacesNear(Far::TopologyLevel const& level, Index vertex) {
    std::set<Index> vertices{vertex}, faces;
    for (int ring = 0; ring < 2; ++ring) {
        for (Index v : vertices) {
            for (Index face : level.GetVertexFaces(v)) faces.insert(face);
        }
        for (Index face : faces) {
            for (Index v : level.GetFaceVertices(face)) vertices.insert(v);
        }
    }
    return {faces.begin(), faces.end()};
}

/// A mesh, and one of its vertices.
struct Neighbourhood {
    engine::Scene scene;
    Index vertex;
};

/// The last level's faces round a vertex, cut out; far enough off it for the cut not to be felt.
Neighbourhood CutOut(Far::TopologyRefiner const& refiner, std::vector<double> const& positions,
                     Index vertex) {
    auto const level = refiner.GetLevel(refiner.GetMaxLevel());
    std::vector<Index> newIndex(static_cast<size_t>(level.GetNumVertices()), -1);
    std::vector<double> points;
    std::vector<std::vector<Index>> faces;
    std::set<Index> edges;
    for (Index face : FindFacesNear(level, vertex)) {
        auto& corners = faces.emplace_back();
        for (Index v : level.GetFaceVertices(face)) {
            Index& index = newIndex[static_cast<size_t>(v)];
            if (index < 0) {
                index = static_cast<Index>(points.size() / 3);
                points.insert(points.end(), &positions[3 * static_cast<size_t>(v)],
                              &positions[3 * static_cast<size_t>(v)] + 3);
            }
            corners.push_back(index);
        }
        for (Index edge : level.GetFaceEdges(face)) edges.insert(edge);
    }
    Neighbourhood result{test::MakeScene(std::move(points), faces, refiner.GetSchemeType()),
                         newIndex[static_cast<size_t>(vertex)]};
    auto& cage = result.scene.cage;
    cage.options = refiner.GetSchemeOptions();
    cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    for (Index edge : edges) {
        if (level.GetEdgeSharpness(edge) <= 0.0f || level.IsEdgeBoundary(edge)) continue;
        for (Index end : level.GetEdgeVertices(edge))
            cage.creaseVertexPairs.push_back(newIndex[static_cast<size_t>(end)]);
        cage.creaseSharpness.push_back(level.GetEdgeSharpness(edge));
    }
    for (size_t v = 0; v < newIndex.size(); ++v) {
        float const sharpness = level.GetVertexSharpness(static_cast<Index>(v));
        if (newIndex[v] < 0 || sharpness <= 0.0f) continue;
        cage.cornerVertices.push_back(newIndex[v]);
        cage.cornerSharpness.push_back(sharpness);
    }
    return result;
}

/// Where refining the whole mesh, over and over, leads a vertex: by OpenSubdiv's rules until no
/// sharpness is left, then by the closed form.
Eigen::Vector3d FindUniformLimit(Neighbourhood near) {
    for (;;) {
        auto const refiner = test::MakeRefiner(near.scene, 1);
        auto const level = refiner->GetLevel(0);
        if (!HasSemiSharpEdges(level)) {
            auto const limits = far_ext::LimitMatrix::Build(*refiner);
            test::Rows const points = limits.AsMatrix() * test::ToRows(near.scene.positions);
            return points.row(near.vertex);
        }
        near = CutOut(*refiner, eval::RefineValues<3>(*refiner, 1, near.scene.positions),
                      level.GetVertexChildVertex(near.vertex));
    }
}

/// The same without cutting out: the whole mesh on the level on which no sharpness is left.
std::vector<Eigen::Vector3d> FindUniformLimits(engine::Scene const& scene) {
    int numLevels = 0;
    auto refiner = test::MakeRefiner(scene, numLevels);
    while (HasSemiSharpEdges(refiner->GetLevel(numLevels)))
        refiner = test::MakeRefiner(scene, ++numLevels);
    std::vector<double> points = scene.positions;
    for (int level = 1; level <= numLevels; ++level)
        points = eval::RefineValues<3>(*refiner, level, points);
    auto const limits = far_ext::LimitMatrix::Build(*refiner, numLevels);
    test::Rows const limitPoints = limits.AsMatrix() * test::ToRows(points);
    std::vector<Eigen::Vector3d> result;
    for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex) {
        Index child = vertex;
        for (int level = 0; level < numLevels; ++level)
            child = refiner->GetLevel(level).GetVertexChildVertex(child);
        result.push_back(limitPoints.row(child));
    }
    return result;
}

// -------- the laws

TEST(ChaikinCreases, AreJudgedByTheWholeMesh) {
    for (Sdc::SchemeType scheme : {kCatmark, kLoop}) {
        for (Pattern const& pattern : MakePatterns()) {
            auto const scene = MakeCreasedGrid(scheme, pattern.make(2.5f, 1.5f));
            auto const expected = FindUniformLimits(scene);
            for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex) {
                Eigen::Vector3d const found = FindUniformLimit({scene, vertex});
                EXPECT_LT((found - expected[static_cast<size_t>(vertex)]).norm(), 1e-12)
                    << pattern.name << ", vertex " << vertex;
            }
        }
    }
}

/// The limit at places that faces share: by the face that came last, and how far any is off the one
/// before at most.
struct SharedLimits {
    std::vector<std::optional<Eigen::Vector3d>> points;
    double largestGap = 0.0;

    void Add(Index at, Eigen::Vector3d const& point) {
        auto& known = points[static_cast<size_t>(at)];
        if (known) largestGap = test::Worse(largestGap, (point - *known).norm());
        known = point;
    }
};

/// Evaluates a surface at places that faces share, from each of them.
class SharedPlaces {
public:
    SharedPlaces(Far::TopologyRefiner const& refiner, std::vector<double> const& positions)
        : _level(refiner.GetLevel(0)), _surface(refiner), _tree(_surface, positions, 3) {}

    /// By vertex.
    SharedLimits FindAtVertices() {
        return Find(_level.GetNumVertices(), [&](Index face, int corner, SharedLimits& limits) {
            limits.Add(_level.GetFaceVertices(face)[corner],
                       Evaluate(eval::GetCornerPlace(_surface, face, corner)));
        });
    }

    /// By edge, at `tau` of the way from its lower to its higher vertex.
    SharedLimits FindAlongEdges(double tau) {
        return Find(_level.GetNumEdges(), [&](Index face, int corner, SharedLimits& limits) {
            auto const vertices = _level.GetFaceVertices(face);
            int const size = vertices.size();
            bool const isUp = vertices[corner] < vertices[(corner + 1) % size];
            limits.Add(
                _level.GetFaceEdges(face)[corner],
                Evaluate(eval::GetEdgePlace(_surface, face, size, corner, isUp ? tau : 1.0 - tau)));
        });
    }

private:
    /// Calls add(face, corner, limits) for all corners of faces that have a limit.
    template <class Add>
    SharedLimits Find(Index numPlaces, Add add) {
        SharedLimits limits;
        limits.points.resize(static_cast<size_t>(numPlaces));
        for (Index face = 0; face < _level.GetNumFaces(); ++face) {
            if (!_surface.HasLimit(face)) continue;
            _tree.Bind(face);
            for (int corner = 0; corner < _level.GetFaceVertices(face).size(); ++corner)
                add(face, corner, limits);
        }
        return limits;
    }

    Eigen::Vector3d Evaluate(eval::SurfacePlace const& place) {
        return eval::EvaluateSample(_tree, place.domain, place.s, place.t).position;
    }

    Far::TopologyLevel _level;  // a view
    eval::LimitSurface _surface;
    eval::FaceTree _tree;
};

constexpr double kAlongEdges[] = {0.125, 0.3, 0.5};

using Parameters = std::tuple<Pattern, Sdc::SchemeType>;

class ChaikinCreases : public testing::TestWithParam<Parameters> {
protected:
    /// Calls visit(scene, refiner) for each pair of values of sharpness.
    template <class Visit>
    void ForEachPair(Visit visit) {
        auto const& [pattern, scheme] = GetParam();
        constexpr float kValues[] = {0.5f, 1.0f, 1.5f, 2.0f, 2.5f, 3.0f,
                                     3.5f, 4.0f, 5.0f, 6.0f, 8.0f};
        for (float a : kValues) {
            for (float b : kValues) {
                SCOPED_TRACE(fmt::format("sharpness {} and {}", a, b));
                auto const scene = MakeCreasedGrid(scheme, pattern.make(a, b));
                visit(scene, *test::MakeRefiner(scene, 0));
            }
        }
    }
};

TEST_P(ChaikinCreases, AllFacesAtAVertexHaveThePointThatUniformRefinementLeadsTo) {
    ForEachPair([](engine::Scene const& scene, Far::TopologyRefiner const& refiner) {
        auto const limits = SharedPlaces(refiner, scene.positions).FindAtVertices();
        EXPECT_LT(limits.largestGap, 1e-12);
        auto const matrix = far_ext::LimitMatrix::Build(refiner);
        test::Rows const byMatrix = matrix.AsMatrix() * test::ToRows(scene.positions);
        for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex) {
            Eigen::Vector3d const expected = FindUniformLimit({scene, vertex});
            EXPECT_LT((*limits.points[static_cast<size_t>(vertex)] - expected).norm(), 1e-12)
                << "vertex " << vertex;
            EXPECT_LT((byMatrix.row(vertex).transpose() - expected).norm(), 1e-12)
                << "vertex " << vertex;
        }
    });
}

TEST_P(ChaikinCreases, BothFacesAtAnEdgeHaveThePointsOnIt) {
    ForEachPair([](engine::Scene const& scene, Far::TopologyRefiner const& refiner) {
        SharedPlaces places(refiner, scene.positions);
        for (double tau : kAlongEdges)
            EXPECT_LT(places.FindAlongEdges(tau).largestGap, 1e-12) << tau;
    });
}

// The middle of an edge is a vertex one level on. Judged where the two values meet.
TEST_P(ChaikinCreases, MiddlesOfEdgesAreWhereUniformRefinementLeadsThem) {
    constexpr int kMeetingPlaces[][2] = {{2, 2}, {3, 2}};
    ForEachPair([&](engine::Scene const& scene, Far::TopologyRefiner const& refiner) {
        auto const middles = SharedPlaces(refiner, scene.positions).FindAlongEdges(0.5);
        auto const refined = test::MakeRefiner(scene, 1);
        auto const points = eval::RefineValues<3>(*refined, 1, scene.positions);
        for (auto const& place : kMeetingPlaces) {
            for (Index edge : refined->GetLevel(0).GetVertexEdges(VertexAt(place))) {
                Index const middle = refined->GetLevel(0).GetEdgeChildVertex(edge);
                Eigen::Vector3d const expected = FindUniformLimit(CutOut(*refined, points, middle));
                EXPECT_LT((*middles.points[static_cast<size_t>(edge)] - expected).norm(), 1e-12)
                    << "edge " << edge;
            }
        }
    });
}

INSTANTIATE_TEST_SUITE_P(Patterns, ChaikinCreases,
                         testing::Combine(testing::ValuesIn(MakePatterns()),
                                          testing::Values(kCatmark, kLoop)),
                         [](testing::TestParamInfo<Parameters> const& instance) {
                             bool const isLoop = std::get<1>(instance.param) == kLoop;
                             return std::get<0>(instance.param).name +
                                    (isLoop ? "Triangles" : "Quads");
                         });

TEST(ChaikinCreases, DoNotCrackAnyMesh) {
    for (auto const& scene : test::MakeChaikinMeshes()) {
        auto const refiner = test::MakeRefiner(scene, 0);
        double const size = test::BoxDiagonal(scene.positions);
        SharedPlaces places(*refiner, scene.positions);
        EXPECT_LT(places.FindAtVertices().largestGap, 1e-12 * size) << scene.name;
        for (double tau : kAlongEdges) {
            EXPECT_LT(places.FindAlongEdges(tau).largestGap, 1e-12 * size)
                << scene.name << ", " << tau;
        }
    }
}

}  // namespace
}  // namespace limn
