// SPDX-License-Identifier: Apache-2.0
#include "far_ext/limit/limit_matrix.h"

#include <cmath>
#include <filesystem>
#include <numeric>

#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>

#include "eval/surface/surface_place.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/refined.h"

namespace limn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using far_ext::LimitMatrix;
using far_ext::LimitOptions;

struct Cage {
    std::string name;
    engine::Scene scene;
    std::unique_ptr<Far::TopologyRefiner> refiner;
};

Cage MakeCage(std::string name, engine::Scene scene) {
    auto refiner = far_ext::CreateRefiner(scene.cage);
    return {std::move(name), std::move(scene), std::move(refiner)};
}

/// Every kind of mesh: the regression cages, fans of valence 3 to 12, tori.
std::vector<Cage> MakeCages() {
    std::vector<Cage> cages;
    for (std::string const& name : test::ListShapes())
        cages.push_back(MakeCage(name, test::LoadShape(name)));
    for (int valence = 3; valence <= 12; ++valence) {
        for (auto scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
            cages.push_back(MakeCage("fan " + std::to_string(valence),
                                     test::MakeFan(valence, scheme, 0.2, 0.1)));
        }
    }
    cages.push_back(MakeCage("torus", test::MakeTorus(7, 5)));
    cages.push_back(MakeCage("triangle torus", test::MakeTriangleTorus(7, 5)));
    return cages;
}

MatrixXd GetPositions(engine::Scene const& scene) {
    return test::ToRows(scene.positions);
}

/// Whether a vertex has what no limit mask of OpenSubdiv covers: semi-sharpness, or the end of a
/// crease.
bool IsBeyondMasks(Far::TopologyLevel const& level, Index vertex) {
    auto const edges = level.GetVertexEdges(vertex);
    bool isSemiSharp = level.IsVertexSemiSharp(vertex);
    int numSharp = 0;
    for (Index edge : edges) {
        isSemiSharp |= level.IsEdgeSemiSharp(edge);
        numSharp += level.IsEdgeInfSharp(edge);
    }
    return isSemiSharp || numSharp == 1;
}

struct Row3 {
    Eigen::Vector3d value;
    void Clear() { value.setZero(); }
    void AddWithWeight(Row3 const& other, double weight) { value += weight * other.value; }
};

/// OpenSubdiv's Limit of the base vertices, after `levels` refinements.
MatrixXd LimitByOpenSubdiv(engine::Scene const& scene, int levels) {
    auto const refiner = test::MakeRefiner(scene, levels);
    Far::PrimvarRefinerReal<double> const primvars(*refiner);
    MatrixXd const M = GetPositions(scene);
    std::vector<Row3> rows(static_cast<size_t>(M.rows()));
    for (size_t i = 0; i < rows.size(); ++i) rows[i].value = M.row(static_cast<Index>(i));
    for (int level = 1; level <= levels; ++level) {
        std::vector<Row3> fine(static_cast<size_t>(refiner->GetLevel(level).GetNumVertices()));
        primvars.Interpolate(level, rows, fine);
        rows = std::move(fine);
    }
    std::vector<Row3> limits(rows.size());
    primvars.Limit(rows, limits);
    MatrixXd limit(M.rows(), 3);
    for (Index vertex = 0; vertex < M.rows(); ++vertex) {
        Index child = vertex;
        for (int level = 0; level < levels; ++level)
            child = refiner->GetLevel(level).GetVertexChildVertex(child);
        limit.row(vertex) = limits[static_cast<size_t>(child)].value;
    }
    return limit;
}

TEST(LimitMatrix, RowsSumToOneAndHaveNoColumnTwice) {
    for (Cage const& cage : MakeCages()) {
        SCOPED_TRACE(cage.name);
        auto const A = LimitMatrix::Build(*cage.refiner);
        for (int row = 0; row < A.GetNumStencils(); ++row) {
            auto const begin = static_cast<size_t>(A.GetOffsets()[row]),
                       end = begin + static_cast<size_t>(A.GetSizes()[row]);
            ASSERT_NEAR(
                std::accumulate(A.GetWeights().begin() + begin, A.GetWeights().begin() + end, 0.0),
                1.0, 1e-12);
            std::vector<Index> columns(A.GetControlIndices().begin() + begin,
                                       A.GetControlIndices().begin() + end);
            std::sort(columns.begin(), columns.end());
            ASSERT_EQ(std::adjacent_find(columns.begin(), columns.end()), columns.end());
        }
    }
}

