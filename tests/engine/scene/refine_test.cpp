// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/refine.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "far_ext/error.h"
#include "support/meshes.h"

namespace limn {
namespace {

using Point = std::array<double, 3>;

std::vector<Point> PointsOf(engine::Scene const& scene) {
    std::vector<Point> points;
    for (size_t v = 0; v < scene.positions.size(); v += 3) {
        points.push_back({scene.positions[v], scene.positions[v + 1], scene.positions[v + 2]});
    }
    return points;
}

/// Largest distance from a point of `from` to the nearest one of `to`.
double FarthestFrom(std::vector<Point> const& from, std::vector<Point> const& to) {
    double worst = 0.0;
    for (Point const& p : from) {
        double nearest = 1e30;
        for (Point const& q : to) {
            nearest = std::min(nearest, std::pow(p[0] - q[0], 2) + std::pow(p[1] - q[1], 2) +
                                            std::pow(p[2] - q[2], 2));
        }
        worst = std::max(worst, std::sqrt(nearest));
    }
    return worst;
}

/// The edits of this cage, a tag that today's OpenSubdiv ignores, set in after the first
/// refinement.
bool HasHierarchicalEdits(std::string const& name, int level) {
    return name == "catmark_square_hedit0" && level > 0;
}

class BaselineOf : public testing::TestWithParam<std::string> {};

// NAME_levelN.obj holds NAME after N + 1 refinements by an independent library, in another vertex
// order.
TEST_P(BaselineOf, IsMet) {
    std::string const file = GetParam();
    std::string const name = file.substr(0, file.rfind("_level"));
    int const level = file[file.rfind("_level") + 6] - '0';
    if (HasHierarchicalEdits(name, level))
        GTEST_SKIP() << "hierarchical edits have no effect today";
    engine::Scene scene = test::LoadData("opensubdiv_shapes/" + name + ".obj");
    if (name.starts_with("loop")) scene.cage.scheme = Sdc::SCHEME_LOOP;
    if (name.starts_with("bilinear")) scene.cage.scheme = Sdc::SCHEME_BILINEAR;
    if (!scene.hasBoundaryTag)
        scene.cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto const fine = engine::RefineUniformly(scene, level + 1, false);
    auto const baseline = test::LoadData("opensubdiv_hbr_baseline/" + file);
    EXPECT_EQ(fine.cage.GetNumFaces(), baseline.cage.GetNumFaces());
    EXPECT_EQ(fine.cage.numVertices, baseline.cage.numVertices);
    auto const ours = PointsOf(fine), theirs = PointsOf(baseline);
    EXPECT_LT(FarthestFrom(theirs, ours), 1e-5);
    EXPECT_LT(FarthestFrom(ours, theirs), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(OpenSubdiv, BaselineOf,
                         testing::ValuesIn(test::ListData("opensubdiv_hbr_baseline")),
                         [](testing::TestParamInfo<std::string> const& file) {
                             return file.param.substr(0, file.param.find('.'));
                         });

// V' = V + E + F, E' = 2 E + 4 F on quads: a cube (8, 12, 6) becomes 26, then 98 vertices.
TEST(Refine, CountsFollowTheSplit) {
    EXPECT_EQ(engine::RefineUniformly(test::MakeCube(), 1, false).cage.numVertices, 26);
    EXPECT_EQ(engine::RefineUniformly(test::MakeCube(), 2, false).cage.numVertices, 98);
    EXPECT_EQ(engine::RefineUniformly(test::MakeCube(), 0, false).positions,
              test::MakeCube().positions);
}

// Refining once twice is refining twice once, up to the order of vertices: tags, UVs and positions
// carry over.
TEST(Refine, LevelsCompose) {
    for (char const* name :
         {"catmark_cubes_semisharp.obj", "catmark_dart_edgeonly.obj", "catmark_hole_test3.obj"}) {
        auto const scene = test::LoadData(std::string("opensubdiv_shapes/") + name);
        auto const once = engine::RefineUniformly(scene, 2, false);
        auto const twice =
            engine::RefineUniformly(engine::RefineUniformly(scene, 1, false), 1, false);
        ASSERT_EQ(once.cage.numVertices, twice.cage.numVertices) << name;
        EXPECT_LT(FarthestFrom(PointsOf(once), PointsOf(twice)), 1e-7) << name;
        EXPECT_EQ(once.uvs.size(), twice.uvs.size());
        auto const sum = [](auto const& values) {
            return std::accumulate(values.begin(), values.end(), 0.0);
        };
        EXPECT_NEAR(sum(once.uvs), sum(twice.uvs), 1e-6 * static_cast<double>(once.uvs.size()));
        EXPECT_NEAR(sum(once.cage.creaseSharpness), sum(twice.cage.creaseSharpness), 1e-3);
        EXPECT_EQ(once.cage.holes.size(), twice.cage.holes.size());
    }
}

// Limit points do not move when their cage is refined.
TEST(Refine, TheLimitStaysWhereItIs) {
    auto const scene = test::LoadData("opensubdiv_shapes/catmark_gregory_test6.obj");
    auto const coarse = engine::RefineUniformly(scene, 1, true),
               fine = engine::RefineUniformly(scene, 2, true);
    for (Index v = 0; v < 3 * coarse.cage.numVertices; ++v)
        EXPECT_NEAR(coarse.positions[v], fine.positions[v], 1e-7);
}

TEST(Refine, TooManyLevelsAreRefused) {
    EXPECT_THROW(engine::RefineUniformly(test::MakeCube(), 11, false), Error);
}

}  // namespace
}  // namespace limn
