// SPDX-License-Identifier: Apache-2.0
#include "eval/stencils/stencil_evaluator.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opensubdiv/osd/cpuEvaluator.h>

#include "support/meshes.h"
#include "support/stencils.h"

namespace limn::eval {
namespace {

#ifndef __SANITIZE_THREAD__  // OpenMP's runtime is not instrumented
TEST(StencilEvaluator, AllKindsAgreeWithDerivatives) {
    for (char const* shape : {"catmark_bishop", "loop_icosahedron", "catmark_nonman_verts"}) {
        auto const refiner = far_ext::CreateRefiner(test::LoadShape(shape).cage);
        refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(2));
        auto const far = test::MakeFarLimitTable(*refiner);
        auto const source =
            test::MakeRandomValues(static_cast<size_t>(far->GetNumControlVertices()) * 3, 7);
        auto const expected = test::EvaluateSets<Osd::CpuEvaluator>(*far, source);
        size_t const size = expected.size() / 6;
        Osd::BufferDescriptor const three(0, 3, 3);
        for (auto kind : {EvaluatorKind::Simd, EvaluatorKind::OsdCpu, EvaluatorKind::OsdOmp}) {
            far_ext::StencilRows const rows =
                far_ext::GroupRows(far_ext::ViewLimitStencils(*far)).Expand();
            StencilEvaluator const evaluator(kind, rows);
            std::vector<float> all(expected.size());
            SimdEvaluator::Targets targets;
            for (size_t set = 0; set < 6; ++set) targets.push_back({&all[set * size], three});
            evaluator.EvalStencils(source.data(), three, targets, 0, far->GetNumStencils());
            test::ExpectNearBySets(all, expected, fmt::format("{}, {}", shape, GetName(kind)));
        }
    }
}
#endif

TEST(StencilEvaluator, NamesAreFound) {
    EXPECT_EQ(kEvaluatorWords.Find("osd-omp"), EvaluatorKind::OsdOmp);
    EXPECT_EQ(kEvaluatorWords.Find("simd"), EvaluatorKind::Simd);
    EXPECT_FALSE(kEvaluatorWords.Find("gpu"));
}

}  // namespace
}  // namespace limn::eval
