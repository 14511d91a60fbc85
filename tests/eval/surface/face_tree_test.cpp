// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/face_tree.h"

#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "eval/surface/surface_sample.h"
#include "far_ext/rows/points.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using eval::FaceTree;
using eval::LimitSurface;

/// A scene with its surface and a tree of its positions.
struct TreeSubject {
    engine::Scene scene;
    std::unique_ptr<Far::TopologyRefiner> refiner;
    LimitSurface surface;
    FaceTree tree;

    explicit TreeSubject(engine::Scene made)
        : scene(std::move(made)),
          refiner(far_ext::CreateRefiner(scene.cage)),
          surface(*refiner),
          tree(surface, scene.positions, 3) {}
};

template <class Act>
void ExpectRefusal(Act act, std::string const& message) {
    EXPECT_EQ(test::RefusalOf(act), message);
    EXPECT_EQ(test::CodeOf(act), ErrorCode::BadOption);
}

std::vector<double> const kGrid{0.0, 0.01, 0.2, 0.33, 0.5, 0.66, 0.9, 1.0};

/// Places all over a domain.
void MakeGrid(bool isLoop, std::vector<double>& s, std::vector<double>& t) {
    for (double u : kGrid) {
        for (double v : kGrid) {
            if (isLoop && u + v > 1.0) continue;
            s.push_back(u);
            t.push_back(v);
        }
    }
}

class FaceTreeOf : public testing::TestWithParam<engine::Scene (*)()> {};
INSTANTIATE_TEST_SUITE_P(Meshes, FaceTreeOf,
                         testing::Values(
                             +[] { return test::MakeCube(); },
                             +[] { return test::MakeFan(5, Sdc::SCHEME_LOOP, 0.2, 0.1); },
                             +[] { return test::MakePrism(5); }));

// Two roads to one piece: alone, and sorted among others.
TEST_P(FaceTreeOf, ARunHasTheSamplesWhereEachIsFoundAlone) {
    TreeSubject subject(GetParam()());
    FaceTree& tree = subject.tree;
    bool const isLoop = subject.surface.IsLoop();
    std::vector<double> s, t;
    MakeGrid(isLoop, s, t);
    constexpr int kDepth = 5;
    tree.Bind(0);
    FaceTree alone(subject.surface, subject.scene.positions, 3);
    alone.Bind(0);
    for (int domain = 0; domain < tree.GetNumDomains(); ++domain) {
        std::vector<int> timesSeen(s.size(), 0);
        tree.ForEachPiece(
            domain, s, t, kDepth,
            [&](eval::PatchRun const& run) {
                for (size_t i = 0; i < run.samples.size(); ++i) {
                    int const sample = run.samples[i];
                    ++timesSeen[sample];
                    auto const at = alone.Locate(domain, s[sample], t[sample], kDepth);
                    EXPECT_EQ(run.patch.scale, at.scale);
                    EXPECT_EQ(run.s[i] - tree.GetCentre(), at.x);
                    EXPECT_EQ(run.t[i] - tree.GetCentre(), at.y);
                    EXPECT_EQ(run.patch.coefficients[0], at.coefficients[0]);
                    EXPECT_FALSE(at.isMoved);
                }
            },
            [&](int sample) {
                ++timesSeen[sample];
                EXPECT_TRUE(alone.Locate(domain, s[sample], t[sample], kDepth).isMoved);
            });
        EXPECT_EQ(timesSeen, std::vector<int>(s.size(), 1));
    }
}

TEST_P(FaceTreeOf, WeightsTimesPointsAreTheValues) {
    TreeSubject subject(GetParam()());
    FaceTree weights(subject.surface, std::vector<FaceTree::Values>{});
    far_ext::Points const points(subject.scene.positions);
    subject.tree.Bind(0);
    weights.BindWeights(0);
    double const s = 0.3, t = 0.4;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < weights.GetPoints().size(); ++i) {
        sum += eval::EvaluateChannel(weights, 0, s, t, static_cast<int>(i)) *
               points[weights.GetPoints()[i]];
    }
    EXPECT_LT((sum - eval::EvaluateDerivatives(subject.tree, 0, s, t).position).norm(), 1e-13);
}

TEST_P(FaceTreeOf, AfterWeightsItBindsValuesAgain) {
    TreeSubject subject(GetParam()());
    subject.tree.Bind(0);
    auto const before = eval::EvaluateDerivatives(subject.tree, 0, 0.3, 0.4).position;
    subject.tree.BindWeights(0);
    subject.tree.Bind(0);
    EXPECT_EQ(subject.tree.GetLength(), 3);
    EXPECT_EQ(eval::EvaluateDerivatives(subject.tree, 0, 0.3, 0.4).position, before);
}

