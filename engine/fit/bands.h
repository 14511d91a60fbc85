// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/scene/extent.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/stencils/table_evaluator.h"
#include "far_ext/limit/limit_row.h"

namespace limn::engine {

/// Bounding box and volume of a mesh's polygons.
struct MeshExtent : Extent {
    std::optional<double> volume;  ///< none where the mesh is open or not manifold
};

/// \param positions  3 per vertex, the model's or others
/// \throws Error     BadOption: there are too few
MeshExtent MeasureExtent(Model const& model, std::span<double const> positions);

/// The last band that can be asked for: each takes an application of the limit matrix, and high
/// ones hold next to nothing.
inline constexpr int kMaxBands = 1000;

/// Frequency bands of a mesh's positions, 3 numbers per vertex each; all add up to the positions.
struct Bands {
    std::vector<std::vector<double>> bands;  ///< lowest frequencies first
    std::vector<double> remainder;
};

/// \param rule       of the limit matrix: generalised Catmull-Clark has an alpha of 0 (plain) to 1
/// \param evaluator  applies that matrix, in float; null: in double
/// \throws Error  BadOption: a count that is not from 0 to kMaxBands; alpha outside [0, 1] or with
///                a scheme that has none
/// \throws Stopped
Bands SplitIntoBands(Model const& model, int count, far_ext::LimitOptions const& rule, Job& job,
                     eval::TableEvaluator* evaluator = nullptr);

/// The mesh's positions with its lowest bands only.
struct DenoiseOptions {
    int detail = 2;                ///< the last band to keep
    int steps = 1;                 ///< how often
    far_ext::LimitOptions rule{};  ///< as SplitIntoBands
    eval::TableEvaluator* evaluator = nullptr;
};

/// \throws Error  BadOption: detail or steps out of range; as SplitIntoBands
/// \throws Stopped
std::vector<double> Denoise(Model const& model, DenoiseOptions const& options, Job& job);

/// The mesh's positions with some bands added again.
struct SharpenOptions {
    int first = 2, last = 4;  ///< powers of the high-pass filter, from 1
    int steps = 1;
    far_ext::LimitOptions rule{};
    eval::TableEvaluator* evaluator = nullptr;
};

/// \param job     told where the mesh outgrows itself
/// \throws Error  BadOption: first and last are no bands.  TooLarge: steps lead beyond double
/// \throws Stopped
std::vector<double> Sharpen(Model const& model, SharpenOptions const& options, Job& job);

}  // namespace limn::engine
