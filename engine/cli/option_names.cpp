// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/option_names.h"

#include <algorithm>

namespace limn::cli {

namespace {

constexpr OptionName kOptionNames[] = {
    {"FieldTexture", "--match-texture"},
    {"Graph", "--graph"},
    {"Natural", "--boundary-rule natural"},
    {"PaintedWidths", "--width-texture"},
    {"adaptive", "--adaptive"},
    {"against", "--against"},
    {"alpha", "--alpha"},
    {"arcFluxes", "--arc-flux"},
    {"boundary", "--boundary"},
    {"boundaryEdges", "--boundary-data"},
    {"compression", "--compression"},
    {"creases", "--creases"},
    {"curve", "--curve"},
    {"dirMagLevels", "--dirmag"},
    {"edit", "--edit"},
    {"evaluator", "--evaluator"},
    {"farLevel", "--far-level"},
    {"field", "--field"},
    {"frames", "--frames"},
    {"frequency", "--noise-frequency"},
    {"fvar", "--fvar"},
    {"groups", "--groups"},
    {"halfMaps", "--half"},
    {"harmonics", "--harmonic"},
    {"isBalanced", "--balance"},
    {"isVector", "--vector"},
    {"keepsSweeps", "--write-stencils"},
    {"keptFeatures", "--keep-features"},
    {"laplacian", "--laplacian"},
    {"last", "--to-band"},
    {"levels", "--levels"},
    {"loops", "--loop"},
    {"maps", "--maps"},
    {"maxLength", "--max-length"},
    {"method", "--method"},
    {"noiseRamp", "--noise-ramp"},
    {"octaves", "--noise-octaves"},
    {"order", "--order"},
    {"orientation", "--orientation"},
    {"origin", "--origin"},
    {"outputPattern", "-o"},
    {"path", "-o"},
    {"pattern", "-o"},
    {"picture", "--picture"},
    {"pins", "--pin"},
    {"precision", "--precision"},
    {"previewRange", "--preview-range"},
    {"refinement", "--refinement"},
    {"rest", "--rest"},
    {"rule", "--rule"},
    {"samplesPerSide", "--samples"},
    {"scheme", "--scheme"},
    {"seam", "--seam-bound"},
    {"seeds", "--seeds"},
    {"separation", "--separation"},
    {"gaussBonnet", "--audit-bound"},
    {"settle", "--settle"},
    {"solver", "--solver"},
    {"space", "--space"},
    {"spatialLevels", "--spatial-first"},
    {"steps", "--steps"},
    {"stop", "--sweeps"},
    {"tension", "--tension"},
    {"step", "--step"},
    {"stopDistance", "--stop-distance"},
    {"tiles", "--tiles"},
    {"triangles", "--triangles"},
    {"view", "--view"},
    {"weld", "--weld"},
    {"width", "--size"},
};

}  // namespace

std::span<OptionName const> GetOptionNames() {
    return kOptionNames;
}

std::string NameFlags(std::string_view message) {
    std::string text;
    while (true) {
        size_t const open = message.find('`');
        size_t const close = open == message.npos ? open : message.find('`', open + 1);
        text += message.substr(0, open);
        if (close == message.npos)
            return text.append(message.substr(std::min(open, message.size())));
        auto const member = message.substr(open + 1, close - open - 1);
        auto const row = std::ranges::find(kOptionNames, member, &OptionName::member);
        if (row == std::end(kOptionNames)) {
            text += message.substr(open, close - open);  // the second one may open a member
            message.remove_prefix(close);
        } else {
            text += row->flag;
            message.remove_prefix(close + 1);
        }
    }
}

}  // namespace limn::cli
