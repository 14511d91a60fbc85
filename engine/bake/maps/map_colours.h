// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/bake/maps/map.h"
#include "engine/bake/maps/preview_range.h"
#include "engine/images/colour_scale.h"
#include "engine/images/picture.h"
#include "engine/images/value_histogram.h"

namespace limn::engine {

/// Which colours show a map: diverging ones where it is signed, else sequential ones; vectors are
/// their components. The range is found among values that are added first.
class MapColours {
public:
    /// \param range     none: what suits the map
    /// \param encoding  of the values, which is undone: colours show the map's own
    MapColours(MapTraits map, std::optional<PreviewRange> const& range, Encoding const& encoding);

    /// How many of the map's channels, from the first on, are shown.
    int GetNumShown() const { return IsColour() ? 3 : 1; }

    /// False of a flow, which has no colours but streaks along it.
    bool HasColours() const { return _map.range != RangeKind::Flow; }

    /// The map's own value.
    float Decode(float value) const;

    void Add(int channel, float value);

    /// All values have been added: finds what lies between the ends of the colours.
    void Prepare();

    /// \param values  of the channels that are shown
    Colour FindColour(std::array<float, 3> const& values) const;

    /// A picture of its own: what is shown, in which unit, and which colour is which value.
    ///
    /// \param of          what the map is of: "spot 1001"
    /// \param leastWidth  pixels; text may ask for more
    Picture DrawLegend(std::string const& of, int leastWidth = 320) const;

private:
    bool IsColour() const;
    bool HasBar() const { return !IsColour() && HasColours() && !_scales[0].IsConstant(); }
    PreviewRange::Rule GetRule() const;
    ColourScale FindScale(int channel) const;
    std::string DescribeMap() const;
    std::vector<std::string> Describe(std::string const& of) const;

    MapTraits _map;
    std::optional<PreviewRange> _range;
    Encoding _encoding;
    std::array<ValueHistogram, 3> _values, _magnitudes;  // per channel shown
    std::array<ColourScale, 3> _scales;
};

}  // namespace limn::engine
