// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/mesh_info.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/scene/weld.h"
#include "far_ext/topology/refiner.h"
#include "support/mesh_info.h"
#include "support/meshes.h"
#include "support/readers.h"

namespace limn {
namespace {

using engine::MeshInfo;
using engine::Scene;
using test::Describe;

engine::Defect const* FindDefect(MeshInfo const& info, std::string const& kind) {
    for (auto const& defect : info.defects) {
        if (defect.kind == kind) return &defect;
    }
    return nullptr;
}

size_t CountDefects(MeshInfo const& info, std::string const& kind) {
    auto const* const defect = FindDefect(info, kind);
    return defect ? defect->count : 0;
}

// -------- what another program measured of the assets

struct Facts {
    std::string path;
    Index vertices, faces;
    int components, boundaryLoops, genus;  // genus -1: not manifold or not orientable
    int minValence, maxValence;
    bool hasUVs;
    size_t flippedFaces, zeroAreaFaces;
};

void PrintTo(Facts const& facts, std::ostream* out) {
    *out << facts.path;
}

std::string NameOf(testing::TestParamInfo<Facts> const& info) {
    return test::NameInstance(info.param.path);
}

void ExpectFacts(MeshInfo const& info, Facts const& facts) {
    EXPECT_EQ(info.vertices, facts.vertices);
    EXPECT_EQ(info.faces, facts.faces);
    EXPECT_EQ(info.components, facts.components);
    EXPECT_EQ(info.boundaryLoops, facts.boundaryLoops);
    EXPECT_EQ(info.genus.value_or(-1), facts.genus);
    EXPECT_EQ(info.minValence, facts.minValence);
    EXPECT_EQ(info.maxValence, facts.maxValence);
    EXPECT_EQ(info.uv.present, facts.hasUVs);
    EXPECT_EQ(info.uv.flippedFaces, facts.flippedFaces);
    EXPECT_EQ(info.uv.zeroAreaFaces, facts.zeroAreaFaces);
    Index sum = 0;
    for (auto const& [size, count] : info.facesBySize) sum += count;
    EXPECT_EQ(sum, facts.faces);
}

class InfoOfShape : public testing::TestWithParam<Facts> {};

TEST_P(InfoOfShape, AgreesWithTheTable) {
    ExpectFacts(Describe(test::LoadShape(GetParam().path)), GetParam());
}

// catmark_nonman_edges and loop_nonman_edges are left out: how many edges a face with repeated
// corners has is a matter of taste.
INSTANTIATE_TEST_SUITE_P(OpenSubdiv, InfoOfShape,
                         testing::ValuesIn(std::vector<Facts>{
                             // path, vertices, faces, components, loops, genus, valence from, to,
                             // UVs, flipped, zero area
                             {"bilinear_cube", 8, 6, 1, 0, 0, 3, 3, true, 0, 0},
                             {"bilinear_nonquads0", 8, 2, 2, 2, 0, 2, 2, true, 0, 0},
                             {"catmark_bishop", 917, 968, 2, 1, 0, 3, 24, true, 0, 0},
                             {"catmark_car", 1642, 1575, 31, 11, 7, 2, 6, true, 0, 0},
                             {"catmark_chaikin0", 24, 22, 1, 0, 0, 3, 4, true, 0, 22},
                             {"catmark_cube", 8, 6, 1, 0, 0, 3, 3, true, 0, 0},
                             {"catmark_cube_corner0", 8, 6, 1, 0, 0, 3, 3, true, 0, 0},
                             {"catmark_cube_corner2", 8, 6, 1, 0, 0, 3, 3, true, 0, 0},
                             {"catmark_cube_corner4", 8, 6, 1, 0, 0, 3, 3, true, 0, 0},
                             {"catmark_cube_creases0", 8, 6, 1, 0, 0, 3, 3, true, 0, 0},
                             {"catmark_cube_creases2", 8, 6, 1, 0, 0, 3, 3, true, 0, 0},
                             {"catmark_cubes_semisharp", 32, 24, 4, 0, 0, 3, 3, true, 0, 0},
                             {"catmark_dart_edgecorner", 25, 16, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_dart_edgeonly", 25, 16, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_edgecorner", 52, 28, 4, 4, 0, 2, 4, true, 0, 0},
                             {"catmark_edgenone", 64, 36, 4, 4, 0, 2, 4, true, 0, 0},
                             {"catmark_edgeonly", 40, 20, 4, 4, 0, 2, 4, true, 0, 0},
                             {"catmark_fan", 22, 13, 1, 1, -1, 2, 6, true, 0, 0},
                             {"catmark_flap", 8, 3, 1, 1, 0, 2, 3, true, 1, 0},
                             {"catmark_fvar_bound0", 25, 16, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_fvar_bound2", 25, 16, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_fvar_bound4", 9, 4, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_gregory_test0", 7, 3, 1, 1, 0, 2, 3, true, 0, 0},
                             {"catmark_gregory_test2", 9, 4, 1, 1, 0, 2, 5, true, 0, 0},
                             {"catmark_gregory_test4", 12, 8, 1, 1, -1, 3, 4, true, 0, 0},
                             {"catmark_gregory_test6", 20, 13, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_helmet", 72, 58, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_hole_test1", 8, 6, 1, 0, 0, 3, 3, true, 0, 0},
                             {"catmark_hole_test3", 24, 16, 1, 1, 0, 2, 5, true, 0, 0},
                             {"catmark_inf_crease0", 25, 16, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_lefthanded", 436, 434, 1, 0, 0, 3, 5, true, 125, 184},
                             {"catmark_nonman_verts", 49, 20, 4, 6, -1, 2, 8, true, 0, 0},
                             {"catmark_nonquads", 33, 17, 4, 4, 0, 2, 4, true, 0, 0},
                             {"catmark_pole64", 129, 128, 1, 1, 0, 3, 64, false, 0, 0},
                             {"catmark_pole8", 17, 16, 1, 1, 0, 3, 8, false, 0, 0},
                             {"catmark_pyramid", 5, 5, 1, 0, 0, 3, 4, true, 5, 0},
                             {"catmark_pyramid_creases0", 5, 5, 1, 0, 0, 3, 4, true, 1, 0},
                             {"catmark_quadstrips", 126, 52, 11, 11, 0, 2, 4, true, 0, 0},
                             {"catmark_righthanded", 436, 434, 1, 0, 0, 3, 5, true, 125, 184},
                             {"catmark_smoothtris0", 42, 80, 1, 0, 0, 5, 20, true, 0, 0},
                             {"catmark_square_hedit0", 16, 9, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_tent", 16, 9, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_tent_creases0", 16, 9, 1, 1, 0, 2, 4, true, 0, 0},
                             {"catmark_toroidal_tet", 20, 24, 1, 0, 3, 4, 6, true, 0, 0},
                             {"catmark_torus", 32, 32, 1, 0, 1, 4, 4, true, 0, 0},
                             {"catmark_torus_creases0", 32, 32, 1, 0, 1, 4, 4, true, 0, 0},
                             {"catmark_val2_interior", 103, 56, 9, 8, 0, 2, 6, true, 0, 1},
                             {"catmark_xord_interior", 151, 71, 9, 9, 0, 2, 12, true, 0, 0},
                             {"loop_chaikin0", 24, 44, 1, 0, 0, 4, 6, true, 0, 44},
                             {"loop_cube", 14, 24, 1, 0, 0, 4, 6, true, 0, 0},
                             {"loop_cube_creases0", 8, 12, 1, 0, 0, 4, 5, true, 0, 0},
                             {"loop_cubes_semisharp", 56, 96, 4, 0, 0, 4, 6, true, 0, 0},
                             {"loop_fvar_bound0", 19, 24, 1, 1, 0, 3, 6, true, 0, 0},
                             {"loop_fvar_bound2", 19, 24, 1, 1, 0, 3, 6, true, 0, 0},
                             {"loop_icosahedron", 12, 20, 1, 0, 0, 5, 5, true, 0, 0},
                             {"loop_pole8", 17, 24, 1, 1, 0, 4, 8, false, 0, 0},
                             {"loop_saddle_edgecorner", 6, 4, 1, 1, 0, 2, 4, true, 0, 0},
                             {"loop_tetrahedron", 4, 4, 1, 0, 0, 3, 3, true, 0, 0},
                             {"loop_toroidal_tet", 32, 72, 1, 0, 3, 6, 8, true, 0, 0},
                             {"loop_triangle_edgeonly", 36, 34, 4, 4, 0, 2, 6, true, 0, 0},
                             {"loop_val2_interior", 15, 10, 3, 2, -1, 2, 6, true, 0, 0},
                             {"loop_xord_interior", 78, 69, 9, 9, 0, 3, 12, true, 0, 0}}),
                         NameOf);

class InfoOfAsset : public testing::TestWithParam<Facts> {};

TEST_P(InfoOfAsset, AgreesWithTheTable) {
    ExpectFacts(Describe(test::LoadAsset(GetParam().path)), GetParam());
}

// path, vertices, faces, components, loops, genus, valence from, to, UVs, flipped, zero area
INSTANTIATE_TEST_SUITE_P(
    Public, InfoOfAsset,
    testing::ValuesIn(std::vector<Facts>{
        {"control/penguin_control_mesh.obj", 201, 221, 1, 0, 0, 3, 8, false, 0, 0},
        {"control/pyramid_corners.obj", 20, 24, 1, 0, 3, 4, 6, true, 0, 0},
        {"control/pyramid_edge_creases.obj", 20, 24, 1, 0, 3, 4, 6, true, 0, 0},
        {"udim/grid_with_udims.obj", 16, 9, 1, 1, 0, 2, 4, true, 0, 0},
        {"udim/plane_3_udims.obj", 9, 4, 1, 1, 0, 2, 4, true, 0, 0},
        {"tri/3torus.off", 19, 23, 1, 0, 3, 4, 8, false, 0, 0},
        {"tri/anchor.off", 519, 1050, 1, 0, 4, 4, 34, false, 0, 0},
        {"tri/bob_small.ply", 250, 500, 1, 0, 1, 4, 9, false, 0, 0},
        {"tri/cat_head.obj", 131, 248, 1, 1, 0, 3, 11, false, 0, 0},
        {"tri/dodecahedron_poly.obj", 20, 12, 1, 0, 0, 3, 3, false, 0, 0},
        {"tri/eight.off", 315, 634, 1, 0, 2, 4, 9, false, 0, 0},
        {"tri/elephant-with-holes.off", 2798, 4463, 1, 106, 3, 2, 9, false, 0, 0},
        {"tri/hourglass_ico.obj", 23, 40, 1, 0, -1, 5, 10, false, 0, 0},
        {"tri/mechpart_loop_control.obj", 115, 238, 1, 0, 3, 3, 16, false, 0, 0},
        {"tri/moebius.obj", 280, 224, 1, 1, -1, 3, 4, false, 0, 0},
        {"tri/pig.off", 468, 891, 1, 7, 0, 3, 9, false, 0, 0},
        {"tri/spot_low_resolution.obj", 829, 1654, 1, 0, 0, 3, 8, false, 0, 0},
        {"tri/torus3_genus3.obj", 864, 1728, 3, 0, 3, 6, 6, false, 0, 0},
        {"tri/torus_quad.off", 25, 25, 1, 0, 1, 4, 4, false, 0, 0}}),
    NameOf);

#ifdef LIMN_ASSETS
INSTANTIATE_TEST_SUITE_P(
    Larger, InfoOfAsset,
    testing::ValuesIn(std::vector<Facts>{
        {"control/chess_knight.obj", 5596, 5592, 2, 0, 0, 3, 8, true, 0, 864},
        {"control/chess_rook.obj", 15270, 15264, 5, 0, 2, 3, 12, true, 0, 0},
        {"control/fancy_teapot.obj", 6072, 6120, 2, 0, 2, 3, 32, true, 0, 0},
        {"control/ict_face_neutral.obj", 26719, 26384, 56, 23, 0, 2, 32, true, 3099, 0},
        {"control/ict_head_skin.obj", 11248, 11144, 1, 4, 0, 3, 5, true, 0, 0},
        {"control/pixar_bottom_panel_creases.obj", 436, 434, 1, 0, 0, 3, 5, true, 127, 180},
        {"control/shaderball_surface.obj", 5914, 5838, 38, 0, 0, 3, 12, true, 0, 3456},
        {"control/spot_quadrangulated.obj", 2930, 2928, 1, 0, 0, 3, 6, true, 88, 0},
        {"tri/blobby_3cc.off", 1820, 3417, 3, 4, 0, 2, 9, false, 0, 0},
        {"tri/cactus.off", 620, 1236, 1, 0, 0, 4, 14, false, 0, 0},
        {"tri/cowhead.obj", 4537, 9024, 1, 1, 0, 3, 8, false, 0, 0},
        {"tri/double-torus.obj", 3070, 6144, 1, 0, 2, 6, 8, false, 0, 0},
        {"tri/elephant.off", 2775, 5558, 1, 0, 3, 4, 9, false, 0, 0},
        {"tri/goathead.obj", 2763, 5522, 1, 0, 0, 4, 8, false, 0, 0},
        {"tri/hand_lowres.obj", 810, 1602, 1, 1, 0, 3, 8, false, 0, 0},
        {"tri/head.off", 1487, 2918, 1, 3, 0, 4, 18, false, 0, 0},
        {"tri/hemisphere.obj", 2051, 4000, 1, 1, 0, 4, 6, false, 0, 0},
        {"tri/hexaSphere_polygons.obj", 1760, 882, 1, 0, 0, 3, 3, false, 0, 0},
        {"tri/hexagon.obj", 3169, 6144, 1, 1, 0, 3, 6, false, 0, 0},
        {"tri/kitten.obj", 9447, 18894, 1, 0, 1, 5, 8, false, 0, 0},
        {"tri/koala_low_resolution.obj", 3560, 7116, 1, 0, 0, 4, 8, false, 0, 0},
        {"tri/mannequin-devil.off", 12977, 25888, 1, 1, 0, 2, 12, false, 0, 0},
        {"tri/rotor.off", 600, 1200, 1, 0, 1, 4, 13, false, 0, 0},
        {"tri/soccerball.obj", 28740, 57600, 1, 0, 31, 3, 8, false, 0, 0},
        {"tri/torus.obj", 3840, 7680, 1, 0, 1, 4, 8, false, 0, 0}}),
    NameOf);

TEST(Larger, AFaceIsSpreadOverSevenTilesAndOverlapsWhereItsSkinDoesNot) {
    auto const face = Describe(test::LoadAsset("control/ict_face_neutral.obj")).uv,
               skin = Describe(test::LoadAsset("control/ict_head_skin.obj")).uv;
    EXPECT_EQ(face.tiles, (std::vector<int>{1001, 1002, 1003, 1004, 1005, 1006, 1007}));
    EXPECT_EQ(skin.tiles, (std::vector<int>{1001, 1002}));
    EXPECT_GT(face.overlapFaces, 1000u);  // left and right parts share texture space
    EXPECT_EQ(skin.overlapFaces, 0u);
}
#endif

TEST(MeshInfo, SpotAgreesWithTheTable) {
    ExpectFacts(Describe(test::LoadSpot()), {"spot.obj", 188, 180, 1, 0, 0, 3, 6, true, 5, 0});
}

TEST(MeshInfo, AssetsHaveTheTilesOfTheTable) {
    // Its polygons reach into 1002 and 1011, their limit does not.
    EXPECT_EQ(Describe(test::LoadShape("catmark_righthanded")).uv.tiles, (std::vector<int>{1001}));
    EXPECT_EQ(Describe(test::LoadSpot()).uv.tiles, (std::vector<int>{1001}));
    EXPECT_EQ(Describe(test::LoadAsset("udim/plane_3_udims.obj")).uv.tiles,
              (std::vector<int>{1001, 1002, 1003}));
}

TEST(MeshInfo, AssetsHaveTheCreasesOfTheTable) {
    EXPECT_EQ(Describe(test::LoadAsset("tri/mechpart_loop_control.obj")).creases, 113u);
    EXPECT_EQ(Describe(test::LoadAsset("control/pyramid_edge_creases.obj")).creases, 6u);
    EXPECT_EQ(Describe(test::LoadAsset("control/pyramid_corners.obj")).corners, 2u);
}

// -------- topology of made meshes

TEST(MeshInfo, CubeIsASphere) {
    // V - E + F = 8 - 12 + 6 = 2 = 2 - 2 genus
    MeshInfo const info = Describe(test::MakeCube());
    EXPECT_EQ(info.edges, 12);
    EXPECT_EQ(info.facesBySize, (std::map<int, Index>{{4, 6}}));
    EXPECT_EQ(info.eulerCharacteristic, 2);
    EXPECT_EQ(info.genus, 0);
    EXPECT_EQ(info.boundaryLoops, 0);
    EXPECT_EQ(info.minValence, 3);
    EXPECT_EQ(info.maxValence, 3);
    EXPECT_TRUE(info.defects.empty());
    EXPECT_FALSE(info.uv.present);
}

TEST(MeshInfo, TorusHasGenusOne) {
    for (Scene const& scene : {test::MakeTorus(8, 5), test::MakeTriangleTorus(8, 5)}) {
        MeshInfo const info = Describe(scene);
        EXPECT_EQ(info.eulerCharacteristic, 0);
        EXPECT_EQ(info.genus, 1);
    }
}

TEST(MeshInfo, FanIsADiscWithOneExtraordinaryVertex) {
    for (int valence : {3, 5, 8, 12}) {
        MeshInfo const info = Describe(test::MakeFan(valence, Sdc::SCHEME_CATMARK, 0.1, 0.2));
        EXPECT_EQ(info.eulerCharacteristic, 1);  // 2 - loops
        EXPECT_EQ(info.boundaryLoops, 1);
        EXPECT_EQ(info.genus, 0);
        EXPECT_EQ(info.maxValence, std::max(4, valence));
        EXPECT_EQ(info.minValence, 2);  // the corners of the rim
    }
}

/// A strip of n quads whose ends meet, turned over by half a turn where `isTwisted`.
Scene MakeBand(int n, bool isTwisted) {
    std::vector<double> positions;
    std::vector<std::vector<Index>> faces;
    for (int i = 0; i < n; ++i) {
        double const a = 2 * std::acos(-1.0) * i / n;
        positions.insert(positions.end(),
                         {std::cos(a), std::sin(a), 0, std::cos(a), std::sin(a), 1});
        int const next = (i + 1) % n;
        bool const isTurned = isTwisted && next == 0;
        faces.push_back(
            {2 * i, 2 * next + (isTurned ? 1 : 0), 2 * next + (isTurned ? 0 : 1), 2 * i + 1});
    }
    return test::MakeScene(std::move(positions), faces);
}

TEST(MeshInfo, BandHasTwoRimsAndAMoebiusBandOne) {
    MeshInfo const band = Describe(MakeBand(7, false)), moebius = Describe(MakeBand(7, true));
    EXPECT_EQ(band.boundaryLoops, 2);
    EXPECT_EQ(band.genus, 0);  // chi = 0 = 2 - 2 loops
    EXPECT_EQ(CountDefects(band, "not_orientable"), 0u);
    EXPECT_EQ(moebius.boundaryLoops, 1);
    EXPECT_FALSE(moebius.genus);
    EXPECT_EQ(CountDefects(moebius, "not_orientable"), 1u);
    EXPECT_EQ(CountDefects(moebius, "winding"), 0u);
}

TEST(MeshInfo, MoebiusAssetCannotBeOriented) {
    MeshInfo const info = Describe(test::LoadAsset("tri/moebius.obj"));
    EXPECT_EQ(CountDefects(info, "not_orientable"), 4u);  // the table: 4 winding flips
}

TEST(MeshInfo, FaceWoundTheOtherWayIsADefectThatTurningCures) {
    Scene scene = test::MakeCube();
    std::swap(scene.cage.faceVertices[1], scene.cage.faceVertices[3]);
    MeshInfo const info = Describe(scene);
    EXPECT_EQ(CountDefects(info, "winding"), 4u);  // its four edges
    EXPECT_EQ(CountDefects(info, "not_orientable"), 0u);
    EXPECT_EQ(info.genus, 0);
    EXPECT_NE(FindDefect(info, "winding")->message.find("turn the faces of one side round"),
              std::string::npos);
}

TEST(MeshInfo, EdgeOfThreeFacesIsNotManifold) {
    MeshInfo const info = Describe(test::LoadData("malformed/nonmanifold_edge.obj"));
    EXPECT_EQ(CountDefects(info, "non_manifold_edge"), 1u);
    EXPECT_FALSE(info.genus);
    auto const* const defect = FindDefect(info, "non_manifold_edge");
    EXPECT_GT(defect->line, 0u);
    EXPECT_NE(defect->message.find("edge 3 5 with 3"), std::string::npos) << defect->message;
}

TEST(MeshInfo, PointWhereTwoSurfacesTouchIsNotManifold) {
    // Two triangles that share vertex 0 only.
    MeshInfo const info = Describe(
        test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, -1, 0, 0, -1, -1, 0}, {{0, 1, 2}, {0, 3, 4}}));
    EXPECT_EQ(CountDefects(info, "non_manifold_vertex"), 1u);
    EXPECT_EQ(FindDefect(info, "non_manifold_vertex")->element, 0);
    EXPECT_FALSE(info.genus);
}

TEST(MeshInfo, TablesCountNonManifoldPlaces) {
    EXPECT_EQ(CountDefects(Describe(test::LoadShape("catmark_fan")), "non_manifold_edge"), 4u);
    MeshInfo const vertices = Describe(test::LoadShape("catmark_nonman_verts"));
    EXPECT_EQ(CountDefects(vertices, "non_manifold_vertex"), 4u);
    EXPECT_EQ(CountDefects(vertices, "unreferenced_vertex"), 1u);
}

TEST(MeshInfo, UnusedVertexIsNamedAndNoPartOfTheSurface) {
    Scene scene = test::MakeCube();
    scene.positions.insert(scene.positions.end(), {9, 9, 9});
    ++scene.cage.numVertices;
    MeshInfo const info = Describe(scene);
    EXPECT_EQ(info.vertices, 9);
    EXPECT_EQ(info.eulerCharacteristic, 2);
    EXPECT_EQ(info.components, 1);
    EXPECT_EQ(info.minValence, 3);
    EXPECT_EQ(CountDefects(info, "unreferenced_vertex"), 1u);
    EXPECT_EQ(FindDefect(info, "unreferenced_vertex")->element, 8);
}

TEST(MeshInfo, RepeatedCornerIsNamedWithItsLine) {
    MeshInfo const info = Describe(test::LoadData("malformed/box_longline.obj"));
    ASSERT_NE(FindDefect(info, "repeated_corner"), nullptr);
    EXPECT_EQ(FindDefect(info, "repeated_corner")->element, 0);
    EXPECT_EQ(FindDefect(info, "repeated_corner")->line, 24u);
}

TEST(MeshInfo, FacesThatStandTwiceAreNamedWithTheirTwins) {
    Scene scene = test::MakeCube();
    auto const& vertices = scene.cage.faceVertices;
    // Face 2 turned on, and turned over; face 0 as it is.
    std::vector<Index> const twins{vertices[9],  vertices[10], vertices[11], vertices[8],
                                   vertices[11], vertices[10], vertices[9],  vertices[8],
                                   vertices[0],  vertices[1],  vertices[2],  vertices[3]};
    scene.cage.faceVertices.insert(scene.cage.faceVertices.end(), twins.begin(), twins.end());
    scene.cage.faceSizes.resize(9, 4);
    MeshInfo const info = Describe(scene);
    ASSERT_EQ(CountDefects(info, "doubled_face"), 3u);
    EXPECT_EQ(FindDefect(info, "doubled_face")->element, 6);
    EXPECT_EQ(
        FindDefect(info, "doubled_face")->message,
        "3 faces have the vertices of another one, first face 6 those of face 2; leave one out "
        "unless both are meant");
}

TEST(MeshInfo, FacesThatShareVerticesWithoutBeingTheSameAreNotDoubled) {
    // Three of four vertices, and the same number of others.
    MeshInfo const info = Describe(test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 2, 2},
                                                   {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 2, 3}}));
    EXPECT_EQ(CountDefects(info, "doubled_face"), 0u);
    for (char const* name : {"catmark_cube", "catmark_torus", "loop_icosahedron"})
        EXPECT_EQ(CountDefects(Describe(test::LoadShape(name)), "doubled_face"), 0u) << name;
}