// Independent of any mask: the face's tree of rings, refined towards the corner as deep as doubles
// can tell.
TEST(LimitMatrix, MeetsTheDeeplyRefinedSurfaceOnEveryKindOfMesh) {
    for (Cage const& cage : MakeCages()) {
        SCOPED_TRACE(cage.name);
        MatrixXd const M = GetPositions(cage.scene);
        MatrixXd const limit = LimitMatrix::Build(*cage.refiner).AsMatrix() * M;
        double const size = test::BoxDiagonal(cage.scene.positions);
        eval::LimitSurface const surface(*cage.refiner);
        eval::FaceTree tree(surface, cage.scene.positions, 3);
        auto const level = cage.refiner->GetLevel(0);
        int numCompared = 0;
        for (Index face = 0; face < surface.GetNumFaces(); ++face) {
            if (!surface.HasLimit(face)) continue;
            tree.Bind(face);
            ++numCompared;
            auto const vertices = level.GetFaceVertices(face);
            for (int corner = 0; corner < vertices.size(); ++corner) {
                auto const place = eval::GetCornerPlace(surface, face, corner);
                for (int c = 0; c < 3; ++c) {
                    ASSERT_NEAR(eval::EvaluateChannel(tree, place.domain, place.s, place.t, c),
                                limit(vertices[corner], c), 1e-12 * size)
                        << "vertex " << vertices[corner];
                }
            }
        }
        EXPECT_GT(numCompared, 0);
    }
}

TEST(LimitMatrix, MeetsOpenSubdivsLimitMasks) {
    int numCompared = 0;
    for (Cage const& cage : MakeCages()) {
        if (cage.scene.cage.scheme == Sdc::SCHEME_BILINEAR)
            continue;  // its Limit is the identity there, too
        SCOPED_TRACE(cage.name);
        MatrixXd const M = GetPositions(cage.scene);
        MatrixXd const limit = LimitMatrix::Build(*cage.refiner).AsMatrix() * M,
                       theirs = LimitByOpenSubdiv(cage.scene, 1);
        double const size = test::BoxDiagonal(cage.scene.positions);
        auto const level = cage.refiner->GetLevel(0);
        for (Index vertex = 0; vertex < M.rows(); ++vertex) {
            auto const faces = level.GetVertexFaces(vertex);
            bool const hasLimit = std::any_of(faces.begin(), faces.end(),
                                              [&](Index f) { return !level.IsFaceHole(f); });
            bool const isInterior2 = faces.size() == 2 && !level.IsVertexBoundary(vertex);
            if (!hasLimit || isInterior2 || IsBeyondMasks(level, vertex)) continue;
            ASSERT_LE((limit.row(vertex) - theirs.row(vertex)).norm(), 1e-12 * size)
                << "vertex " << vertex;
            ++numCompared;
        }
    }
    EXPECT_GT(numCompared, 5000);
}

/// Positions without any symmetry that would hide a wrong mask.
void Perturb(engine::Scene& scene) {
    for (size_t i = 0; i < scene.positions.size(); ++i)
        scene.positions[i] += 0.1 * std::sin(static_cast<double>(7 * i + 3));
}

/// A cube whose last faces differ: `faces` in place of {4,5,6,7}; vertex 8, where they use it, lies
/// at their middle.
engine::Scene MakeCubeWith(std::vector<std::vector<Index>> faces) {
    engine::Scene const cube = test::MakeCube();
    for (Index face = 0; face < 6; ++face) {
        if (face == 1) continue;
        auto const begin = cube.cage.faceVertices.begin() + 4 * face;
        faces.emplace_back(begin, begin + 4);
    }
    bool const hasMiddle = std::any_of(faces.begin(), faces.end(), [](auto const& f) {
        return std::count(f.begin(), f.end(), 8) > 0;
    });
    auto positions = cube.positions;
    if (hasMiddle) positions.insert(positions.end(), {0, 0, 1});
    return test::MakeScene(std::move(positions), faces);
}

