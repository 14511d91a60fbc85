// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/noise/surface_noise.h"

namespace limn::cli {

/// The options that AddNoiseOptions adds.
inline std::vector<char const*> const kNoiseFlags{"--noise-octaves", "--noise-frequency",
                                                  "--noise-gain",    "--noise-seed",
                                                  "--noise-at",      "--noise-ramp"};

/// Adds the options of noise.
///
/// \param ramp  text for engine::ColourRamp::Parse; empty: none
void AddNoiseOptions(CLI::App& verb, engine::NoiseOptions& noise, std::string& ramp);

}  // namespace limn::cli
