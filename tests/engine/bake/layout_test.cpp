// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/layout.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "engine/bake/maps/map_table.h"
#include "engine/version.h"
#include "support/files.h"
#include "support/map_options.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::BakeOptions;
using engine::FileLayout;
using engine::Model;
using Names = std::vector<std::string>;

class Layout : public testing::Test {
protected:
    std::vector<FileLayout> LayOut(Names const& maps, std::string const& pattern,
                                   bool hasCoverage = false) const {
        BakeOptions named = options;
        named.maps = maps;
        return engine::LayOutFiles(engine::MakeMaps(named, model), pattern, hasCoverage);
    }

    /// The option text of a map's own file.
    std::string TextOf(std::string const& map, BakeOptions own, Model const& of) const {
        own.maps = {map};
        auto const files =
            engine::LayOutFiles(engine::MakeMaps(own, of), "{map}.exr", own.hasCoverage);
        return engine::MakeOptionText(own, files.at(0), of);
    }
    std::string TextOf(std::string const& map, BakeOptions const& own) const {
        return TextOf(map, own, model);
    }

    Model const model = test::MakeModelWithColours();
    BakeOptions const options = test::OptionsForAllMaps(model);
};

// -------- files and channels

TEST_F(Layout, WithAMapTokenEveryMapHasItsFile) {
    auto const files = LayOut({"mean", "normal", "primvar:color"}, "{map}.exr");
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[0].channelNames, (Names{"Y"}));
    EXPECT_EQ(files[1].channelNames, (Names{"R", "G", "B"}));
    EXPECT_EQ(files[2].channelNames, (Names{"R", "G", "B"}));
    Names maps;
    std::vector<std::pair<int, int>> planes;
    for (FileLayout const& file : files) {
        maps.push_back(file.mapName);
        planes.emplace_back(file.firstPlane, file.numPlanes);
        EXPECT_EQ(file.maps.size(), 1u);
        EXPECT_EQ(file.groups.at(0).first, 0) << "groups count from the file's own first plane";
    }
    EXPECT_EQ(maps, (Names{"mean", "normal", "primvar:color"}));
    EXPECT_EQ(planes, (std::vector<std::pair<int, int>>{{0, 1}, {1, 3}, {4, 3}}));
}

TEST_F(Layout, WithoutAMapTokenMapsAreLayersOfOneFile) {
    auto const files = LayOut({"mean", "normal", "primvar:color"}, "all.<UDIM>.exr");
    ASSERT_EQ(files.size(), 1u);
    EXPECT_EQ(files[0].channelNames,
              (Names{"mean.Y", "normal.R", "normal.G", "normal.B", "primvar_color.R",
                     "primvar_color.G", "primvar_color.B"}));
    EXPECT_EQ(files[0].mapName, "mean+normal+primvar:color");
    EXPECT_EQ(files[0].firstPlane, 0);
    EXPECT_EQ(files[0].numPlanes, 7);
    int next = 0;
    for (engine::ChannelGroup const& group : files[0].groups) {
        EXPECT_EQ(group.first, next);
        next += group.count;
    }
    EXPECT_EQ(next, 7);
}

TEST_F(Layout, AMapAloneIsNoLayer) {
    EXPECT_EQ(LayOut({"curvature"}, "a.exr").at(0).channelNames,
              (Names{"k1", "k2", "mean", "gaussian"}));
}

TEST_F(Layout, CoverageIsTheLastChannelOfEveryFileAndNoPlane) {
    auto const apart = LayOut({"mean", "normal"}, "{map}.exr", true);
    EXPECT_EQ(apart.at(0).channelNames, (Names{"Y", "coverage"}));
    EXPECT_EQ(apart.at(1).channelNames, (Names{"R", "G", "B", "coverage"}));
    EXPECT_EQ(apart.at(1).numPlanes, 3);
    auto const together = LayOut({"mean", "normal"}, "a.exr", true);
    EXPECT_EQ(together.at(0).channelNames,
              (Names{"mean.Y", "normal.R", "normal.G", "normal.B", "coverage"}));
    EXPECT_EQ(together.at(0).numPlanes, 4);
}

