// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/model.h"

#include <limits>
#include <ostream>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/scene/content_hash.h"
#include "eval/surface/limit_surface.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::Model;
using engine::Scene;

Scene MakeNamedTorus() {
    Scene scene = test::MakeTorus(6, 4);
    scene.path = "models/torus.obj";
    scene.name = "torus";
    scene.sha256 = "12ab";
    return scene;
}

TEST(Model, HoldsWhatTheSceneSaid) {
    Scene const scene = MakeNamedTorus();
    Model const model = Model::Build(scene);
    EXPECT_EQ(model.GetPath(), scene.path);
    EXPECT_EQ(model.GetName(), scene.name);
    EXPECT_EQ(model.GetSha256(), scene.sha256);
    EXPECT_EQ(model.GetCage().faceVertices, scene.cage.faceVertices);
    EXPECT_EQ(model.GetPositions(), scene.positions);
    EXPECT_EQ(model.GetUVs(), scene.uvs);
    EXPECT_EQ(model.GetLevel().GetNumVertices(), scene.cage.numVertices);
}

TEST(Model, StaysWholeWhereItIsMovedFrom) {
    Model model = Model::Build(MakeNamedTorus());
    // NOLINTBEGIN(performance-move-const-arg,bugprone-use-after-move): what is left is looked at
    Model const moved = std::move(model);
    EXPECT_EQ(&model.GetPositions(), &moved.GetPositions());
    EXPECT_EQ(model.GetName(), "torus");
    // NOLINTEND(performance-move-const-arg,bugprone-use-after-move)
}

TEST(Model, MakesTheSceneItWasBuiltFrom) {
    Scene scene = MakeNamedTorus();
    scene.primvars = {{"mass", 1, std::vector<float>(scene.cage.numVertices, 2.0f)}};
    scene.groups[0] = {{"skin"}, std::vector<Index>(scene.cage.faceSizes.size(), 0)};
    Scene const back = Model::Build(scene).MakeScene();
    EXPECT_EQ(back.path, scene.path);
    EXPECT_EQ(back.positions, scene.positions);
    EXPECT_EQ(back.uvs, scene.uvs);
    EXPECT_EQ(back.primvars.at(0).values, scene.primvars[0].values);
    EXPECT_EQ(back.groups[0].faceGroup, scene.groups[0].faceGroup);
}

TEST(Model, MakesItsLimitSurfacesOnceForAllCopies) {
    Model const model = Model::Build(MakeNamedTorus());
    std::vector<eval::LimitSurface const*> limits(8), textures(8);
    std::vector<std::thread> threads;
    for (size_t i = 0; i < limits.size(); ++i) {
        threads.emplace_back([&, i, copy = model] {
            limits[i] = &copy.GetLimitSurface();
            textures[i] = &copy.GetTextureSurface();
        });
    }
    for (std::thread& thread : threads) thread.join();
    Model const moved = model.WithPoints(std::vector<double>(model.GetPositions().size(), 1.0));
    for (size_t i = 0; i < limits.size(); ++i) {
        EXPECT_EQ(limits[i], &moved.GetLimitSurface());
        EXPECT_EQ(textures[i], &moved.GetTextureSurface());
    }
    EXPECT_EQ(limits[0]->GetFVarChannel(), -1);
    EXPECT_EQ(textures[0]->GetFVarChannel(), 0);
}

TEST(Model, WithoutTextureCoordinatesHasNoLimitOfThem) {
    Model const model = Model::Build(test::MakeCube());
    ASSERT_FALSE(model.HasUVs());
    for (int i = 0; i < 2; ++i)
        EXPECT_EQ(test::CodeOf([&] { model.GetTextureSurface(); }), ErrorCode::BadOption);
}

TEST(Model, DoesNotChangeWithTheSceneItWasBuiltFrom) {
    Scene scene = MakeNamedTorus();
    Scene const before = scene;
    Model const model = Model::Build(scene);
    scene.positions[0] += 1.0;
    scene.uvs[0] += 1.0;
    EXPECT_EQ(model.GetPositions(), before.positions);
    EXPECT_EQ(model.GetUVs(), before.uvs);
}

