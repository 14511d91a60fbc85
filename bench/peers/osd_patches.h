// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuPatchTable.h>

#include "far_ext/topology/control_mesh.h"
#include "far_ext/topology/refiner.h"

namespace limn::bench {

namespace Osd = OpenSubdiv::Osd;

/// OpenSubdiv's patches as its users evaluate them: adaptive refinement to `level`, Gregory ends,
/// one EvalPatches call for all samples. Tables, refined points and the patch of every sample are
/// made beforehand and not timed.
class OsdPatches {
public:
    static constexpr int kLength = 18;  ///< floats per sample: P, Ps, Pt, Pss, Pst, Ptt

    OsdPatches(far_ext::ControlMesh const& cage, std::span<double const> positions, int level)
        : _refiner(far_ext::CreateRefiner(cage)) {
        Far::PatchTableFactory::Options options(static_cast<unsigned>(level));
        options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
        _refiner->RefineAdaptive(options.GetRefineAdaptiveOptions());
        _table.reset(Far::PatchTableFactory::Create(*_refiner, options));
        _map = std::make_unique<Far::PatchMap>(*_table);
        _cpuTable.reset(Osd::CpuPatchTable::Create(_table.get()));
        RefinePoints(positions);
    }

    Osd::PatchCoord Find(Index face, double s, double t) const {
        auto const* const handle = _map->FindPatch(face, s, t);
        return {*handle, static_cast<float>(s), static_cast<float>(t)};
    }

    void Evaluate(std::span<Osd::PatchCoord const> coords, float* out) const {
        Osd::BufferDescriptor const from(0, 3, 3), to(0, 3, kLength);
        Osd::CpuEvaluator::EvalPatches(
            _points.data(), from, out, to, out + 3, to, out + 6, to, out + 9, to, out + 12, to,
            out + 15, to, static_cast<int>(coords.size()), coords.data(),
            _cpuTable->GetPatchArrayBuffer(), _cpuTable->GetPatchIndexBuffer(),
            _cpuTable->GetPatchParamBuffer());
    }

    int GetNumPatches() const { return _table->GetNumPatchesTotal(); }

private:
    void RefinePoints(std::span<double const> positions) {
        using Factory = Far::StencilTableFactory;
        Factory::Options options;
        options.generateOffsets = options.generateIntermediateLevels = true;
        std::unique_ptr<Far::StencilTable const> stencils(Factory::Create(*_refiner, options));
        if (auto const* const local = _table->GetLocalPointStencilTable()) {
            if (auto const* const all =
                    Factory::AppendLocalPointStencilTable(*_refiner, stencils.get(), local)) {
                stencils.reset(all);
            }
        }
        int const numCage = static_cast<int>(positions.size() / 3),
                  numRefined = stencils->GetNumStencils();
        _points.assign(positions.begin(), positions.end());
        _points.resize(static_cast<size_t>(numCage + numRefined) * 3);
        if (numRefined == 0) return;
        Osd::CpuEvaluator::EvalStencils(_points.data(), Osd::BufferDescriptor(0, 3, 3),
                                        _points.data(), Osd::BufferDescriptor(3 * numCage, 3, 3),
                                        stencils->GetSizes().data(), stencils->GetOffsets().data(),
                                        stencils->GetControlIndices().data(),
                                        stencils->GetWeights().data(), 0, numRefined);
    }

    std::unique_ptr<Far::TopologyRefiner> _refiner;
    std::unique_ptr<Far::PatchTable> _table;
    std::unique_ptr<Far::PatchMap> _map;
    std::unique_ptr<Osd::CpuPatchTable> _cpuTable;
    std::vector<float> _points;
};

}  // namespace limn::bench
