// SPDX-License-Identifier: Apache-2.0
#include <limn/eval/simd_evaluator.h>
#include <limn/eval/surface_sample.h>
#include <limn/far_ext/refined_stencils.h>
#include <limn/far_ext/refiner.h>

// Programs written for 0.1 find what they use where it was.
// NOLINTBEGIN(misc-unused-using-decls): that there are such names is what is checked
using limn::eval::EvaluateSample;
using limn::eval::SimdEvaluator;
using limn::far_ext::BuildRefinedStencils;
using limn::far_ext::CreateRefiner;
// NOLINTEND(misc-unused-using-decls)

// And call it as they did.
[[maybe_unused]] static limn::eval::SurfaceSample SampleFromInside(limn::eval::FaceTree& tree) {
    return EvaluateSample(tree, 0, 0.5, 0.5, -1.0);
}
