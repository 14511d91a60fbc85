// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/audit/seam_audit.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "engine/bake/layout.h"
#include "engine/images/exr_lookup.h"
#include "engine/scene/udim.h"
#include "eval/surface/surface_place.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;

/// Compares one map along all seams.
class SeamAuditor {
public:
    SeamAuditor(AuditInput const& input, std::vector<std::string> const& channels,
                std::map<int, std::string> const& pathOfTile)
        : _input(input),
          _channels(channels),
          _pathOfTile(pathOfTile),
          _raster(input.faces.surface, input.faces.uvs) {}

    SeamAudit Run(MapTraits const& map);

private:
    /// Values at places along one side of a seam; empty where a place has no tile.
    using Values = std::vector<std::vector<double>>;
    Values LookAlong(Index face, int corner, bool isReversed);
    bool IsSeam(Index edge, MapTraits const& map) const;

    AuditInput const& _input;
    std::vector<std::string> const& _channels;
    std::map<int, std::string> const& _pathOfTile;
    UVRaster _raster;
    ExrLookup _lookup;
};

SeamAuditor::Values SeamAuditor::LookAlong(Index face, int corner, bool isReversed) {
    constexpr int kPlaces = 8;
    int const faceSize = _input.level.GetFaceVertices(face).size();
    Values values;
    _raster.Bind(face);
    for (int k = 0; k < kPlaces; ++k) {
        double const tau = (k + 0.5) / kPlaces;
        auto const place = eval::GetEdgePlace(_input.faces.surface, face, faceSize, corner,
                                              isReversed ? 1.0 - tau : tau);
        auto const [u, v] = _raster.Evaluate(place.domain, place.s, place.t);
        // A seam on a tile's border belongs to the tile its face lies in: look a hair inside.
        auto const [insideU, insideV] = _raster.Evaluate(place.domain, 0.01 * 0.5 + 0.99 * place.s,
                                                         0.01 * 0.5 + 0.99 * place.t);
        values.emplace_back();
        auto const tile = FindUdimTile(insideU, insideV);
        auto const path = tile ? _pathOfTile.find(tile->GetNumber()) : _pathOfTile.end();
        if (path == _pathOfTile.end()) continue;
        TileGrid const grid = _input.MakeGrid(path->first);
        values.back() = _lookup.Look(path->second, _channels, grid.ToX(u), grid.ToY(v));
    }
    return values;
}

bool SeamAuditor::IsSeam(Index edge, MapTraits const& map) const {
    auto const faces = _input.level.GetEdgeFaces(edge);
    if (faces.size() != 2 || _input.level.DoesEdgeFVarTopologyMatch(edge, 0)) return false;
    if (!_input.faces.isBaked[faces[0]] || !_input.faces.isBaked[faces[1]] ||
        faces[0] == faces[1]) {
        return false;
    }
    // Across an infinitely sharp edge each side rightly has its own normal and curvature.
    return !_input.level.IsEdgeInfSharp(edge) || map.isSameAcrossCreases;
}

double FindDistance(std::vector<double> const& a, std::vector<double> const& b) {
    double sum = 0.0;
    for (size_t c = 0; c < a.size(); ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
    return std::sqrt(sum);
}

SeamAudit SeamAuditor::Run(MapTraits const& map) {
    Level const& level = _input.level;
    SeamAudit audit;
    audit.map = map.name;
    std::vector<double> differences;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        if (!IsSeam(edge, map)) continue;
        _input.job.CheckStopped();
        auto const faces = level.GetEdgeFaces(edge);
        auto const locals = level.GetEdgeFaceLocalIndices(edge);
        auto const a = LookAlong(faces[0], locals[0], false),
                   b = LookAlong(faces[1], locals[1], true);
        for (size_t k = 0; k < a.size(); ++k) {
            if (a[k].empty() || b[k].empty()) continue;
            double const difference = FindDistance(a[k], b[k]);
            differences.push_back(difference);
            if (difference < audit.max) continue;
            auto const ends = level.GetEdgeVertices(edge);
            audit.max = difference;
            audit.place =
                fmt::format("edge {} {} between {} and {}", ends[0], ends[1],
                            _input.model.NameFace(faces[0]), _input.model.NameFace(faces[1]));
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
            audits.push_back(SeamAuditor(input, channels, found->second).Run(map));
        }
    }
    return audits;
}

}  // namespace limn::engine
