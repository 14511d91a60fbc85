// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/field/field_inputs.h"

#include <fmt/format.h>

#include "engine/cli/names.h"
#include "engine/cli/options/choices.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/word_option.h"
#include "engine/field/boundary_data.h"
#include "engine/io/edge_values.h"
#include "engine/io/number_table.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

/// "12:0.5" as its two parts; the second is empty without a colon.
struct ElementText {
    Index element;
    std::string_view rest;
    bool hasRest;
};
ElementText SplitElement(std::string_view text, char const* option) {
    size_t const colon = std::min(text.find(':'), text.size());
    bool const hasRest = colon < text.size();
    return {ParseNumber<Index>(option, text.substr(0, colon)),
            hasRest ? text.substr(colon + 1) : std::string_view(), hasRest};
}

/// "12" or "12:0.5".
engine::FieldStrength ParseStrength(std::string const& text, char const* option, double sign) {
    auto const [element, rest, hasRest] = SplitElement(text, option);
    return {element, sign * (hasRest ? ParseNumber<double>(option, rest) : 1.0)};
}

/// "12:0.5"; a number that is not there is refused as no number.
engine::FieldStrength ParseValue(std::string const& text, char const* option) {
    auto const [element, rest, hasRest] = SplitElement(text, option);
    return {element, ParseNumber<double>(option, rest)};
}

/// "12:tangent", "12:normal", "12:circulation=0.5" or "12:flux=0.5".
engine::BoundaryLoop ParseLoop(std::string const& text) {
    constexpr char const* kOption = "--loop";
    auto const [vertex, rest, hasRest] = SplitElement(text, kOption);
    if (rest == "tangent") return {vertex, false, 0.0};
    if (rest == "normal") return {vertex, true, 0.0};
    size_t const equals = std::min(rest.find('='), rest.size());
    auto const kind = rest.substr(0, equals);
    if (equals == rest.size() || (kind != "circulation" && kind != "flux")) {
        RefuseChoice(kOption, std::string(rest),
                     {"tangent", "normal", "circulation=NUMBER", "flux=NUMBER"});
    }
    return {vertex, kind == "circulation", ParseNumber<double>(kOption, rest.substr(equals + 1))};
}

std::vector<double> ParseList(std::string const& text, char const* option) {
    std::vector<double> values;
    for (size_t start = 0; start <= text.size() && !text.empty();) {
        size_t const comma = std::min(text.find(',', start), text.size());
        values.push_back(
            ParseNumber<double>(option, std::string_view(text).substr(start, comma - start)));
        start = comma + 1;
    }
    return values;
}

std::vector<eval::WantedVector> ReadWanted(std::string const& path,
                                           Far::TopologyLevel const& level) {
    auto const table =
        engine::ReadNumberTable(path, {{"face", "x", "y", "z"}, {"vertex", "x", "y", "z"}});
    bool const isFace = table.layout == 0;
    int const count = isFace ? level.GetNumFaces() : level.GetNumVertices();
    std::vector<eval::WantedVector> wanted;
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        Index const element =
            engine::GetIndex(table, path, row, 0, count, isFace ? "face" : "vertex");
        wanted.push_back(
            {isFace, element, {table.Get(row, 1), table.Get(row, 2), table.Get(row, 3)}});
    }
    return wanted;
}

/// A number per vertex or face, 0 where none is listed.
///
/// \param element  "vertex" or "face", the first column
std::vector<double> ReadNumbers(std::string const& path, char const* element, int count) {
    auto const table = engine::ReadNumberTable(path, {{element, "value"}});
    std::vector<double> values(static_cast<size_t>(count), 0.0);
    std::vector<char> isKnown(values.size(), 0);
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        Index const at = engine::GetIndex(table, path, row, 0, count, element);
        if (isKnown[at]) {
            throw Error(ErrorCode::BadMesh, fmt::format("{}:{}: {} {} comes twice", path,
                                                        table.lines[row], element, at));
        }
        isKnown[at] = 1;
        values[at] = table.Get(row, 1);
    }
    return values;
}

CLI::Option* AddRepeated(CLI::App& verb, char const* name, std::vector<std::string>& values,
                         char const* help, char const* type) {
    return verb.add_option(name, values, help)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name(type);
}

}  // namespace

engine::FieldOptions FieldInputs::MakeOptions(Far::TopologyLevel const& level) const {
    engine::FieldOptions options = _options;
    for (auto const& text : _sources)
        options.sources.push_back(ParseStrength(text, "--source", 1.0));
    for (auto const& text : _sinks) options.sources.push_back(ParseStrength(text, "--sink", -1.0));
    for (auto const& text : _vortices)
        options.vortices.push_back(ParseStrength(text, "--vortex", 1.0));
    for (auto const& text : _pins) {
        auto const [vertex, value] = ParseValue(text, "--pin");
        options.pins.push_back({vertex, value});
    }
    for (auto const& text : _singularities) {
        auto const [vertex, rest, hasRest] = SplitElement(text, "--singularity");
        options.singularities.push_back({vertex, ParseNumber<int>("--singularity", rest)});
    }
    for (auto const& text : _loops) options.loops.push_back(ParseLoop(text));
    for (auto const& text : _arcFluxes) options.arcFluxes.push_back(ParseValue(text, "--arc-flux"));
    if (!_boundaryPath.empty())
        options.boundaryEdges = engine::ReadBoundaryEdges(_boundaryPath, level);
    if (!_harmonics.empty()) options.harmonics = ParseList(_harmonics, "--harmonic");
    if (!_edgesPath.empty()) options.edges = engine::ReadEdgeValues(_edgesPath, level);
    if (!_matchPath.empty()) options.wanted = ReadWanted(_matchPath, level);
    if (!_texturePattern.empty()) options.texture = engine::FieldTexture{_texturePattern, _isFlow};
    if (!_valuesPath.empty())
        options.values = ReadNumbers(_valuesPath, "vertex", level.GetNumVertices());
    if (!_integralsPath.empty())
        options.integrals = ReadNumbers(_integralsPath, "face", level.GetNumFaces());
    RequirePart(options);
    return options;
}

