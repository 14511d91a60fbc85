#include "engine/bake/audit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "engine/bake/exr_lookup.h"
#include "engine/bake/layout.h"
#include "engine/bake/uv_raster.h"
#include "eval/face_places.h"
#include "eval/surface_sampler.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;
constexpr double kPi = 3.14159265358979323846;

/// Components of faces that share vertices, numbered by their lowest face.
std::vector<int> FindComponents(Level const& level, int& count) {
    std::vector<Index> parent(static_cast<size_t>(level.GetNumVertices()));
    std::iota(parent.begin(), parent.end(), 0);
    auto const root = [&](Index v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        for (Index v : vertices) parent[root(v)] = root(vertices[0]);
    }
    std::map<Index, int> numbers;
    std::vector<int> component(static_cast<size_t>(level.GetNumFaces()));
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        Index const r = root(level.GetFaceVertices(face)[0]);
        component[face] = numbers.try_emplace(r, static_cast<int>(numbers.size())).first->second;
    }
    count = static_cast<int>(numbers.size());
    return component;
}

class Auditor {
public:
    Auditor(Scene const& scene, Far::TopologyRefiner const& refiner, BakeOptions const& options, BakeReport const& bake)
        : _scene(scene),
          _level(refiner.GetLevel(0)),
          _options(options),
          _bake(bake),
          _surface(refiner),
          _uvSurface(refiner, 0),
          _isBaked(scene.cage.faceSizes.size(), 1) {
        if (!options.groups.empty()) _isBaked = SelectGroups(scene, options.groups);
        for (Index face = 0; face < _surface.GetNumFaces(); ++face) _isBaked[face] &= _surface.HasLimit(face);
    }

    std::vector<SeamAudit> AuditSeams();
    std::vector<GaussBonnetAudit> AuditGaussBonnet(double bound, bool& isWithin);

private:
    struct Sums {
        double curvature = 0.0, magnitude = 0.0, area = 0.0;
        size_t overlaps = 0;
        void Add(Sums const& other) {
            curvature += other.curvature;
            magnitude += other.magnitude;
            area += other.area;
            overlaps += other.overlaps;
        }
    };

    TileGrid MakeGrid(int tile) const {
        TileGrid grid;
        grid.width = _options.width;
        grid.height = _options.height;
        grid.tileU = (tile - 1001) % 10;
        grid.tileV = (tile - 1001) / 10;
        return grid;
    }
    void AuditSeamsOf(Map const& map, std::vector<std::string> const& channels,
                      std::map<int, std::string> const& pathOfTile, SeamAudit& audit);
    std::vector<Sums> SumTexels(std::vector<int> const& component, int numComponents);
    std::vector<double> FindAreas(std::vector<int> const& component, int numComponents);
    std::string FindReason(int component, std::vector<int> const& componentOfFace) const;

    Scene const& _scene;
    Level _level;
    BakeOptions const& _options;
    BakeReport const& _bake;
    eval::LimitSurface _surface, _uvSurface;
    std::vector<char> _isBaked;
};

std::vector<SeamAudit> Auditor::AuditSeams() {
    std::map<std::string, std::map<int, std::string>> paths;  // per map name of the file, per tile
    for (BakeOutput const& output : _bake.outputs) paths[output.map][output.tile] = output.path;
    std::vector<Map> const maps = MakeMaps(_options.maps, _scene);
    std::vector<SeamAudit> audits;
    for (FileLayout const& file : LayOutFiles(maps, _options.pattern, _options.hasCoverage)) {
        auto const found = paths.find(file.mapName);
        if (found == paths.end()) continue;
        size_t first = 0;
        for (Map const& map : file.maps) {
            auto const begin = file.channelNames.begin() + static_cast<ptrdiff_t>(first);
            std::vector<std::string> const channels(begin, begin + map.GetNumChannels());
            first += channels.size();
            if (map.averaging == Averaging::Line) continue;  // a line has no sign to compare
            SeamAudit audit;
            audit.map = map.name;
            AuditSeamsOf(map, channels, found->second, audit);
            audits.push_back(std::move(audit));
        }
    }
    return audits;
}

