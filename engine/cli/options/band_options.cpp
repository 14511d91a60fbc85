// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/band_options.h"

#include <fmt/format.h>

#include "engine/cli/options/number_option.h"
#include "engine/cli/options/word_option.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

constexpr NumberRange<int> kBandNumbers{0, 999};

/// Bands that follow each other; without a last one, to the remainder.
struct BandRange {
    int first;
    std::optional<int> last;
};

/// "i-j", "i-" or "i".
BandRange ParseBandRange(std::string const& text) {
    auto const parse = [](std::string_view part, NumberRange<int> const& range) {
        return ParseNumber<int>("--bands", part, range);
    };
    std::string_view const words(text);
    size_t const dash = words.find('-');
    int const first = parse(words.substr(0, dash), kBandNumbers);
    if (dash == words.npos) return {first, first};
    if (dash + 1 == words.size()) return {first, {}};
    return {first, parse(words.substr(dash + 1), {first, kBandNumbers.high})};
}

/// \param numBands     that have a gain each
/// \param hasRemainder  it may have one more, of what lies beyond them
eval::BandGains MakeGains(int first, size_t numBands, bool hasRemainder,
                          std::vector<double> gains) {
    bool const isComplete = hasRemainder && gains.size() == numBands + 1;
    if (!gains.empty() && gains.size() != numBands && !isComplete) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("--gain: {} numbers for {} bands{}", gains.size(), numBands,
                                hasRemainder ? "; one each is needed, and perhaps one of the "
                                               "remainder"
                                             : "; one each is needed"));
    }
    eval::BandGains result{first, {}, std::nullopt};
    if (hasRemainder) result.remainder = isComplete ? gains.back() : 1.0;
    gains.resize(numBands, 1.0);
    result.gains = std::move(gains);
    return result;
}

}  // namespace

void AddBandOptions(CLI::App& verb, BandArguments& a, std::string const& bandsHelp,
                    std::string const& bandsDefault) {
    AddNumberOption(verb, "--gain", a.gains,
                    "a factor for each band, and perhaps one for the remainder (else 1)")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    verb.add_option("--from", a.from, "a mesh of the same faces: its --bands replace MESH's");
    auto const parse = [&a](CLI::results_t const& texts) {
        ParseBandRange(texts[0]);  // or refuses what is none
        a.bands = texts[0];
        return true;
    };
    verb.add_option("--bands", parse, bandsHelp, false, [bandsDefault] { return bandsDefault; })
        ->type_name("INT or I-J or I-");
    AddWordOption(verb, "--carry", a.carry, engine::kCarryWords,
                  "of --from: object (bands as they are) or local (default: turned with the "
                  "surface)");
}

void RefuseWithoutFrom(BandArguments const& a) {
    if (!a.from.empty()) return;
    if (a.carry) throw Error(ErrorCode::BadOption, "--carry needs --from");
    if (a.bands.find('-') != std::string::npos)
        throw Error(ErrorCode::BadOption, fmt::format("--bands {} needs --from", a.bands));
}

engine::BandSumOptions MakeBandSum(BandArguments const& a, std::optional<int> count,
                                   std::string const& counted) {
    RefuseWithoutFrom(a);
    engine::BandSumOptions options;
    options.carry = a.carry.value_or(engine::Carry::Local);
    if (a.from.empty()) {
        options.gains = MakeGains(0, static_cast<size_t>(count.value_or(0)), true, a.gains);
        return options;
    }
    if (a.bands.empty()) throw Error(ErrorCode::BadOption, "--from needs --bands");
    auto const [first, last] = ParseBandRange(a.bands);
    if (last && count) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("{} and --bands {} exclude each other", counted, a.bands));
    }
    if (count && *count < first) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("{} {} ends before --bands {} begins", counted, *count, a.bands));
    }
    size_t const numBands = last    ? static_cast<size_t>(*last - first + 1)
                            : count ? static_cast<size_t>(*count - first)
                                    : a.gains.size();
    options.gains = MakeGains(first, numBands, !last, a.gains);
    return options;
}

void AddToReport(nlohmann::json& report, BandArguments const& a, engine::BandSum const& sum) {
    auto& bands = report["bands"] = nlohmann::json::array();
    for (auto const& [band, rms, gain] : sum.parts) {
        nlohmann::json const index = band ? nlohmann::json(*band) : nlohmann::json("remainder");
        bands.push_back({{"index", index}, {"rms", rms}, {"gain", gain}});
    }
    if (a.from.empty()) return;
    report["from"] = {
        {"bands", a.bands},
        {"carry", engine::kCarryWords.GetWord(a.carry.value_or(engine::Carry::Local))},
        {"largest_turn_degrees", sum.largestTurnDegrees}};
}

}  // namespace limn::cli
