// SPDX-License-Identifier: Apache-2.0
//
// The mesh's frequency bands as layers of displacement: from the limit of its smooth base they add
// up to the way to its own.

#include "engine/fit/bands.h"

#include <fmt/format.h>

#include "engine/bake/maps/map_table.h"
#include "engine/bake/maps/vector_frame.h"

namespace limn::engine {

namespace {

class BandsMap : public Map {
public:
    BandsMap(MapTraits traits, MapOptions const& options)
        : Map(std::move(traits)), _numBands(options.bands), _frame(options) {}

    void Prepare(BakedSurface const& baked, Job& job) override {
        auto [bands, remainder] = SplitIntoBands(baked.model, _numBands, 0.0, job);
        bands.push_back(std::move(remainder));
        for (size_t vertex = 0; vertex < baked.model.GetPositions().size(); vertex += 3) {
            for (int band = 1; band <= _numBands; ++band) {  // all but the base
                for (size_t c = 0; c < 3; ++c) _values.push_back(bands[band][vertex + c]);
            }
        }
    }

    std::vector<eval::FaceTree::Values> GetValues() const override {
        return {{_values, 3 * _numBands}};
    }

    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(*this);
    }

private:
    class Sampler : public MapSampler {
    public:
        explicit Sampler(BandsMap const& map) : _numBands(map._numBands), _frame(map._frame) {}

        void Evaluate(SampleBlock const& block, float* out, size_t outStride) override {
            for (int band = 0; band < _numBands; ++band) {
                for (size_t i = 0; i < block.GetCount(); ++i) {
                    _frame.Put(block, i, block.GetValue(3 * band, i), out, outStride);
                }
                out += _frame.GetNumChannels() * outStride;
            }
        }

        TangentialPart TakeTangentialPart() override { return _frame.TakeTangentialPart(); }

    private:
        int _numBands;
        VectorFrame _frame;
    };

    int _numBands;
    VectorFrame _frame;
    std::vector<double> _values;  // per vertex: bands 1, 2, ..., the remainder
};

}  // namespace

std::unique_ptr<Map> MakeBandsMap(std::string const& name, MapOptions const& options,
                                  Model const&) {
    MapTraits traits{.name = name, .units = "length"};
    for (int band = 1; band <= options.bands; ++band) {
        std::string const part =
            band < options.bands ? fmt::format("band{}", band) : std::string("remainder");
        if (!options.isVector) traits.channels.push_back(part);
        for (char const* axis : {".R", ".G", ".B"}) {
            if (options.isVector) traits.channels.push_back(part + axis);
        }
    }
    if (traits.channels.size() == 3) traits.range = RangeKind::Vector;
    traits.optionText = fmt::format("bands={}", options.bands);
    VectorFrame(options).AddNeeds(traits);
    return std::make_unique<BandsMap>(std::move(traits), options);
}

}  // namespace limn::engine
