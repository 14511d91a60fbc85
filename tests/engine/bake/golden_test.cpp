// SPDX-License-Identifier: Apache-2.0
//
// A whole bake against files kept in tests/golden. They were made by
//     limn bake scenes/spot/spot.obj -o 'tests/golden/spot.{map}.exr'
//         --maps curvature,normal,principal-direction,stretch --size 64 --samples 2 --coverage
// and change only with a commit that says why.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/bake/bake.h"
#include "engine/images/exr_lookup.h"
#include "far_ext/topology/refiner.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn {
namespace {

struct GoldenCase {
    char const* map;
    std::vector<std::string> channels;
    double tolerance;  ///< of a value, relative to its size plus 1
    bool isLine;
};

class GoldenBake : public testing::TestWithParam<GoldenCase> {};

INSTANTIATE_TEST_SUITE_P(
    Spot, GoldenBake,
    testing::Values(
        GoldenCase{"curvature", {"k1", "k2", "mean", "gaussian", "coverage"}, 2e-6, false},
        GoldenCase{"normal", {"R", "G", "B", "coverage"}, 1e-6, false},
        GoldenCase{"principal-direction", {"R", "G", "B"}, 1e-4, true},
        GoldenCase{"stretch", {"Y"}, 1e-6, false}),
    [](testing::TestParamInfo<GoldenCase> const& golden) {
        std::string name = golden.param.map;
        std::replace(name.begin(), name.end(), '-', '_');
        return name;
    });

TEST_P(GoldenBake, IsWhatItWas) {
    auto const& [map, channels, tolerance, isLine] = GetParam();
    test::TemporaryFolder const folder;
    engine::Scene const spot = test::LoadSpot();
    engine::BakeOptions options;
    options.pattern = folder / "now.exr";
    options.maps = {map};
    options.width = options.height = 64;
    options.samplesPerSide = 2;
    options.hasCoverage = true;
    engine::Job job;
    engine::Bake(engine::Model::Build(spot), options, job);
    engine::ExrLookup lookup;
    std::string const before = std::string(LIMN_TEST_DATA) + "/../golden/spot." + map + ".exr";
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            auto const now = lookup.Look(options.pattern, channels, x, y),
                       then = lookup.Look(before, channels, x, y);
            double product = 0.0;
            for (size_t c = 0; c < channels.size(); ++c) product += now[c] * then[c];
            double const sign = isLine && product < 0.0 ? -1.0 : 1.0;
            for (size_t c = 0; c < channels.size(); ++c) {
                ASSERT_NEAR(now[c], sign * then[c], tolerance * (1.0 + std::abs(then[c])))
                    << channels[c] << " at " << x << " " << y;
            }
        }
    }
}

}  // namespace
}  // namespace limn
