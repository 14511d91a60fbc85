// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/raster/uv_raster.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "far_ext/topology/refiner.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::TexelStrip;
using engine::TileGrid;
using engine::UVRaster;

/// A plane of n x n quads whose UVs are its own x and y, scaled to [low, high].
engine::Scene MakePlane(int n, double low, double high) {
    std::vector<double> positions, uvs;
    std::vector<std::vector<Index>> faces;
    std::vector<Index> values;
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            positions.insert(positions.end(),
                             {static_cast<double>(i), static_cast<double>(j), 0.0});
            uvs.insert(uvs.end(), {low + (high - low) * i / n, low + (high - low) * j / n});
        }
    }
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            Index const v = j * (n + 1) + i;
            faces.push_back({v, v + 1, v + n + 2, v + n + 1});
            values.insert(values.end(), faces.back().begin(), faces.back().end());
        }
    }
    engine::Scene scene = test::MakeScene(std::move(positions), faces);
    scene.cage.fvarChannels.push_back({static_cast<Index>(uvs.size() / 2), std::move(values)});
    scene.uvs = std::move(uvs);
    return scene;
}

struct Covering {
    TexelStrip strip;
    size_t numHits = 0, numExact = 0;
};

/// Rasterises all faces; checks that every hit maps to its texel's centre and is within its domain.
/// \param numClamped  how many hits may lie at a piece's edge rather than at their texel's centre;
///                    -1: one in twenty
Covering CoverAndCheck(engine::Scene const& scene, int size, int tile = 1001, int numClamped = -1) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    eval::LimitSurface const surface(*refiner, 0);
    UVRaster raster(surface, scene.uvs);
    TileGrid grid;
    grid.width = grid.height = size;
    grid.tileU = (tile - 1001) % 10;
    grid.tileV = (tile - 1001) / 10;
    Covering result;
    result.strip.Reset(0, size, size);
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (!surface.HasLimit(face)) continue;
        auto const hits = raster.Rasterise(face, grid, result.strip);
        for (int domain = 0; domain < surface.GetNumDomains(face); ++domain) {
            for (size_t i = 0; i < hits[domain].texel.size(); ++i) {
                double const s = hits[domain].s[i], t = hits[domain].t[i];
                auto const [u, v] = raster.Evaluate(domain, s, t);
                double const dx = grid.ToX(u) - hits[domain].texel[i] % size;
                double const dy = grid.ToY(v) - hits[domain].texel[i] / size;
                EXPECT_LT(std::hypot(dx, dy), 1.01e-4) << "face " << face;
                result.numExact += std::hypot(dx, dy) < 1.01 * eval::kInversionEnd;
                EXPECT_TRUE(s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0);
                EXPECT_EQ(result.strip.owner[hits[domain].texel[i]], face);
                ++result.numHits;
            }
        }
    }
    // Newton's method ends within kInversionEnd; only at the edge of a piece a place may be
    // clamped.
    EXPECT_GE(
        result.numExact + (numClamped < 0 ? result.numHits / 20 : static_cast<size_t>(numClamped)),
        result.numHits);
    return result;
}

size_t Count(std::vector<uint8_t> const& flags) {
    return static_cast<size_t>(std::count(flags.begin(), flags.end(), 1));
}

// The whole square is covered: size^2 texels, each once.
TEST(UVRaster, APlaneOverTheTileCoversEveryTexelOnce) {
    for (int n : {1, 3, 7}) {
        auto const covering = CoverAndCheck(MakePlane(n, 0.0, 1.0), 64);
        EXPECT_EQ(covering.numHits, 64u * 64u) << n;
        EXPECT_EQ(Count(covering.strip.overlap), 0u);
        EXPECT_EQ(Count(covering.strip.failed), 0u);
    }
}

// Texel centres at (x + 1/2)/64: those in [0.25, 0.75] are x = 16 .. 47, 32 x 32 of them.
TEST(UVRaster, APlaneOverHalfTheTileCoversItsTexels) {
    EXPECT_EQ(CoverAndCheck(MakePlane(2, 0.25, 0.75), 64).numHits, 32u * 32u);
}

// Edges through texel centres (0.5/8 + k/8): the border's texels count as covered.
TEST(UVRaster, ABorderThroughTexelCentresCounts) {
    EXPECT_EQ(CoverAndCheck(MakePlane(2, 2.5 / 8, 5.5 / 8), 8).numHits, 16u);
}

// A texel is covered up to 1e-4 of a texel beside the face: a border half as far inside of the
// centres keeps them (12 of the 16 are at the border), one twice as far loses them.
TEST(UVRaster, ABorderCountsWithinATenThousandthOfATexel) {
    auto const plane = [](double inset) {
        return MakePlane(2, (2.5 + inset) / 8, (5.5 - inset) / 8);
    };
    EXPECT_EQ(CoverAndCheck(plane(5e-5), 8, 1001, 12).numHits, 16u);
    EXPECT_EQ(CoverAndCheck(plane(2e-4), 8).numHits, 4u);
}

