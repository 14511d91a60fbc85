// SPDX-License-Identifier: Apache-2.0
//
// Position of the limit surface in object space, or relative to an origin: far from the origin of
// the space floats are farther apart than texels.

#include "engine/bake/maps/map_table.h"
#include "engine/scene/extent.h"

namespace limn::engine {

namespace {

class PositionMap : public Map {
public:
    explicit PositionMap(MapTraits traits) : Map(std::move(traits)) {}

    void Prepare(BakedSurface const& baked, Job&) override {
        _origin = GetTraits().origin.value_or(_origin);
        for (size_t c = 0; c < 3; ++c) _origin[c] -= baked.floatOrigin[c];
    }

    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(_origin);
    }

private:
    class Sampler : public MapSampler {
    public:
        explicit Sampler(std::array<double, 3> const& origin) : _origin(origin) {}

        void Evaluate(SampleBlock const& block, float* out, size_t outStride) override {
            for (size_t c = 0; c < 3; ++c) {
                float const* const plane = block.GetPlane(eval::kPositionX + static_cast<int>(c));
                for (size_t i = 0; i < block.GetCount(); ++i)
                    out[c * outStride + i] = static_cast<float>(plane[i] - _origin[c]);
            }
        }

    private:
        std::array<double, 3> _origin;
    };

    std::array<double, 3> _origin{};  // of samples' positions
};

std::array<double, 3> Resolve(Origin const& origin, Model const& model) {
    auto const* const point = std::get_if<std::array<double, 3>>(&origin);
    return point ? *point : FindOrigin(FindExtent(model.GetPositions()));
}

}  // namespace

std::unique_ptr<Map> MakePositionMap(std::string const& name, MapOptions const& options,
                                     Model const& model) {
    MapTraits traits{.name = name, .channels = {"R", "G", "B"}, .units = "length"};
    traits.range = RangeKind::Vector;
    traits.isPlace = true;
    traits.isSameAcrossCreases = true;
    if (options.origin) traits.origin = Resolve(*options.origin, model);
    if (std::string const origin = traits.GetOriginText(); !origin.empty())
        traits.optionText = "origin=" + origin;
    return std::make_unique<PositionMap>(std::move(traits));
}

}  // namespace limn::engine