// -------- the option text

TEST_F(Layout, OptionTextIsTheSameWhateverTheOrderOfGroups) {
    BakeOptions one = options, other = options;
    one.groups = {"red", "blue", "green"};
    other.groups = {"green", "red", "blue", "red"};
    EXPECT_EQ(TextOf("mean", one), TextOf("mean", other));
    EXPECT_NE(TextOf("mean", one), TextOf("mean", options));
}

TEST_F(Layout, OptionTextKnowsNothingOfPathsAndOfWhatLeavesPixelsAlone) {
    test::TemporaryFolder const folder;
    auto const here = engine::Model::Build(test::LoadShape("catmark_cube"));
    auto elsewhere = test::LoadShape("catmark_cube");
    elsewhere.path = folder / "other.obj";
    elsewhere.name = "other";
    BakeOptions other = options;
    other.pattern = folder / "{map}.exr";
    other.tiles = {1001, 1002};
    other.skipsExisting = other.hasPreview = other.wantsChecksums = true;
    std::string const text = TextOf("mean", options, here);
    EXPECT_EQ(text, TextOf("mean", other, engine::Model::Build(std::move(elsewhere))));
    EXPECT_EQ(text.find('/'), std::string::npos) << text;
    EXPECT_EQ(text.find(".obj"), std::string::npos) << text;
    EXPECT_EQ(text.find("thread"), std::string::npos) << text;
}

// Every single change makes a text of its own.
TEST_F(Layout, OptionTextTellsEveryOptionThatAffectsPixels) {
    std::vector<std::function<void(BakeOptions&)>> const changes{
        [](BakeOptions& o) { o.width = 17; },
        [](BakeOptions& o) { o.height = 17; },
        [](BakeOptions& o) { o.samplesPerSide = 3; },
        [](BakeOptions& o) { o.padding = 5; },
        [](BakeOptions& o) { o.isHalf = true; },
        [](BakeOptions& o) { o.hasMips = true; },
        [](BakeOptions& o) { o.hasCoverage = true; },
        [](BakeOptions& o) { o.compression = engine::ExrCompression::Piz; },
        [](BakeOptions& o) { o.groups = {"red"}; },
        [](BakeOptions& o) { o.groups = {"red", "blue"}; },
        [](BakeOptions& o) { o.orientation = Orientation::Left; },
        [](BakeOptions& o) { o.encoding = engine::Encoding{0.5, 0.5}; },
        [](BakeOptions& o) { o.encoding = engine::Encoding{0.5, 0.25}; }};
    std::set<std::string> texts{TextOf("mean", options)};
    for (auto const& change : changes) {
        BakeOptions changed = options;
        change(changed);
        texts.insert(TextOf("mean", changed));
    }
    EXPECT_EQ(texts.size(), changes.size() + 1);
}

TEST_F(Layout, OptionTextTellsTheRulesOfSubdivision) {
    engine::Scene const cube = test::LoadShape("catmark_cube");
    std::vector<std::function<void(far_ext::ControlMesh&)>> const changes{
        [](far_ext::ControlMesh& cage) { cage.scheme = Sdc::SCHEME_BILINEAR; },
        [](far_ext::ControlMesh& cage) {
            cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        },
        [](far_ext::ControlMesh& cage) {
            cage.options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_ALL);
        },
        [](far_ext::ControlMesh& cage) {
            cage.options.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN);
        },
        [](far_ext::ControlMesh& cage) {
            cage.options.SetTriangleSubdivision(Sdc::Options::TRI_SUB_SMOOTH);
        }};
    std::set<std::string> texts{TextOf("mean", options, Model::Build(cube))};
    for (auto const& change : changes) {
        engine::Scene changed = cube;
        change(changed.cage);
        texts.insert(TextOf("mean", options, Model::Build(std::move(changed))));
    }
    EXPECT_EQ(texts.size(), changes.size() + 1);
}

