// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/bufferDescriptor.h>
#include <opensubdiv/osd/cpuEvaluator.h>

#include "far_ext/types.h"
#include "harness.h"

namespace limn::bench {

namespace Osd = OpenSubdiv::Osd;

/// Far's table of the last level, as its users build it for repeated evaluation.
inline std::unique_ptr<Far::StencilTable const> MakeFarTable(Far::TopologyRefiner const& refiner) {
    Far::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    options.generateOffsets = true;
    return std::unique_ptr<Far::StencilTable const>(
        Far::StencilTableFactory::Create(refiner, options));
}

inline double GetMemory(Far::StencilTable const& table) {
    return 4.0 * static_cast<double>(table.GetSizes().size() + table.GetOffsets().size() +
                                     table.GetControlIndices().size() + table.GetWeights().size());
}

/// OpenSubdiv's evaluator: of `length` floats per point, one after another.
template <class Table>
void EvaluateWithOsd(Table const& table, float const* source, float* target, int length) {
    Osd::BufferDescriptor const desc(0, length, length);
    Check(
        Osd::CpuEvaluator::EvalStencils(source, desc, target, desc, table.GetSizes().data(),
                                        table.GetOffsets().data(), table.GetControlIndices().data(),
                                        table.GetWeights().data(), 0, table.GetNumStencils()),
        "OpenSubdiv's evaluator refuses");
}

}  // namespace limn::bench