void Auditor::AuditSeamsOf(Map const& map, std::vector<std::string> const& channels,
                           std::map<int, std::string> const& pathOfTile, SeamAudit& audit) {
    ExrLookup lookup;
    UVRaster raster(_uvSurface, _scene.uvs);
    std::vector<double> differences;
    // Values of one side of a seam at a few places along it; empty where the place has no tile.
    constexpr int kPlaces = 8;
    auto const lookAlong = [&](Index face, int corner, bool isReversed) {
        std::vector<std::vector<double>> values;
        raster.Bind(face);
        for (int k = 0; k < kPlaces; ++k) {
            double const tau = (k + 0.5) / kPlaces;
            auto const place = eval::GetEdgePlace(_uvSurface, face, _level.GetFaceVertices(face).size(), corner,
                                                  isReversed ? 1.0 - tau : tau);
            auto const [u, v] = raster.Evaluate(place.domain, place.s, place.t);
            // A seam on a tile's border belongs to the tile its face lies in: look a hair inside.
            auto const [cu, cv] = raster.Evaluate(place.domain, 0.01 * 0.5 + 0.99 * place.s, 0.01 * 0.5 + 0.99 * place.t);
            int const tile = 1001 + static_cast<int>(std::floor(cu)) + 10 * static_cast<int>(std::floor(cv));
            auto const path = pathOfTile.find(tile);
            values.emplace_back();
            if (path == pathOfTile.end() || cu < 0.0 || cu >= 10.0 || cv < 0.0) continue;
            TileGrid const grid = MakeGrid(tile);
            values.back() = lookup.Look(path->second, channels, grid.ToX(u), grid.ToY(v));
        }
        return values;
    };
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        auto const faces = _level.GetEdgeFaces(edge);
        if (faces.size() != 2 || _level.DoesEdgeFVarTopologyMatch(edge, 0)) continue;
        if (!_isBaked[faces[0]] || !_isBaked[faces[1]] || faces[0] == faces[1]) continue;
        // Across an infinitely sharp edge each side rightly has its own normal and curvature.
        bool const isContinuous = map.kind == MapKind::Position || map.kind == MapKind::Primvar;
        if (_level.IsEdgeInfSharp(edge) && !isContinuous) continue;
        CheckInterrupted();
        auto const locals = _level.GetEdgeFaceLocalIndices(edge);
        auto const a = lookAlong(faces[0], locals[0], false), b = lookAlong(faces[1], locals[1], true);
        for (int k = 0; k < kPlaces; ++k) {
            if (a[k].empty() || b[k].empty()) continue;
            double sum = 0.0;
            for (size_t c = 0; c < channels.size(); ++c) sum += (a[k][c] - b[k][c]) * (a[k][c] - b[k][c]);
            double const difference = std::sqrt(sum);
            if (difference >= audit.max) {
                auto const ends = _level.GetEdgeVertices(edge);
                audit.max = difference;
                audit.place = fmt::format("edge {} {} between {} and {}", ends[0], ends[1], _scene.NameFace(faces[0]),
                                          _scene.NameFace(faces[1]));
            }
            differences.push_back(difference);
        }
    }
    audit.samples = differences.size();
    if (differences.empty()) return;
    auto const at = differences.begin() + static_cast<ptrdiff_t>(0.99 * static_cast<double>(differences.size() - 1));
    std::nth_element(differences.begin(), at, differences.end());
    audit.p99 = *at;
}

