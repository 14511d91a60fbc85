// SPDX-License-Identifier: Apache-2.0
#include "engine/noise/surface_noise.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "engine/noise/gradient_noise.h"
#include "engine/scene/refine.h"
#include "eval/differential/value_refiner.h"
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

/// One octave at points.
std::vector<double> MakeOctave(std::span<double const> points, int octave, double frequency,
                               double amplitude, uint64_t seed, Job& job) {
    std::vector<double> values(points.size() / 3);
    tbb::parallel_for(tbb::blocked_range<size_t>(0, values.size(), 4096), [&](auto const& range) {
        job.CheckStopped();
        for (size_t i = range.begin(); i != range.end(); ++i) {
            double const* const x = &points[3 * i];
            uint64_t const own =
                seed + static_cast<uint64_t>(octave) * 0x9e3779b97f4a7c15ull;  // octaves differ
            values[i] = amplitude *
                        GradientNoise(own, frequency * x[0], frequency * x[1], frequency * x[2]);
        }
    });
    return values;
}

/// \return the level of the last octave
int CheckOptions(Model const& model, NoiseOptions const& options) {
    if (options.octaves < 1 || options.octaves > 10)
        throw Error(ErrorCode::BadOption,
                    fmt::format("`octaves`: {} is not from 1 to 10", options.octaves));
    double const frequency = options.frequency.value_or(1.0);
    if (!(frequency > 0.0 && std::isfinite(frequency)))
        throw Error(ErrorCode::BadOption,
                    fmt::format("`frequency`: {} is no number above 0", frequency));
    int const levels = options.octaves - 1;
    double const corners =
        static_cast<double>(model.GetCage().faceVertices.size()) * std::pow(4.0, levels);
    if (corners > 2e9) {
        throw Error(
            ErrorCode::TooLarge,
            fmt::format("{}: {} octaves of noise would make {:.1e} face corners on the finest "
                        "level; at most 2e9 can be indexed, take fewer octaves",
                        model.GetPath(), options.octaves, corners));
    }
    return levels;
}

/// All octaves as control values of the last one's level, and their range over its limits.
struct Octaves {
    std::vector<double> control;
    double low = 0.0, high = 0.0;
    std::vector<int> singularLevels;
};

/// Control values of one octave.
std::vector<double> FitOctave(Model const& model, eval::Interpolator const& interpolator, int level,
                              std::vector<double> const& octave, Octaves& octaves, Job& job) {
    std::vector<double> control(octave.size());
    auto const report = interpolator.Solve(
        octave, 1, control,
        {.tolerance = 1e-9, .onIteration = [&](int, double) { job.CheckStopped(); }});
    if (report.singularComponents.empty()) return control;
    octaves.singularLevels.push_back(level);
    job.Warn(
        fmt::format("{}: noise of octave {}: on {} component{} all vertices have valence 3 "
                    "and alternate, like a cube's; what alternates is taken out of it there",
                    model.GetPath(), level + 1, report.singularComponents.size(),
                    report.singularComponents.size() > 1 ? "s" : ""));
    return control;
}

/// \param values  of a refiner that is refined uniformly as far as the last octave, or farther
Octaves AddUpOctaves(Model const& model, eval::ValueRefiner& values, NoiseOptions const& options,
                     Job& job) {
    Octaves octaves;
    std::vector<double> positions = model.GetPositions();
    double frequency =
        options.frequency ? *options.frequency : FindFrequency(model.GetLevel(), positions);
    double amplitude = 1.0;
    for (int level = 0; level < options.octaves; ++level) {
        job.CheckStopped();
        if (level > 0) {
            positions = values.Refine<3>(level, positions);
            octaves.control = values.Refine<1>(level, octaves.control);
        }
        eval::Interpolator const interpolator(values.GetRefiner(), level);
        auto const points =
            options.at == NoiseAt::Limit ? interpolator.FindLimits(positions, 3) : positions;
        auto const octave = MakeOctave(points, level, frequency, amplitude, options.seed, job);
        auto const control = FitOctave(model, interpolator, level, octave, octaves, job);
        octaves.control.resize(control.size(), 0.0);
        for (size_t i = 0; i < control.size(); ++i) octaves.control[i] += control[i];
        frequency *= 2.0;
        amplitude *= options.gain;
        if (level + 1 < options.octaves) continue;
        auto const limits = interpolator.FindLimits(octaves.control, 1);
        auto const [low, high] = std::minmax_element(limits.begin(), limits.end());
        octaves.low = *low;
        octaves.high = *high;
    }
    return octaves;
}

}  // namespace

SurfaceNoise::SurfaceNoise(Model const& model, NoiseOptions const& options, Job& job) {
    int const levels = CheckOptions(model, options);
    auto const refiner = MakeUniformRefiner(model.GetCage(), model.GetPath(), levels);
    eval::ValueRefiner values(*refiner, options.evaluator);
    Octaves octaves = AddUpOctaves(model, values, options, job);
    _values = std::move(octaves.control);
    _low = octaves.low;
    _high = octaves.high;
    _singularLevels = std::move(octaves.singularLevels);
    _cage = levels > 0 ? far_ext::MakeRefinedCage(*refiner, model.GetCage()) : model.GetCage();
    _cage.fvarChannels.clear();
    _faces = std::make_unique<eval::RefinedFaces>(eval::LimitSurface(model.GetRefiner()), levels);
    _refiner = far_ext::CreateRefiner(_cage);
    _surface = std::make_unique<eval::LimitSurface>(*_refiner);
}

VertexNoise FindVertexNoise(Model const& model, NoiseOptions const& options, int level, Job& job) {
    int const octaveLevel = CheckOptions(model, options), last = std::max(level, octaveLevel);
    auto const refiner = MakeUniformRefiner(model.GetCage(), model.GetPath(), last);
    eval::ValueRefiner values(*refiner, options.evaluator);
    Octaves octaves = AddUpOctaves(model, values, options, job);
    for (int next = octaveLevel + 1; next <= last; ++next) {
        job.CheckStopped();
        octaves.control = values.Refine<1>(next, octaves.control);
    }
    VertexNoise noise{eval::Interpolator(*refiner, last).FindLimits(octaves.control, 1),
                      octaves.low, octaves.high, std::move(octaves.singularLevels)};
    // A vertex keeps its number, and its limit, on all levels to come.
    noise.values.resize(static_cast<size_t>(refiner->GetLevel(level).GetNumVertices()));
    return noise;
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
