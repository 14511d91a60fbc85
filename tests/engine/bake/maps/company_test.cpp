// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include <gtest/gtest.h>

#include "engine/bake/bake.h"
#include "support/map_options.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::BakedImage;

std::vector<BakedImage> BakeMaps(engine::Model const& model, engine::BakeOptions options,
                                 std::vector<std::string> maps) {
    options.maps = std::move(maps);
    engine::Job job;
    return engine::BakeToMemory(model, options, job).images;
}

bool AreSameBits(std::vector<float> const& a, std::vector<float> const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// What is baked beside a map must not change it: each alone, all at once, and each beside each of
/// the two that ask least and most of the surface.
void ExpectSameInCompany(engine::Scene scene) {
    auto const model = test::AddColours(std::move(scene));
    auto options = test::OptionsForAllMaps(model);
    options.width = options.height = 96;
    auto const all = BakeMaps(model, options, options.maps);
    ASSERT_EQ(all.size(), options.maps.size());
    for (size_t m = 0; m < all.size(); ++m) {
        SCOPED_TRACE(options.maps[m]);
        auto const alone = BakeMaps(model, options, {options.maps[m]});
        ASSERT_EQ(alone.size(), 1u);
        EXPECT_EQ(all[m].channels, alone[0].channels);
        EXPECT_TRUE(AreSameBits(all[m].texels, alone[0].texels));
        EXPECT_TRUE(AreSameBits(all[m].coverage, alone[0].coverage));
        for (char const* other : {"position", "stretch"}) {
            if (options.maps[m] == other) continue;
            auto const pair = BakeMaps(model, options, {other, options.maps[m]});
            EXPECT_TRUE(AreSameBits(pair[1].texels, alone[0].texels)) << "beside " << other;
        }
    }
}

TEST(MapsInCompany, AreTheSameOnQuads) {
    ExpectSameInCompany(test::LoadSpot());
}

TEST(MapsInCompany, AreTheSameOnTriangles) {
    engine::Scene triangles = test::MakeTriangleTorus(10, 6);
    triangles.cage.fvarChannels.assign(
        1, {static_cast<Index>(triangles.positions.size() / 3), triangles.cage.faceVertices});
    triangles.uvs.clear();
    for (size_t v = 0; v < triangles.positions.size(); v += 3) {  // seen from above
        for (size_t c = 0; c < 2; ++c) {
            triangles.uvs.push_back(0.5 + 0.15 * triangles.positions[v + c]);
        }
    }
    ExpectSameInCompany(std::move(triangles));
}

/// Two quads folded flat onto a line: no texel of one has a tangent plane.
TEST(MapsInCompany, AreTheSameWithoutATangentPlane) {
    engine::Scene sheet = test::MakeScene({0, 0, 0, 1, 0, 0, 2, 0, 0,  //
                                           0, 1, 0, 1, 0, 0, 2, 1, 1,  //
                                           0, 2, 0, 1, 2, 0, 2, 2, 0},
                                          {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}});
    sheet.cage.fvarChannels.assign(1, {9, sheet.cage.faceVertices});
    sheet.uvs = {0, 0, 0.5, 0, 1, 0, 0, 0.5, 0.5, 0.5, 1, 0.5, 0, 1, 0.5, 1, 1, 1};
    sheet.cage.creaseVertexPairs = {1, 4, 4, 7};
    sheet.cage.creaseSharpness = {10.0f, 10.0f};
    ExpectSameInCompany(std::move(sheet));
}

}  // namespace
}  // namespace limn
