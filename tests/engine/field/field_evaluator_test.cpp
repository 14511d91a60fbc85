// SPDX-License-Identifier: Apache-2.0
//
// Fields whose tables an evaluator applies.

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "engine/field/circulation.h"
#include "engine/field/field.h"
#include "engine/smooth/smooth.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::Model;
using eval::EvaluatorKind;

/// With sources, vortices and a function, on a mesh of quads far from the origin.
engine::Field DesignSeen(Model const& model, eval::TableEvaluator* evaluator) {
    engine::FieldOptions options;
    options.sources = {{0, 1.0}, {5, -1.0}};
    options.vortices = {{2, 2.0}, {9, -2.0}};
    options.levels = 2;
    options.evaluator = evaluator;
    engine::Job job;
    return engine::DesignField(model, options, job);
}

Model MakeFarTorus() {
    engine::Scene scene = test::MakeTorus(9, 7);
    for (double& x : scene.positions) x += 1000.0;
    return Model::Build(std::move(scene));
}

double FindLargest(std::vector<double> const& values) {
    return test::LargestDifference(values, std::vector<double>(values.size(), 0.0));
}

std::vector<double> Flatten(std::vector<std::array<double, 3>> const& vectors) {
    std::vector<double> values;
    for (auto const& vector : vectors) values.insert(values.end(), vector.begin(), vector.end());
    return values;
}

TEST(FieldEvaluator, IsNearTheDoubles) {
    Model const model = MakeFarTorus();
    auto const expected = DesignSeen(model, nullptr);
    double const diagonal = test::BoxDiagonal(expected.mesh.positions);
    for (auto kind : {EvaluatorKind::Simd, EvaluatorKind::OsdCpu, EvaluatorKind::OsdOmp}) {
        eval::TableEvaluator door(kind);
        auto const found = DesignSeen(model, &door);
        auto const isNear = [](std::vector<double> const& a, std::vector<double> const& b) {
            EXPECT_LT(test::LargestDifference(a, b), 1e-5 * FindLargest(b));
        };
        isNear(found.form, expected.form);
        isNear(found.integrals, expected.integrals);
        isNear(Flatten(found.vectors), Flatten(expected.vectors));
        isNear(Flatten(found.faceVectors), Flatten(expected.faceVectors));
        EXPECT_LT(test::LargestDifference(found.mesh.positions, expected.mesh.positions),
                  2e-6 * diagonal);
    }
}

TEST(FieldEvaluator, AppliesTheTablesOfEachLevel) {
    Model const model = MakeFarTorus();
    eval::TableEvaluator door(EvaluatorKind::OsdCpu);
    auto const field = DesignSeen(model, &door);
    size_t numVertices = 0, numEdges = 0, numFaces = 0;
    for (int level = 1; level <= 2; ++level) {
        auto const topology = field.refined->GetLevel(level);
        numVertices += static_cast<size_t>(topology.GetNumVertices());
        numEdges += static_cast<size_t>(topology.GetNumEdges());
        numFaces += static_cast<size_t>(topology.GetNumFaces());
    }
    auto const expect = [&](char const* what, size_t rows, size_t applications) {
        auto const uses = door.GetUses();
        auto const use = std::ranges::find(uses, what, &eval::TableUse::what);
        ASSERT_NE(use, uses.end()) << what;
        EXPECT_EQ(use->rows, rows) << what;
        EXPECT_GE(use->applications, applications) << what;
    };
    expect("S0", numVertices, 4);  // positions and values
    expect("S1", numEdges, 2);
    expect("S2", numFaces, 2);
    expect("covectors", 2 * field.vectors.size(), 1);
}

TEST(FieldEvaluator, SubdividesWhatIsIntegratedAlongEdges) {
    Model const model = Model::Build(test::LoadShape("catmark_cubes_semisharp"));
    std::vector<double> form(static_cast<size_t>(model.GetLevel().GetNumEdges()));
    for (size_t edge = 0; edge < form.size(); ++edge) form[edge] = 0.1 * static_cast<double>(edge);
    auto const ends = model.GetLevel().GetEdgeVertices(3);
    std::vector<engine::EdgeValue> const edges{
        {3, std::min(ends[0], ends[1]), std::max(ends[0], ends[1]), 0.0, 1}};
    engine::Job job;
    eval::TableEvaluator door(EvaluatorKind::Simd);
    auto const expected = engine::FindCirculations(model, form, edges, job);
    auto const found = engine::FindCirculations(model, form, edges, job, &door);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].value, expected[0].value, 1e-5 * FindLargest(form));
    ASSERT_EQ(door.GetUses().size(), 1u);
    EXPECT_EQ(door.GetUses()[0].what, "S1");
}

/// Notes which tables go through, and applies them.
class SeeingEvaluator : public eval::TableEvaluator {
public:
    SeeingEvaluator() : TableEvaluator(EvaluatorKind::OsdCpu) {}
    mutable std::set<std::string> seen;

protected:
    void Apply(std::string const& what, eval::StencilEvaluator const& table, float const* source,
               eval::Osd::BufferDescriptor const& desc,
               eval::SimdEvaluator::Targets const& targets) const override {
        seen.insert(what);
        TableEvaluator::Apply(what, table, source, desc, targets);
    }
};

TEST(FieldEvaluator, AnotherInItsPlaceSeesOneFormTablesAndJacobiSweeps) {
    SeeingEvaluator evaluator;
    Model const model = MakeFarTorus();
    DesignSeen(model, &evaluator);
    EXPECT_EQ(evaluator.seen,
              (std::set<std::string>{"S0", "S0 face-varying", "S1", "S2", "covectors"}));
    evaluator.seen.clear();
    engine::SmoothOptions options;
    options.solver = eval::CascadeSolver::Jacobi;
    options.stop = engine::IterationsPerLevel{2};
    options.evaluator = &evaluator;
    engine::Job job;
    engine::Smooth(model, engine::ConstantWidth{0.05}, options, job);
    EXPECT_EQ(evaluator.seen, (std::set<std::string>{"load", "prolongation", "sweep"}));
}

}  // namespace
}  // namespace limn