TEST_P(FaceTreeOf, BoundsOfANodeHoldItsLimit) {
    TreeSubject subject(GetParam()());
    FaceTree& tree = subject.tree;
    std::vector<double> s, t;
    MakeGrid(subject.surface.IsLoop(), s, t);
    tree.Bind(0);
    int const root = tree.GetRoot(0);
    for (int c = 0; c < 3; ++c) {
        auto const [low, high] = tree.GetBounds(root, c);
        for (size_t i = 0; i < s.size(); ++i) {
            double const value = eval::EvaluateChannel(tree, 0, s[i], t[i], c);
            EXPECT_GE(value, low - 1e-12);
            EXPECT_LE(value, high + 1e-12);
        }
    }
}

TEST(FaceTree, PartsAreChannelsSideBySide) {
    TreeSubject subject(test::MakeCube());
    std::vector<double> ones(8, 1.0);
    FaceTree tree(subject.surface, {{subject.scene.positions, 3}, {ones, 1}});
    tree.Bind(0);
    EXPECT_EQ(tree.GetLength(), 4);
    EXPECT_NEAR(eval::EvaluateChannel(tree, 0, 0.1, 0.2, 3), 1.0, 1e-15);
}

TEST(FaceTree, ValuesThatAreTooShortAreRefused) {
    TreeSubject subject(test::MakeCube());
    std::vector<double> const six(6), seven(7);
    ExpectRefusal([&] { FaceTree(subject.surface, six, 3); },
                  "control points: 6 values are too few for 8 vertices of 3");
    ExpectRefusal(
        [&] {
            FaceTree(subject.surface,
                     std::vector<FaceTree::Values>{{subject.scene.positions, 3}, {seven, 1}});
        },
        "control points: 7 values are too few for 8 vertices of 1");
}

TEST(FaceTree, FaceVaryingValuesThatAreTooShortAreRefused) {
    auto const torus = test::MakeTorus(4, 3);
    auto const refiner = far_ext::CreateRefiner(torus.cage);
    LimitSurface const surface(*refiner, 0);
    EXPECT_NO_THROW(FaceTree(surface, torus.uvs, 2));
    ExpectRefusal([&] { FaceTree(surface, std::span(torus.uvs).first(4), 2); },
                  "control points: 4 values are too few for 20 face-varying values of 2");
    ExpectRefusal([&] { LimitSurface(*refiner, 1); },
                  "face-varying channel 1 does not exist; the mesh has 1");
}

TEST(FaceTree, AFaceThatDoesNotExistIsRefusedAndTheLastOneStays) {
    TreeSubject subject(test::MakeCube());
    subject.tree.Bind(4);
    auto const before = eval::EvaluateDerivatives(subject.tree, 0, 0.3, 0.4).position;
    for (auto bind : {&FaceTree::Bind, &FaceTree::BindWeights}) {
        ExpectRefusal([&] { (subject.tree.*bind)(77); },
                      "face 77 does not exist; the surface has 6 faces, 0 to 5");
        ExpectRefusal([&] { (subject.tree.*bind)(-1); },
                      "face -1 does not exist; the surface has 6 faces, 0 to 5");
    }
    EXPECT_EQ(subject.tree.GetFace(), 4);
    EXPECT_EQ(eval::EvaluateDerivatives(subject.tree, 0, 0.3, 0.4).position, before);
}

TEST(FaceTree, AFaceWithoutALimitIsRefused) {
    auto scene = test::MakeCube();
    scene.cage.holes = {2};
    TreeSubject subject(scene);
    ExpectRefusal([&] { subject.tree.Bind(2); }, "face 2 has no limit");
    ExpectRefusal([&] { subject.tree.BindWeights(2); }, "face 2 has no limit");
}

TEST(FaceTree, ADomainThatDoesNotExistIsRefused) {
    TreeSubject subject(test::MakePrism(5));  // pentagons below and above
    subject.tree.Bind(1);
    std::string const message = "domain 5 does not exist; face 1 has domains 0 to 4";
    std::vector<double> const half{0.5};
    auto const ignore = [](auto const&) {};
    ExpectRefusal([&] { subject.tree.GetRoot(5); }, message);
    ExpectRefusal([&] { subject.tree.Locate(5, 0.5, 0.5, 5); }, message);
    ExpectRefusal([&] { subject.tree.ForEachPiece(5, half, half, 5, ignore, ignore); }, message);
    ExpectRefusal([&] { eval::EvaluateSample(subject.tree, 5, 0.5, 0.5); }, message);
    ExpectRefusal([&] { eval::EvaluateDerivatives(subject.tree, 5, 0.5, 0.5); }, message);
    ExpectRefusal([&] { eval::EvaluateChannel(subject.tree, 5, 0.5, 0.5, 0); }, message);
}

