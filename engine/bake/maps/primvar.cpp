// SPDX-License-Identifier: Apache-2.0
//
// Colours and scalars that came with the mesh's vertices, subdivided like positions.

#include <algorithm>

#include <fmt/format.h>

#include "engine/bake/maps/map_table.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

class PrimvarMap : public Map {
public:
    PrimvarMap(MapTraits traits, Primvar const& primvar)
        : Map(std::move(traits)),
          _values(primvar.values.begin(), primvar.values.end()),
          _numChannels(primvar.numChannels) {}

    std::vector<eval::FaceTree::Values> GetValues() const override {
        return {{_values, _numChannels}};
    }
    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(static_cast<size_t>(_numChannels));
    }

private:
    class Sampler : public MapSampler {
    public:
        explicit Sampler(size_t numChannels) : _numChannels(numChannels) {}
        void Evaluate(SampleBlock const& block, float* out, size_t outStride) override {
            for (size_t c = 0; c < _numChannels; ++c) {
                std::copy_n(block.values + c * block.stride, block.GetCount(), out + c * outStride);
            }
        }

    private:
        size_t _numChannels;
    };

    std::vector<double> _values;
    int _numChannels;
};

}  // namespace

std::unique_ptr<Map> MakePrimvarMap(std::string const& name, MapOptions const&,
                                    Model const& model) {
    std::string const wanted = name.substr(name.find(':') + 1);
    auto const primvar = std::find_if(model.GetPrimvars().begin(), model.GetPrimvars().end(),
                                      [&](Primvar const& p) { return p.name == wanted; });
    if (primvar == model.GetPrimvars().end()) {
        std::string known;
        for (Primvar const& p : model.GetPrimvars()) known += (known.empty() ? "" : ", ") + p.name;
        throw Error(ErrorCode::BadOption,
                    fmt::format("`maps`: '{}' has no primvar '{}'; it has: {}", model.GetPath(),
                                wanted, known.empty() ? "none" : known));
    }
    MapTraits traits{.name = name, .channels = {"Y"}, .units = "as in the mesh"};
    traits.range = primvar->numChannels == 3 ? RangeKind::Vector : RangeKind::Positive;
    traits.isSameAcrossCreases = true;
    if (primvar->numChannels > 1) {
        static char const* const kNames[] = {"R", "G", "B", "A"};
        traits.channels.assign(kNames, kNames + primvar->numChannels);
    }
    return std::make_unique<PrimvarMap>(std::move(traits), *primvar);
}

}  // namespace limn::engine
