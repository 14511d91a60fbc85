// SPDX-License-Identifier: Apache-2.0
//
// Positions, and what else must not depend on where a mesh lies.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/bake/bake.h"
#include "engine/bake/layout.h"
#include "engine/bake/maps/map_table.h"
#include "engine/scene/extent.h"
#include "engine/scene/refine.h"
#include "support/listener.h"
#include "support/map_options.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::Model;
using Point = std::array<double, 3>;

constexpr Point kShift{448266.125, 5411932.5, 312.25};

Model Move(Model const& model) {
    return model.WithPoints(engine::Subtract(model.GetPositions(),
                                             {0.0 - kShift[0], 0.0 - kShift[1], 0.0 - kShift[2]}));
}

Model MakeTorus() {
    return Model::Build(test::MakeTorus(12, 8));
}

struct Baked {
    engine::BakedImages images;
    std::vector<std::string> warnings;

    std::vector<float> const& GetTexels() const { return images.images.at(0).texels; }
};

Baked Bake(Model const& model, engine::BakeOptions options) {
    options.width = options.height = 32;
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    Baked baked{engine::BakeToMemory(model, options, job), {}};
    baked.warnings = listener.warnings;
    return baked;
}

Baked BakePositions(Model const& model, std::optional<engine::Origin> const& origin = {}) {
    engine::BakeOptions options;
    options.maps = {"position"};
    options.origin = origin;
    return Bake(model, options);
}

/// The largest difference of texels and those of another bake, moved.
double FindMiss(std::vector<float> const& texels, std::vector<float> const& others,
                Point const& shift) {
    EXPECT_EQ(texels.size(), others.size());
    double miss = 0.0;
    for (size_t i = 0; i < texels.size(); ++i)
        miss = test::Worse(miss, std::abs(texels[i] - (others[i] + shift[i % 3])));
    return miss;
}

TEST(PositionMap, IsRelativeToItsOrigin) {
    Model const torus = MakeTorus();
    Point const origin{1.5, -2.25, 0.1};
    auto const relative = BakePositions(torus, origin);
    EXPECT_LE(FindMiss(BakePositions(torus).GetTexels(), relative.GetTexels(), origin), 4e-7);
    EXPECT_EQ(relative.images.report.outputs.at(0).origin, origin);
    EXPECT_EQ(BakePositions(torus).images.report.outputs.at(0).origin, std::nullopt);
}

TEST(PositionMap, FarFromTheOriginIsTheNearestFloatAndSaidToBeCoarse) {
    Model const torus = MakeTorus(), far = Move(torus);
    auto const baked = BakePositions(far);
    EXPECT_LE(FindMiss(baked.GetTexels(), BakePositions(torus).GetTexels(), kShift), 0.25 + 1e-6);
    ASSERT_EQ(baked.warnings.size(), 1u);
    EXPECT_NE(baked.warnings[0].find("positions of single precision are 0.5 apart"),
              std::string::npos)
        << baked.warnings[0];
    EXPECT_NE(baked.warnings[0].find("`origin` auto"), std::string::npos);
}

TEST(PositionMap, AnAutomaticOriginKeepsAllDigits) {
    Model const torus = MakeTorus(), far = Move(torus);
    auto const near = BakePositions(torus);
    for (engine::Origin const& origin :
         {engine::Origin(engine::AutomaticOrigin{}), engine::Origin(Point{448000, 5412000, 0})}) {
        auto const baked = BakePositions(far, origin);
        Point shift = kShift;
        for (size_t c = 0; c < 3; ++c) shift[c] -= (*baked.images.report.outputs.at(0).origin)[c];
        bool const isAutomatic = origin.index() == 0;
        // A float's step where the second origin leaves the mesh is 3e-5.
        EXPECT_LE(FindMiss(baked.GetTexels(), near.GetTexels(), shift), isAutomatic ? 1e-6 : 3e-5);
        EXPECT_EQ(baked.warnings.size(), isAutomatic ? 0u : 1u);
    }
}

TEST(PositionMap, AnOriginThatIsZeroLeavesNoTrace) {
    Model const torus = MakeTorus();
    auto const plain = BakePositions(torus),
               automatic = BakePositions(torus, engine::AutomaticOrigin{});
    EXPECT_EQ(automatic.GetTexels(), plain.GetTexels());
    EXPECT_EQ(automatic.images.report.outputs.at(0).origin, Point{});
    engine::BakeOptions options;
    options.maps = {"position"};
    auto const describe = [&] {
        auto const files = engine::LayOutFiles(engine::MakeMaps(options, torus), "{map}", false);
        return engine::MakeAttributes(options, files.at(0), torus, 1001);
    };
    auto const before = describe();
    options.origin = engine::AutomaticOrigin{};
    EXPECT_EQ(describe(), before);
}

TEST(PositionMap, AnOriginStandsInTheHeaderOfPositionsOnly) {
    Model const torus = MakeTorus();
    engine::BakeOptions options;
    options.maps = {"position", "normal"};
    options.origin = Point{0.1, 5411932, -3};
    auto const files = engine::LayOutFiles(engine::MakeMaps(options, torus), "{map}", false);
    auto const find = [&](engine::FileLayout const& file, std::string const& key) {
        for (auto const& [name, value] : engine::MakeAttributes(options, file, torus, 1001)) {
            if (name == key) return value;
        }
        return std::string();
    };
    EXPECT_EQ(find(files.at(0), "limn:origin"), "0.1,5411932,-3");
    EXPECT_NE(find(files.at(0), "limn:options").find(" origin=0.1,5411932,-3"), std::string::npos);
    EXPECT_EQ(find(files.at(1), "limn:origin"), "");
    EXPECT_EQ(find(files.at(1), "limn:options").find("origin"), std::string::npos);
}

// -------- the other maps

TEST(FarFromTheOrigin, MapsAreThoseOfTheMeshNearIt) {
    Model const near = test::MakeModelWithColours(), far = Move(near);
    auto const all = test::OptionsForAllMaps(near);
    for (std::string const& map : all.maps) {
        if (map == "position" || map == "noise") continue;  // which are told by the place
        SCOPED_TRACE(map);
        auto options = all;
        options.maps = {map};
        auto const expected = Bake(near, options);
        options.against = Move(*all.against);
        options.rest = Move(*all.rest);
        auto const found = Bake(far, options);
        double size = 0.0;
        for (float x : expected.GetTexels()) size = std::max(size, std::abs(double{x}));
        // Doubles of such coordinates are 1e-9 apart, on faces of size 1.
        EXPECT_LE(FindMiss(found.GetTexels(), expected.GetTexels(), {}), 1e-5 * size);
    }
}

TEST(FarFromTheOrigin, DisplacementToAFinerMeshKeepsItsDigits) {
    engine::Job job;
    Model const near = MakeTorus();
    engine::BakeOptions options;
    options.maps = {"displacement"};
    options.isVector = true;
    engine::Scene finer = engine::RefineUniformly(near, {.levels = 1}, job);
    for (double& x : finer.positions) x *= 1.1;
    options.against = Model::Build(finer);
    auto const expected = Bake(near, options);
    options.against = Move(*options.against);
    auto const found = Bake(Move(near), options);
    EXPECT_LE(FindMiss(found.GetTexels(), expected.GetTexels(), {}), 1e-6);
}

}  // namespace
}  // namespace limn