// A map's own options are told by its file, and by no other's.
TEST_F(Layout, OptionTextTellsTheOptionsOfItsMapsOnly) {
    struct Change {
        std::string map;
        std::function<void(BakeOptions&)> act;
    };
    std::vector<Change> const changes{
        {"bands", [](BakeOptions& o) { o.bands = 3; }},
        {"bands", [](BakeOptions& o) { o.isVector = true; }},
        {"displacement", [](BakeOptions& o) { o.isVector = true; }},
        {"displacement", [](BakeOptions& o) { o.space = engine::VectorSpace::Tangent; }},
        {"noise", [](BakeOptions& o) { o.noise.octaves = 3; }},
        {"noise", [](BakeOptions& o) { o.noise.frequency = 3.5; }},
        {"noise", [](BakeOptions& o) { o.noise.seed = 99; }},
        {"noise", [](BakeOptions& o) { o.isNormalized = true; }},
        {"noise",
         [](BakeOptions& o) { o.noiseRamp = engine::ColourRamp::Parse("#000000,#ff0000"); }},
        {"field", [](BakeOptions& o) { o.isNormalized = true; }},
        {"field", [](BakeOptions& o) { o.space = engine::VectorSpace::UV; }},
        {"field", [](BakeOptions& o) { o.field->at(0) += 1.0; }}};
    std::map<std::string, std::set<std::string>> texts;
    std::map<std::string, size_t> numChanges;
    for (auto const& [map, act] : changes) {
        BakeOptions changed = options;
        act(changed);
        texts[map].insert(TextOf(map, options));
        texts[map].insert(TextOf(map, changed));
        ++numChanges[map];
        if (changed.space != engine::VectorSpace::UV) {
            EXPECT_EQ(TextOf("mean", changed), TextOf("mean", options)) << map;
        }
    }
    for (auto const& [map, own] : texts) EXPECT_EQ(own.size(), numChanges[map] + 1) << map;
}

// -------- attributes, and files that have them

std::map<std::string, std::string> AsMap(engine::Attributes const& attributes) {
    return {attributes.begin(), attributes.end()};
}

TEST_F(Layout, AttributesTellInputMapsOptionsUnitsAndVersion) {
    auto scene = test::MakeTorus(12, 8);
    scene.sha256 = "checksum";
    auto const torus = Model::Build(std::move(scene));
    BakeOptions own;
    own.maps = {"mean", "stretch"};
    auto const file = engine::LayOutFiles(engine::MakeMaps(own, torus), "a.exr", false).at(0);
    auto const plain = AsMap(engine::MakeAttributes(own, file, torus, 1012));
    EXPECT_EQ(plain.at("limn:input"), "checksum");
    EXPECT_EQ(plain.at("limn:map"), "mean+stretch");
    EXPECT_EQ(plain.at("limn:tile"), "1012");
    EXPECT_EQ(plain.at("limn:options"), engine::MakeOptionText(own, file, torus));
    EXPECT_EQ(plain.at("limn:version"), kVersion);
    EXPECT_EQ(plain.at("limn:units"),
              "mean " + file.maps[0].units + "; stretch " + file.maps[1].units);
    for (char const* missing : {"limn:against", "limn:scale", "limn:offset", "textureformat"})
        EXPECT_FALSE(plain.contains(missing)) << missing;
    own.encoding = engine::Encoding{0.5, 0.25};
    own.hasMips = true;
    auto const rich = AsMap(engine::MakeAttributes(own, file, torus, 1012));
    EXPECT_EQ(rich.at("limn:scale"), "0.5");
    EXPECT_EQ(rich.at("limn:offset"), "0.25");
    EXPECT_EQ(rich.at("textureformat"), "Plain Texture");
}

