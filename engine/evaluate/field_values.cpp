// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/field_values.h"

#include <algorithm>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "engine/scene/require_limit.h"
#include "eval/forms/field_surface.h"

namespace limn::engine {

int ChooseFieldLevels(Model const& model) {
    constexpr int kMost = 4;
    constexpr double kMostFaces = 0x1p20;
    double count = static_cast<double>(model.GetCage().faceVertices.size());
    int levels = 1;  // has a face per corner
    for (; levels < kMost && 4.0 * count <= kMostFaces; count *= 4.0) ++levels;
    return levels;
}

std::vector<double> EvaluateField(Model const& model, PlaceArrays const& places,
                                  std::span<double const> form, int levels, Job& job) {
    RequireLimit(model);
    job.Start("evaluating the field");
    auto const located = LocatePlaces(model, places);
    eval::LimitSurface const surface(model.GetRefiner());
    eval::FieldSurface const field(model.GetCage(), model.GetPositions(), form, levels);
    std::vector<double> vectors(3 * located.size(), std::numeric_limits<double>::quiet_NaN());
    tbb::enumerable_thread_specific<eval::FieldSurface::Sampler> samplers(
        [&] { return eval::FieldSurface::Sampler(field); });
    tbb::parallel_for(tbb::blocked_range<size_t>(0, located.size(), 256), [&](auto const& range) {
        job.CheckStopped();
        auto& sampler = samplers.local();
        for (size_t i = range.begin(); i != range.end(); ++i) {
            auto const& [face, domain, s, t] = located[i];
            if (!surface.HasLimit(face)) continue;
            Eigen::Vector3d vector;
            sampler.Evaluate(face, domain, {&s, 1}, {&t, 1}, {&vector, 1});
            std::copy_n(vector.data(), 3, &vectors[3 * i]);
        }
    });
    return vectors;
}

}  // namespace limn::engine
