// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/field/streamline_arguments.h"

#include <fmt/format.h>

#include "engine/cli/names.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/option_rules.h"
#include "engine/cli/options/word_option.h"
#include "engine/evaluate/place_table.h"
#include "engine/io/file.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

void ReportStreamlines(nlohmann::json& report, engine::Streamlines const& streamlines) {
    constexpr char const* kEndNames[eval::kNumStreamEnds] = {"boundary", "singular", "near",
                                                             "length", "closed"};
    auto const ends = streamlines.CountEnds();
    nlohmann::json stopped;
    for (size_t i = 0; i < ends.size(); ++i) stopped[kEndNames[i]] = ends[i];
    report["streamlines"] = {{"lines", streamlines.lines.size()},
                             {"closed", streamlines.CountClosed()},
                             {"points", streamlines.CountPoints()},
                             {"total_length", streamlines.FindTotalLength()},
                             {"farthest", nullptr},
                             {"stopped", stopped},
                             {"seconds", streamlines.seconds}};
    if (streamlines.farthest) report["streamlines"]["farthest"] = *streamlines.farthest;
}

}  // namespace

void StreamlineArguments::Add(CLI::App& verb) {
    verb.add_option("--streamlines", _output,
                    "also write lines along the limit field: x.obj (line elements) or x.csv "
                    "(line,face,s,t,x,y,z,length)");
    AddNumberOption(verb, "--separation", _options.separation,
                    "lines all over the surface, this far apart");
    verb.add_option("--seeds", _seedsPath, "CSV face,s,t: a line through each place of it instead");
    AddNumberOption(verb, "--step", _options.step,
                    "of the integration (default: a quarter of the mean limit edge, or an eighth "
                    "of --separation if that is less)");
    AddNumberOption(verb, "--max-length", _options.maxLength,
                    "of a line (default: any with --separation, else 10 times the box's diagonal)");
    AddNumberOption(verb, "--stop-distance", _options.stopDistance,
                    "a line ends nearer to another one than this share of --separation (default "
                    "0.5)",
                    {0.0, 1.0});
    AddWordOption(verb, "--direction", _options.isForwardOnly, kIsForwardOnlyWords,
                  "both (default): lines run both ways from their seeds; forward: with the field");
}

void StreamlineArguments::Check(CLI::App const& verb) const {
    if (!IsWanted()) {
        RefuseEach(
            verb,
            {"--separation", "--seeds", "--step", "--max-length", "--stop-distance", "--direction"},
            "needs --streamlines");
        return;
    }
    std::string const ending = engine::GetEnding(_output);
    if (ending != ".obj" && ending != ".csv") {
        throw Error(ErrorCode::BadOption,
                    fmt::format("--streamlines '{}': lines are written as .obj or .csv", _output));
    }
    if (!_options.separation) {
        if (_seedsPath.empty())
            throw Error(ErrorCode::BadOption, "--streamlines needs --separation or --seeds");
        RefuseEach(verb, {"--stop-distance"}, "needs --separation");
    }
}

engine::Streamlines StreamlineArguments::Trace(engine::Model const& model,
                                               std::span<double const> form,
                                               eval::TableEvaluator* evaluator,
                                               Context& context) const {
    auto options = _options;
    options.evaluator = evaluator;
    engine::PlaceTable seeds;
    if (!_seedsPath.empty()) {
        seeds = engine::ReadPlaces(_seedsPath);
        options.seeds = seeds.GetPlaces();
    }
    auto streamlines = engine::NamingRows(
        seeds, [&] { return TraceStreamlines(model, form, options, context.GetJob()); });
    ReportStreamlines(context.GetReport(), streamlines);
    return streamlines;
}

void StreamlineArguments::Write(engine::Model const& model, engine::Streamlines const& streamlines,
                                Context const& context, engine::MeshSequence& files) const {
    auto const precision = context.GetCommon().precision.value_or(
        engine::FindTablePrecision(engine::FindExtent(model.GetPositions())));
    files.Add(_output, engine::GetEnding(_output) == ".obj"
                           ? FormatLineElements(streamlines, precision)
                           : FormatLineTable(model, streamlines, precision));
}

}  // namespace limn::cli
