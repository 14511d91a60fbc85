// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/limit_application.h"

#include "far_ext/limit/limit_matrix.h"

namespace limn::eval {

namespace {

far_ext::StencilRows MakeRows(far_ext::LimitMatrix const& A) {
    far_ext::StencilRows rows(A.GetNumControlVertices(), 1);
    size_t entry = 0;
    for (int size : A.GetSizes()) {
        for (int k = 0; k < size; ++k, ++entry) {
            auto const weight = static_cast<float>(A.GetWeights()[entry]);
            rows.AddEntry(A.GetControlIndices()[entry], &weight);
        }
        rows.EndRow();
    }
    return rows;
}

}  // namespace

LimitApplication LimitApplication::Build(Far::TopologyRefiner const& refiner,
                                         far_ext::LimitOptions const& options,
                                         TableEvaluator* evaluator) {
    if (!evaluator) return LimitOperator::Build(refiner, 0, options);
    auto const A = far_ext::LimitMatrix::Build(refiner, 0, options);
    return LimitApplication(evaluator->Make(kTable, MakeRows(A)));
}

void LimitApplication::Apply(std::span<double const> x, int length, std::span<double> y) const {
    if (auto const* const A = std::get_if<LimitOperator>(&_operator)) return A->Apply(x, length, y);
    // Rows add up to 1: relative to any of the points, floats keep the digits of a far mesh.
    std::get<FixedTable>(_operator).Apply(x, length, y, x.data());
}

}  // namespace limn::eval
