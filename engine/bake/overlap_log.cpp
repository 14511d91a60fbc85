// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/overlap_log.h"

#include <algorithm>

namespace limn::engine {

namespace {

constexpr uint8_t GetMark(size_t kind) {
    return static_cast<uint8_t>(2u << kind);  // 1 says that there is an overlap at all
}

/// A mark for each kind of group in which the faces are in different ones.
uint8_t MarkGroups(Model const& model, Index a, Index b) {
    uint8_t marks = 1;
    for (size_t kind = 0; kind < model.GetGroups().size(); ++kind) {
        auto const& group = model.GetGroups()[kind].faceGroup;
        if (!group.empty() && group[a] != group[b]) marks |= GetMark(kind);
    }
    return marks;
}

/// The lower of two pairs of faces; {-1, -1} is none.
std::array<Index, 2> FindLowest(std::array<Index, 2> const& a, std::array<Index, 2> const& b) {
    if (a[0] < 0 || b[0] < 0) return std::max(a, b);
    return std::min(a, b);
}

}  // namespace

void OverlapLog::Take(TexelStrip& texels) {
    for (auto const& [texel, other] : texels.overlaps) {
        Index const owner = texels.owner[texel];
        texels.overlap[texel] |= MarkGroups(_model, owner, other);
        _found.faces = FindLowest(_found.faces, {owner, other});
    }
    _found.depth = std::max(_found.depth, texels.deepestOverlap);
    texels.overlaps.clear();
    texels.deepestOverlap = 0.0;
}

void OverlapLog::Count(std::span<uint8_t const> overlap) {
    for (uint8_t const marks : overlap) {
        if (marks == 0) continue;
        ++_numTexels;
        for (size_t kind = 0; kind < _found.betweenGroups.size(); ++kind)
            _found.betweenGroups[kind] += (marks & GetMark(kind)) != 0;
    }
}

void OverlapLog::AddTo(BakeReport& report) const {
    report.overlaps += _numTexels;
    report.overlap.faces = FindLowest(report.overlap.faces, _found.faces);
    report.overlap.depth = std::max(report.overlap.depth, _found.depth);
    for (size_t kind = 0; kind < _found.betweenGroups.size(); ++kind)
        report.overlap.betweenGroups[kind] += _found.betweenGroups[kind];
}

}  // namespace limn::engine