TEST(UVRaster, TheLowestFaceWinsWhereFacesOverlap) {
    engine::Scene scene = MakePlane(1, 0.0, 1.0);
    engine::Scene const second = MakePlane(1, 0.25, 0.75);
    for (double x : second.positions) scene.positions.push_back(x + 10.0);
    scene.cage.faceSizes.push_back(4);
    for (Index v : {4, 5, 7, 6}) scene.cage.faceVertices.push_back(v);
    scene.cage.numVertices = 8;
    scene.uvs.insert(scene.uvs.end(), second.uvs.begin(), second.uvs.end());
    scene.cage.fvarChannels[0].numValues = 8;
    for (Index v : {4, 5, 7, 6}) scene.cage.fvarChannels[0].valueIndices.push_back(v);
    auto const covering = CoverAndCheck(scene, 32);
    EXPECT_EQ(covering.numHits, 32u * 32u);  // all of face 0, nothing of face 1
    EXPECT_EQ(Count(covering.strip.overlap), 16u * 16u);
}

/// Sheets of n x n quads one over another in texture space, from low to high each.
engine::Scene MakePile(std::vector<std::pair<double, double>> const& sheets, int n) {
    engine::Scene pile;
    for (auto const& [low, high] : sheets) {
        engine::Scene const sheet = MakePlane(n, low, high);
        Index const first = pile.cage.numVertices;
        for (double x : sheet.positions) pile.positions.push_back(x + 100.0 * first);
        pile.uvs.insert(pile.uvs.end(), sheet.uvs.begin(), sheet.uvs.end());
        pile.cage.numVertices += sheet.cage.numVertices;
        for (Index size : sheet.cage.faceSizes) pile.cage.faceSizes.push_back(size);
        for (Index vertex : sheet.cage.faceVertices)
            pile.cage.faceVertices.push_back(vertex + first);
    }
    pile.cage.fvarChannels.push_back({pile.cage.numVertices, pile.cage.faceVertices});
    return pile;
}

/// How many texels have so many faces over their centre.
std::map<int, int> CountFaces(engine::Scene const& scene, int size) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    eval::LimitSurface const surface(*refiner, 0);
    UVRaster raster(surface, scene.uvs);
    TexelStrip strip;
    strip.countsFaces = true;
    strip.Reset(0, size, size);
    TileGrid const grid = TileGrid::OfTile(1001, size, size);
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (surface.HasLimit(face)) raster.Rasterise(face, grid, strip);
    }
    std::map<int, int> texels;
    for (size_t texel = 0; texel < strip.owner.size(); ++texel) ++texels[strip.CountFaces(texel)];
    return texels;
}

// Of 64 x 64 texels, 32 x 32 lie under the half sheet, too.
TEST(UVRaster, CountsEveryFaceOverATexel) {
    EXPECT_EQ(CountFaces(MakePile({{0, 1}, {0, 1}, {0.25, 0.75}}, 5), 64),
              (std::map<int, int>{{2, 64 * 64 - 32 * 32}, {3, 32 * 32}}));
}

// With edges through texel centres (0.5/8 + k/8) each sheet still counts once, be it on one side of
// an edge or at a vertex, in whatever order the sheets come.
TEST(UVRaster, CountsASheetOnceAlongItsEdges) {
    double const low = 2.5 / 8, high = 6.5 / 8;
    EXPECT_EQ(CountFaces(MakePile({{low, high}}, 4), 8), (std::map<int, int>{{0, 39}, {1, 25}}));
    for (auto const& sheets :
         {std::vector{std::pair{0.0, 1.0}, {low, high}}, {{low, high}, {0.0, 1.0}}}) {
        auto const texels = CountFaces(MakePile(sheets, 4), 8);
        // Of the 25 texels 9 lie within the small sheet, the others on its border: they count as
        // half in, half out, all on the same two sides.
        EXPECT_EQ(texels, (std::map<int, int>{{1, 48}, {2, 16}}));
    }
}

TEST(UVRaster, CountsOneFaceEverywhereOnASoundLayout) {
    for (engine::Scene const& scene : {test::LoadShape("catmark_fvar_bound0"), test::LoadSpot()}) {
        auto texels = CountFaces(scene, 301);
        EXPECT_GT(texels[1], 10000);
        texels.erase(0);
        EXPECT_EQ(texels.size(), 1u);
    }
}

// What is known of overlaps without counting: each texel with the lowest two faces.
TEST(UVRaster, NamesTheLowestTwoFacesOfAnOverlap) {
    auto const covering = CoverAndCheck(MakePile({{0, 1}, {0, 1}, {0, 1}}, 1), 16);
    ASSERT_EQ(covering.strip.overlaps.size(), 256u);
    for (auto const& [texel, other] : covering.strip.overlaps) {
        EXPECT_EQ(covering.strip.owner[static_cast<size_t>(texel)], 0);
        EXPECT_EQ(other, 1);
    }
    EXPECT_NEAR(covering.strip.deepestOverlap, 7.5, 1e-6);  // to the border of 16 texels
}