engine::Scene MakeCubeWithValence2() {
    return MakeCubeWith({{4, 5, 6, 8}, {8, 6, 7, 4}});
}

// OpenSubdiv's Limit leaves an interior vertex of valence 2 where its refinement put it, so that
// its answer depends on the level, and takes the mask of a smooth vertex at darts; both come nearer
// to A with each level.
TEST(LimitMatrix, OpenSubdivsMasksOnlyApproachItAtValence2AndDarts) {
    for (char const* name : {"valence 2", "catmark_dart_edgeonly", "catmark_dart_edgecorner"}) {
        SCOPED_TRACE(name);
        engine::Scene scene =
            std::string(name) == "valence 2" ? MakeCubeWithValence2() : test::LoadShape(name);
        Perturb(scene);
        for (float& sharpness : scene.cage.creaseSharpness) sharpness = 10.0f;
        Cage const cage = MakeCage(name, std::move(scene));
        auto const level = cage.refiner->GetLevel(0);
        MatrixXd const limit =
            LimitMatrix::Build(*cage.refiner).AsMatrix() * GetPositions(cage.scene);
        MatrixXd const first = LimitByOpenSubdiv(cage.scene, 1),
                       fourth = LimitByOpenSubdiv(cage.scene, 4);
        int numFound = 0;
        for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
            bool const isInterior2 =
                level.GetVertexFaces(vertex).size() == 2 && !level.IsVertexBoundary(vertex);
            bool const isDart = level.GetVertexRule(vertex) == Sdc::Crease::RULE_DART;
            if (!isInterior2 && !isDart) continue;
            ++numFound;
            double const early = (first.row(vertex) - limit.row(vertex)).norm(),
                         late = (fourth.row(vertex) - limit.row(vertex)).norm();
            EXPECT_GT(early, 1e-3);
            EXPECT_LT(late, 0.3 * early);
            EXPECT_GT(late, 1e-6);
        }
        EXPECT_GT(numFound, 0);
    }
}

// For a vertex of valence n among quads: (n^2 v + 4 sum of edge ends + sum of face opposites) / (n
// (n+5)).
TEST(LimitMatrix, CubeCornerHasTheClosedFormWeights) {
    auto const cube = MakeCage("cube", test::MakeCube());
    auto const limit = LimitMatrix::Build(*cube.refiner);
    MatrixXd const A = limit.AsMatrix();
    EXPECT_NEAR(A(0, 0), 9.0 / 24.0, 1e-15);
    EXPECT_NEAR(A(0, 1), 4.0 / 24.0, 1e-15);  // along an edge
    EXPECT_NEAR(A(0, 2), 1.0 / 24.0, 1e-15);  // across a face
    EXPECT_EQ(A(0, 6), 0.0);                  // the far corner is out of reach
}

// Closed meshes without tags: B = D A is symmetric, whatever the faces.
TEST(LimitMatrix, ScaledByDItIsSymmetricOnClosedMeshes) {
    std::vector<engine::Scene> scenes;
    for (char const* name : {"golden_surface/icosa", "golden_surface/torustri",
                             "opensubdiv_shapes/catmark_toroidal_tet"}) {
        scenes.push_back(test::LoadData(std::string(name) + ".obj"));
    }
    scenes.push_back(scenes[0]);
    scenes.back().cage.scheme = Sdc::SCHEME_LOOP;
    scenes.push_back(test::MakeCube());
    scenes.push_back(MakeCubeWithValence2());
    scenes.push_back(MakeCubeWith({{4, 5, 6}, {4, 6, 7}}));
    scenes.push_back(MakeCubeWith({{4, 5, 8}, {5, 6, 8}, {6, 7, 4, 8}}));
    for (size_t i = 0; i < scenes.size(); ++i) {
        auto const limit = LimitMatrix::Build(*far_ext::CreateRefiner(scenes[i].cage));
        VectorXd const D =
            Eigen::Map<VectorXd const>(limit.GetScales().data(), limit.GetNumStencils());
        MatrixXd const B = D.asDiagonal() * MatrixXd(limit.AsMatrix());
        EXPECT_LT(test::LargestOf(B - B.transpose()), 1e-11) << "mesh " << i;
    }
}

