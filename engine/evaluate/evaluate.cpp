// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluate.h"

#include <algorithm>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "engine/scene/require_limit.h"

namespace limn::engine {

LimitValues LimitValues::MakeEmpty(size_t numPlaces) {
    std::vector<double> const one(numPlaces, std::numeric_limits<double>::quiet_NaN()),
        three(3 * numPlaces, std::numeric_limits<double>::quiet_NaN());
    return {three, three, one, one, one, one, three, std::vector<char>(numPlaces, 0)};
}

size_t LimitValues::CountWithoutLimit() const {
    return static_cast<size_t>(std::count(hasLimit.begin(), hasLimit.end(), 0));
}

LimitValues EvaluateLimit(Model const& model, PlaceArrays const& places, Orientation orientation,
                          Job& job) {
    RequireLimit(model);
    job.Start("evaluating places");
    eval::LimitSurface const surface(model.GetRefiner());
    auto const located = LocatePlaces(model, places);
    std::vector<eval::SurfaceSample> samples(located.size());
    tbb::enumerable_thread_specific<eval::FaceTree> trees(
        [&] { return eval::FaceTree(surface, model.GetPositions(), 3); });
    tbb::parallel_for(tbb::blocked_range<size_t>(0, located.size(), 256), [&](auto const& range) {
        job.CheckStopped();
        eval::FaceTree& tree = trees.local();
        Index bound = -1;
        for (size_t i = range.begin(); i != range.end(); ++i) {
            auto const& place = located[i];
            if (!surface.HasLimit(place.face)) continue;
            if (place.face != bound) tree.Bind(place.face);
            bound = place.face;
            samples[i] = eval::EvaluateSample(tree, place.domain, place.s, place.t, orientation);
        }
    });
    return MakeLimitValues(surface, places.faces, samples);
}

LimitValues EvaluateLimit(Model const& model, PlaceArrays const& places, Orientation orientation,
                          eval::TableEvaluator& evaluator, Job& job) {
    RequireLimit(model);
    job.Start("building the table of places");
    eval::LimitSurface const surface(model.GetRefiner());
    eval::PlaceStencils const stencils(surface, LocatePlaces(model, places));
    auto const table = evaluator.Make(kPlacesTable, stencils.MakeRows());
    job.CheckStopped();
    return MakeLimitValues(surface, places.faces,
                           stencils.Evaluate(model.GetPositions(), orientation, table));
}

LimitValues MakeLimitValues(eval::LimitSurface const& surface, std::span<Index const> faces,
                            std::vector<eval::SurfaceSample> const& samples) {
    size_t const count = samples.size();
    LimitValues values = LimitValues::MakeEmpty(count);
    auto const put = [](Eigen::Vector3d const& v, double* to) { std::copy_n(v.data(), 3, to); };
    for (size_t i = 0; i < count; ++i) {
        if (!surface.HasLimit(faces[i])) continue;
        auto const& curvature = samples[i].curvature;
        values.hasLimit[i] = 1;
        put(samples[i].position, &values.positions[3 * i]);
        put(samples[i].normal, &values.normals[3 * i]);
        put(curvature.direction, &values.directions[3 * i]);
        values.mean[i] = curvature.mean;
        values.gaussian[i] = curvature.gaussian;
        values.k1[i] = curvature.k1;
        values.k2[i] = curvature.k2;
    }
    return values;
}

}  // namespace limn::engine
