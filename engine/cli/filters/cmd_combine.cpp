// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "engine/cli/filter_options.h"
#include "engine/cli/options/option_rules.h"
#include "engine/fit/combine.h"
#include "engine/io/file.h"
#include "engine/io/mesh_writer.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

struct CombineArguments {
    std::string mesh, output, offsetName;
    std::vector<std::string> added, offsets;
    engine::CombineOptions options;
};

/// A mesh's or two meshes' names, and the weight behind the last colon.
struct WeightedWord {
    std::string text;
    double weight = 1.0;
};

WeightedWord SplitWeight(std::string const& flag, std::string const& word) {
    size_t const colon = word.rfind(':');
    if (colon == std::string::npos) return {word};
    return {word.substr(0, colon),
            ParseNumber<double>(flag, std::string_view(word).substr(colon + 1))};
}

/// "A,B[:W]"
struct OffsetWord {
    std::string from, to;
    double weight;
};

OffsetWord ParseOffset(std::string const& word) {
    auto const [text, weight] = SplitWeight("--offset", word);
    size_t const comma = text.find(',');
    bool const isPair = std::ranges::count(text, ',') == 1 && comma > 0 && comma + 1 < text.size();
    if (!isPair) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("--offset: '{}' is not A,B or A,B:W, of two meshes", word));
    }
    return {text.substr(0, comma), text.substr(comma + 1), weight};
}

/// Of scalars in a PLY.
void CheckOffsetName(CombineArguments const& a) {
    if (a.offsetName.empty()) return;
    bool const isWord =
        std::ranges::all_of(a.offsetName, [](char c) { return c > ' ' && c < 127; });
    if (!isWord) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("--write-offset: '{}' is no name of a scalar", a.offsetName));
    }
    if (a.offsetName == "n") {
        throw Error(ErrorCode::BadOption,
                    "--write-offset: nx, ny and nz are a PLY's normals; take another name than n");
    }
    if (engine::GetEnding(a.output) != ".ply") {
        throw Error(
            ErrorCode::BadOption,
            fmt::format("--write-offset: -o '{}' holds no scalars; write a .ply", a.output));
    }
}

void AddOffsetPrimvars(CombineArguments const& a, engine::Model const& model, engine::Scene& mesh) {
    if (a.offsetName.empty()) return;
    for (auto& primvar : engine::MakeOffsetPrimvars(a.offsetName, model, mesh.positions)) {
        if (std::ranges::find(mesh.primvars, primvar.name, &engine::Primvar::name) !=
            mesh.primvars.end()) {
            throw Error(ErrorCode::BadOption,
                        fmt::format("--write-offset: '{}' has a primvar '{}'; take another name",
                                    a.mesh, primvar.name));
        }
        mesh.primvars.push_back(std::move(primvar));
    }
}

int Run(CombineArguments const& a, CLI::App const& verb, Context& context) {
    engine::RequireMeshEnding(a.output);
    CheckOffsetName(a);
    if (a.offsets.empty()) RefuseEach(verb, {"--carry"}, "needs --offset");
    std::vector<WeightedWord> added;
    std::vector<OffsetWord> offsets;
    for (std::string const& word : a.added) added.push_back(SplitWeight("--add", word));
    for (std::string const& word : a.offsets) offsets.push_back(ParseOffset(word));
    std::vector<NamedFile> read{{"MESH", a.mesh}};
    for (auto const& [path, weight] : added) read.push_back({"--add", path});
    for (auto const& [from, to, weight] : offsets) {
        read.push_back({"--offset", from});
        read.push_back({"--offset", to});
    }
    context.KeepApart(read, {{"-o", a.output}});
    auto const model = context.Load(a.mesh);
    engine::CombineOptions options = a.options;
    for (auto const& [path, weight] : added) options.added.push_back({context.Load(path), weight});
    for (auto const& [from, to, weight] : offsets)
        options.offsets.push_back({context.Load(from), context.Load(to), weight});
    context.GetReport()["before"] = DescribeExtent(model, model.GetPositions());
    auto result = engine::Combine(model, options, context.GetJob());
    context.GetReport()["offset"] = {{"max", result.maxOffset}, {"rms", result.rmsOffset}};
    context.GetReport()["largest_turn_degrees"] = result.largestTurnDegrees;
    AddOffsetPrimvars(a, model, result.mesh);
    WriteFiltered(a.output, model, std::move(result.mesh), context);
    return kDone;
}

/// An option that may be given again and again.
void AddListOption(CLI::App& verb, std::string const& flag, std::vector<std::string>& words,
                   std::string const& help) {
    verb.add_option(flag, words, help)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace

Verb AddCombine(CLI::App& app) {
    auto const a = std::make_shared<CombineArguments>();
    CLI::App* const verb = app.add_subcommand(
        "combine", "Add up meshes of the same faces, and what lies between them");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF; its tags, UVs, groups and primvars stay")
        ->required();
    verb->add_option("-o,--output", a->output, "mesh to write, .obj or .ply")->required();
    AddNumberOption(*verb, "--scale", a->options.scale, "of MESH (default 1)");
    AddListOption(*verb, "--add", a->added,
                  "OTHER or OTHER:W: adds a mesh, W times (default 1); scalars that all of these "
                  "have are added, too (repeatable)");
    AddListOption(*verb, "--offset", a->offsets,
                  "A,B or A,B:W: adds what leads from A to B, W times (repeatable)");
    AddWordOption(*verb, "--carry", a->options.carry, engine::kCarryWords,
                  "of offsets: object (as they are) or local (default: turned as the surface is "
                  "turned from A to MESH)");
    verb->add_option("--write-offset", a->offsetName,
                     "NAME: the scalars NAMEx, NAMEy, NAMEz, result minus MESH (.ply)");
    verb->footer(
        "Example:\n  limn combine neutral.obj -o out/broad.smile.obj --offset "
        "neutral.obj,smile.obj:2");
    return {verb, [a, verb](Context& context) { return Run(*a, *verb, context); }};
}

}  // namespace limn::cli