TEST(LimitMatrix, MeetsTheGoldenLimits) {
    struct Variant {
        char const* suffix;
        Sdc::SchemeType scheme;
        LimitOptions options;
    };
    Variant const variants[] = {
        {"cc", Sdc::SCHEME_CATMARK, {}},
        {"loop", Sdc::SCHEME_LOOP, {}},
        {"cc_a50p", Sdc::SCHEME_CATMARK, {0.5, LimitOptions::AlphaRule::FirstStep}},
        {"cc_a50s", Sdc::SCHEME_CATMARK, {0.5, LimitOptions::AlphaRule::Stationary}}};
    int numCompared = 0;
    for (std::string const name : {"cube", "icosa", "torustri", "gridholetri"}) {
        for (Variant const& variant : variants) {
            std::string const golden =
                "golden_surface/" + name + "_pi_" + variant.suffix + "_limit.obj";
            if (!std::filesystem::exists(test::DataPath(golden))) continue;
            engine::Scene scene = test::LoadData("golden_surface/" + name + ".obj");
            scene.cage.scheme = variant.scheme;
            Cage const cage = MakeCage(name, std::move(scene));
            MatrixXd const limit =
                LimitMatrix::Build(*cage.refiner, 0, variant.options).AsMatrix() *
                GetPositions(cage.scene);
            EXPECT_LT(test::LargestOf(limit - test::ToRows(test::LoadPoints(golden))), 1e-12)
                << golden;
            ++numCompared;
        }
    }
    EXPECT_EQ(numCompared, 9);
}

// OpenSubdiv's own table of limit stencils, at the vertices of a mesh with valences 3 to 5.
TEST(LimitMatrix, MeetsOpenSubdivsLimitStencils) {
    Cage const cage = MakeCage("bishop", test::LoadShape("catmark_bishop"));
    Far::PtexIndices const ptex(*cage.refiner);
    auto const level = cage.refiner->GetLevel(0);
    cage.refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(6));
    std::vector<Far::LimitStencilTableFactoryReal<double>::LocationArray> places;
    std::vector<Index> vertices;
    double const s[4] = {0, 1, 1, 0}, t[4] = {0, 0, 1, 1};
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        if (level.GetFaceVertices(face).size() != 4) continue;
        Far::LimitStencilTableFactoryReal<double>::LocationArray place;
        place.ptexIdx = ptex.GetFaceId(face);
        place.numLocations = 4;
        place.s = s;
        place.t = t;
        places.push_back(place);
        for (Index vertex : level.GetFaceVertices(face)) vertices.push_back(vertex);
    }
    std::unique_ptr<Far::LimitStencilTableReal<double> const> const table(
        Far::LimitStencilTableFactoryReal<double>::Create(*cage.refiner, places));
    auto const A = LimitMatrix::Build(*cage.refiner);
    MatrixXd const dense = A.AsMatrix();
    ASSERT_EQ(static_cast<size_t>(table->GetNumStencils()), vertices.size());
    for (Index i = 0; i < table->GetNumStencils(); ++i) {
        auto const stencil = table->GetStencil(i);
        VectorXd row = VectorXd::Zero(dense.cols());
        for (int k = 0; k < stencil.GetSize(); ++k)
            row[stencil.GetVertexIndices()[k]] += stencil.GetWeights()[k];
        ASSERT_LT(test::LargestOf(row.transpose() - dense.row(vertices[static_cast<size_t>(i)])),
                  1e-9);
    }
}

