// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/morph.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::Model;
using engine::Morph;
using engine::MorphStep;
using Steps = std::vector<MorphStep>;

Steps Repeat(size_t count, MorphStep const& step) {
    return Steps(count, step);
}

/// Two meshes of the same faces that differ in shape and detail.
std::pair<Model, Model> MakeEnds() {
    engine::Scene from = test::MakeTorus(9, 7), to = from;
    test::AddNoise(from, 0.3, 5);
    for (size_t i = 0; i < to.positions.size(); i += 3) to.positions[i] *= 1.5;
    return {Model::Build(from), Model::Build(to)};
}

// Q = M + (1,0,0): the constant difference is an eigenvector of D with eigenvalue 1; rho^k of it is
// left.
TEST(Morph, RefusesStepsOutOfRange) {
    Model const mesh = Model::Build(test::MakeTorus(9, 7));
    for (MorphStep const step : {MorphStep{.rate = std::nan("")}, MorphStep{.rate = -0.1},
                                 MorphStep{.rate = 1.1}, MorphStep{.detail = -1}})
        EXPECT_EQ(test::CodeOf([&] { Morph(mesh, mesh, {.steps = {step}}); }), ErrorCode::BadOption)
            << step.rate << " " << step.detail;
}

TEST(Morph, KeepsRhoToTheKOfAConstantDifference) {
    engine::Scene const to = test::MakeTorus(9, 7);
    engine::Scene from = to;
    for (size_t i = 0; i < from.positions.size(); i += 3) from.positions[i] += 1.0;
    Morph morph(Model::Build(from), Model::Build(to), {.steps = Repeat(5, {2, 0.8})});
    engine::Job job;
    for (int step = 1; step <= 5; ++step) {
        auto const& Q = morph.MakeNext(job);
        ASSERT_EQ(Q.size(), to.positions.size());
        for (size_t i = 0; i < Q.size(); ++i)
            ASSERT_NEAR(Q[i] - to.positions[i], i % 3 == 0 ? std::pow(0.8, step) : 0.0, 1e-13);
    }
}

// F_N = M; what a constant difference c leaves after k steps is c (P_k - P_N)/(1 - P_N).
TEST(Morph, EndsExactlyWhereItIsAskedTo) {
    auto const [from, to] = MakeEnds();
    Morph morph(from, to, {.steps = Repeat(4, {2, 0.6}), .endsExactly = true});
    engine::Job job;
    for (int step = 1; step < 4; ++step) EXPECT_NE(morph.MakeNext(job), to.GetPositions());
    EXPECT_EQ(morph.MakeNext(job), to.GetPositions());
}

TEST(Morph, WithAnExactEndAConstantDifferenceGoesToNothing) {
    engine::Scene const to = test::MakeTorus(9, 7);
    engine::Scene from = to;
    for (size_t i = 1; i < from.positions.size(); i += 3) from.positions[i] += 1.0;
    Steps const steps{{2, 0.9}, {0, 0.5}, {3, 0.7}};
    Morph morph(Model::Build(from), Model::Build(to), {.steps = steps, .endsExactly = true});
    engine::Job job;
    double const atEnd = 0.9 * 0.5 * 0.7;
    double kept = 1.0;
    for (MorphStep const& step : steps) {
        kept *= step.rate;
        auto const& F = morph.MakeNext(job);
        for (size_t i = 1; i < F.size(); i += 3)
            ASSERT_NEAR(F[i] - to.positions[i], (kept - atEnd) / (1.0 - atEnd), 1e-13);
    }
}

TEST(Morph, TakesAStepOfTheScheduleAfterTheOther) {
    auto const [from, to] = MakeEnds();
    engine::Job job;
    Morph two(from, to, {.steps = {{0, 0.9}, {3, 0.5}}});
    two.MakeNext(job);
    auto const& end = two.MakeNext(job);
    Morph first(from, to, {.steps = {{0, 0.9}}});
    Morph second(from.WithPoints(first.MakeNext(job)), to, {.steps = {{3, 0.5}}});
    EXPECT_EQ(second.MakeNext(job), end);
}

TEST(Morph, RefusesMoreFramesThanSteps) {
    auto const [from, to] = MakeEnds();
    engine::Job job;
    Morph morph(from, to, {.steps = Repeat(1, {})});
    morph.MakeNext(job);
    EXPECT_EQ(test::CodeOf([&] { morph.MakeNext(job); }), ErrorCode::BadOption);
}

TEST(Morph, RefusesAnExactEndThatNoStepBringsNearer) {
    auto const ends = MakeEnds();
    engine::MorphOptions const options{.steps = Repeat(3, {2, 1.0}), .endsExactly = true};
    EXPECT_EQ(test::CodeOf([&] { Morph(ends.first, ends.second, options); }), ErrorCode::BadOption);
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