// The other mesh is told by files that lead to it, whatever else is baked.
TEST_F(Layout, AttributesTellTheMeshThatDisplacementLeadsTo) {
    BakeOptions own = options;
    own.against = model.WithPoints(model.GetPositions(), "of the other mesh");
    own.maps = {"mean", "displacement"};
    auto const maps = engine::MakeMaps(own, model);
    auto const apart = engine::LayOutFiles(maps, "{map}.exr", false);
    EXPECT_FALSE(
        AsMap(engine::MakeAttributes(own, apart.at(0), model, 1001)).contains("limn:against"));
    auto const together = engine::LayOutFiles(maps, "a.exr", false);
    for (FileLayout const& file : {apart.at(1), together.at(0)}) {
        EXPECT_EQ(AsMap(engine::MakeAttributes(own, file, model, 1001)).at("limn:against"),
                  "of the other mesh");
    }
}

/// A file of a few texels with the given attributes.
std::string WriteExr(test::TemporaryFolder const& folder, engine::Attributes const& attributes) {
    engine::ExrSpec spec;
    spec.width = spec.height = 64;
    spec.channels = {"Y"};
    spec.attributes = attributes;
    std::string const path = folder / "a.exr";
    engine::ExrWriter writer(path, spec);
    std::vector<float> const plane(64 * 64, 0.5f);
    float const* const tile = plane.data();
    writer.Write(writer.Pack(0, 0, 0, &tile, 64));
    writer.Seal({0.25f, 0.5f})->Commit();
    return path;
}

TEST(FindUpToDate, IsAFileOfTheSameAttributesInAnyOrder) {
    test::TemporaryFolder const folder;
    engine::Attributes attributes{{"limn:map", "mean"}, {"limn:input", "a"}, {"software", "any"}};
    std::string const path = WriteExr(folder, attributes);
    EXPECT_EQ(engine::FindUpToDate(path, attributes), (engine::ValueRange{0.25f, 0.5f}));
    std::reverse(attributes.begin(), attributes.end());
    EXPECT_TRUE(engine::FindUpToDate(path, attributes));
    attributes[0].second = "of other programs' attributes nothing depends";
    EXPECT_TRUE(engine::FindUpToDate(path, attributes));
}

TEST(FindUpToDate, NoFileWithAnotherAttributeOneMoreOrOneLess) {
    test::TemporaryFolder const folder;
    engine::Attributes const attributes{{"limn:map", "mean"}, {"limn:input", "a"}};
    std::string const path = WriteExr(folder, attributes);
    EXPECT_FALSE(engine::FindUpToDate(path, {{"limn:map", "mean"}, {"limn:input", "b"}}));
    EXPECT_FALSE(engine::FindUpToDate(path, {{"limn:map", "mean"}}));
    EXPECT_FALSE(engine::FindUpToDate(
        path, {{"limn:map", "mean"}, {"limn:input", "a"}, {"limn:against", "c"}}));
    EXPECT_FALSE(engine::FindUpToDate(path, {}));
}

TEST(FindUpToDate, NoFileThatIsMissingCutShortOrNoImage) {
    test::TemporaryFolder const folder;
    engine::Attributes const attributes{{"limn:map", "mean"}};
    std::string const path = WriteExr(folder, attributes), whole = test::ReadText(path);
    EXPECT_FALSE(engine::FindUpToDate(folder / "none.exr", attributes));
    for (size_t size : {whole.size() - 1, whole.size() / 2, size_t{10}, size_t{0}})
        EXPECT_FALSE(engine::FindUpToDate(folder.Write("b.exr", whole.substr(0, size)), attributes))
            << size;
    EXPECT_FALSE(engine::FindUpToDate(folder.Write("c.exr", "no image"), attributes));
    EXPECT_TRUE(engine::FindUpToDate(folder.Write("d.exr", whole), attributes));
}

}  // namespace
}  // namespace limn