// EDGE_ONLY: the one face's corner moves along the boundary curve; OpenSubdiv's stencils keep it
// sharp at the isolation level, A and its Limit do not.
TEST(LimitMatrix, AnEdgeOnlyCornerFollowsTheBoundaryCurve) {
    engine::Scene scene = test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {{0, 1, 2, 3}});
    scene.cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    Cage const cage = MakeCage("quad", std::move(scene));
    MatrixXd const M = GetPositions(cage.scene),
                   limit = LimitMatrix::Build(*cage.refiner).AsMatrix() * M;
    EXPECT_LT((limit.row(0) - Eigen::RowVector3d(1, 1, 0) / 6.0).norm(), 1e-15);

    constexpr int kIsolation = 6;
    cage.refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(kIsolation));
    double const place = 0.0;
    Far::LimitStencilTableFactoryReal<double>::LocationArray corner;
    corner.ptexIdx = 0;
    corner.numLocations = 1;
    corner.s = corner.t = &place;
    std::unique_ptr<Far::LimitStencilTableReal<double> const> const table(
        Far::LimitStencilTableFactoryReal<double>::Create(*cage.refiner, {corner}));
    Eigen::RowVector3d theirs = Eigen::RowVector3d::Zero();
    auto const stencil = table->GetStencil(0);
    for (int k = 0; k < stencil.GetSize(); ++k)
        theirs += stencil.GetWeights()[k] * M.row(stencil.GetVertexIndices()[k]);
    // A third of what is left of the corner, which each level quarters: in both coordinates half of
    // that.
    double const miss = (limit.row(0) - theirs).norm();
    EXPECT_GT(miss, 0.1 * std::pow(4.0, -kIsolation));
    EXPECT_LT(miss, 0.5 * std::pow(4.0, -kIsolation));
}

TEST(LimitMatrix, RunsInOpenSubdivsEvaluatorAndAsAMatrix) {
    Cage const cage = MakeCage("torus", test::MakeTorus(20, 12));
    auto const A = LimitMatrix::Build(*cage.refiner);
    std::vector<float> const src(cage.scene.positions.begin(), cage.scene.positions.end()),
        weights = A.MakeFloatWeights();
    std::vector<float> dst(src.size());
    OpenSubdiv::Osd::BufferDescriptor const rows(0, 3, 3);
    OpenSubdiv::Osd::CpuEvaluator::EvalStencils(
        src.data(), rows, dst.data(), rows, A.GetSizes().data(), A.GetOffsets().data(),
        A.GetControlIndices().data(), weights.data(), 0, A.GetNumStencils());
    MatrixXd const limit = A.AsMatrix() * GetPositions(cage.scene);
    for (Index i = 0; i < limit.rows(); ++i) {
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(dst[static_cast<size_t>(3 * i + c)], limit(i, c), 1e-6);
    }
}

TEST(LimitMatrix, RefinedLevelsHaveTheirOwn) {
    engine::Scene const scene = test::LoadShape("catmark_cubes_semisharp");
    auto const refiner = test::MakeRefiner(scene, 2);
    // The limit of the refined points is the limit of the cage, at the vertices the cage has
    // already.
    MatrixXd const M = GetPositions(scene);
    MatrixXd const refined = test::ToRows(
        eval::RefineValues<3>(*refiner, 2, eval::RefineValues<3>(*refiner, 1, scene.positions)));
    MatrixXd const coarse = LimitMatrix::Build(*refiner).AsMatrix() * M,
                   fine = LimitMatrix::Build(*refiner, 2).AsMatrix() * refined;
    for (Index vertex = 0; vertex < M.rows(); ++vertex) {
        Index const child = refiner->GetLevel(1).GetVertexChildVertex(
            refiner->GetLevel(0).GetVertexChildVertex(vertex));
        EXPECT_LT((coarse.row(vertex) - fine.row(child)).norm(), 1e-13);
    }
}

TEST(LimitMatrix, AlphaOutOfRangeOrOfAnotherSchemeIsRefused) {
    Cage const cube = MakeCage("cube", test::MakeCube()),
               torus = MakeCage("torus", test::MakeTriangleTorus(5, 5));
    EXPECT_NE(test::RefusalOf([&] { LimitMatrix::Build(*cube.refiner, 0, {.alpha = -0.1}); }), "");
    EXPECT_NE(test::RefusalOf([&] { LimitMatrix::Build(*cube.refiner, 0, {.alpha = NAN}); }), "");
    EXPECT_NE(test::RefusalOf([&] { LimitMatrix::Build(*torus.refiner, 0, {.alpha = 0.5}); }), "");
}

}  // namespace
}  // namespace limn
