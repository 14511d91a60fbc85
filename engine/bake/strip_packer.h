// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/bake/strip.h"
#include "engine/bake/texel_sink.h"
#include "engine/scene/job.h"

namespace limn::engine {

/// A strip ready to be written.
struct PackedStrip {
    /// What goes to one sink; without `rows` where there is none.
    struct Output {
        StripView view;
        std::unique_ptr<PackedRows> rows;
        float min = 0.0f, max = 0.0f;  ///< over covered texels; min > max if there are none
    };
    std::vector<Output> outputs;
    std::shared_ptr<Strip> strip;  ///< what the views look at, and
    std::vector<float> coverage;   ///< [row][column]; empty where no sink wants it
};

/// Pads a strip from its neighbours and lets each sink pack it.
///
/// \param window  the strip and those round it, in order, at least enough for the padding where
/// they
///                exist
/// \param at      the strip's place in the window. Only its uncovered texels are written, so that
///                neighbours may be padded from it at the same time
/// \param sinks   one per file; null for files that are not written
PackedStrip PackStrip(std::span<std::shared_ptr<Strip> const> window, size_t at, int padding,
                      std::vector<FileLayout> const& files,
                      std::vector<std::unique_ptr<TexelSink>> const& sinks, Job const& job);

}  // namespace limn::engine
