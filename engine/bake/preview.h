// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/bake/maps/map_colours.h"
#include "engine/bake/mip_chain.h"

namespace limn::engine {

/// A picture of a map, a pixel per texel, padding included, in the map's colours; of a flow,
/// streaks along it.
///
/// Order    rows are added as they are baked; then the picture is drawn row by row from the values
///          that the finished file has. What is kept in between does not grow with the image: how
///          often values occur, and where runs of texels begin and end.
class Preview {
public:
    /// \param firstChannel  of the map within the rows given to Add
    /// \param range         none: what suits the map
    /// \param encoding      of the rows, which is undone: a preview shows the map's own values
    Preview(MapTraits const& map, int firstChannel, int width, int height,
            std::optional<PreviewRange> const& range, Encoding const& encoding);

    void Add(int row, TexelRowView const& texels);

    /// How many of the map's channels are drawn, and whether their values are asked for at all.
    int GetNumShown() const { return _colours.GetNumShown(); }
    bool NeedsValues() const { return _colours.HasColours(); }
    int GetWidth() const { return _width; }
    int GetHeight() const { return _height; }

    /// All rows have been added: finds what is common to all that are drawn.
    void Prepare();

    /// \param values  of the row, per channel that is shown
    void DrawRow(int row, std::array<float const*, 3> const& values, uint8_t* rgb) const;

    MapColours const& GetColours() const { return _colours; }

private:
    void AddFlow(int row, TexelRowView const& texels);

    MapColours _colours;
    int _firstChannel, _width, _height;
    std::vector<std::vector<int>> _edgesOfRow;  // where texels with and without values take turns
    // of a flow: cells of _factor x _factor texels, which streaks need in memory
    int _factor, _flowWidth, _flowHeight;
    std::vector<float> _flow;                  // [cell][2]
    std::vector<uint8_t> _isInside, _streaks;  // per cell
};

}  // namespace limn::engine
