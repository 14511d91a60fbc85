// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/bake.h"

#include <cmath>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "engine/bake/audit/audit.h"
#include "engine/fit/bands.h"
#include "engine/images/exr_lookup.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::BakeOptions;
using engine::BakeReport;

BakeOptions MakeFileOptions(std::string const& pattern, std::vector<std::string> maps, int size) {
    BakeOptions options;
    options.pattern = pattern;
    options.maps = std::move(maps);
    options.width = options.height = size;
    options.wantsChecksums = true;
    return options;
}

BakeReport RunBake(engine::Scene const& scene, BakeOptions const& options) {
    engine::Job job;
    return engine::Bake(engine::Model::Build(scene), options, job);
}

// The torus's UVs are its parameters, so the texel's surface point is known by evaluating face and
// (s, t) directly: the bake must find the same position, normal and curvature.
TEST(Bake, TexelsHoldTheLimitSurface) {
    test::TemporaryFolder const folder;
    engine::Scene const torus = test::MakeTorus(12, 8);
    auto options = MakeFileOptions(folder / "{map}.exr", {"position", "normal", "curvature"}, 48);
    // Straight texture coordinates, so that u and v are the parameters themselves.
    engine::Scene linear = torus;
    linear.cage.options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_ALL);
    auto const report = RunBake(linear, options);
    EXPECT_EQ(report.texelsCovered, 48u * 48u);
    EXPECT_EQ(report.newtonFailures, 0u);

    auto const refiner = far_ext::CreateRefiner(linear.cage);
    eval::LimitSurface const surface(*refiner);
    eval::FaceTree tree(surface, linear.positions, 3);
    engine::ExrLookup lookup;
    for (int y = 0; y < 48; y += 5) {
        for (int x = 0; x < 48; x += 5) {
            double const u = (x + 0.5) / 48, v = 1.0 - (y + 0.5) / 48;
            int const i = static_cast<int>(u * 12), j = static_cast<int>(v * 8);
            tree.Bind(i * 8 + j);
            auto const expected = eval::EvaluateSample(tree, 0, u * 12 - i, v * 8 - j);
            auto const position = lookup.Look(folder / "position.exr", {"R", "G", "B"}, x, y);
            auto const normal = lookup.Look(folder / "normal.exr", {"R", "G", "B"}, x, y);
            auto const curvature =
                lookup.Look(folder / "curvature.exr", {"k1", "k2", "mean", "gaussian"}, x, y);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(position[static_cast<size_t>(c)], expected.position[c], 1e-6);
                EXPECT_NEAR(normal[static_cast<size_t>(c)], expected.normal[c], 1e-6);
            }
            EXPECT_NEAR(curvature[0], expected.curvature.k1, 2e-5);
            EXPECT_NEAR(curvature[1], expected.curvature.k2, 2e-5);
            EXPECT_NEAR(curvature[2], expected.curvature.mean, 2e-5);
            EXPECT_NEAR(curvature[3], expected.curvature.gaussian, 1e-4);
        }
    }
}

TEST(Bake, FilesDoNotDependOnThreads) {
    engine::Scene const spot = test::LoadSpot();
    std::vector<std::string> sums;
    for (int threads : {1, 3}) {
        test::TemporaryFolder const folder;
        auto options = MakeFileOptions(folder / "{map}.<UDIM>.exr",
                                       {"mean", "normal", "principal-direction", "stretch"}, 200);
        options.isHalf = options.hasMips = options.hasCoverage = true;
        options.samplesPerSide = 2;
        tbb::task_arena arena(threads);
        arena.execute([&] {
            for (auto const& output : RunBake(spot, options).outputs) sums.push_back(output.sha256);
        });
    }
    ASSERT_EQ(sums.size(), 8u);
    for (size_t i = 0; i < 4; ++i) EXPECT_EQ(sums[i], sums[i + 4]);
}

// Meshes from arrays have no file that could tell one from another.
TEST(Bake, SkipsNoFileOfOtherArrays) {
    test::TemporaryFolder const folder;
    auto const model = engine::Model::Build(test::MakeTorus(8, 6));
    std::vector<double> moved = model.GetPositions();
    moved[0] += 0.1;
    auto const other = model.WithPoints(moved);
    auto options =
        MakeFileOptions(folder / "{map}.exr", {"mean", "displacement", "tension", "field"}, 16);
    options.skipsExisting = true;
    options.against = options.rest = model;
    options.field.emplace(static_cast<size_t>(model.GetLevel().GetNumEdges()), 1.0);
    auto const listBaked = [&](engine::Model const& of) {
        engine::Job job;
        std::string baked;
        for (auto const& output : engine::Bake(of, options, job).outputs)
            baked += output.wasSkipped ? "" : output.map + " ";
        return baked;
    };
    EXPECT_EQ(listBaked(model), "mean displacement tension field ");
    EXPECT_EQ(listBaked(model), "");
    EXPECT_EQ(listBaked(other), "mean displacement tension field ");
    options.rest = other;
    EXPECT_EQ(listBaked(other), "tension ");
    options.field->at(0) = 2.0;
    EXPECT_EQ(listBaked(other), "field ");
    options.against = other;
    EXPECT_NE(listBaked(other).find("displacement "), std::string::npos);
    EXPECT_EQ(listBaked(other), "");
}

