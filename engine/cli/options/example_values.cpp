// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/example_values.h"

#include <algorithm>
#include <iterator>

namespace limn::cli {

namespace {

struct Example {
    std::string_view name, value;
};

struct VerbExample {
    std::string_view verb, name, value;
};

/// Where an option's values differ with the verb; the others stand below.
constexpr VerbExample kOfVerbs[] = {
    {"bake", "--output", "out/{map}.exr"}, {"bands", "--output", "out/spot"},
    {"eval", "--output", "out/limit.csv"}, {"measure", "--output", "out/spot"},
    {"morph", "--output", "out/spot"},     {"smooth", "--write-stencils", "out/spot"}};

constexpr Example kValues[] = {{"--adaptive", "3e-4"},
                               {"--add", "bumps.obj:0.5"},
                               {"--against", "sculpted.obj"},
                               {"--along", "edges.csv"},
                               {"--arc-flux", "12:0.5"},
                               {"--at", "places.csv"},
                               {"--bands", "2-4"},
                               {"--boundary-data", "boundary.csv"},
                               {"--count", "4"},
                               {"--edges", "edges.csv"},
                               {"--edit", "edit.json"},
                               {"--encode", "0.5,0.5"},
                               {"--field", "field.edges.csv"},
                               {"--frames", "walk.{frame}.obj"},
                               {"--from", "sculpted.obj"},
                               {"--gain", "1,1.5,2"},
                               {"--groups", "skin,eyes"},
                               {"--handle", "0"},
                               {"--harmonic", "1,0"},
                               {"--integrals", "integrals.csv"},
                               {"--iterations", "10"},
                               {"--keep-features", "20%"},
                               {"--loop", "12:tangent"},
                               {"--maps", "noise"},
                               {"--match", "vectors.csv"},
                               {"--match-texture", "'flow.<UDIM>.exr'"},
                               {"--max-length", "1"},
                               {"--noise-frequency", "8"},
                               {"--noise-ramp", "'#203040,#ffffff'"},
                               {"--offset", "neutral.obj,smile.obj"},
                               {"--origin", "auto"},
                               {"--output", "out/spot.obj"},
                               {"--picture", "out/spot.png"},
                               {"--pin", "12:1"},
                               {"--preview-range", "p1"},
                               {"--report", "run.json"},
                               {"--rest", "rest.obj"},
                               {"--scale", "1"},
                               {"--schedule", "steps.csv"},
                               {"--seam-bound", "0.01"},
                               {"--seeds", "seeds.csv"},
                               {"--separation", "0.1"},
                               {"--singularity", "12:1"},
                               {"--settle", "1e-5"},
                               {"--sink", "12"},
                               {"--size", "2048"},
                               {"--source", "7"},
                               {"--step", "0.01"},
                               {"--steps", "3"},
                               {"--streamlines", "out/lines.obj"},
                               {"--sweeps", "10"},
                               {"--tension", "0.0625"},
                               {"--threads", "4"},
                               {"--tiles", "1001,1003-1005"},
                               {"--tolerance", "1e-6"},
                               {"--values", "values.csv"},
                               {"--vortex", "3"},
                               {"--weld", "0"},
                               {"--width", "0.1"},
                               {"--width-edges", "edges.csv"},
                               {"--width-factor", "0.12"},
                               {"--width-map", "widths.csv"},
                               {"--width-scale", "0.12"},
                               {"--width-texture", "widths.png"},
                               {"--write-matrix", "A.mtx"},
                               {"--write-offset", "offset"},
                               {"--write-stencils", "S1.mtx,S2.mtx"},
                               {"FROM", "neutral.obj"},
                               {"MESH", "spot.obj"},
                               {"TO", "smile.obj"}};

std::string_view Find(std::string_view verb, std::string_view name) {
    auto const ofVerb = std::ranges::find_if(kOfVerbs, [&](VerbExample const& example) {
        return example.verb == verb && example.name == name;
    });
    if (ofVerb != std::end(kOfVerbs)) return ofVerb->value;
    auto const found = std::ranges::find(kValues, name, &Example::name);
    return found == std::end(kValues) ? std::string_view() : found->value;
}

}  // namespace

std::string FindExample(OptionEntry const& option, std::string_view verb,
                        std::string const& byDefault) {
    std::string_view const name = option.IsPositional() ? option.placeholder : option.longFlag;
    std::string_view const value = Find(verb, name);
    if (!value.empty()) return std::string(value);
    if (!option.words.empty()) return option.words[0];
    bool const isList = byDefault.starts_with('[') && byDefault.ends_with(']');
    return isList ? byDefault.substr(1, byDefault.size() - 2) : byDefault;
}

}  // namespace limn::cli
