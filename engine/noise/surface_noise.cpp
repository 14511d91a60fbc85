// SPDX-License-Identifier: Apache-2.0
#include "engine/noise/surface_noise.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "engine/noise/gradient_noise.h"
#include "eval/differential/refine_values.h"
#include "eval/fit/interpolate.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/refined_cage.h"
#include "far_ext/topology/refiner.h"

namespace limn::engine {

namespace {

/// Half a noise cell per mean edge of the cage: what its vertices can show.
double FindFrequency(Far::TopologyLevel const& level, std::span<double const> positions) {
    far_ext::Points const points(positions);
    double length = 0.0;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        length += (points[ends[0]] - points[ends[1]]).norm();
    }
    return length > 0.0 ? 0.5 * level.GetNumEdges() / length : 1.0;
}

/// One octave at the limit points of a level's vertices.
std::vector<double> MakeOctave(std::span<double const> limitPoints, int octave, double frequency,
                               double amplitude, uint64_t seed, Job& job) {
    std::vector<double> values(limitPoints.size() / 3);
    tbb::parallel_for(tbb::blocked_range<size_t>(0, values.size(), 4096), [&](auto const& range) {
        job.CheckStopped();
        for (size_t i = range.begin(); i != range.end(); ++i) {
            double const* const x = &limitPoints[3 * i];
            uint64_t const own =
                seed + static_cast<uint64_t>(octave) * 0x9e3779b97f4a7c15ull;  // octaves differ
            values[i] = amplitude *
                        GradientNoise(own, frequency * x[0], frequency * x[1], frequency * x[2]);
        }
    });
    return values;
}

void CheckOptions(NoiseOptions const& options) {
    if (options.octaves < 1 || options.octaves > 10)
        throw Error(ErrorCode::BadOption,
                    fmt::format("`octaves`: {} is not from 1 to 10", options.octaves));
    double const frequency = options.frequency.value_or(1.0);
    if (!(frequency > 0.0 && std::isfinite(frequency)))
        throw Error(ErrorCode::BadOption,
                    fmt::format("`frequency`: {} is no number above 0", frequency));
}

}  // namespace

SurfaceNoise::SurfaceNoise(Model const& model, NoiseOptions const& options, Job& job) {
    auto const& cage = model.GetCage();
    CheckOptions(options);
    int const levels = options.octaves - 1;
    double const corners = static_cast<double>(cage.faceVertices.size()) * std::pow(4.0, levels);
    if (corners > 2e9) {
        throw Error(
            ErrorCode::TooLarge,
            fmt::format("{}: {} octaves of noise would make {:.1e} face corners on the finest "
                        "level; at most 2e9 can be indexed, take fewer octaves",
                        model.GetPath(), options.octaves, corners));
    }
    auto const refiner = far_ext::CreateRefiner(cage);
    if (levels > 0) {
        Far::TopologyRefiner::UniformOptions uniform(levels);
        uniform.fullTopologyInLastLevel = true;
        refiner->RefineUniform(uniform);
    }
    std::vector<double> positions = model.GetPositions();
    double frequency =
        options.frequency ? *options.frequency : FindFrequency(model.GetLevel(), positions);
    double amplitude = 1.0;
    for (int level = 0; level <= levels; ++level, frequency *= 2.0, amplitude *= options.gain) {
        job.CheckStopped();
        if (level > 0) {
            positions = eval::RefineValues<3>(*refiner, level, positions);
            _values = eval::RefineValues<1>(*refiner, level, _values);
        }
        eval::Interpolator const interpolator(*refiner, level);
        std::vector<double> const octave = MakeOctave(interpolator.FindLimits(positions, 3), level,
                                                      frequency, amplitude, options.seed, job);
        std::vector<double> control(octave.size());
        interpolator.Solve(octave, 1, control, {.tolerance = 1e-9, .onIteration = [&](int, double) {
                                                    job.CheckStopped();
                                                }});
        _values.resize(control.size(), 0.0);
        for (size_t i = 0; i < control.size(); ++i) _values[i] += control[i];
        if (level < levels) continue;
        auto const limits = interpolator.FindLimits(_values, 1);
        auto const [low, high] = std::minmax_element(limits.begin(), limits.end());
        _low = *low;
        _high = *high;
    }
    _cage = levels > 0 ? far_ext::MakeRefinedCage(*refiner, cage) : cage;
    _cage.fvarChannels.clear();
    _faces = std::make_unique<eval::RefinedFaces>(eval::LimitSurface(model.GetRefiner()), levels);
    _refiner = far_ext::CreateRefiner(_cage);
    _surface = std::make_unique<eval::LimitSurface>(*_refiner);
}

SurfaceNoise::Sampler::Sampler(SurfaceNoise const& noise)
    : _noise(noise), _tree(*noise._surface, noise._values, 1) {}

void SurfaceNoise::Sampler::Evaluate(Index face, int domain, std::span<double const> s,
                                     std::span<double const> t, std::span<double> values) {
    _noise._faces->FindSorted(face, domain, s, t, _places);
    Index bound = -1;
    for (auto const& place : _places) {
        if (place.at.face != bound) _tree.Bind(place.at.face);
        bound = place.at.face;
        auto const piece = _tree.LocateChecked(place.at.domain, place.at.s, place.at.t,
                                               eval::FaceTree::kLimitDepth);
        values[place.index] = eval::EvaluateDerivatives(_tree, piece, 0)[0];
    }
}

}  // namespace limn::engine