void FieldInputs::RequirePart(engine::FieldOptions const& options) const {
    bool const hasPart =
        !options.sources.empty() || !options.vortices.empty() || options.harmonics ||
        options.edges || !_matchPath.empty() || options.texture || options.values ||
        options.integrals || !options.pins.empty() || !options.singularities.empty() ||
        !options.loops.empty() || !options.boundaryEdges.empty() || !options.arcFluxes.empty();
    if (hasPart) return;
    throw Error(ErrorCode::BadOption,
                "a field needs at least one of --source, --sink, --vortex, --harmonic, --edges, "
                "--match, --match-texture, --values, --pin, --integrals, --singularity, --loop and "
                "--boundary-data");
}

std::vector<NamedFile> FieldInputs::ListFiles() const {
    return {{"--edges", _edgesPath},
            {"--match", _matchPath},
            {"--match-texture", _texturePattern},
            {"--values", _valuesPath},
            {"--integrals", _integralsPath},
            {"--boundary-data", _boundaryPath}};
}

void FieldInputs::AddParts(CLI::App& verb) {
    constexpr char const* kStrength = "N[:STRENGTH]";
    AddRepeated(verb, "--source", _sources,
                "vertex out of which the field flows (repeatable; strength 1)", kStrength);
    AddRepeated(verb, "--sink", _sinks, "vertex into which it flows (repeatable)", kStrength);
    AddRepeated(verb, "--vortex", _vortices,
                "face round which it turns, counter-clockwise (repeatable)", kStrength);
    verb.add_option("--harmonic", _harmonics,
                    "c1,c2,...: circulations round handles and holes, one per generator");
    verb.add_option("--edges", _edgesPath,
                    "CSV v0,v1,value: a field along edges of MESH, to be added");
    AddRepeated(verb, "--singularity", _singularities,
                "vertex inside and the index (1, -1, -2 ...) that a field of unit vectors has "
                "there; on a closed component they add up to its Euler characteristic (repeatable)",
                "V:INDEX");
}

void FieldInputs::AddMatches(CLI::App& verb) {
    auto* const match = verb.add_option(
        "--match", _matchPath, "CSV face,x,y,z or vertex,x,y,z: vectors that the field is to fit");
    auto* const texture =
        verb.add_option("--match-texture", _texturePattern,
                        "images of vectors that it is to fit, as bake --maps field writes them; "
                        "<UDIM> stands for the tile, without it 1001 alone is read")
            ->excludes(match);
    AddWordOption(verb, "--match-space", _isFlow, kIsFlowWords,
                  "object (default): pixels R,G,B are vectors; uv: R,G are flow in texture "
                  "coordinates")
        ->needs(texture);
}

void FieldInputs::AddFunctions(CLI::App& verb) {
    verb.add_option("--values", _valuesPath,
                    "CSV vertex,value: a function whose gradient is added");
    AddRepeated(verb, "--pin", _pins,
                "vertex and the value there of a function that is harmonic between two or more of "
                "them; its gradient is added (repeatable)",
                "V:VALUE");
    verb.add_option("--integrals", _integralsPath,
                    "CSV face,value: circulations round faces, to be added to vortices");
}

void FieldInputs::AddBoundaries(CLI::App& verb) {
    AddWordOption(verb, "--at-boundary", _options.atBoundary, kAtBoundaryWords,
                  "tangent (default): the field runs along boundaries; normal: into them");
    AddRepeated(verb, "--loop", _loops,
                "any vertex of a boundary loop and what the field does there, over --at-boundary: "
                "tangent, normal, circulation=C or flux=F in all, outwards (repeatable)",
                "V:KIND");
    verb.add_option("--boundary-data", _boundaryPath,
                    "CSV v0,v1,kind,value: circulation or flux of single boundary edges, over "
                    "--loop");
    AddRepeated(verb, "--arc-flux", _arcFluxes,
                "vertex of an arc of given circulation and what flows out of it (0; the first arc "
                "of a component takes the rest; repeatable)",
                "V:FLUX");
    verb.add_flag("--balance", _options.isBalanced,
                  "spread what strengths do not add up to evenly over their component");
}

void FieldInputs::Add(CLI::App& verb) {
    AddParts(verb);
    AddMatches(verb);
    AddFunctions(verb);
    AddNumberOption(verb, "--levels", _options.levels,
                    "refinements (default 0; 1 where faces are not all quads)", {0, 10});
    AddBoundaries(verb);
}

}  // namespace limn::cli
