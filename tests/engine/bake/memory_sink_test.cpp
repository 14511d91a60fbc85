// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/memory_sink.h"

#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/bake/bake.h"
#include "engine/images/exr_lookup.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn {
namespace {

engine::BakeOptions MakeOptions() {
    engine::BakeOptions options;
    options.maps = {"normal", "mean"};
    options.width = 150;  // no multiple of a tile
    options.height = 100;
    options.padding = 5;
    options.samplesPerSide = 2;
    options.hasCoverage = true;
    return options;
}

// Files and memory go the same road: the same texels, padding and coverage.
TEST(BakeToMemory, HoldsWhatTheFilesHold) {
    test::TemporaryFolder const folder;
    auto const model = engine::Model::Build(test::LoadSpot());
    engine::Job job;
    auto options = MakeOptions();
    auto const baked = engine::BakeToMemory(model, options, job);
    options.pattern = folder / "{map}.<UDIM>.exr";
    auto const report = engine::Bake(model, options, job);
    ASSERT_EQ(baked.images.size(), 2u);
    ASSERT_EQ(report.outputs.size(), 2u);
    EXPECT_EQ(baked.report.texelsCovered, report.texelsCovered);
    engine::ExrLookup lookup;
    size_t numPadded = 0;
    for (size_t i = 0; i < 2; ++i) {
        engine::BakedImage const& image = baked.images[i];
        EXPECT_EQ(image.map, report.outputs[i].map);
        EXPECT_EQ(baked.report.outputs[i].min, report.outputs[i].min);
        auto channels = image.channels;
        channels.push_back("coverage");
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                auto const file = lookup.Look(report.outputs[i].path, channels, x, y);
                auto const texel = image.GetTexel(y, x);
                float const coverage = image.GetCoverage(y, x);
                bool hasValue = false;
                for (size_t c = 0; c < texel.size(); ++c) {
                    ASSERT_EQ(texel[c], static_cast<float>(file[c])) << x << " " << y;
                    hasValue |= texel[c] != 0.0f;
                }
                ASSERT_EQ(coverage, static_cast<float>(file.back()));
                numPadded += hasValue && coverage == 0.0f;
            }
        }
    }
    EXPECT_GT(numPadded, 100u);
}

TEST(BakeToMemory, RefusesSidesThatNoImageHas) {
    auto const model = engine::Model::Build(test::MakeTorus(6, 4));
    engine::Job job;
    for (int const side : {-1, 0, 65537, 2000000000}) {
        auto options = MakeOptions();
        options.height = side;
        EXPECT_EQ(test::RefusalOf([&] { engine::BakeToMemory(model, options, job); }),
                  fmt::format("`height` is {}; 1 to 65536 texels are possible", side));
    }
}

/// Adds up all that it is given, padding included.
class SumOfTexels : public engine::BakeDestination {
public:
    std::unique_ptr<engine::TexelSink> Open(engine::FileLayout const& file,
                                            engine::BakeOutput& output) override {
        output.path = "sum";
        return std::make_unique<Sink>(file.numPlanes, sum);
    }

    double sum = 0.0;

private:
    class Sink : public engine::TexelSink {
    public:
        Sink(int numPlanes, double& sum) : _numPlanes(numPlanes), _sum(sum) {}
        bool WantsCoverage() const override { return false; }
        std::unique_ptr<engine::PackedRows> Pack(engine::StripView const&) override {
            return std::make_unique<engine::PackedRows>();
        }
        void Write(engine::StripView const& strip, engine::PackedRows&) override {
            for (int row = 0; row < strip.numRows; ++row) {
                for (int x = 0; x < strip.width; ++x) {
                    for (int plane = 0; plane < _numPlanes; ++plane)
                        _sum += static_cast<double>(strip.GetRow(plane, row)[x]);
                }
            }
        }
        size_t Commit(engine::BakeOutput&) override { return 0; }

    private:
        int _numPlanes;
        double& _sum;
    };
};

TEST(BakeTo, GivesTheSameTexelsToADestinationOfTheCaller) {
    auto const model = engine::Model::Build(test::LoadSpot());
    auto options = MakeOptions();
    options.maps = {"normal"};
    engine::Job job;
    SumOfTexels texels;
    auto const report = engine::BakeTo(texels, model, options, job);
    ASSERT_EQ(report.outputs.size(), 1u);
    EXPECT_EQ(report.outputs[0].path, "sum");
    auto const baked = engine::BakeToMemory(model, options, job);
    double sum = 0.0;
    for (float const value : baked.images.at(0).texels) sum += static_cast<double>(value);
    EXPECT_EQ(texels.sum, sum);
}

TEST(BakeToMemory, HasAnImagePerTile) {
    auto scene = test::MakeTorus(12, 8);
    for (size_t i = 0; i < scene.uvs.size(); i += 2) scene.uvs[i] *= 2.0;  // two tiles wide
    auto const model = engine::Model::Build(std::move(scene));
    engine::BakeOptions options;
    options.maps = {"position"};
    options.width = options.height = 32;
    engine::Job job;
    auto const baked = engine::BakeToMemory(model, options, job);
    ASSERT_EQ(baked.images.size(), 2u);
    EXPECT_EQ(baked.images[0].tile, 1001);
    EXPECT_EQ(baked.images[1].tile, 1002);
    EXPECT_EQ(baked.report.tiles, (std::vector<int>{1001, 1002}));
    for (auto const& image : baked.images) {
        EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
        EXPECT_EQ(image.texels.size(), 3u * 32 * 32);
    }
}

TEST(BakeToMemory, LayersShareAnImageWithoutAMapToken) {
    auto const model = engine::Model::Build(test::MakeTorus(12, 8));
    engine::BakeOptions options;
    options.maps = {"mean", "normal"};
    options.pattern = "all";
    options.width = options.height = 16;
    engine::Job job;
    auto const baked = engine::BakeToMemory(model, options, job);
    ASSERT_EQ(baked.images.size(), 1u);
    EXPECT_EQ(baked.images[0].channels,
              (std::vector<std::string>{"mean.Y", "normal.R", "normal.G", "normal.B"}));
}

// Two bakes in one process, each with its own host: the one that is stopped stops, the other goes
// on.
TEST(BakeToMemory, StopsOnlyTheJobThatIsAskedTo) {
    auto const model = engine::Model::Build(test::MakeTorus(24, 16));
    auto const options = MakeOptions();
    engine::Job stopped({.isStopped = [] { return true; }});
    EXPECT_THROW(engine::BakeToMemory(model, options, stopped), engine::Stopped);
    engine::Job job;
    EXPECT_EQ(engine::BakeToMemory(model, options, job).images.size(), 2u);
}

}  // namespace
}  // namespace limn
