// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "engine/fit/band_sum.h"

namespace limn::cli {

/// The options by which `bands` and the map bands make one sum.
struct BandArguments {
    std::vector<double> gains;
    std::string from;   ///< the mesh; empty: none
    std::string bands;  ///< "i-j", "i-" or "i": which of its bands
    std::optional<engine::Carry> carry;

    bool IsSum() const { return !gains.empty() || !from.empty(); }
};

/// Adds --gain, --from, --bands and --carry.
///
/// \param bandsHelp     of --bands
/// \param bandsDefault  what it is where nobody gives it
void AddBandOptions(CLI::App& verb, BandArguments& a, std::string const& bandsHelp,
                    std::string const& bandsDefault = {});

/// What is asked for, but for the mesh that bands come from. \pre a.IsSum()
///
/// \param count    of bands; none: not given
/// \param counted  the option that gives it, for messages
/// \throws Error   BadOption: gains of another number than bands, options that need others
engine::BandSumOptions MakeBandSum(BandArguments const& a, std::optional<int> count,
                                   std::string const& counted);

/// \throws Error  BadOption: options of bands of another mesh, without that mesh
void RefuseWithoutFrom(BandArguments const& a);

/// "bands" and "from" of a report.
void AddToReport(nlohmann::json& report, BandArguments const& a, engine::BandSum const& sum);

}  // namespace limn::cli
