// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "engine/bake/bake_report.h"
#include "engine/bake/raster/uv_raster.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// Takes note of where faces overlap. One per thread; together they say the same for any number of
/// them.
class OverlapLog {
public:
    /// \param model  kept by reference
    explicit OverlapLog(Model const& model) : _model(model) {}

    /// Takes the overlaps that a strip has found, and marks its texels with the kinds of groups
    /// that tell the faces apart.
    void Take(TexelStrip& texels);

    /// Counts texels so marked, of which all faces are known.
    void Count(std::span<uint8_t const> overlap);

    void AddTo(BakeReport& report) const;

private:
    Model const& _model;
    size_t _numTexels = 0;
    OverlapReport _found;
};

}  // namespace limn::engine
