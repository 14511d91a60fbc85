// SPDX-License-Identifier: Apache-2.0
#include "far_ext/limit/far_limit_stencils.h"

#include <memory>

#include <fmt/format.h>
#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>

#include "far_ext/error.h"
#include "far_ext/topology/refiner.h"

namespace limn::far_ext {

namespace {

using Factory = Far::LimitStencilTableFactoryReal<float>;

Far::PatchTableFactory::Options MakePatchOptions(FarLimitOptions const& options) {
    using Patches = Far::PatchTableFactory::Options;
    if (options.level < 1 || options.level > FarLimitOptions::kMaxLevel) {
        throw Error(ErrorCode::BadOption, fmt::format("`farLevel` {}: it is from 1 to {}",
                                                      options.level, FarLimitOptions::kMaxLevel));
    }
    Patches patches(static_cast<unsigned int>(options.level));
    patches.SetEndCapType(options.endCap == EndCap::Gregory ? Patches::ENDCAP_GREGORY_BASIS
                                                            : Patches::ENDCAP_BSPLINE_BASIS);
    patches.useInfSharpPatch = options.hasInfSharpPatches;
    return patches;
}

StencilRows CopyRows(Far::LimitStencilTableReal<float> const& table, Index numControls) {
    StencilRows rows(numControls, kMaxWeightSets);
    std::vector<float> const* const sets[kMaxWeightSets] = {
        &table.GetWeights(),    &table.GetDuWeights(),  &table.GetDvWeights(),
        &table.GetDuuWeights(), &table.GetDuvWeights(), &table.GetDvvWeights()};
    size_t entry = 0;
    for (int size : table.GetSizes()) {
        for (int k = 0; k < size; ++k, ++entry) {
            float weights[kMaxWeightSets];
            for (size_t set = 0; set < kMaxWeightSets; ++set) weights[set] = (*sets[set])[entry];
            rows.AddEntry(table.GetControlIndices()[entry], weights);
        }
        rows.EndRow();
    }
    return rows;
}

/// The factory skips places without a patch; so these are found first.
std::vector<int> NumberRows(Far::PatchTable const& patches, std::span<PtexPlace const> places) {
    Far::PatchMap const map(patches);
    std::vector<int> rows;
    rows.reserve(places.size());
    int next = 0;
    for (PtexPlace const& place : places)
        rows.push_back(map.FindPatch(place.face, place.s, place.t) ? next++ : -1);
    return rows;
}

}  // namespace

FarLimitStencils BuildFarLimitStencils(ControlMesh const& cage, std::span<PtexPlace const> places,
                                       FarLimitOptions const& options) {
    auto const patchOptions = MakePatchOptions(options);
    FarReportGuard const guard;
    auto const refiner = CreateRefiner(cage);
    refiner->RefineAdaptive(patchOptions.GetRefineAdaptiveOptions());
    std::unique_ptr<Far::PatchTable const> const patches(
        Far::PatchTableFactory::Create(*refiner, patchOptions));
    guard.ThrowIfReported("isolating features");
    FarLimitStencils result{StencilRows(cage.numVertices, kMaxWeightSets),
                            NumberRows(*patches, places)};

    std::vector<float> s, t;
    Factory::LocationArrayVec locations;
    s.reserve(places.size());
    t.reserve(places.size());
    for (size_t i = 0; i < places.size(); ++i) {
        if (result.rowOfPlace[i] < 0) continue;
        s.push_back(static_cast<float>(places[i].s));
        t.push_back(static_cast<float>(places[i].t));
        auto& location = locations.emplace_back();
        location.ptexIdx = places[i].face;
        location.numLocations = 1;
        location.s = &s.back();
        location.t = &t.back();
    }
    if (locations.empty()) return result;
    Factory::Options tableOptions;
    tableOptions.generate2ndDerivatives = true;
    std::unique_ptr<Far::LimitStencilTableReal<float> const> const table(
        Factory::Create(*refiner, locations, nullptr, patches.get(), tableOptions));
    guard.ThrowIfReported("making limit stencils");
    if (!table || table->GetNumStencils() != static_cast<int>(locations.size()))
        throw Error(ErrorCode::BadMesh, "OpenSubdiv makes no limit stencils of this mesh");
    result.rows = CopyRows(*table, cage.numVertices);
    return result;
}

}  // namespace limn::far_ext
