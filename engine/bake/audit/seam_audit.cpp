// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/audit/seam_audit.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "engine/bake/layout.h"
#include "engine/images/exr_lookup.h"
#include "engine/images/udim.h"
#include "eval/surface/face_places.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;

SeamAudit AuditSeamsOf(AuditInput const& input, MapTraits const& map,
                       std::vector<std::string> const& channels,
                       std::map<int, std::string> const& pathOfTile) {
    Level const& level = input.level;
    SeamAudit audit;
    audit.map = map.name;
    ExrLookup lookup;
    UVRaster raster(input.uvSurface, input.model.GetUVs());
    std::vector<double> differences;
    // Values of one side of a seam at a few places along it; empty where the place has no tile.
    constexpr int kPlaces = 8;
    auto const lookAlong = [&](Index face, int corner, bool isReversed) {
        std::vector<std::vector<double>> values;
        raster.Bind(face);
        for (int k = 0; k < kPlaces; ++k) {
            double const tau = (k + 0.5) / kPlaces;
            auto const place =
                eval::GetEdgePlace(input.uvSurface, face, level.GetFaceVertices(face).size(),
                                   corner, isReversed ? 1.0 - tau : tau);
            auto const [u, v] = raster.Evaluate(place.domain, place.s, place.t);
            // A seam on a tile's border belongs to the tile its face lies in: look a hair inside.
            auto const [cu, cv] = raster.Evaluate(place.domain, 0.01 * 0.5 + 0.99 * place.s,
                                                  0.01 * 0.5 + 0.99 * place.t);
            auto const inside = FindUdimTile(cu, cv);
            int const tile = inside ? inside->GetNumber() : 0;
            auto const path = pathOfTile.find(tile);
            values.emplace_back();
            if (path == pathOfTile.end()) continue;
            TileGrid const grid = input.MakeGrid(tile);
            values.back() = lookup.Look(path->second, channels, grid.ToX(u), grid.ToY(v));
        }
        return values;
    };
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const faces = level.GetEdgeFaces(edge);
        if (faces.size() != 2 || level.DoesEdgeFVarTopologyMatch(edge, 0)) continue;
        if (!input.isBaked[faces[0]] || !input.isBaked[faces[1]] || faces[0] == faces[1]) continue;
        // Across an infinitely sharp edge each side rightly has its own normal and curvature.
        if (level.IsEdgeInfSharp(edge) && !map.isSameAcrossCreases) continue;
        input.job.CheckStopped();
        auto const locals = level.GetEdgeFaceLocalIndices(edge);
        auto const a = lookAlong(faces[0], locals[0], false),
                   b = lookAlong(faces[1], locals[1], true);
        for (int k = 0; k < kPlaces; ++k) {
            if (a[k].empty() || b[k].empty()) continue;
            double sum = 0.0;
            for (size_t c = 0; c < channels.size(); ++c)
                sum += (a[k][c] - b[k][c]) * (a[k][c] - b[k][c]);
            double const difference = std::sqrt(sum);
            if (difference >= audit.max) {
                auto const ends = level.GetEdgeVertices(edge);
                audit.max = difference;
                audit.place =
                    fmt::format("edge {} {} between {} and {}", ends[0], ends[1],
                                input.model.NameFace(faces[0]), input.model.NameFace(faces[1]));
            }
            differences.push_back(difference);
        }
    }
    audit.samples = differences.size();
    if (differences.empty()) return audit;
    auto const at = differences.begin() +
                    static_cast<ptrdiff_t>(0.99 * static_cast<double>(differences.size() - 1));
    std::nth_element(differences.begin(), at, differences.end());
    audit.p99 = *at;
    return audit;
}

/// Names in the file of the channels that can be compared; lines have no sign to compare.
std::vector<std::string> ListComparable(FileLayout const& file, MapTraits const& map, int first) {
    std::vector<std::string> names;
    for (ChannelGroup const& group : map.GetGroups()) {
        if (group.averaging == Averaging::Line || !map.isComparableAtSeams) continue;
        auto const begin = file.channelNames.begin() + first + group.first;
        names.insert(names.end(), begin, begin + group.count);
    }
    return names;
}

}  // namespace

std::vector<SeamAudit> AuditSeams(AuditInput const& input) {
    std::map<std::string, std::map<int, std::string>> paths;  // per map name of the file, per tile
    for (BakeOutput const& output : input.bake.outputs) {
        paths[output.map][output.tile] = output.path;
    }
    std::vector<SeamAudit> audits;
    for (FileLayout const& file : input.bake.files) {
        auto const found = paths.find(file.mapName);
        if (found == paths.end()) continue;
        int first = 0;
        for (MapTraits const& map : file.maps) {
            auto const channels = ListComparable(file, map, first);
            first += map.GetNumChannels();
            if (channels.empty()) continue;
            audits.push_back(AuditSeamsOf(input, map, channels, found->second));
        }
    }
    return audits;
}

}  // namespace limn::engine
