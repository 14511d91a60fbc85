// SPDX-License-Identifier: Apache-2.0
//
// Noise made on the surface (SurfaceNoise), as it is, as a share of its range, or through a ramp.

#include <algorithm>

#include <fmt/format.h>

#include "engine/bake/maps/map_table.h"

namespace limn::engine {

namespace {

class NoiseMap : public Map {
public:
    NoiseMap(MapTraits traits, MapOptions const& options)
        : Map(std::move(traits)), _options(options) {}

    void Prepare(BakedSurface const& baked, Job& job) override {
        _noise = std::make_unique<SurfaceNoise>(baked.model, _options.noise, job);
    }

    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(*this);
    }

private:
    class Sampler : public MapSampler {
    public:
        explicit Sampler(NoiseMap const& map)
            : _ramp(map._options.noiseRamp ? &*map._options.noiseRamp : nullptr),
              _isNormalized(map._options.isNormalized),
              _low(map._noise->GetLow()),
              _range(map._noise->GetHigh() - _low),
              _noise(*map._noise) {}

        void Start(FaceSamples const& samples) override {
            _values.resize(samples.s.size());
            _noise.Evaluate(samples.face, samples.domain, samples.s, samples.t, _values);
        }

        void Evaluate(SampleBlock const& block, float* out, size_t outStride) override {
            for (size_t i = 0; i < block.GetCount(); ++i) {
                double const value = _values[block.samples[i]];
                double const share =
                    _range > 0.0 ? std::clamp((value - _low) / _range, 0.0, 1.0) : 0.5;
                if (!_ramp) {
                    out[i] = static_cast<float>(_isNormalized ? share : value);
                    continue;
                }
                auto const colour = _ramp->Evaluate(share);
                for (size_t c = 0; c < 3; ++c) {
                    out[c * outStride + i] = static_cast<float>(colour[c]);
                }
            }
        }

    private:
        ColourRamp const* _ramp;
        bool _isNormalized;
        double _low, _range;  // over the whole surface
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
    return std::make_unique<NoiseMap>(std::move(traits), options);
}

}  // namespace limn::engine
