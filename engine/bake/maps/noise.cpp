// SPDX-License-Identifier: Apache-2.0
//
// Noise made on the surface (SurfaceNoise), as it is, as a share of its range, or through a ramp.

#include <array>

#include <fmt/format.h>

#include "engine/bake/maps/map_table.h"
#include "engine/noise/noise_scale.h"

namespace limn::engine {

namespace {

class NoiseMap : public Map {
public:
    NoiseMap(MapTraits traits, MapOptions const& options)
        : Map(std::move(traits)), _options(options) {}

    void Prepare(BakedSurface const& baked, Job& job) override {
        NoiseOptions noise = _options.noise;
        noise.evaluator = _options.evaluator;
        _noise = std::make_unique<SurfaceNoise>(baked.model, noise, job);
    }

    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(*this);
    }

    std::vector<int> GetSingularLevels() const override {
        return _noise ? _noise->GetSingularLevels() : std::vector<int>();
    }

private:
    class Sampler : public MapSampler {
    public:
        explicit Sampler(NoiseMap const& map)
            : _scale(map._noise->GetLow(), map._noise->GetHigh(), map._options.isNormalized,
                     map._options.noiseRamp),
              _noise(*map._noise) {}

        void Start(FaceSamples const& samples) override {
            _values.resize(samples.s.size());
            _noise.Evaluate(samples.face, samples.domain, samples.s, samples.t, _values);
        }

        void Evaluate(SampleBlock const& block, float* out, size_t outStride) override {
            std::array<double, 3> channels{};
            size_t const numChannels = static_cast<size_t>(_scale.GetNumChannels());
            for (size_t i = 0; i < block.GetCount(); ++i) {
                _scale.Convert(_values[block.samples[i]], channels);
                for (size_t c = 0; c < numChannels; ++c)
                    out[c * outStride + i] = static_cast<float>(channels[c]);
            }
        }

    private:
        NoiseScale _scale;
        SurfaceNoise::Sampler _noise;
        std::vector<double> _values;  // per sample of the face
    };

    MapOptions const& _options;
    std::unique_ptr<SurfaceNoise> _noise;
};

}  // namespace

std::unique_ptr<Map> MakeNoiseMap(std::string const& name, MapOptions const& options,
                                  Model const&) {
    MapTraits traits{.name = name, .channels = {"Y"}, .units = "amplitude"};
    bool const isShare = options.isNormalized && !options.noiseRamp;
    if (isShare) {
        traits.range = RangeKind::Positive;
        traits.units = "share of the range";
        traits.limits = {0.0f, 1.0f};
    }
    if (options.noiseRamp) {
        traits.range = RangeKind::Colours;
        traits.units = "colour";
        traits.channels = {"R", "G", "B"};
    }
    traits.optionText = fmt::format("octaves={} frequency={} gain={} seed={} normalize={} ramp={}",
                                    options.noise.octaves, options.noise.frequency.value_or(0.0),
                                    options.noise.gain, options.noise.seed, isShare,
                                    options.noiseRamp ? options.noiseRamp->GetText() : "none");
    if (options.noise.at != NoiseAt::Limit)
        traits.optionText += fmt::format(" at={}", kNoiseAtWords.GetWord(options.noise.at));
    traits.optionText += options.DescribeEvaluator();
    return std::make_unique<NoiseMap>(std::move(traits), options);
}

}  // namespace limn::engine
