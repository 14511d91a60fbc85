// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <optional>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "eval/cascade/cascade_sweep.h"
#include "eval/parallel/step_pass.h"
#include "support/fit_meshes.h"
#include "support/instruction_sets.h"
#include "support/refined.h"
#include "support/values.h"

namespace limn {
namespace {

using eval::CascadeRows;
using far_ext::BoundaryRule;
using far_ext::CascadeLevel;

struct Case {
    char const* name;
    engine::Scene scene;
    int levels;
};

/// Regular and irregular rings, open ones, creases; triangles and quads; more rows than threads
/// share out at a time.
std::vector<Case> MakeCases() {
    std::vector<Case> cases;
    cases.push_back({"irregular triangles", test::MakeIrregularTriangles(12, 12, 3), 3});
    cases.push_back({"triangles with boundary", test::LoadData("cascade/gridholetri.obj"), 4});
    cases.back().scene.cage.scheme = Sdc::SCHEME_LOOP;
    cases.push_back({"quads", test::MakeTorus(12, 12), 3});
    cases.push_back({"quads with creases", test::LoadShape("catmark_cube_creases0"), 5});
    return cases;
}

template <class Scalar>
CascadeRows<Scalar> MakeRandomRows(CascadeLevel const& level, unsigned seed) {
    CascadeRows<Scalar> rows(level.vertices.size());
    auto const values = test::MakeRandomValues(4 * rows.size(), seed);
    for (size_t i = 0; i < values.size(); ++i)
        rows[i / 4][static_cast<Index>(i % 4)] = static_cast<Scalar>(values[i]);
    return rows;
}

/// Weights of random rows, and two sweeps with them, one after the other.
template <class Scalar>
struct Filtered {
    eval::CascadeOperator<Scalar> op;
    CascadeRows<Scalar> x, x0, swept;
    eval::MetricQuality quality;

    Filtered(CascadeLevel const& level, Scalar width)
        : x(MakeRandomRows<Scalar>(level, 1)), x0(MakeRandomRows<Scalar>(level, 2)), swept(x) {
        quality = eval::BuildOperator(level, x, width, op);
        eval::SweepJacobi(level, op, x, x0, swept);
    }

    bool operator==(Filtered const& other) const {
        auto const same = [](auto const& a, auto const& b) {
            return a.size() == b.size() &&
                   std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
        };
        return same(op.edges, other.op.edges) && same(op.masses, other.op.masses) &&
               same(op.diagonals, other.op.diagonals) && same(swept, other.swept) &&
               quality.minAngleRadians == other.quality.minAngleRadians &&
               quality.areaRatio == other.quality.areaRatio;
    }
};

template <class Scalar>
void ExpectSameBytes(char const* name, CascadeLevel const& level, Scalar width) {
    std::optional<Filtered<Scalar>> first;
    test::ForEachInstructionSet([&](eval::InstructionSet set) {
        for (size_t threads : {1, 4}) {
            tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, threads);
            Filtered<Scalar> const filtered(level, width);
            if (!first) first = filtered;
            EXPECT_TRUE(filtered == *first)
                << name << ", " << eval::GetName(set) << ", " << threads << " threads, "
                << sizeof(Scalar) << " bytes, width " << width;
        }
    });
}

/// A sweep is X + theta D^-1 times the residual, to the bit; rows that stay are not written.
template <class Scalar>
void ExpectResiduals(char const* name, CascadeLevel const& level) {
    Filtered<Scalar> const filtered(level, Scalar(-1));
    for (Index row = 0; row < level.GetNumRows(); ++row) {
        eval::CascadeRow<Scalar> expected = filtered.x[row];
        if (row < level.numUnknowns && filtered.op.diagonals[row] > Scalar(0)) {
            Scalar const scale = Scalar(eval::kJacobiDamping) / filtered.op.diagonals[row];
            expected += scale * FindResidual(level, filtered.op, filtered.x.data(),
                                             filtered.x0.data(), row);
        }
        ASSERT_TRUE((filtered.swept[row] == expected).all()) << name << ", row " << row;
    }
}

TEST(CascadeKernel, SameBytesOnEveryInstructionSetAndNumberOfThreads) {
    for (auto const& [name, scene, levels] : MakeCases()) {
        auto const mesh = far_ext::MakeCascadeMesh(*test::MakeRefiner(scene, levels), levels);
        auto const level = far_ext::BuildCascadeLevel(mesh, {}, BoundaryRule::Natural);
        for (double width : {0.5, -1.0}) {
            ExpectSameBytes(name, level, static_cast<float>(width));
            ExpectSameBytes(name, level, width);
        }
        ExpectResiduals<float>(name, level);
        ExpectResiduals<double>(name, level);
    }
}

// A level large enough to be passed through once for several sweeps, on threads.
TEST(CascadeKernel, SweepsTogetherAreSweepsOneAfterAnother) {
    auto const mesh =
        far_ext::MakeCascadeMesh(*test::MakeRefiner(test::MakeIrregularTriangles(20, 20, 3), 4), 4);
    auto const level = far_ext::BuildCascadeLevel(mesh, {}, BoundaryRule::Fixed);
    ASSERT_GT(eval::CountStepsPerPass(level.numUnknowns, level.bandwidth), 1);
    Filtered<float> const filtered(level, 0.5f);
    tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, 4);
    for (int count : {1, 2, 3, 4, 5, 9}) {
        CascadeRows<float> one = filtered.x, next = filtered.x, odd = filtered.x, even = filtered.x,
                           inPlace = filtered.x, other = filtered.x;
        for (int sweep = 0; sweep < count; ++sweep) {
            eval::SweepJacobi(level, filtered.op, one, filtered.x0, next);
            one.swap(next);
        }
        eval::SweepJacobi(level, filtered.op, filtered.x, filtered.x0, odd, even, count);
        eval::SweepJacobi(level, filtered.op, inPlace, filtered.x0, other, inPlace, count);
        for (auto const* rows :
             {count % 2 == 1 ? &odd : &even, count % 2 == 1 ? &other : &inPlace}) {
            EXPECT_EQ(std::memcmp(rows->data(), one.data(), one.size() * sizeof one[0]), 0)
                << count << " sweeps";
        }
    }
}

