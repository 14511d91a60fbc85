// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/bake/maps/maps.h"
#include "engine/bake/mip_chain.h"

namespace limn::engine {

/// A small picture of a map to look at: signed maps in diverging colours with zero in the middle,
/// the range written below. Collects rows as they are baked and keeps at most 1024 x 1024 texels.
class PreviewBuilder {
public:
    /// \param firstChannel  of the map within the rows given to Add
    PreviewBuilder(Map const& map, int firstChannel, int width, int height);

    void Add(int row, TexelRowView const& texels);

    /// An RGB picture, 8 bits a channel.
    struct Picture {
        int width = 0, height = 0;
        std::vector<uint8_t> pixels;
    };
    /// A field in texture space is drawn as streaks along it.
    Picture Draw() const;

private:
    Picture DrawFlow() const;

    Map _map;
    int _firstChannel, _factor, _width, _height, _sourceWidth;
    std::vector<float> _sums;  // [channel][texel]
    std::vector<float> _weights;
};

/// Writes a picture as PNG, complete or not at all. \throws Error Io
void WritePng(std::string const& path, PreviewBuilder::Picture const& picture);

}  // namespace limn::engine
