// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/noise_options.h"

#include "engine/cli/options/number_option.h"
#include "engine/cli/options/word_option.h"

namespace limn::cli {

void AddNoiseOptions(CLI::App& verb, engine::NoiseOptions& noise, std::string& ramp) {
    AddNumberOption(verb, "--noise-octaves", noise.octaves,
                    "levels of refinement with noise each (default 4)", {1, 10});
    AddNumberOption(
        verb, "--noise-frequency", noise.frequency,
        "noise cells per unit length in the first octave (default: half a cell per mean edge)",
        {1e-12, 1e12});
    AddNumberOption(verb, "--noise-gain", noise.gain,
                    "amplitude from octave to octave (default 0.5)", {0.0, 16.0});
    AddNumberOption(verb, "--noise-seed", noise.seed, "another noise for every number (default 0)");
    AddWordOption(verb, "--noise-at", noise.at, engine::kNoiseAtWords,
                  "where in space a vertex takes its noise: at its limit point (default) or, as "
                  "the paper does, at the vertex");
    verb.add_option("--noise-ramp", ramp,
                    "noise as colours: '#rrggbb,#rrggbb,...' from low to high, equally spaced");
}

}  // namespace limn::cli
