// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/bake/maps/map.h"
#include "engine/bake/mip_chain.h"
#include "engine/bake/preview_range.h"
#include "engine/images/colour_scale.h"
#include "engine/images/picture.h"
#include "engine/images/value_histogram.h"

namespace limn::engine {

/// A picture of a map, a pixel per texel, padding included: signed maps in diverging colours,
/// others in sequential ones, vectors as colours, a flow as streaks along it.
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

    /// Which of the map's channels are drawn, and whether their values are asked for at all.
    int GetNumShown() const { return IsColour() ? 3 : 1; }
    bool NeedsValues() const { return _map.range != RangeKind::Flow; }
    int GetWidth() const { return _width; }
    int GetHeight() const { return _height; }

    /// All rows have been added: finds what is common to all that are drawn.
    void Prepare();

    /// \param values  of the row, per channel that is shown
    void DrawRow(int row, std::array<float const*, 3> const& values, uint8_t* rgb) const;

    /// A picture of its own: what is shown, in which unit, and which colour is which value.
    ///
    /// \param of  what the map is of: "spot 1001"
    Picture DrawLegend(std::string const& of) const;

private:
    bool IsColour() const;
    PreviewRange::Rule GetRule() const;
    float Decode(float value) const;
    ColourScale FindScale(int channel) const;
    Colour FindColour(int x, std::array<float const*, 3> const& values) const;
    void AddFlow(int row, TexelRowView const& texels);
    void DrawFlow();
    std::vector<std::string> Describe(std::string const& of) const;

    MapTraits const _map;
    int _firstChannel, _width, _height;
    std::optional<PreviewRange> _range;
    Encoding _encoding;
    std::array<ValueHistogram, 3> _values, _magnitudes;  // per channel shown
    std::vector<std::vector<int>> _edgesOfRow;  // where texels with and without values take turns
    std::array<ColourScale, 3> _scales;
    // of a flow: cells of _factor x _factor texels, which streaks need in memory
    int _factor, _flowWidth, _flowHeight;
    std::vector<float> _flow;                  // [cell][2]
    std::vector<uint8_t> _isInside, _streaks;  // per cell
};

}  // namespace limn::engine
