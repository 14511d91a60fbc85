// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/stencilTableFactory.h>

#include "far_ext/topology/refiner.h"

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
inline std::unique_ptr<FarTable const> MakeFarTable(Far::TopologyRefiner const& refiner,
                                                    int interpolationMode) {
    using Factory = Far::StencilTableFactoryReal<float>;
    Factory::Options options;
    options.interpolationMode = static_cast<unsigned>(interpolationMode) & 3u;
    options.generateIntermediateLevels = false;
    options.generateOffsets = true;
    return std::unique_ptr<FarTable const>(Factory::Create(refiner, options));
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

inline std::vector<float> MakeRandomValues(size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> values(count);
    for (float& value : values) value = static_cast<float>(random()) * 0x1p-31f - 1.0f;
    return values;
}

/// Largest difference over the largest value.
inline double RelativeDifference(std::vector<float> const& a, std::vector<float> const& b) {
    double largest = 0.0, difference = a.size() == b.size() ? 0.0 : 1.0;
    for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        largest = std::max(largest, std::abs(static_cast<double>(b[i])));
        difference = std::max(difference, std::abs(static_cast<double>(a[i]) - b[i]));
    }
    return largest > 0.0 ? difference / largest : difference;
}

}  // namespace limn::test