// Every three of eight vertices make a face: six faces on each edge, more faces than edges at each
// vertex.
TEST(Bake, TakesManyFacesOnAnEdge) {
    std::vector<double> positions, uvs;
    for (int i = 0; i < 8; ++i) {
        positions.insert(positions.end(), {std::cos(i), std::sin(i), 0.1 * i * i});
        uvs.insert(uvs.end(), {0.5 + 0.4 * std::cos(i), 0.5 + 0.4 * std::sin(i)});
    }
    std::vector<std::vector<Index>> faces;
    for (Index a = 0; a < 8; ++a) {
        for (Index b = a + 1; b < 8; ++b) {
            for (Index c = b + 1; c < 8; ++c) faces.push_back({a, b, c});
        }
    }
    for (auto scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP, Sdc::SCHEME_BILINEAR}) {
        test::TemporaryFolder const folder;
        engine::Scene scene = test::MakeScene(positions, faces);
        scene.cage.scheme = scheme;
        scene.cage.fvarChannels.push_back({8, scene.cage.faceVertices});
        scene.uvs = uvs;
        auto const report = RunBake(scene, MakeFileOptions(folder / "a.exr", {"normal"}, 16));
        EXPECT_GT(report.texelsCovered, 40u);
        engine::ExrLookup lookup;
        for (int x = 0; x < 16; ++x) {
            for (double value : lookup.Look(folder / "a.exr", {"R", "G", "B"}, x, 8))
                EXPECT_LE(std::abs(value), 1.0001);
        }
    }
}

// The bands' layers add up to what leads from the smooth base's limit surface to the mesh's: the
// displacement to the base, turned round.
TEST(Bake, BandsAddUpToTheWayFromTheSmoothBase) {
    test::TemporaryFolder const folder;
    engine::Scene const spot = test::LoadSpot();
    engine::Scene base = spot;
    engine::Job job;
    base.positions = engine::SplitIntoBands(engine::Model::Build(spot), 3, {}, job).bands[0];
    for (bool const isVector : {false, true}) {
        auto bands = MakeFileOptions(folder / "bands.exr", {"bands"}, 64);
        bands.bands = 3;
        bands.isVector = isVector;
        RunBake(spot, bands);
        auto way = MakeFileOptions(folder / "way.exr", {"displacement"}, 64);
        way.against = engine::Model::Build(base);
        way.isVector = isVector;
        RunBake(spot, way);
        auto both = MakeFileOptions(folder / "both.{map}.exr", {"bands", "displacement"}, 64);
        both.against = engine::Model::Build(base);
        both.isVector = isVector;
        both.bands = 3;
        RunBake(spot, both);
        engine::ExrLookup lookup;
        std::vector<std::string> const axes =
            isVector ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
        double most = 0.0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                auto const expected = lookup.Look(folder / "way.exr", axes, x, y);
                bool const isSample = (x + y) % 8 == 0;
                if (isSample) {
                    EXPECT_EQ(lookup.Look(folder / "both.displacement.exr", axes, x, y), expected);
                }
                for (size_t c = 0; c < axes.size(); ++c) {
                    std::vector<std::string> layers;
                    for (char const* part : {"band1", "band2", "remainder"})
                        layers.push_back(part + (isVector ? "." + axes[c] : ""));
                    auto const values = lookup.Look(folder / "bands.exr", layers, x, y);
                    if (isSample) {
                        EXPECT_EQ(lookup.Look(folder / "both.bands.exr", layers, x, y), values);
                    }
                    ASSERT_NEAR(values[0] + values[1] + values[2], -expected[c], 1e-6)
                        << x << " " << y;
                    most = std::max(most, std::abs(values[0]));
                }
            }
        }
        EXPECT_GT(most, 1e-3);
    }
}

