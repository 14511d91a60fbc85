// SPDX-License-Identifier: Apache-2.0
#include "eval/stencils/table_evaluator.h"

#include <gtest/gtest.h>

#include "eval/fit/limit_operator.h"
#include "far_ext/error.h"
#include "far_ext/limit/limit_matrix.h"
#include "far_ext/topology/refiner.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"

namespace limn {
namespace {

using eval::EvaluatorKind;
using eval::TableEvaluator;

far_ext::SparseRows MakeRows() {
    far_ext::SparseRows rows;
    far_ext::WeightRow mean, difference;
    mean.Add(0, 0.25);
    mean.Add(2, 0.75);
    difference.Add(1, 1.0);
    difference.Add(0, -1.0);
    rows.AddRow(mean);
    rows.AddRow(difference);
    return rows;
}

TEST(TableEvaluator, AppliesRowsWhateverTheLength) {
    for (auto kind : {EvaluatorKind::Simd, EvaluatorKind::OsdCpu, EvaluatorKind::OsdOmp}) {
        TableEvaluator door(kind);
        auto const table = door.Make("rows", MakeRows(), 3);
        std::vector<double> one(2), two(4);
        table.Apply(std::vector<double>{4, 5, 8}, 1, one);
        EXPECT_EQ(one, (std::vector<double>{7, 1}));
        table.Apply(std::vector<double>{4, 40, 5, 50, 8, 80}, 2, two);
        EXPECT_EQ(two, (std::vector<double>{7, 70, 1, 10}));
    }
}

TEST(TableEvaluator, AnOriginKeepsWhatFloatsWouldLose) {
    auto const scene = test::LoadSpot();
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const A = far_ext::LimitMatrix::Build(*refiner);
    far_ext::StencilRows rows(A.GetNumControlVertices(), 1);
    auto const weights = A.MakeFloatWeights();
    size_t entry = 0;
    for (int size : A.GetSizes()) {
        for (int k = 0; k < size; ++k, ++entry)
            rows.AddEntry(A.GetControlIndices()[entry], &weights[entry]);
        rows.EndRow();
    }
    std::vector<double> far = scene.positions, limits(far.size()), expected(far.size());
    for (double& x : far) x += 1e6;
    double const origin[3] = {1e6, 1e6, 1e6};
    TableEvaluator door(EvaluatorKind::OsdCpu);
    door.Make("A", std::move(rows)).Apply(far, 3, limits, origin);
    eval::LimitOperator::Build(*refiner, 0, {}).Apply(far, 3, expected);
    for (size_t i = 0; i < limits.size(); ++i) EXPECT_NEAR(limits[i], expected[i], 1e-6);
}

TEST(TableEvaluator, CountsTablesOfOneNameTogether) {
    TableEvaluator door(EvaluatorKind::Simd);
    auto const first = door.Make("S1", MakeRows(), 3), second = door.Make("S1", MakeRows(), 5);
    auto const other = door.Make("A", MakeRows(), 3);
    std::vector<double> const x(5, 1.0);
    std::vector<double> y(2);
    first.Apply(x, 1, y);
    second.Apply(x, 1, y);
    second.Apply(x, 1, y);
    auto const uses = door.GetUses();
    ASSERT_EQ(uses.size(), 2u);
    EXPECT_EQ(uses[0].what, "S1");
    EXPECT_EQ(uses[0].rows, 4u);
    EXPECT_EQ(uses[0].entries, 8u);
    EXPECT_EQ(uses[0].applications, 3u);
    EXPECT_EQ(uses[1].what, "A");
    EXPECT_EQ(uses[1].applications, 0u);
}

TEST(TableEvaluator, AnotherMayTakeItsPlaceAndSeesEveryApplication) {
    class Watcher : public TableEvaluator {
    public:
        using TableEvaluator::TableEvaluator;
        mutable std::vector<std::string> seen;

    protected:
        void Apply(std::string const& what, eval::StencilEvaluator const& table, float const*,
                   eval::Osd::BufferDescriptor const&,
                   eval::SimdEvaluator::Targets const& targets) const override {
            seen.push_back(what);
            for (Index row = 0; row < table.GetNumStencils(); ++row) targets[0].values[row] = 3.0f;
        }
    };
    Watcher watcher(EvaluatorKind::OsdCpu);
    std::vector<double> y(2);
    watcher.Make("A", MakeRows(), 3).Apply(std::vector<double>(3, 0.0), 1, y);
    watcher.Make("S1", MakeRows(), 3).Apply(std::vector<double>(3, 0.0), 1, y);
    EXPECT_EQ(watcher.seen, (std::vector<std::string>{"A", "S1"}));
    EXPECT_EQ(y, (std::vector<double>{3, 3}));
}

TEST(TableEvaluator, RowsWithoutEntriesAreZero) {
    far_ext::SparseRows empty;
    empty.AddRow({});
    empty.AddRow({});
    for (auto kind : {EvaluatorKind::Simd, EvaluatorKind::OsdCpu, EvaluatorKind::OsdOmp}) {
        TableEvaluator door(kind);
        std::vector<double> y(2, 7.0);
        door.Make("rows", empty, 3).Apply(std::vector<double>{4, 5, 8}, 1, y);
        EXPECT_EQ(y, (std::vector<double>{0, 0}));
    }
}

TEST(TableEvaluator, WhatDoesNotFitIsRefused) {
    TableEvaluator door(EvaluatorKind::Simd);
    auto const table = door.Make("rows", MakeRows(), 3);
    std::vector<double> y(2), shortOne(1);
    EXPECT_THROW(table.Apply(std::vector<double>(2, 0.0), 1, y), Error);
    EXPECT_THROW(table.Apply(std::vector<double>(3, 0.0), 1, shortOne), Error);
    EXPECT_THROW(table.Apply(std::vector<double>(3, 1e39), 1, y), Error);
    EXPECT_THROW(door.Make("rows", MakeRows(), 2), Error) << "a column that there is not";
}

}  // namespace
}  // namespace limn
