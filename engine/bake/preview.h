// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "engine/bake/maps/map.h"
#include "engine/bake/mip_chain.h"
#include "engine/images/picture.h"

namespace limn::engine {

/// A small picture of a map to look at: signed maps in diverging colours with zero in the middle,
/// the range written below. Collects rows as they are baked and keeps at most 1024 x 1024 texels.
class PreviewBuilder {
public:
    /// \param firstChannel  of the map within the rows given to Add
    /// \param zero          what 0 is written as: the offset of an encoding
    PreviewBuilder(RangeKind range, int numChannels, int firstChannel, int width, int height,
                   float zero = 0.0f);

    void Add(int row, TexelRowView const& texels);

    /// A flow is drawn as streaks along it.
    Picture Draw() const;

private:
    /// Limits between which each component is shown.
    struct Limits {
        std::array<float, 3> low{}, high{};
    };

    bool IsColour() const;
    float GetMean(int channel, size_t texel) const;
    Limits FindLimits() const;
    Picture DrawFlow() const;
    void DrawLegend(Limits const& limits, Picture& picture) const;
    Colour ToColour(float share) const;

    RangeKind _range;
    int _numChannels, _firstChannel, _factor, _width, _height, _sourceWidth;
    float _zero;
    std::vector<float> _sums;  // [channel][texel]
    std::vector<float> _weights;
};

}  // namespace limn::engine
