// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/maps/map.h"

#include <fmt/format.h>

namespace limn::engine {

namespace {

class PointwiseMap : public Map {
public:
    PointwiseMap(MapTraits traits, EvaluateBlock evaluate)
        : Map(std::move(traits)), _evaluate(evaluate) {}

    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(_evaluate);
    }

private:
    class Sampler : public MapSampler {
    public:
        explicit Sampler(EvaluateBlock evaluate) : _evaluate(evaluate) {}
        void Evaluate(SampleBlock const& block, float* out, size_t outStride) override {
            _evaluate(block, out, outStride);
        }

    private:
        EvaluateBlock _evaluate;
    };

    EvaluateBlock _evaluate;
};

}  // namespace

std::string MapTraits::GetOriginText() const {
    if (!origin || *origin == std::array<double, 3>{}) return {};
    return fmt::format("{},{},{}", (*origin)[0], (*origin)[1], (*origin)[2]);
}

std::vector<ChannelGroup> MapTraits::GetGroups() const {
    if (groups.empty()) return {{0, GetNumChannels(), Averaging::Plain}};
    return groups;
}

std::unique_ptr<Map> MakePointwiseMap(MapTraits traits, EvaluateBlock evaluate) {
    return std::make_unique<PointwiseMap>(std::move(traits), evaluate);
}

}  // namespace limn::engine
