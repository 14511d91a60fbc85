// SPDX-License-Identifier: Apache-2.0
//
// How many faces lie over a texel's centre: 1 where the layout is sound.

#include <algorithm>

#include "engine/bake/maps/map_table.h"

namespace limn::engine {

namespace {

class OverlapMap : public Map {
public:
    using Map::Map;

    std::unique_ptr<MapSampler> MakeSampler() const override { return std::make_unique<Sampler>(); }

private:
    class Sampler : public MapSampler {
    public:
        void Evaluate(SampleBlock const&, float*, size_t) override {}
        void EvaluateCounts(std::span<int const> numFaces, float* out) override {
            std::ranges::transform(numFaces, out,
                                   [](int count) { return static_cast<float>(count); });
        }
    };
};

}  // namespace

std::unique_ptr<Map> MakeOverlapMap(std::string const& name, MapOptions const&, Model const&) {
    MapTraits traits{.name = name, .channels = {"Y"}, .units = "faces"};
    traits.range = RangeKind::Positive;
    traits.groups = {{0, 1, Averaging::Count}};
    traits.needsFaceCounts = true;
    traits.isComparableAtSeams = false;
    return std::make_unique<OverlapMap>(std::move(traits));
}

}  // namespace limn::engine