// Moving the other mesh by d along z makes the displacement d times the normal's z, and the vector
// d z.
TEST(Bake, DisplacementIsTheDifferenceToTheOtherLimit) {
    test::TemporaryFolder const folder;
    engine::Scene const torus = test::MakeTorus(12, 8);
    engine::Scene moved = torus;
    for (size_t i = 2; i < moved.positions.size(); i += 3) moved.positions[i] += 0.25;
    auto options = MakeFileOptions(folder / "{map}.exr", {"displacement", "normal"}, 32);
    options.against = engine::Model::Build(moved);
    RunBake(torus, options);
    auto vectors = MakeFileOptions(folder / "vector.exr", {"displacement"}, 32);
    vectors.against = engine::Model::Build(moved);
    vectors.isVector = true;
    RunBake(torus, vectors);
    engine::ExrLookup lookup;
    for (int x = 1; x < 32; x += 3) {
        double const along = lookup.Look(folder / "displacement.exr", {"Y"}, x, 9)[0];
        double const z = lookup.Look(folder / "normal.exr", {"B"}, x, 9)[0];
        EXPECT_NEAR(along, 0.25 * z, 1e-6);
        auto const vector = lookup.Look(folder / "vector.exr", {"R", "G", "B"}, x, 9);
        EXPECT_NEAR(vector[0], 0.0, 1e-6);
        EXPECT_NEAR(vector[1], 0.0, 1e-6);
        EXPECT_NEAR(vector[2], 0.25, 1e-6);
    }
}

// A tangent-space vector has the same length, and its last component is the displacement along the
// normal.
TEST(Bake, TangentSpaceKeepsLengthAndNormalPart) {
    test::TemporaryFolder const folder;
    engine::Scene const torus = test::MakeTorus(12, 8);
    engine::Scene moved = torus;
    for (size_t i = 0; i < moved.positions.size(); ++i)
        moved.positions[i] += i % 3 == 0 ? 0.2 : 0.1;
    auto options = MakeFileOptions(folder / "v.exr", {"displacement"}, 32);
    options.against = engine::Model::Build(moved);
    options.isVector = true;
    options.space = engine::VectorSpace::Tangent;
    RunBake(torus, options);
    auto scalar = MakeFileOptions(folder / "s.exr", {"displacement"}, 32);
    scalar.against = engine::Model::Build(moved);
    RunBake(torus, scalar);
    engine::ExrLookup lookup;
    for (int x = 1; x < 32; x += 3) {
        auto const v = lookup.Look(folder / "v.exr", {"R", "G", "B"}, x, 20);
        EXPECT_NEAR(std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]),
                    std::sqrt(0.2 * 0.2 + 2 * 0.1 * 0.1), 1e-5);
        EXPECT_NEAR(v[2], lookup.Look(folder / "s.exr", {"Y"}, x, 20)[0], 1e-5);
    }
}

TEST(Bake, PrimvarsAreSubdividedLikePositions) {
    test::TemporaryFolder const folder;
    engine::Scene torus = test::MakeTorus(12, 8);
    torus.primvars.push_back({"color", 4, {}});
    torus.primvars.push_back({"height", 1, {}});
    for (size_t v = 0; v < torus.positions.size(); v += 3) {
        for (size_t c = 0; c < 3; ++c)
            torus.primvars[0].values.push_back(static_cast<float>(torus.positions[v + c]));
        torus.primvars[0].values.push_back(1.0f);
        torus.primvars[1].values.push_back(static_cast<float>(torus.positions[v + 2]));
    }
    RunBake(torus, MakeFileOptions(folder / "{map}.exr",
                                   {"position", "primvar:color", "primvar:height"}, 32));
    engine::ExrLookup lookup;
    for (int x = 0; x < 32; x += 3) {
        auto const position = lookup.Look(folder / "position.exr", {"R", "G", "B"}, x, 11);
        auto const color = lookup.Look(folder / "primvar_color.exr", {"R", "G", "B", "A"}, x, 11);
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(color[c], position[c], 1e-6);
        EXPECT_NEAR(color[3], 1.0, 1e-6);
        EXPECT_NEAR(lookup.Look(folder / "primvar_height.exr", {"Y"}, x, 11)[0], position[2], 1e-6);
    }
}

// log2 of area ratio over its mean: 0 where the layout is even, and the texture-weighted mean of
// 2^stretch is 1.
TEST(Bake, StretchAveragesToOne) {
    test::TemporaryFolder const folder;
    engine::Scene const torus = test::MakeTorus(12, 8);
    RunBake(torus, MakeFileOptions(folder / "s.exr", {"stretch"}, 64));
    engine::ExrLookup lookup;
    double sum = 0.0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x)
            sum += std::exp2(lookup.Look(folder / "s.exr", {"Y"}, x, y)[0]);
    }
    EXPECT_NEAR(sum / (64 * 64), 1.0, 5e-3);
}

