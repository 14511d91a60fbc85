// SPDX-License-Identifier: Apache-2.0
#include "engine/noise/noise_scale.h"

#include <algorithm>

namespace limn::engine {

void NoiseScale::Convert(double noise, std::span<double> out) const {
    double const share = _range > 0.0 ? std::clamp((noise - _low) / _range, 0.0, 1.0) : 0.5;
    if (_ramp)
        std::ranges::copy(_ramp->Evaluate(share), out.begin());
    else
        out[0] = _isNormalized ? share : noise;
}

}  // namespace limn::engine
