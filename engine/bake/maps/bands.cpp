// SPDX-License-Identifier: Apache-2.0
//
// The mesh's frequency bands as layers of displacement: from the limit of its smooth base they add
// up to the way to its own. Or one layer: the way from the mesh's limit to that of a sum of bands.

#include "engine/fit/bands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/bake/maps/map_table.h"
#include "engine/bake/maps/vector_frame.h"

namespace limn::engine {

namespace {

class BandsMap : public Map {
public:
    BandsMap(MapTraits traits, MapOptions const& options)
        : Map(std::move(traits)),
          _numLayers(options.bandSum ? 1 : options.bands),
          _frame(options),
          _sum(options.bandSum),
          _evaluator(options.evaluator) {
        if (_sum) _sum->evaluator = _evaluator;
    }

    void Prepare(BakedSurface const& baked, Job& job) override {
        _values = _sum ? FindWayToSum(baked.model, job) : FindLayers(baked.model, job);
    }

    std::vector<eval::FaceTree::Values> GetValues() const override {
        return {{_values, 3 * _numLayers}};
    }

    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(*this);
    }

private:
    /// Per vertex bands 1, 2, ..., the remainder.
    std::vector<double> FindLayers(Model const& model, Job& job) const {
        auto [bands, remainder] = SplitIntoBands(model, _numLayers, {}, job, _evaluator);
        bands.push_back(std::move(remainder));
        std::vector<double> values;
        for (size_t vertex = 0; vertex < model.GetPositions().size(); vertex += 3) {
            for (int band = 1; band <= _numLayers; ++band) {  // all but the base
                for (size_t c = 0; c < 3; ++c) values.push_back(bands[band][vertex + c]);
            }
        }
        return values;
    }

    std::vector<double> FindWayToSum(Model const& model, Job& job) const {
        std::vector<double> way = SumBands(model, *_sum, job).positions;
        for (size_t i = 0; i < way.size(); ++i) way[i] -= model.GetPositions()[i];
        return way;
    }

    class Sampler : public MapSampler {
    public:
        explicit Sampler(BandsMap const& map) : _numLayers(map._numLayers), _frame(map._frame) {}

        void Evaluate(SampleBlock const& block, float* out, size_t outStride) override {
            for (int layer = 0; layer < _numLayers; ++layer) {
                for (size_t i = 0; i < block.GetCount(); ++i) {
                    _frame.Put(block, i, block.GetValue(3 * layer, i), out, outStride);
                }
                out += _frame.GetNumChannels() * outStride;
            }
        }

        TangentialPart TakeTangentialPart() override { return _frame.TakeTangentialPart(); }

    private:
        int _numLayers;
        VectorFrame _frame;
    };

    int _numLayers;
    VectorFrame _frame;
    std::optional<BandSumOptions> _sum;
    eval::TableEvaluator* _evaluator;
    std::vector<double> _values;  // per vertex a vector for each layer
};

std::vector<std::string> NameLayers(MapOptions const& options) {
    if (options.bandSum) return {"from"};
    std::vector<std::string> names;
    for (int band = 1; band < options.bands; ++band) names.push_back(fmt::format("band{}", band));
    names.emplace_back("remainder");
    return names;
}

/// What makes the pixels, told in the file.
std::string DescribeBands(MapOptions const& options) {
    if (!options.bandSum) return fmt::format("bands={}", options.bands);
    auto const& [first, gains, remainder] = options.bandSum->gains;
    std::string text = fmt::format("bands={} gain={}", first, fmt::join(gains, ","));
    if (remainder) text += fmt::format(" remainder={}", *remainder);
    if (options.bandSum->from) {
        text += fmt::format(" from={} carry={}", options.bandSum->from->GetSha256(),
                            kCarryWords.GetWord(options.bandSum->carry));
    }
    return text;
}

}  // namespace

std::unique_ptr<Map> MakeBandsMap(std::string const& name, MapOptions const& options,
                                  Model const&) {
    MapTraits traits{.name = name, .units = "length"};
    for (std::string const& layer : NameLayers(options)) {
        if (!options.isVector) traits.channels.push_back(layer);
        for (char const* axis : {".R", ".G", ".B"}) {
            if (options.isVector) traits.channels.push_back(layer + axis);
        }
    }
    if (traits.channels.size() == 3) traits.range = RangeKind::Vector;
    traits.optionText = DescribeBands(options) + options.DescribeEvaluator();
    VectorFrame(options).AddNeeds(traits);
    return std::make_unique<BandsMap>(std::move(traits), options);
}

}  // namespace limn::engine
