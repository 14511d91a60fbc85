// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/group_bakes.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/bake/bake.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/listener.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::BakeOptions;
using engine::GroupKind;
using Words = std::vector<std::string>;

/// A torus of 24 faces, those of `second` in the second of two groups of the kind, -1 in none.
void PutIntoGroups(engine::Scene& scene, GroupKind kind, Words names,
                   std::vector<Index> const& ofFirstFaces) {
    auto& groups = scene.groups[static_cast<size_t>(kind)];
    groups.names = std::move(names);
    groups.faceGroup = ofFirstFaces;
    groups.faceGroup.resize(scene.cage.faceSizes.size(), 0);
}

Words NamesOf(engine::Scene scene, BakeOptions const& options, Words* warnings = nullptr) {
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    Words names;
    for (BakeOptions const& own :
         engine::SplitByGroup(engine::Model::Build(std::move(scene)), options, job)) {
        EXPECT_EQ(own.groups, Words{own.group});
        EXPECT_EQ(own.pattern, options.pattern);
        names.push_back(own.group);
    }
    if (warnings) *warnings = listener.warnings;
    return names;
}

TEST(SplitByGroup, TakesMaterialsBeforeGroupsBeforeObjects) {
    engine::Scene scene = test::MakeTorus(6, 4);
    PutIntoGroups(scene, GroupKind::Object, {"body", "head"}, {1});
    EXPECT_EQ(NamesOf(scene, {}), (Words{"body", "head"}));
    PutIntoGroups(scene, GroupKind::Group, {"left", "left both"}, {1});
    EXPECT_EQ(NamesOf(scene, {}), (Words{"left", "both"}));
    PutIntoGroups(scene, GroupKind::Material, {"red", "never used", "blue"}, {2});
    EXPECT_EQ(NamesOf(scene, {}), (Words{"red", "blue"}));
}

TEST(SplitByGroup, TakesTheGroupsThatAreNamed) {
    engine::Scene scene = test::MakeTorus(6, 4);
    PutIntoGroups(scene, GroupKind::Material, {"red", "blue"}, {1});
    BakeOptions options;
    options.groups = {"blue"};
    EXPECT_EQ(NamesOf(scene, options), (Words{"blue"}));
    options.groups = {"green"};
    EXPECT_EQ(test::CodeOf([&] { NamesOf(scene, options); }), ErrorCode::BadOption);
}

TEST(SplitByGroup, SaysHowManyFacesAreInNone) {
    engine::Scene scene = test::MakeTorus(6, 4);
    PutIntoGroups(scene, GroupKind::Material, {"red"}, {0, -1, -1});
    Words warnings;
    EXPECT_EQ(NamesOf(scene, {}, &warnings), (Words{"red"}));
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("2 of 24 faces are in none"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("first face 1"), std::string::npos) << warnings[0];
}

TEST(SplitByGroup, AMeshWithoutGroupsIsRefused) {
    EXPECT_EQ(test::CodeOf([&] { NamesOf(test::MakeTorus(6, 4), {}); }), ErrorCode::BadOption);
}

TEST(SplitByGroup, GroupsThatWouldHaveOneFileAreRefused) {
    engine::Scene scene = test::MakeTorus(6, 4);
    PutIntoGroups(scene, GroupKind::Material, {"b/c", "b_c"}, {1});
    BakeOptions options;
    options.maps = {"mean"};
    options.pattern = "{group}.exr";
    std::string const refusal = test::RefusalOf([&] { NamesOf(scene, options); });
    EXPECT_TRUE(refusal.starts_with("`pattern`: two outputs are named 'b_c.exr'")) << refusal;
}

// Each group has a file with its own faces; one without texels is passed over with a warning.
TEST(SplitByGroup, MakesBakesOfOneGroupEach) {
    test::TemporaryFolder const folder;
    engine::Scene scene = test::MakeTorus(6, 4);
    PutIntoGroups(scene, GroupKind::Material, {"red", "dark/blue", "far"}, {0, 1, 1, 2});
    auto const& values = scene.cage.fvarChannels[0].valueIndices;
    for (size_t corner = 12; corner < 16; ++corner)  // face 3, out of UDIM's range
        scene.uvs[2 * static_cast<size_t>(values[corner])] -= 3.0;
    auto const model = engine::Model::Build(std::move(scene));
    BakeOptions options;
    options.pattern = folder / "{map}.{group}.exr";
    options.maps = {"mean"};
    options.width = options.height = 64;
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    EXPECT_EQ(test::CodeOf([&] { engine::Bake(model, options, job); }), ErrorCode::BadOption);
    size_t numTexels = 0;
    for (BakeOptions const& own : engine::SplitByGroup(model, options, job))
        numTexels += engine::Bake(model, own, job).texelsCovered;
    EXPECT_EQ(folder.List(), (Words{"mean.dark_blue.exr", "mean.red.exr"}));
    EXPECT_GT(numTexels, 3000u);
    EXPECT_TRUE(std::ranges::any_of(listener.warnings, [](std::string const& warning) {
        return warning.find("no texel is covered by far") != std::string::npos;
    }));
}

}  // namespace
}  // namespace limn