TEST(FaceTree, APlaceOutsideItsDomainIsRefused) {
    TreeSubject subject(test::MakeCube());
    subject.tree.Bind(0);
    std::string const message = "(1.5, -3) lies outside domain 0 of face 0";
    ExpectRefusal([&] { subject.tree.Locate(0, 1.5, -3.0, 5); }, message);
    ExpectRefusal([&] { eval::EvaluateSample(subject.tree, 0, 1.5, -3.0); }, message);
    ExpectRefusal([&] { eval::EvaluateDerivatives(subject.tree, 0, 1.5, -3.0); }, message);
    ExpectRefusal([&] { eval::EvaluateChannel(subject.tree, 0, 1.5, -3.0, 0); }, message);
    double const nan = std::numeric_limits<double>::quiet_NaN();
    ExpectRefusal([&] { subject.tree.Locate(0, nan, 0.5, 5); },
                  "(nan, 0.5) lies outside domain 0 of face 0");
}

TEST(FaceTree, SamplesOutsideTheirDomainOrWithoutAPartnerAreRefused) {
    TreeSubject subject(test::MakeCube());
    subject.tree.Bind(0);
    std::vector<double> const s{0.5, 0.5, 1.5}, t{0.5, 0.5, -3.0};
    auto const visit = [](auto const&) { ADD_FAILURE() << "a sample was visited"; };
    ExpectRefusal([&] { subject.tree.ForEachPiece(0, s, t, 5, visit, visit); },
                  "place 2: (1.5, -3) lies outside domain 0 of face 0");
    ExpectRefusal([&] { subject.tree.ForEachPiece(0, s, std::span(t).first(2), 5, visit, visit); },
                  "places: 3 values of s and 2 of t; each has one of both");
}

TEST(FaceTree, NothingIsAskedBeforeTheFirstBind) {
    TreeSubject subject(test::MakeCube());
    EXPECT_EQ(subject.tree.GetFace(), -1);
    ExpectRefusal([&] { subject.tree.Locate(0, 0.5, 0.5, 5); }, "FaceTree: no face is bound");
    ExpectRefusal([&] { subject.tree.GetBounds(0, 0); }, "FaceTree: no face is bound");
}

TEST(FaceTree, ANodeThatDoesNotExistIsRefused) {
    TreeSubject subject(test::MakeCube());
    FaceTree& tree = subject.tree;
    tree.Bind(0);
    int const root = tree.GetRoot(0);
    std::string const message = "node 99 does not exist; the tree has 1 by now";
    ExpectRefusal([&] { tree.IsLeaf(99); }, message);
    ExpectRefusal([&] { tree.GetChild(99, 0); }, message);
    ExpectRefusal([&] { tree.GetLeaf(99); }, message);
    ExpectRefusal([&] { tree.GetLinearLeaf(99); }, message);
    ExpectRefusal([&] { tree.GetBounds(99, 0); }, message);
    ExpectRefusal([&] { tree.GetOrigin(99); }, message);
    ExpectRefusal([&] { tree.GetDomain(99); }, message);
    ExpectRefusal([&] { tree.GetChild(root, 4); }, "child 4 does not exist; node 0 has 4");
    ExpectRefusal([&] { tree.GetLeaf(root); }, "node 0 is no leaf; it has children");
}

TEST(FaceTree, ALeafHasNoChildren) {
    TreeSubject subject(test::MakeTorus(5, 4));  // regular
    subject.tree.Bind(0);
    ExpectRefusal([&] { subject.tree.GetChild(subject.tree.GetRoot(0), 0); },
                  "child 0 does not exist; node 0 has 0");
}

TEST(FaceTree, AChannelThatDoesNotExistIsRefused) {
    TreeSubject subject(test::MakeCube());
    std::vector<double> const pairs(16);
    FaceTree tree(subject.surface, pairs, 2);
    tree.Bind(0);
    std::string const message = "channel 2 does not exist; the tree has 2";
    ExpectRefusal([&] { eval::EvaluateChannel(tree, 0, 0.5, 0.5, 2); }, message);
    ExpectRefusal([&] { tree.GetBounds(0, 2); }, message);
    // No third coordinate, no position.
    ExpectRefusal([&] { eval::EvaluateSample(tree, 0, 0.5, 0.5); }, message);
    ExpectRefusal([&] { eval::EvaluateDerivatives(tree, 0, 0.5, 0.5); }, message);
}

}  // namespace
}  // namespace limn
