// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/uv_info.h"

#include <array>

#include <gtest/gtest.h>

#include "support/mesh_info.h"
#include "support/meshes.h"
#include "support/readers.h"

namespace limn {
namespace {

using engine::MeshInfo;
using engine::Scene;
using test::Describe;

/// A row of separate quads, each with the four texture coordinates given.
Scene MakeQuads(std::vector<std::array<double, 8>> const& uvs) {
    std::vector<double> positions;
    std::vector<std::vector<Index>> faces;
    far_ext::FVarChannel channel;
    Scene scene;
    for (size_t i = 0; i < uvs.size(); ++i) {
        double const x = 2.0 * static_cast<double>(i);
        Index const first = static_cast<Index>(4 * i);
        positions.insert(positions.end(), {x, 0, 0, x + 1, 0, 0, x + 1, 1, 0, x, 1, 0});
        faces.push_back({first, first + 1, first + 2, first + 3});
        channel.valueIndices.insert(channel.valueIndices.end(),
                                    {first, first + 1, first + 2, first + 3});
        channel.numValues += 4;
    }
    scene = test::MakeScene(std::move(positions), faces);
    for (auto const& quad : uvs) scene.uvs.insert(scene.uvs.end(), quad.begin(), quad.end());
    scene.cage.fvarChannels.push_back(std::move(channel));
    return scene;
}

std::array<double, 8> Square(double u, double v, double size) {
    return {u, v, u + size, v, u + size, v + size, u, v + size};
}

TEST(UVInfo, TilesAreNumberedByTensInV) {
    // 1001 + floor(u) + 10 floor(v)
    auto const uv = Describe(MakeQuads({Square(0, 0, 1), Square(9, 0, 1), Square(0, 1, 1),
                                        Square(2.25, 3.25, 0.5)}))
                        .uv;
    EXPECT_EQ(uv.tiles, (std::vector<int>{1001, 1010, 1011, 1033}));
    EXPECT_EQ(uv.outOfRangeFaces, 0u);
}

TEST(UVInfo, FacesOutsideTheUdimRangeAreCounted) {
    auto const uv = Describe(MakeQuads({Square(0, 0, 1), Square(10.5, 0, 0.5),
                                        Square(-0.5, 0, 0.25), Square(0, -2, 1)}))
                        .uv;
    EXPECT_EQ(uv.outOfRangeFaces, 3u);
    EXPECT_EQ(uv.tiles, (std::vector<int>{1001}));
}

TEST(UVInfo, FlippedAndFlatFacesAreCountedApart) {
    auto const uv = Describe(MakeQuads({Square(0, 0, 0.25),
                                        {0.5, 0, 0.5, 0.25, 0.75, 0.25, 0.75, 0},
                                        {0.5, 0.5, 0.6, 0.6, 0.7, 0.7, 0.8, 0.8}}))
                        .uv;
    EXPECT_EQ(uv.flippedFaces, 1u);
    EXPECT_EQ(uv.zeroAreaFaces, 1u);
}

TEST(UVInfo, FacesThatShareTextureSpaceOverlap) {
    // The second lies half on the first, the third beside both.
    auto const uv =
        Describe(MakeQuads({Square(0, 0, 0.25), Square(0.125, 0, 0.25), Square(0.5, 0.5, 0.25)}))
            .uv;
    EXPECT_EQ(uv.overlapFaces, 2u);
}

TEST(UVInfo, FacesThatShareAnEdgeDoNotOverlap) {
    // Axis-parallel edges, on and off the lines of a 512 grid.
    EXPECT_EQ(
        Describe(MakeQuads({Square(0, 0, 0.25), Square(0.25, 0, 0.25), Square(0, 0.25, 0.25)}))
            .uv.overlapFaces,
        0u);
    EXPECT_EQ(Describe(MakeQuads({Square(0, 0, 0.3), Square(0.3, 0, 0.3), Square(0, 0.3, 0.3)}))
                  .uv.overlapFaces,
              0u);
    // Edges at 45 degrees: a chequered square on its corner.
    auto const diamond = [](double u, double v, double r) {
        return std::array<double, 8>{u, v - r, u + r, v, u, v + r, u - r, v};
    };
    EXPECT_EQ(Describe(MakeQuads({diamond(0.25, 0.25, 0.125), diamond(0.375, 0.375, 0.125),
                                  diamond(0.375, 0.125, 0.125)}))
                  .uv.overlapFaces,
              0u);
}

TEST(UVInfo, ShapesWithoutOverlapInTheTableHaveNone) {
    for (char const* name :
         {"bilinear_cube", "catmark_cube", "catmark_dart_edgecorner", "catmark_torus", "loop_cube",
          "loop_tetrahedron", "loop_cubes_semisharp", "catmark_pyramid"}) {
        EXPECT_EQ(Describe(test::LoadShape(name)).uv.overlapFaces, 0u) << name;
    }
}

TEST(UVInfo, ShapesOfFullOverlapInTheTableOverlapInEveryFace) {
    for (char const* name : {"catmark_helmet", "catmark_torus_creases0"}) {
        MeshInfo const info = Describe(test::LoadShape(name));
        EXPECT_EQ(info.uv.overlapFaces, static_cast<size_t>(info.faces)) << name;
    }
}

TEST(UVInfo, TextureThatRepeatsOftenTakesNoMemory) {
    // Repeating textures have coordinates far beyond 1: here 24 x 24 tiles under one face.
    size_t const before = test::PeakMemory();
    auto const uv = Describe(MakeQuads({Square(0, 0, 24)})).uv;
    EXPECT_LT(test::PeakMemory() - before, test::kModestMemory);
    EXPECT_EQ(uv.outOfRangeFaces, 1u);
}

}  // namespace
}  // namespace limn
