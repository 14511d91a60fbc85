// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/widths.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::EdgeWidths;
using engine::FilterWidths;
using engine::Model;
using engine::PaintedWidths;
using engine::ScaledWidths;
using engine::SmoothLevels;
using engine::VertexWidths;

double const kNaN = std::numeric_limits<double>::quiet_NaN();

/// A cube from -1 to 1; vertex 0 and 1 share an edge.
Model MakeCubeModel() {
    return Model::Build(test::MakeCube());
}

/// Widths at the vertices of a level, and where these lie on the start surface.
struct LevelWidths {
    std::vector<double> sigmas, positions;
};

/// The start surface on a level: linear, as the bilinear scheme has it.
LevelWidths Sample(FilterWidths const& widths, Model const& model, int numLevels,
                   double factor = 1.0) {
    SmoothLevels levels(model, numLevels, engine::SmoothRefinement::Quadrisect, false);
    LevelWidths found;
    found.positions = model.GetPositions();
    for (int level = 1; level <= numLevels; ++level) {
        auto const& mesh = levels.MakeNext();
        std::vector<double> fine(3 * static_cast<size_t>(mesh.numVertices), 0.0);
        for (size_t i = 0; i < fine.size(); ++i) {
            int const begin = mesh.parentOffsets[i / 3], end = mesh.parentOffsets[i / 3 + 1];
            for (int k = begin; k < end; ++k)
                fine[i] += found.positions[3 * static_cast<size_t>(mesh.parents[k]) + i % 3] /
                           (end - begin);
        }
        found.positions = std::move(fine);
    }
    found.sigmas = ScaledWidths(widths, factor).SampleLevel(levels, found.positions);
    return found;
}

double DistanceFromSegment(double const* p, double const* a, double const* b) {
    double dot = 0.0, square = 0.0;
    for (int c = 0; c < 3; ++c) {
        dot += (p[c] - a[c]) * (b[c] - a[c]);
        square += (b[c] - a[c]) * (b[c] - a[c]);
    }
    double const t = std::clamp(dot / square, 0.0, 1.0);
    double distance = 0.0;
    for (int c = 0; c < 3; ++c) distance += std::pow(p[c] - a[c] - t * (b[c] - a[c]), 2);
    return std::sqrt(distance);
}

TEST(Widths, AConstantIsGivenAsSuch) {
    FilterWidths const widths = engine::ConstantWidth{0.25};
    ScaledWidths const scaled(widths, 2.0);
    EXPECT_EQ(scaled.GetConstant(), 0.5);
    EXPECT_EQ(scaled.GetLargest(), 0.5);
    EXPECT_TRUE(scaled.GetStart(MakeCubeModel()).empty());
    EXPECT_TRUE(Sample(widths, MakeCubeModel(), 1).sigmas.empty());
}

TEST(Widths, AtVerticesTheyStartAndAreNotSampledAgain) {
    FilterWidths const widths = VertexWidths{{0, 1, 2, 3, 4, 5, 6, 7}};
    ScaledWidths const scaled(widths, 0.5);
    EXPECT_FALSE(scaled.GetConstant());
    EXPECT_EQ(scaled.GetLargest(), 3.5);
    EXPECT_EQ(scaled.GetStart(MakeCubeModel()),
              (std::vector<double>{0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5}));
    EXPECT_TRUE(Sample(widths, MakeCubeModel(), 1).sigmas.empty());
}

// All edges of the cube are 2 long.
TEST(Widths, LocalOnesAreTheMeanEdgeTimesAScale) {
    for (double sigma : engine::MakeLocalWidths(MakeCubeModel(), 0.3).sigmas)
        EXPECT_DOUBLE_EQ(sigma, 0.6);
}

TEST(Widths, OnAnEdgeTheyFallFromOneToThreeWidths) {
    Model const model = MakeCubeModel();
    double const sigma = 0.4;
    FilterWidths const widths = EdgeWidths(model, {{{0, 1}, sigma}});
    EXPECT_EQ(ScaledWidths(widths, 1.0).GetStart(model), std::vector<double>(8, 0.0));
    auto const found = Sample(widths, model, 4);
    int numFull = 0, numBetween = 0, numNone = 0;
    for (size_t i = 0; i < found.sigmas.size(); ++i) {
        double const distance = DistanceFromSegment(
            &found.positions[3 * i], &model.GetPositions()[0], &model.GetPositions()[3]);
        if (distance <= sigma) {
            EXPECT_DOUBLE_EQ(found.sigmas[i], sigma);
            ++numFull;
        } else if (distance >= 3.0 * sigma) {
            EXPECT_EQ(found.sigmas[i], 0.0);
            ++numNone;
        } else {
            EXPECT_GT(found.sigmas[i], 0.0);
            EXPECT_LT(found.sigmas[i], sigma);
            ++numBetween;
        }
    }
    EXPECT_GT(numFull, 0);
    EXPECT_GT(numBetween, 0);
    EXPECT_GT(numNone, 0);
}

// The factor is on the width, not on how far it reaches.
TEST(Widths, AFactorLeavesTheReachAsItIs) {
    Model const model = MakeCubeModel();
    FilterWidths const widths = EdgeWidths(model, {{{0, 1}, 0.4}});
    auto const whole = Sample(widths, model, 3), half = Sample(widths, model, 3, 0.5);
    for (size_t i = 0; i < whole.sigmas.size(); ++i)
        EXPECT_EQ(half.sigmas[i], 0.5 * whole.sigmas[i]);
}