TEST(MeshInfo, BoundaryVerticesThatCoincideAreCountedWithTheCure) {
    // Three quads: two touch along an edge, a third in one of its points.
    Scene scene = test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 0, 2, 0,
                                   0, 2, 1, 0, 1, 1, 0, 1, 1, 0, 2, 2, 0, 1, 2, 0},
                                  {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10}});
    scene.faceLines = {7, 8, 9};
    MeshInfo const info = Describe(scene);
    ASSERT_EQ(CountDefects(info, "coincident_vertices"), 5u);
    auto const* const defect = FindDefect(info, "coincident_vertices");
    EXPECT_EQ(defect->element, 1);
    EXPECT_EQ(defect->line, 7u);
    EXPECT_EQ(
        defect->message,
        "5 boundary vertices coincide with others, first vertex 1 with 4: sheets that only touch "
        "come apart as they are subdivided; `weld` 0 joins them");
}

TEST(MeshInfo, WeldingIsNotAdvisedWhereItWouldJoinNothing) {
    // Three quads along one edge, as the pages of a book, none joined with another.
    Scene const book = test::MakeScene({0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0, 0,  0, 0, 0,  0, 1,
                                        0, 1, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1, -1, 0, 1, -1, 0, 0},
                                       {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}});
    auto const* const defect = FindDefect(Describe(book), "coincident_vertices");
    ASSERT_TRUE(defect);
    EXPECT_TRUE(defect->message.ends_with("`weld` 0 can join none of them as they are"))
        << defect->message;
    EXPECT_EQ(engine::Weld(book, 0.0).cage.numVertices, book.cage.numVertices);
}