/// K dA over texel centres, per component; band sums are added in order, whatever the threads.
std::vector<Auditor::Sums> Auditor::SumTexels(std::vector<int> const& component, int numComponents) {
    struct Worker {
        eval::FaceTree tree;
        eval::SurfaceSampler sampler;
        UVRaster raster;
        TexelBand band;
        explicit Worker(Auditor const& a)
            : tree(a._surface, a._scene.positions, 3),
              sampler(tree, eval::Quantity::Tangents, 1.0f),
              raster(a._uvSurface, a._scene.uvs) {}
    };
    tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers;
    std::vector<Sums> total(static_cast<size_t>(numComponents));
    int const rows = 64, numBands = (_options.height + rows - 1) / rows;
    std::vector<UVBounds> bounds(_isBaked.size());
    UVRaster measure(_uvSurface, _scene.uvs);
    for (Index face = 0; face < static_cast<Index>(bounds.size()); ++face) {
        if (_isBaked[face]) bounds[face] = measure.GetBounds(face);
    }
    for (int tile : _bake.tiles) {
        TileGrid const grid = MakeGrid(tile);
        std::vector<std::vector<Sums>> ofBand(static_cast<size_t>(numBands));
        tbb::parallel_for(0, numBands, [&](int index) {
            CheckInterrupted();
            auto& slot = workers.local();
            if (!slot) slot = std::make_unique<Worker>(*this);
            Worker& w = *slot;
            auto& sums = ofBand[index];
            sums.resize(total.size());
            w.band.Reset(index * rows, std::min(rows, grid.height - index * rows), grid.width);
            for (Index face = 0; face < static_cast<Index>(bounds.size()); ++face) {
                if (!_isBaked[face]) continue;
                bool const isNear = grid.ToY(bounds[face].maxV) < w.band.firstRow + w.band.numRows &&
                                    grid.ToY(bounds[face].minV) > w.band.firstRow - 1 &&
                                    grid.ToX(bounds[face].minU) < grid.width && grid.ToX(bounds[face].maxU) > -1;
                if (!isNear) continue;
                auto const& hits = w.raster.Rasterise(face, grid, w.band);
                Sums& sum = sums[component[face]];
                w.sampler.Bind(face);
                for (int domain = 0; domain < _surface.GetNumDomains(face); ++domain) {
                    w.sampler.Evaluate(domain, hits[domain].s, hits[domain].t,
                                       [&](std::span<int const> samples, float const* p, size_t stride) {
                        for (size_t i = 0; i < samples.size(); ++i) {
                            auto const at = [&](int c) { return static_cast<double>(p[static_cast<size_t>(c) * stride + i]); };
                            Eigen::Vector3d const s(at(eval::kTangentSX), at(eval::kTangentSY), at(eval::kTangentSZ));
                            Eigen::Vector3d const t(at(eval::kTangentTX), at(eval::kTangentTY), at(eval::kTangentTZ));
                            auto const [us, ut, vs, vt] = w.raster.GetJacobian(domain, hits[domain].s[samples[i]],
                                                                               hits[domain].t[samples[i]]);
                            double const texels = std::abs(us * vt - ut * vs) * grid.width * grid.height;
                            if (!(texels > 0.0)) continue;
                            double const area = s.cross(t).norm() / texels;
                            sum.curvature += at(eval::kGaussian) * area;
                            sum.magnitude += std::abs(at(eval::kGaussian)) * area;
                            sum.area += area;
                        }
                    });
                }
            }
            for (size_t texel = 0; texel < w.band.owner.size(); ++texel) {
                if (w.band.overlap[texel]) ++sums[component[w.band.owner[texel]]].overlaps;
            }
        });
        for (auto const& sums : ofBand) {
            for (size_t c = 0; c < total.size(); ++c) total[c].Add(sums[c]);
        }
    }
    return total;
}

/// Surface area per component, to tell whether texels cover it.
std::vector<double> Auditor::FindAreas(std::vector<int> const& component, int numComponents) {
    std::vector<double> areas(static_cast<size_t>(numComponents), 0.0);
    eval::FaceTree tree(_surface, _scene.positions, 3);
    for (Index face = 0; face < _surface.GetNumFaces(); ++face) {
        if (!_surface.HasLimit(face)) continue;
        tree.Bind(face);
        eval::ForEachGaussPoint(_surface, face, [&](eval::FacePlace const& place, double weight) {
            auto const x = eval::EvaluateSample(tree, place.domain, place.s, place.t, 1.0);
            areas[component[face]] += weight * x.tangentS.cross(x.tangentT).norm();
        });
    }
    return areas;
}

