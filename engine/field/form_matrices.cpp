// SPDX-License-Identifier: Apache-2.0
#include "engine/field/form_matrices.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "engine/io/matrix_market.h"
#include "far_ext/forms/form_stencils.h"

namespace limn::engine {

namespace {

std::string FormatEdges(Far::TopologyLevel const& level) {
    std::string text = "edge,v0,v1\n";
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        fmt::format_to(std::back_inserter(text), "{},{},{}\n", edge, std::min(ends[0], ends[1]),
                       std::max(ends[0], ends[1]));
    }
    return text;
}

}  // namespace

std::string NameEdgeTable(std::string const& s1, int level) {
    return fmt::format("{}.edges{}.csv", s1.substr(0, s1.rfind('.')), level);
}

void AddFormMatrices(Far::TopologyRefiner const& refined, int levels, std::string const& s1,
                     std::string const& s2, MeshSequence& files) {
    auto const stencils = far_ext::ComposeFormStencils(refined, levels);
    auto const base = refined.GetLevel(0);
    WriteMatrixMarket(files.Open(s1), far_ext::AsMatrix(stencils.s1, base.GetNumEdges()),
                      {fmt::format("edges of level {}", levels), "edges of the mesh"});
    WriteMatrixMarket(files.Open(s2), far_ext::AsMatrix(stencils.s2, base.GetNumFaces()),
                      {fmt::format("faces of level {}", levels), "faces of the mesh"});
    for (int level : {0, levels})
        files.Add(NameEdgeTable(s1, level), FormatEdges(refined.GetLevel(level)));
}

}  // namespace limn::engine