TEST(Model, SharesAllButPositionsWithOneOfOtherPoints) {
    Model const model = Model::Build(MakeNamedTorus());
    std::vector<double> const moved(model.GetPositions().size(), 0.5);
    Model const other = model.WithPoints(moved, "34cd");
    EXPECT_EQ(&other.GetRefiner(), &model.GetRefiner());
    EXPECT_EQ(&other.GetCage(), &model.GetCage());
    EXPECT_EQ(&other.GetUVs(), &model.GetUVs());
    EXPECT_EQ(other.GetPositions(), moved);
    EXPECT_EQ(other.GetSha256(), "34cd");
}

TEST(Model, NeverShowsPositionsItNoLongerHas) {
    Model const model = Model::Build(MakeNamedTorus());
    auto const before = MakeNamedTorus().positions;
    Model const other = model.WithPoints(std::vector<double>(before.size(), 0.5));
    EXPECT_EQ(other.MakeScene().positions, other.GetPositions());
    EXPECT_NE(other.GetSha256(), model.GetSha256());
    EXPECT_EQ(model.GetPositions(), before);
    EXPECT_EQ(model.MakeScene().positions, before);
}

TEST(Model, FromArraysHasTheChecksumOfItsContent) {
    Scene scene = MakeNamedTorus();
    scene.sha256.clear();
    std::string const sha256 = Model::Build(scene).GetSha256();
    EXPECT_EQ(sha256, engine::HashContent(scene, scene.positions));
    EXPECT_EQ(Model::Build(scene).GetSha256(), sha256);
    scene.positions[0] += 1.0;
    EXPECT_NE(Model::Build(scene).GetSha256(), sha256);
}

TEST(Model, OfAChangedSceneIsNotTakenForItsFile) {
    Model const model = Model::Build(MakeNamedTorus());
    Scene scene = model.MakeScene();
    scene.positions[0] += 1.0;
    EXPECT_NE(Model::Build(scene).GetSha256(), model.GetSha256());
}

TEST(Model, OutlivesTheOneItSharesWith) {
    auto const makeOther = [] {
        Model const model = Model::Build(MakeNamedTorus());
        return model.WithPoints(std::vector<double>(model.GetPositions().size(), 0.5));
    };
    EXPECT_EQ(makeOther().GetRefiner().GetLevel(0).GetNumFaces(), 24);
}

TEST(Model, FromArraysGoesByItsName) {
    Scene scene;
    scene.name = "triangle";
    scene.cage.numVertices = 3;
    scene.cage.faceSizes = {3};
    scene.cage.faceVertices = {0, 1, 2};
    scene.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    EXPECT_EQ(Model::Build(scene).GetPath(), "triangle");
}

// -------- what is refused

struct Refusal {
    std::string name;
    void (*damage)(Scene&);
    std::string message;
    friend std::ostream& operator<<(std::ostream& out, Refusal const& r) { return out << r.name; }
};

class ModelRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(ModelRefuses, AndNamesMeshThingAndValue) {
    Scene scene = MakeNamedTorus();
    GetParam().damage(scene);
    EXPECT_EQ(test::RefusalOf([&] { Model::Build(scene); }), GetParam().message);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    Scenes, ModelRefuses,
    testing::Values(
        Refusal{"IndexOfNoVertex", [](Scene& s) { s.cage.faceVertices[0] = 24; },
                "models/torus.obj: face 0 uses vertex 24; there are 24 vertices"},
        Refusal{"TooFewPositions", [](Scene& s) { s.positions.pop_back(); },
                "models/torus.obj: positions: 71 values; 72 are needed"},
        Refusal{"PositionThatIsNone", [](Scene& s) { s.positions[4] = kNan; },
                "models/torus.obj: position of vertex 1 is nan; a finite number is needed"},
        Refusal{"UVsWithoutTopology", [](Scene& s) { s.cage.fvarChannels.clear(); },
                "models/torus.obj: texture coordinates: 70 values; 0 are needed"},
        Refusal{"InfiniteUV", [](Scene& s) { s.uvs[3] = 1 / 0.0; },
                "models/torus.obj: texture coordinate 1 is inf; a finite number is needed"},
        Refusal{"ShortPrimvar", [](Scene& s) { s.primvars = {{"mass", 2, {1.0f}}}; },
                "models/torus.obj: primvar 'mass': 1 values; 48 are needed"},
        Refusal{"PrimvarOfNothing", [](Scene& s) { s.primvars = {{"mass", 0, {}}}; },
                "models/torus.obj: primvar 'mass' has 0 channels; at least 1 is needed"},
        Refusal{"GroupsOfOtherFaces", [](Scene& s) { s.groups[0] = {{"skin"}, {0, 0}}; },
                "models/torus.obj: groups of faces: 2 values; 24 are needed"},
        Refusal{"GroupThatIsNone",
                [](Scene& s) { s.groups[0] = {{"skin"}, std::vector<Index>(24, 1)}; },
                "models/torus.obj: face 0 is in group 1; there are 1"},
        Refusal{"CreaseWithoutSharpness", [](Scene& s) { s.cage.creaseVertexPairs = {0, 1}; },
                "models/torus.obj: creases: 2 vertices and 0 sharpnesses; each needs two and one"},
        Refusal{"FarPosition", [](Scene& s) { s.positions[5] = -1e31; },
                "models/torus.obj: position of vertex 1 is -1e+31; at most 1e+30 in magnitude is "
                "possible"},
        Refusal{"FarUV", [](Scene& s) { s.uvs[5] = 1e308; },
                "models/torus.obj: texture coordinate 2 is 1e+308; at most 1e+30 in magnitude is "
                "possible"},
        Refusal{"PrimvarOfNoNumber",
                [](Scene& s) {
                    s.primvars = {{"mass", 2, std::vector<float>(48, 1.0f)}};
                    s.primvars[0].values[7] = static_cast<float>(kNan);
                },
                "models/torus.obj: primvar 'mass' of vertex 3 is nan; at most 1e+30 in magnitude "
                "is possible"},
        Refusal{"ShortNormals", [](Scene& s) { s.normals = {0, 0, 1}; },
                "models/torus.obj: normals: 3 values; 72 are needed"},
        Refusal{"LinesOfOtherFaces", [](Scene& s) { s.faceLines = {1, 2}; },
                "models/torus.obj: lines of faces: 2 values; 24 are needed"},
        Refusal{"ManyVertices", [](Scene& s) { s.cage.numVertices = 2000000000; },
                "models/torus.obj: positions: 72 values; 6000000000 are needed"},
        Refusal{"Nameless", [](Scene& s) { s.path = s.name = "", s.positions.clear(); },
                "mesh: positions: 0 values; 72 are needed"},
        Refusal{"NoVertices", [](Scene& s) { s.cage.numVertices = -1; },
                "models/torus.obj: the mesh has no vertices"}),
    [](testing::TestParamInfo<Refusal> const& instance) { return instance.param.name; });

TEST(Model, RefusesPointsThatAreNoneOrTooFew) {
    Model const model = Model::Build(MakeNamedTorus());
    EXPECT_EQ(test::RefusalOf([&] { model.WithPoints(std::vector<double>(9, 0.0)); }),
              "models/torus.obj: positions: 9 values; 72 are needed");
    auto positions = model.GetPositions();
    positions.back() = 2e30;
    EXPECT_EQ(test::RefusalOf([&] { model.WithPoints(positions); }),
              "models/torus.obj: position of vertex 23 is 2e+30; at most 1e+30 in magnitude is "
              "possible");
    positions.back() = kNan;
    EXPECT_EQ(test::RefusalOf([&] { model.WithPoints(positions); }),
              "models/torus.obj: position of vertex 23 is nan; a finite number is needed");
}

}  // namespace
}  // namespace limn