/// Why a component cannot be audited, by its topology and tags; empty if it can.
std::string Auditor::FindReason(int component, std::vector<int> const& componentOfFace) const {
    for (Index face = 0; face < _level.GetNumFaces(); ++face) {
        if (componentOfFace[face] != component) continue;
        if (_level.IsFaceHole(face)) return "it has a hole";
        if (!_isBaked[face]) return "not all of its faces are baked";
        for (Index edge : _level.GetFaceEdges(face)) {
            if (_level.IsEdgeBoundary(edge)) return "it is not closed";
            if (_level.IsEdgeInfSharp(edge)) return "it has infinitely sharp creases";
        }
        for (Index vertex : _level.GetFaceVertices(face)) {
            if (_level.IsVertexInfSharp(vertex)) return "it has infinitely sharp corners";
        }
    }
    return {};
}

std::vector<GaussBonnetAudit> Auditor::AuditGaussBonnet(double bound, bool& isWithin) {
    int count = 0;
    std::vector<int> const component = FindComponents(_level, count);
    std::vector<Sums> const sums = SumTexels(component, count);
    std::vector<double> const areas = FindAreas(component, count);
    std::vector<int> euler(static_cast<size_t>(count), 0);
    for (Index face = 0; face < _level.GetNumFaces(); ++face) ++euler[component[face]];
    for (Index vertex = 0; vertex < _level.GetNumVertices(); ++vertex) {
        if (_level.GetVertexFaces(vertex).size()) ++euler[component[_level.GetVertexFaces(vertex)[0]]];
    }
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) --euler[component[_level.GetEdgeFaces(edge)[0]]];

    std::vector<GaussBonnetAudit> audits;
    for (int c = 0; c < count; ++c) {
        GaussBonnetAudit audit;
        audit.component = c;
        audit.integral = sums[c].curvature;
        audit.expected = 2.0 * kPi * euler[c];
        audit.relativeError = std::abs(audit.integral - audit.expected) / std::max(2.0 * kPi, sums[c].magnitude);
        audit.reason = FindReason(c, component);
        if (audit.reason.empty() && sums[c].overlaps) audit.reason = "its texture coordinates overlap";
        size_t const numMissed = static_cast<size_t>(
            std::count_if(_bake.facesWithoutTexels.begin(), _bake.facesWithoutTexels.end(),
                          [&](Index face) { return component[face] == c; }));
        if (audit.reason.empty() && numMissed) {
            audit.reason = fmt::format("{} of its faces have no texel; a larger --size resolves them", numMissed);
        }
        // Texel centres miss or double-count up to half a texel along chart borders.
        if (audit.reason.empty() && std::abs(sums[c].area - areas[c]) > 0.01 * areas[c]) {
            audit.reason = fmt::format("its texels cover {:.1f} % of its area", 100.0 * sums[c].area / areas[c]);
        }
        audit.wasAudited = audit.reason.empty();
        isWithin &= !audit.wasAudited || audit.relativeError <= bound;
        audits.push_back(std::move(audit));
    }
    return audits;
}

}  // namespace

AuditReport Audit(Scene const& scene, Far::TopologyRefiner const& refiner, BakeOptions const& options,
                  BakeReport const& bake, double bound, Job& job) {
    job.Start(fmt::format("auditing {}", scene.name), 2);
    Auditor auditor(scene, refiner, options, bake);
    AuditReport report;
    report.seams = auditor.AuditSeams();
    job.Advance();
    report.gaussBonnet = auditor.AuditGaussBonnet(bound, report.isWithin);
    job.Finish();
    return report;
}

}  // namespace limn::engine