// 2048 rows are a block, and no empty one follows it, whose shapes would be none.
TEST(CascadeKernel, RowsThatFillABlockHaveTheirShapes) {
    auto const scene = test::MakeTriangleTorus(32, 16);
    auto const level = far_ext::BuildCascadeLevel(
        far_ext::MakeCascadeMesh(*test::MakeRefiner(scene, 1), 1), {}, BoundaryRule::Fixed);
    ASSERT_EQ(level.numUnknowns, 2048);
    auto const points = eval::RefineValues<3>(*test::MakeRefiner(scene, 1), 1, scene.positions);
    CascadeRows<double> metric(2048);
    for (size_t row = 0; row < metric.size(); ++row) {
        double const* const p = &points[3 * static_cast<size_t>(level.vertices[row])];
        metric[row] = {p[0], p[1], p[2], 0.0};
    }
    eval::CascadeOperator<double> op;
    auto const quality = eval::BuildOperator(level, metric, 0.1, op);
    EXPECT_GT(quality.areaRatio, 0.1);
    EXPECT_GT(quality.minAngleRadians, 0.1);
}

// Float and double take different ways through regular rings.
TEST(CascadeKernel, FloatIsNearDouble) {
    auto const scene = test::MakeIcosphere(2);
    auto const refiner = test::MakeRefiner(scene, 3);
    auto const mesh = far_ext::MakeCascadeMesh(*refiner, 3);
    auto const level = far_ext::BuildCascadeLevel(mesh, {}, BoundaryRule::Fixed);
    auto const points = test::SubdivideToSphere(*refiner, scene.positions);
    CascadeRows<float> metric(level.vertices.size());
    CascadeRows<double> exact(metric.size());
    for (size_t row = 0; row < metric.size(); ++row) {
        double const* const p = &points[3 * static_cast<size_t>(level.vertices[row])];
        metric[row] = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
                       0.1f * static_cast<float>(p[0] * p[1])};
        exact[row] = metric[row].cast<double>();
    }
    for (float width : {0.3f, -1.0f}) {
        eval::CascadeOperator<float> near;
        eval::CascadeOperator<double> op;
        auto const quality = eval::BuildOperator(level, metric, width, near),
                   expected = eval::BuildOperator(level, exact, double{width}, op);
        EXPECT_NEAR(quality.minAngleRadians, expected.minAngleRadians, 1e-5);
        EXPECT_NEAR(quality.areaRatio, expected.areaRatio, 1e-5);
        double const largest = *std::max_element(op.diagonals.begin(), op.diagonals.end());
        for (size_t k = 0; k < op.edges.size(); ++k)
            ASSERT_NEAR(static_cast<double>(near.edges[k]), op.edges[k], 1e-5 * largest);
        for (size_t row = 0; row < op.masses.size(); ++row) {
            ASSERT_NEAR(static_cast<double>(near.masses[row]), op.masses[row], 1e-5 * largest);
            ASSERT_NEAR(static_cast<double>(near.diagonals[row]), op.diagonals[row],
                        1e-5 * largest);
        }
    }
}

}  // namespace
}  // namespace limn