TEST(Widths, AWhiteImageIsTheWidthAndABlackOneNone) {
    Model const torus = Model::Build(test::MakeTorus(8, 6));
    test::TemporaryFolder const folder;
    for (int value : {255, 0}) {
        auto const path = folder.Write("grey.pgm", "P2 1 1 255\n" + std::to_string(value) + "\n");
        FilterWidths const widths = PaintedWidths::Read(path, 0.3, torus);
        EXPECT_EQ(ScaledWidths(widths, 1.0).GetLargest(), value > 0 ? 0.3 : 0.0);
        for (double sigma : Sample(widths, torus, 1).sigmas)
            EXPECT_DOUBLE_EQ(sigma, value > 0 ? 0.3 : 0.0);
    }
}

TEST(Widths, OutsideOfThePaintedTilesThereAreNone) {
    engine::Scene torus = test::MakeTorus(8, 6);
    for (size_t i = 0; i < torus.uvs.size(); i += 2) torus.uvs[i] *= 2.0;  // tiles 1001 and 1002
    Model const model = Model::Build(torus);
    test::TemporaryFolder const folder;
    folder.Write("w.1002.pgm", "P2 1 1 255\n255\n");
    auto const found = Sample(PaintedWidths::Read(folder / "w.<UDIM>.pgm", 0.3, model), model, 1);
    size_t const full =
        static_cast<size_t>(std::count(found.sigmas.begin(), found.sigmas.end(), 0.3));
    size_t const none =
        static_cast<size_t>(std::count(found.sigmas.begin(), found.sigmas.end(), 0.0));
    EXPECT_GT(full, found.sigmas.size() / 3);
    EXPECT_GT(none, found.sigmas.size() / 3);
    EXPECT_EQ(test::CodeOf([&] { PaintedWidths::Read(folder / "x.<UDIM>.pgm", 0.3, model); }),
              ErrorCode::Io);
}

TEST(Widths, PaintNeedsTextureCoordinates) {
    engine::Scene scene = test::MakeCube();
    scene.uvs.clear();
    scene.cage.fvarChannels.clear();
    EXPECT_NE(test::RefusalOf([&] {
                  PaintedWidths::Read("x.png", 1.0, Model::Build(scene));
              }).find("no texture coordinates"),
              std::string::npos);
}

TEST(Widths, ATableNamesItsVertices) {
    test::TemporaryFolder const folder;
    auto const read = [&](std::string const& rows) {
        return engine::ReadVertexWidths(folder.Write("w.csv", "vertex,width\n" + rows),
                                        MakeCubeModel());
    };
    EXPECT_EQ(read("7,0.5\n0,0.25\n").sigmas, (std::vector<double>{0.25, 0, 0, 0, 0, 0, 0, 0.5}));
    EXPECT_NE(test::RefusalOf([&] { read("1,1\n1,2\n"); }).find("w.csv:3: vertex 1 comes twice"),
              std::string::npos);
    EXPECT_NE(test::RefusalOf([&] { read("1,-1\n"); }).find("w.csv:2: width -1 is negative"),
              std::string::npos);
    EXPECT_EQ(test::CodeOf([&] { read("8,1\n"); }), ErrorCode::BadMesh);
}

TEST(Widths, EdgesMustBeThereAndHaveAWidth) {
    Model const model = MakeCubeModel();
    auto const refusal = [&](EdgeWidths::Edge const& edge) {
        return test::RefusalOf([&] { EdgeWidths(model, {edge}); });
    };
    EXPECT_EQ(refusal({{0, 1}, 0.1}), "");
    for (auto const& ends : {std::array<Index, 2>{0, 7}, {0, 0}, {-1, 0}, {0, 8}})
        EXPECT_NE(refusal({ends, 0.1}).find("no such edge"), std::string::npos);
    for (double sigma : {-0.1, kNaN, std::numeric_limits<double>::infinity()})
        EXPECT_NE(refusal({{0, 1}, sigma}).find("from 0 up"), std::string::npos) << sigma;
}

TEST(Widths, WhatIsNoWidthIsRefused) {
    Model const model = MakeCubeModel();
    auto const code = [&](FilterWidths const& widths) {
        return test::CodeOf([&] { engine::CheckWidths(widths, model); });
    };
    EXPECT_FALSE(code(engine::ConstantWidth{0.0}));
    EXPECT_FALSE(code(VertexWidths{std::vector<double>(8, 1.0)}));
    EXPECT_EQ(code(engine::ConstantWidth{-1.0}), ErrorCode::BadOption);
    EXPECT_EQ(code(engine::ConstantWidth{kNaN}), ErrorCode::BadOption);
    EXPECT_EQ(code(VertexWidths{{1.0, 2.0}}), ErrorCode::BadOption);
    EXPECT_NE(test::RefusalOf([&] {
                  engine::CheckWidths(VertexWidths{{0, 0, 0, kNaN, 0, 0, 0, 0}}, model);
              }).find("vertex 3"),
              std::string::npos);
}

}  // namespace
}  // namespace limn
