// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/morph.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::Model;
using engine::Morph;

// Q = M + (1,0,0): the constant difference is an eigenvector of D with eigenvalue 1; rho^k of it is
// left.
TEST(Morph, KeepsRhoToTheKOfAConstantDifference) {
    engine::Scene const to = test::MakeTorus(9, 7);
    engine::Scene from = to;
    for (size_t i = 0; i < from.positions.size(); i += 3) from.positions[i] += 1.0;
    Morph morph(Model::Build(from), Model::Build(to), {.detail = 2, .rate = 0.8});
    engine::Job job;
    for (int step = 1; step <= 5; ++step) {
        auto const& Q = morph.MakeNext(job);
        ASSERT_EQ(Q.size(), to.positions.size());
        for (size_t i = 0; i < Q.size(); ++i)
            ASSERT_NEAR(Q[i] - to.positions[i], i % 3 == 0 ? std::pow(0.8, step) : 0.0, 1e-13);
    }
}

TEST(Morph, RefusesAnotherTopologyAndNamesTheFace) {
    engine::Scene const to = test::MakeTorus(9, 7);
    auto const refusal = [&](engine::Scene const& from) {
        return test::RefusalOf([&] { Morph(Model::Build(from), Model::Build(to), {}); });
    };
    EXPECT_NE(refusal(test::MakeTorus(7, 9)).find("face 0 "), std::string::npos);
    EXPECT_NE(refusal(test::MakeCube()).find("8 and 63 vertices"), std::string::npos);
    engine::Scene turned = to;
    std::swap(turned.cage.faceVertices[21], turned.cage.faceVertices[22]);
    EXPECT_NE(refusal(turned).find("face 5 "), std::string::npos);
}

TEST(Morph, StopsWhereItsHostWants) {
    Model const torus = Model::Build(test::MakeTorus(9, 7));
    Morph morph(torus, torus, {});
    engine::Job job({.isStopped = [] { return true; }});
    EXPECT_THROW(morph.MakeNext(job), engine::Stopped);
}

}  // namespace
}  // namespace limn
