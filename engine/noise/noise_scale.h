// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "engine/images/colour_ramp.h"

namespace limn::engine {

/// What is written of noise: as it is, as a share of its range over the whole surface, or that
/// share as a colour.
class NoiseScale {
public:
    /// \param low, high  the range
    NoiseScale(double low, double high, bool isNormalized, std::optional<ColourRamp> ramp)
        : _low(low), _range(high - low), _isNormalized(isNormalized), _ramp(std::move(ramp)) {}

    int GetNumChannels() const { return _ramp ? 3 : 1; }

    /// \param out  as many as there are channels
    void Convert(double noise, std::span<double> out) const;

private:
    double _low, _range;
    bool _isNormalized;
    std::optional<ColourRamp> _ramp;
};

}  // namespace limn::engine
