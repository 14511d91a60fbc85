// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/bufferDescriptor.h>

#include "far_ext/topology/refiner.h"
#include "support/values.h"

namespace limn::test {

inline std::unique_ptr<Far::TopologyRefiner> RefineUniformly(far_ext::ControlMesh const& cage,
                                                             int level) {
    auto refiner = far_ext::CreateRefiner(cage);
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(level));
    return refiner;
}

// Tables by the names of their templates: Far::StencilTableFactory casts them to a class they are
// not of, which the undefined-behaviour sanitizer reports.
using FarTable = Far::StencilTableReal<float>;
using FarLimitTable = Far::LimitStencilTableReal<float>;

/// Far's table of the last level.
template <class Real = float>
std::unique_ptr<Far::StencilTableReal<Real> const> MakeFarTable(Far::TopologyRefiner const& refiner,
                                                                int interpolationMode) {
    using Factory = Far::StencilTableFactoryReal<Real>;
    typename Factory::Options options;
    options.interpolationMode = static_cast<unsigned>(interpolationMode) & 3u;
    options.generateIntermediateLevels = false;
    options.generateOffsets = true;
    return std::unique_ptr<Far::StencilTableReal<Real> const>(Factory::Create(refiner, options));
}

/// Far's limit stencils with second derivatives at the same grid of places in every face.
///
/// \param refiner  refined by RefineAdaptive
inline std::unique_ptr<FarLimitTable const> MakeFarLimitTable(Far::TopologyRefiner const& refiner) {
    static float const s[] = {0.1f, 0.6f, 0.85f, 0.3f, 0.5f, 0.2f},
                       t[] = {0.2f, 0.3f, 0.1f, 0.65f, 0.45f, 0.05f};
    Far::PtexIndices const faces(refiner);
    using Factory = Far::LimitStencilTableFactoryReal<float>;
    Factory::LocationArrayVec places;
    for (int face = 0; face < faces.GetNumFaces(); ++face) {
        Factory::LocationArray array;
        array.ptexIdx = face;
        array.numLocations = 6;
        array.s = s;
        array.t = t;
        places.push_back(array);
    }
    Factory::Options options;
    options.generate1stDerivatives = options.generate2ndDerivatives = true;
    return std::unique_ptr<FarLimitTable const>(
        Factory::Create(refiner, places, nullptr, nullptr, options));
}

/// Six weight sets through any evaluator that mirrors OpenSubdiv's raw form.
template <class Evaluator>
std::vector<float> EvaluateSets(FarLimitTable const& table, std::vector<float> const& source) {
    size_t const size = static_cast<size_t>(table.GetNumStencils()) * 3;
    std::vector<float> out(6 * size);
    float* const to = out.data();
    OpenSubdiv::Osd::BufferDescriptor const three(0, 3, 3);
    Evaluator::EvalStencils(
        source.data(), three, to, three, to + size, three, to + 2 * size, three, to + 3 * size,
        three, to + 4 * size, three, to + 5 * size, three, table.GetSizes().data(),
        table.GetOffsets().data(), table.GetControlIndices().data(), table.GetWeights().data(),
        table.GetDuWeights().data(), table.GetDvWeights().data(), table.GetDuuWeights().data(),
        table.GetDuvWeights().data(), table.GetDvvWeights().data(), 0, table.GetNumStencils());
    return out;
}

/// Set by set: each against its own largest value.
inline void ExpectNearBySets(std::vector<float> const& ours, std::vector<float> const& theirs,
                             std::string const& name) {
    size_t const size = ours.size() / 6;
    for (size_t set = 0; set < 6; ++set) {
        auto const part = [&](std::vector<float> const& all) {
            return std::vector<float>(all.begin() + set * size, all.begin() + (set + 1) * size);
        };
        EXPECT_LT(RelativeDifference(part(ours), part(theirs)), 1e-6)
            << name << ", weight set " << set;
    }
}

}  // namespace limn::test
