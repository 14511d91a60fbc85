// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/subdivision_rows.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using far_ext::SubdivisionRule;
using far_ext::TunedRule;

// A scheme's table is what OpenSubdiv does to values.
TEST(SubdivisionRows, OfTheSchemeAreOpenSubdivs) {
    for (auto const& scene : {test::MakeCube(), test::MakeBipyramid(7),
                              test::MakeFan(5, Sdc::SCHEME_CATMARK, 0.1, 0.2)}) {
        auto const refiner = test::MakeRefiner(scene, 2);
        auto const rows =
            far_ext::BuildSubdivisionRows(*refiner, 1, far_ext::SubdivisionRule::Scheme);
        auto const fine = test::Apply(rows, scene.positions);
        EXPECT_LT(
            test::LargestDifference(fine, eval::RefineValues<3>(*refiner, 1, scene.positions)),
            1e-15);
    }
}

TEST(SubdivisionRows, TensionsThatARuleDoesNotHaveAreRefused) {
    auto const check = [](TunedRule const& rule) {
        return test::CodeOf([&] { far_ext::CheckTension(rule); });
    };
    for (double tension : {0.0, 1.0 / 16, 1.0 / 8})
        EXPECT_FALSE(check({SubdivisionRule::OriginalButterfly, tension}));
    for (double tension : {0.0, 1.0, 2.0}) EXPECT_FALSE(check({SubdivisionRule::Kobbelt, tension}));
    for (double tension : {-0.01, 0.126, std::nan("")})
        EXPECT_EQ(check({SubdivisionRule::OriginalButterfly, tension}), ErrorCode::BadOption);
    EXPECT_EQ(check({SubdivisionRule::Kobbelt, 2.1}), ErrorCode::BadOption);
    for (auto rule :
         {SubdivisionRule::Scheme, SubdivisionRule::Butterfly, SubdivisionRule::Interpolating})
        EXPECT_EQ(check({rule, 0.0}), ErrorCode::BadOption);
}

/// An interpolating rule and the meshes that it takes.
struct Rule {
    char const* name;
    TunedRule rule;
    bool (*takes)(engine::Scene const& scene);
};

bool IsLoop(engine::Scene const& scene) {
    return scene.cage.scheme == Sdc::SCHEME_LOOP;
}

bool HasQuads(engine::Scene const& scene) {
    return !IsLoop(scene) && std::ranges::count(scene.cage.faceSizes, 4) ==
                                 static_cast<std::ptrdiff_t>(scene.cage.faceSizes.size());
}

class InterpolatingRules : public testing::TestWithParam<Rule> {
protected:
    /// Two steps of the rule on each mesh, by its name: what is checked gets both.
    template <class Check>
    void ForEachMesh(Check check) const {
        int count = 0;
        for (auto const& [name, scene] : test::MakeFormMeshes()) {
            if (!GetParam().takes(scene)) continue;
            auto const refiner = test::MakeRefiner(scene, 2);
            SCOPED_TRACE(name);
            check(scene, *refiner);
            ++count;
        }
        EXPECT_GT(count, 20);
    }
};
INSTANTIATE_TEST_SUITE_P(
    Rules, InterpolatingRules,
    testing::Values(Rule{"Butterfly", SubdivisionRule::Butterfly, IsLoop},
                    Rule{"OriginalButterfly", SubdivisionRule::OriginalButterfly, IsLoop},
                    Rule{"TenseButterfly", {SubdivisionRule::OriginalButterfly, 0.1}, IsLoop},
                    Rule{"Kobbelt", SubdivisionRule::Kobbelt, HasQuads},
                    Rule{"TenseKobbelt", {SubdivisionRule::Kobbelt, 1.6}, HasQuads},
                    Rule{"OfLoop", SubdivisionRule::Interpolating, IsLoop},
                    Rule{"OfCatmullClark", SubdivisionRule::Interpolating,
                         [](engine::Scene const& scene) { return !IsLoop(scene); }}),
    [](auto const& test) { return test.param.name; });

TEST_P(InterpolatingRules, RowsAddUpToOne) {
    ForEachMesh([&](engine::Scene const&, Far::TopologyRefiner const& refiner) {
        for (int level : {1, 2}) {
            auto const rows = far_ext::BuildSubdivisionRows(refiner, level, GetParam().rule);
            ASSERT_EQ(rows.GetNumRows(), refiner.GetLevel(level).GetNumVertices());
            for (int row = 0; row < rows.GetNumRows(); ++row) {
                EXPECT_NEAR(std::accumulate(rows.weights.begin() + rows.offsets[row],
                                            rows.weights.begin() + rows.offsets[row + 1], 0.0),
                            1.0, 1e-14);
            }
        }
    });
}

