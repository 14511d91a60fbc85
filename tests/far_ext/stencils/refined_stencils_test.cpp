// SPDX-License-Identifier: Apache-2.0
#include "far_ext/stencils/refined_stencils.h"

#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "far_ext/error.h"
#include "far_ext/topology/refiner.h"
#include "support/chaikin_meshes.h"
#include "support/meshes.h"
#include "support/stencils.h"

namespace limn::far_ext {
namespace {

using Mode = RefinedStencilOptions::Mode;
using test::RefineUniformly;

/// Every weight is Far's in double, rounded to float; where limn takes Far's table in float, to its
/// bound.
void ExpectFarsWeights(Far::TopologyRefiner const& refiner, Mode mode, std::string const& name,
                       double bound = 1.2e-7) {
    auto const theirs = test::MakeFarTable<double>(refiner, static_cast<int>(mode));
    StencilRows const ours = BuildRefinedStencils(refiner, {mode, 0}).Expand();
    ASSERT_EQ(ours.GetNumStencils(), theirs->GetNumStencils()) << name;
    ASSERT_EQ(ours.GetNumControlVertices(), theirs->GetNumControlVertices()) << name;
    double worst = 0.0;
    Index worstRow = -1;
    std::map<Index, double> row;
    for (Index i = 0; i < ours.GetNumStencils(); ++i) {
        row.clear();
        for (Index k = ours.GetOffsets()[i]; k < ours.GetOffsets()[i] + ours.GetSizes()[i]; ++k) {
            row[ours.GetControlIndices()[k]] += ours.GetWeights()[k];
        }
        auto const stencil = theirs->GetStencil(i);
        for (int k = 0; k < stencil.GetSize(); ++k)
            row[stencil.GetVertexIndices()[k]] -= stencil.GetWeights()[k];
        for (auto const& [control, difference] : row) {
            if (std::abs(difference) > worst) {
                worst = std::abs(difference);
                worstRow = i;
            }
        }
    }
    EXPECT_LT(worst, bound) << name << ", row " << worstRow;
}

TEST(RefinedStencils, VertexWeightsAreFarsOnEveryCage) {
    for (std::string const& shape : test::ListShapes()) {
        auto const scene = test::LoadShape(shape);
        for (int level = 1; level <= 4; ++level) {
            if (scene.cage.GetNumFaces() << (2 * level) > 300000)
                break;  // the rest: simd_evaluator_test
            ExpectFarsWeights(*RefineUniformly(scene.cage, level), Mode::Vertex,
                              fmt::format("{} level {}", shape, level));
        }
    }
}

TEST(RefinedStencils, VaryingWeightsAreFarsOnEveryCage) {
    for (std::string const& shape : test::ListShapes()) {
        auto const scene = test::LoadShape(shape);
        for (int level = 1; level <= 3; ++level) {
            if (scene.cage.GetNumFaces() << (2 * level) > 20000) break;
            ExpectFarsWeights(*RefineUniformly(scene.cage, level), Mode::Varying,
                              fmt::format("{} level {}", shape, level));
        }
    }
}

TEST(RefinedStencils, FaceVaryingWeightsAreFarsOnEveryCageAndRule) {
    for (std::string const& shape : test::ListShapes()) {
        auto scene = test::LoadShape(shape);
        if (scene.cage.fvarChannels.empty()) continue;
        for (int rule = 0; rule <= Sdc::Options::FVAR_LINEAR_ALL; ++rule) {
            scene.cage.options.SetFVarLinearInterpolation(
                static_cast<Sdc::Options::FVarLinearInterpolation>(rule));
            for (int level = 1; level <= 3; ++level) {
                if (scene.cage.GetNumFaces() << (2 * level) > 20000) break;
                ExpectFarsWeights(*RefineUniformly(scene.cage, level), Mode::FaceVarying,
                                  fmt::format("{} level {} rule {}", shape, level, rule));
            }
        }
    }
}

/// A chart cut from its boundary to its middle: the values end in one that meets itself there.
TEST(RefinedStencils, FaceVaryingWeightsAreFarsWhereACutEnds) {
    constexpr int kSize = 6, kCut = 3;
    std::vector<double> positions;
    std::vector<std::vector<Index>> faces;
    FVarChannel channel{(kSize + 1) * (kSize + 1) + kCut, {}};
    for (int j = 0; j <= kSize; ++j) {
        for (int i = 0; i <= kSize; ++i) positions.insert(positions.end(), {1.0 * i, 1.0 * j, 0.0});
    }
    for (int j = 0; j < kSize; ++j) {
        for (int i = 0; i < kSize; ++i) {
            int const corner = j * (kSize + 1) + i;
            faces.push_back({corner, corner + 1, corner + kSize + 2, corner + kSize + 1});
            for (int vertex : faces.back()) {
                int const x = vertex % (kSize + 1), y = vertex / (kSize + 1);
                bool const isOtherSide = y == kCut && x < kCut && j >= kCut;
                channel.valueIndices.push_back(isOtherSide ? (kSize + 1) * (kSize + 1) + x
                                                           : vertex);
            }
        }
    }
    auto scene = test::MakeScene(positions, faces);
    scene.cage.fvarChannels.push_back(channel);
    for (int rule = 0; rule <= Sdc::Options::FVAR_LINEAR_ALL; ++rule) {
        scene.cage.options.SetFVarLinearInterpolation(
            static_cast<Sdc::Options::FVarLinearInterpolation>(rule));
        ExpectFarsWeights(*RefineUniformly(scene.cage, 3), Mode::FaceVarying,
                          fmt::format("rule {}", rule));
    }
}

TEST(RefinedStencils, BoundaryRulesAreFars) {
    auto scene = test::LoadShape("catmark_edgeonly");
    for (auto rule : {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY,
                      Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
        scene.cage.options.SetVtxBoundaryInterpolation(rule);
        ExpectFarsWeights(*RefineUniformly(scene.cage, 3), Mode::Vertex,
                          fmt::format("boundary rule {}", static_cast<int>(rule)));
    }
}

TEST(RefinedStencils, WeightsAreFarsWhereNoTwoFacesAreAlike) {
    auto scene = test::MakeTorus(40, 40);
    for (Index v = 0; v + 1 < scene.cage.numVertices; ++v) {
        if (v % 40 == 39) continue;
        scene.cage.creaseVertexPairs.insert(scene.cage.creaseVertexPairs.end(), {v, v + 1});
        scene.cage.creaseSharpness.push_back(0.001f * static_cast<float>(v + 1));
    }
    ExpectFarsWeights(*RefineUniformly(scene.cage, 2), Mode::Vertex,
                      "a crease of its own at every face", 1e-6);
}

TEST(RefinedStencils, WeightsAreFarsUnderChaikinsRule) {
    for (auto const& scene : test::MakeChaikinMeshes()) {
        auto const refiner = RefineUniformly(scene.cage, 3);
        ExpectFarsWeights(*refiner, Mode::Vertex, scene.name);
        if (!scene.cage.fvarChannels.empty())
            ExpectFarsWeights(*refiner, Mode::FaceVarying, scene.name);
    }
}

TEST(RefinedStencils, UnusedVerticesStay) {
    auto scene = test::MakeCube();
    scene.cage.numVertices = 10;  // two more that no face uses
    ExpectFarsWeights(*RefineUniformly(scene.cage, 2), Mode::Vertex, "cube and two vertices");
}

TEST(RefinedStencils, RowsSumToOneAndTorusIsSmall) {
    auto const scene = test::MakeTorus(24, 16);
    auto const table = BuildRefinedStencils(*RefineUniformly(scene.cage, 4));
    // 24 * 16 faces, 256 points each; Far's table takes 141 bytes per point.
    EXPECT_EQ(table.numRows, 24 * 16 * 256);
    EXPECT_LE(table.blocks.size(), 16u);
    StencilRows const rows = table.Expand();
    for (Index i = 0; i < rows.GetNumStencils(); i += 37) {
        auto const begin = rows.GetWeights().begin() + rows.GetOffsets()[i];
        EXPECT_NEAR(std::accumulate(begin, begin + rows.GetSizes()[i], 0.0), 1.0, 1e-6);
    }
}

TEST(RefinedStencils, WhatCannotBeBuiltIsRefused) {
    auto const cube = test::MakeCube();
    EXPECT_THROW(BuildRefinedStencils(*CreateRefiner(cube.cage)), Error);
    EXPECT_THROW(BuildRefinedStencils(*RefineUniformly(cube.cage, 2), {Mode::FaceVarying, 0}),
                 Error);
    auto const adaptive = CreateRefiner(cube.cage);
    adaptive->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(2));
    EXPECT_THROW(BuildRefinedStencils(*adaptive), Error);
}

}  // namespace
}  // namespace limn::far_ext