TEST(MeshInfo, VerticesThatCoincideWithinSurfacesAreNoDefect) {
    // A closed cube beside one vertex of which a triangle begins; a vertex that no face uses.
    Scene scene = test::MakeCube();
    scene.positions.insert(scene.positions.end(), {-1, -1, -1, -2, -1, -1, -1, -2, -1, -2, -1, -1});
    scene.cage.faceVertices.insert(scene.cage.faceVertices.end(), {8, 9, 10});
    scene.cage.faceSizes.push_back(3);
    scene.cage.numVertices = 12;
    EXPECT_EQ(CountDefects(Describe(scene), "coincident_vertices"), 0u);
}

TEST(MeshInfo, CreaseWithoutAnEdgeIsNamed) {
    Scene scene = test::MakeCube();
    scene.cage.creaseVertexPairs = {0, 1, 0, 6};  // 0 6 is a diagonal
    scene.cage.creaseSharpness = {1, 2};
    MeshInfo const info = Describe(scene);
    EXPECT_EQ(info.creases, 2u);
    ASSERT_EQ(CountDefects(info, "crease_without_edge"), 1u);
    EXPECT_NE(FindDefect(info, "crease_without_edge")->message.find("0 6"), std::string::npos);
}

TEST(MeshInfo, CountsTagsAndListsGroups) {
    Scene scene = test::MakeCube();
    scene.cage.cornerVertices = {0, 1};
    scene.cage.cornerSharpness = {1, 2};
    scene.cage.holes = {3};
    scene.groups[0] = {{"red", "blue"}, {0, 0, 0, 1, 1, 1}};
    scene.groups[1] = {{"left"}, {0, 0, 0, 0, 0, 0}};
    MeshInfo const info = Describe(scene);
    EXPECT_EQ(info.corners, 2u);
    EXPECT_EQ(info.holes, 1u);
    EXPECT_EQ(info.groups, (std::vector<std::string>{"red", "blue", "left"}));
}

}  // namespace
}  // namespace limn