// Faces of a tenth of a texel, any of which has a centre near its edge now and then.
TEST(UVRaster, NeighboursAreNoOverlapHoweverSmall) {
    auto const covering = CoverAndCheck(MakePlane(96, 0.0, 1.0), 9);
    EXPECT_EQ(covering.numHits, 81u);
    EXPECT_TRUE(covering.strip.overlaps.empty());
}

class UVRasterOnMesh : public testing::TestWithParam<char const*> {};

// Curved charts, seams, extraordinary texture vertices: hits are exact, and supply both sides of
// every inner edge, so that no texel within a chart stays empty. Coverage by a finer dicing would
// be the same.
TEST_P(UVRasterOnMesh, HitsMapToTexelCentres) {
    auto const scene = test::LoadShape(GetParam());
    ASSERT_TRUE(scene.HasUVs());
    auto const covering = CoverAndCheck(scene, 96);
    EXPECT_GT(covering.numHits, 0u);
    EXPECT_EQ(Count(covering.strip.failed), 0u);
}

INSTANTIATE_TEST_SUITE_P(Cages, UVRasterOnMesh,
                         testing::Values("catmark_fvar_bound0", "catmark_fvar_bound2",
                                         "catmark_helmet", "catmark_nonquads",
                                         "catmark_torus_creases0", "catmark_car"),
                         [](auto const& mesh) { return std::string(mesh.param); });

TEST(UVRaster, EveryFaceVaryingRuleIsInverted) {
    for (auto rule :
         {Sdc::Options::FVAR_LINEAR_NONE, Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
          Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2,
          Sdc::Options::FVAR_LINEAR_BOUNDARIES, Sdc::Options::FVAR_LINEAR_ALL}) {
        engine::Scene scene = test::LoadShape("catmark_fvar_bound0");
        scene.cage.options.SetFVarLinearInterpolation(rule);
        EXPECT_GT(CoverAndCheck(scene, 48).numHits, 100u) << static_cast<int>(rule);
    }
}

// Spot's chart interiors have no gaps: a covered texel's four neighbours are covered unless the
// chart ends there, which shows as an uncovered run at least two texels long in that direction.
TEST(UVRaster, ChartsOfARealAssetHaveNoPinholes) {
    auto const covering = CoverAndCheck(test::LoadSpot(), 256);
    auto const isCovered = [&](int x, int y) {
        return covering.strip.owner[static_cast<size_t>(y * 256 + x)] >= 0;
    };
    size_t pinholes = 0;
    for (int y = 1; y < 255; ++y) {
        for (int x = 1; x < 255; ++x) {
            pinholes += !isCovered(x, y) && isCovered(x - 1, y) && isCovered(x + 1, y) &&
                        isCovered(x, y - 1) && isCovered(x, y + 1);
        }
    }
    EXPECT_EQ(pinholes, 0u);
    EXPECT_GT(covering.numHits, 256u * 256u / 4);
}

// The square's UVs scaled by zero in one direction: no area, no texel, no endless search.
TEST(UVRaster, CollapsedTextureCoordinatesCoverNothing) {
    engine::Scene scene = MakePlane(2, 0.1, 0.9);
    for (size_t i = 1; i < scene.uvs.size(); i += 2) scene.uvs[i] = 0.5;
    auto const covering = CoverAndCheck(scene, 32);
    EXPECT_EQ(covering.numHits, 0u);
    EXPECT_EQ(Count(covering.strip.failed), 0u);
}

// With linear boundaries a face is irregular all along its edges, however deep one looks; in one
// point, a texel's centre, no piece of it could be left out.
TEST(UVRaster, AFaceThatIsATexelsCentreIsNoEndlessSearch) {
    engine::Scene scene = MakePlane(2, 0.1, 0.9);
    scene.cage.options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_BOUNDARIES);
    std::ranges::fill(scene.uvs, 0.5);
    EXPECT_EQ(CoverAndCheck(scene, 33).numHits, 0u);
}

// Half of the pieces of such a face have a corner twice again, down to any depth.
TEST(UVRaster, AFaceWithOneCornerTwiceIsNoEndlessSearch) {
    engine::Scene scene = test::MakeScene({0, 0, 0, 1, 0, 0}, {{1, 0, 0}}, Sdc::SCHEME_LOOP);
    scene.cage.fvarChannels.push_back({2, {0, 1, 1}});
    scene.uvs = {0.5, 0.5, 0.2890625, 0.734375};
    for (int size : {15, 16, 64}) CoverAndCheck(scene, size);
}

}  // namespace
}  // namespace limn