TEST_P(InterpolatingRules, VerticesStayToTheBit) {
    ForEachMesh([&](engine::Scene const& scene, Far::TopologyRefiner const& refiner) {
        auto points = scene.positions;
        for (int level : {1, 2}) {
            auto const fine =
                test::Apply(far_ext::BuildSubdivisionRows(refiner, level, GetParam().rule), points);
            auto const coarse = refiner.GetLevel(level - 1);
            for (Index vertex = 0; vertex < coarse.GetNumVertices(); ++vertex) {
                size_t const child = static_cast<size_t>(coarse.GetVertexChildVertex(vertex));
                for (size_t c = 0; c < 3; ++c)
                    EXPECT_EQ(fine[3 * child + c], points[3 * static_cast<size_t>(vertex) + c]);
            }
            points = fine;
        }
    });
}

TEST_P(InterpolatingRules, PlanesStay) {
    ForEachMesh([&](engine::Scene const& scene, Far::TopologyRefiner const& refiner) {
        auto points = scene.positions;
        for (size_t i = 0; i < points.size(); i += 3)
            points[i + 2] = 0.3 * points[i] - 0.7 * points[i + 1] + 2.0;
        for (int level : {1, 2})
            points =
                test::Apply(far_ext::BuildSubdivisionRows(refiner, level, GetParam().rule), points);
        for (size_t i = 0; i < points.size(); i += 3)
            EXPECT_NEAR(points[i + 2], 0.3 * points[i] - 0.7 * points[i + 1] + 2.0, 1e-12);
    });
}

/// Points of level 1 by what they are children of: vertices and faces by number, edges by their
/// ends.
std::map<std::vector<Index>, std::array<double, 3>> NamePoints(Far::TopologyLevel const& coarse,
                                                               bool hasFacePoints,
                                                               std::vector<double> const& points) {
    std::map<std::vector<Index>, std::array<double, 3>> named;
    auto const name = [&](std::vector<Index> key, Index child) {
        double const* const p = &points[3 * static_cast<size_t>(child)];
        named[std::move(key)] = {p[0], p[1], p[2]};
    };
    for (Index vertex = 0; vertex < coarse.GetNumVertices(); ++vertex)
        name({vertex}, coarse.GetVertexChildVertex(vertex));
    for (Index face = 0; hasFacePoints && face < coarse.GetNumFaces(); ++face)
        name({face, face, face}, coarse.GetFaceChildVertex(face));
    for (Index edge = 0; edge < coarse.GetNumEdges(); ++edge) {
        auto const ends = coarse.GetEdgeVertices(edge);
        name({std::min(ends[0], ends[1]), std::max(ends[0], ends[1])},
             coarse.GetEdgeChildVertex(edge));
    }
    return named;
}

/// The mesh in a mirror: x is -x, and faces go round the other way.
engine::Scene Mirror(engine::Scene scene) {
    auto corner = scene.cage.faceVertices.begin();
    for (int size : scene.cage.faceSizes) {
        std::reverse(corner, corner + size);
        corner += size;
    }
    for (size_t i = 0; i < scene.positions.size(); i += 3) scene.positions[i] *= -1.0;
    return scene;
}

TEST_P(InterpolatingRules, AMirrorChangesNothing) {
    ForEachMesh([&](engine::Scene const& scene, Far::TopologyRefiner const& refiner) {
        auto const mirrored = Mirror(scene);
        auto const other = test::MakeRefiner(mirrored, 1);
        auto const points = test::Apply(far_ext::BuildSubdivisionRows(refiner, 1, GetParam().rule),
                                        scene.positions),
                   otherPoints =
                       test::Apply(far_ext::BuildSubdivisionRows(*other, 1, GetParam().rule),
                                   mirrored.positions);
        auto const named = NamePoints(refiner.GetLevel(0), !IsLoop(scene), points),
                   otherNamed = NamePoints(other->GetLevel(0), !IsLoop(scene), otherPoints);
        ASSERT_EQ(named.size(), otherNamed.size());
        for (auto const& [key, p] : named) {
            auto const& q = otherNamed.at(key);
            EXPECT_NEAR(p[0], -q[0], 1e-13);
            EXPECT_NEAR(p[1], q[1], 1e-13);
            EXPECT_NEAR(p[2], q[2], 1e-13);
        }
    });
}

// A component's points do not know of the others.
TEST_P(InterpolatingRules, ComponentsAreByThemselves) {
    bool const isLoop = GetParam().takes(test::MakeBipyramid(5));
    auto const one = isLoop ? test::MakeBipyramid(5) : test::MakeTorus(5, 4),
               other = isLoop ? test::MakeLattice(3, 2, Sdc::SCHEME_LOOP)
                              : test::MakeGridWithHole(4, 3);
    auto const both = test::Join({one, other});
    auto const refiner = test::MakeRefiner(one, 1), joined = test::MakeRefiner(both, 1);
    auto const alone = NamePoints(
                   refiner->GetLevel(0), !isLoop,
                   test::Apply(far_ext::BuildSubdivisionRows(*refiner, 1, GetParam().rule),
                               one.positions)),
               together = NamePoints(
                   joined->GetLevel(0), !isLoop,
                   test::Apply(far_ext::BuildSubdivisionRows(*joined, 1, GetParam().rule),
                               both.positions));
    for (auto const& [key, point] : alone) EXPECT_EQ(point, together.at(key));
}

}  // namespace
}  // namespace limn