TEST(Bake, EncodingScalesAndOffsets) {
    test::TemporaryFolder const folder;
    engine::Scene const torus = test::MakeTorus(12, 8);
    RunBake(torus, MakeFileOptions(folder / "plain.exr", {"normal"}, 16));
    auto options = MakeFileOptions(folder / "encoded.exr", {"normal"}, 16);
    options.encoding = engine::Encoding{0.5, 0.5};
    RunBake(torus, options);
    engine::ExrLookup lookup;
    double const plain = lookup.Look(folder / "plain.exr", {"R"}, 5, 5)[0];
    EXPECT_NEAR(lookup.Look(folder / "encoded.exr", {"R"}, 5, 5)[0], 0.5 * plain + 0.5, 1e-6);
}

// Supersampled maps agree with a finer bake averaged by hand.
TEST(Bake, SupersamplingIsTheMeanOfAFinerBake) {
    test::TemporaryFolder const folder;
    engine::Scene const torus = test::MakeTorus(12, 8);
    RunBake(torus, MakeFileOptions(folder / "fine.exr", {"mean"}, 64));
    auto options = MakeFileOptions(folder / "coarse.exr", {"mean"}, 32);
    options.samplesPerSide = 2;
    RunBake(torus, options);
    engine::ExrLookup lookup;
    for (int x = 0; x < 32; x += 5) {
        double mean = 0.0;
        for (int k = 0; k < 4; ++k)
            mean += 0.25 * lookup.Look(folder / "fine.exr", {"Y"}, 2 * x + k % 2, 2 * 7 + k / 2)[0];
        EXPECT_NEAR(lookup.Look(folder / "coarse.exr", {"Y"}, x, 7)[0], mean, 1e-5);
    }
}

TEST(Bake, TilesAreThoseWithTexels) {
    test::TemporaryFolder const folder;
    auto const report = RunBake(test::LoadAsset("udim/grid_with_udims.obj"),
                                MakeFileOptions(folder / "n.<UDIM>.exr", {"normal"}, 32));
    EXPECT_EQ(report.tiles.size(), 9u);
    EXPECT_EQ(report.tiles.front(), 1001);
    EXPECT_EQ(report.tiles.back(), 1056);
    EXPECT_EQ(folder.List().size(), 9u);
}

TEST(Bake, AMeshWithoutUVsIsRefused) {
    test::TemporaryFolder const folder;
    EXPECT_EQ(test::CodeOf([&] {
                  RunBake(test::MakeCube(), MakeFileOptions(folder / "n.exr", {"normal"}, 16));
              }),
              ErrorCode::BadMesh);
    EXPECT_TRUE(folder.List().empty());
}

// Sum of K dA over the texels of a closed torus is 0, of spot (a sphere) 4 pi.
TEST(Bake, GaussBonnetHoldsOnClosedMeshes) {
    test::TemporaryFolder const folder;
    for (auto const& [scene, expected] : {std::pair{test::MakeTorus(24, 16), 0.0},
                                          std::pair{test::LoadSpot(), 4 * std::acos(-1.0)}}) {
        auto options = MakeFileOptions(folder / "{mesh}.{map}.<UDIM>.exr", {"position"}, 512);
        auto const report = RunBake(scene, options);
        engine::Job job;
        auto const audit = engine::Audit(engine::Model::Build(scene), options, report, {}, job);
        ASSERT_EQ(audit.gaussBonnet.size(), 1u);
        EXPECT_TRUE(audit.gaussBonnet[0].wasAudited) << audit.gaussBonnet[0].reason;
        EXPECT_NEAR(audit.gaussBonnet[0].expected, expected, 1e-12);
        EXPECT_LT(audit.gaussBonnet[0].relativeError, 1e-3);
        EXPECT_TRUE(audit.misses.empty());
    }
}

// Positions agree across seams to within what one texel spans: the padding continues the chart.
TEST(Bake, SeamsOfPositionsCloseWithinATexel) {
    test::TemporaryFolder const folder;
    engine::Scene const torus = test::MakeTorus(24, 16);
    auto const options = MakeFileOptions(folder / "{map}.exr", {"position"}, 256);
    auto const report = RunBake(torus, options);
    engine::Job job;
    auto const audit = engine::Audit(engine::Model::Build(torus), options, report, {}, job);
    ASSERT_EQ(audit.seams.size(), 1u);
    EXPECT_GT(audit.seams[0].samples, 100u);
    EXPECT_LT(audit.seams[0].max, 2 * std::acos(-1.0) * 1.5 / 256);  // circumference over size
}

}  // namespace
}  // namespace limn
