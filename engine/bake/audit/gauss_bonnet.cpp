// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/audit/gauss_bonnet.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "engine/bake/audit/extraordinary_discs.h"
#include "engine/bake/raster/face_bins.h"
#include "eval/surface/surface_place.h"
#include "eval/surface/surface_sampler.h"
#include "far_ext/topology/face_components.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;
constexpr double kPi = 3.14159265358979323846;
constexpr int kStripRows = 64;

class GaussBonnetAuditor {
public:
    explicit GaussBonnetAuditor(AuditInput const& input)
        : _input(input), _components(far_ext::FaceComponents::Find(input.level)) {}

    std::vector<GaussBonnetAudit> Run();

private:
    struct Sums {
        double apart = 0.0;      // K dA that no disc takes
        double curvature = 0.0;  // K dA
        double magnitude = 0.0, area = 0.0;
        size_t overlaps = 0;
        void Add(Sums const& other) {
            apart += other.apart;
            curvature += other.curvature;
            magnitude += other.magnitude;
            area += other.area;
            overlaps += other.overlaps;
        }
    };
    struct Worker {
        eval::FaceTree tree;
        eval::SurfaceSampler sampler;
        UVRaster raster;
        TexelStrip strip;
        explicit Worker(AuditInput const& input)
            : tree(input.surface, input.model.GetPositions(), 3),
              sampler(tree, eval::Quantity::Tangents, Orientation::Right),
              raster(input.uvSurface, input.model.GetUVs()) {}
    };

    std::vector<double> FindAreas() const;
    std::string FindReason(int component) const;
    std::vector<Sums> SumTexels(ExtraordinaryDiscs const& discs) const;
    void SumFace(Worker& worker, ExtraordinaryDiscs const& discs, Index face, TileGrid const& grid,
                 Sums& sums) const;

    AuditInput const& _input;
    far_ext::FaceComponents _components;
};

/// K dA over texel centres, per component; strip sums are added in order, whatever the threads.
std::vector<GaussBonnetAuditor::Sums> GaussBonnetAuditor::SumTexels(
    ExtraordinaryDiscs const& discs) const {
    tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers;
    std::vector<Sums> total(static_cast<size_t>(_components.count));
    std::vector<UVBounds> bounds(_input.isBaked.size());
    UVRaster measure(_input.uvSurface, _input.model.GetUVs());
    for (Index face = 0; face < static_cast<Index>(bounds.size()); ++face) {
        if (_input.isBaked[face]) bounds[face] = measure.GetBounds(face);
    }
    for (int tile : _input.bake.tiles) {
        TileGrid const grid = _input.MakeGrid(tile);
        FaceBins const bins(bounds, _input.isBaked, grid, kStripRows, grid.width);
        size_t const numStrips = static_cast<size_t>(bins.GetNumStrips());
        std::vector<std::vector<Sums>> ofStrip(numStrips, std::vector<Sums>(total.size()));
        tbb::parallel_for(size_t{0}, numStrips, [&](size_t index) {
            _input.job.CheckStopped();
            auto& slot = workers.local();
            if (!slot) slot = std::make_unique<Worker>(_input);
            int const firstRow = static_cast<int>(index) * kStripRows;
            slot->strip.Reset(firstRow, std::min(kStripRows, grid.height - firstRow), grid.width);
            for (Index face : bins.GetStrip(static_cast<int>(index))[0])
                SumFace(*slot, discs, face, grid, ofStrip[index][_components.ofFace[face]]);
            TexelStrip const& strip = slot->strip;
            for (size_t texel = 0; texel < strip.owner.size(); ++texel) {
                if (strip.overlap[texel])
                    ++ofStrip[index][_components.ofFace[strip.owner[texel]]].overlaps;
            }
        });
        for (auto const& sums : ofStrip) {
            for (size_t c = 0; c < total.size(); ++c) total[c].Add(sums[c]);
        }
    }
    return total;
}

/// Adds what lies of a face in the worker's strip.
void GaussBonnetAuditor::SumFace(Worker& worker, ExtraordinaryDiscs const& discs, Index face,
                                 TileGrid const& grid, Sums& sums) const {
    auto const& hits = worker.raster.Rasterise(face, grid, worker.strip);
    worker.sampler.Bind(face);
    for (int domain = 0; domain < _input.surface.GetNumDomains(face); ++domain) {
        auto const& [texels, s, t] = hits[domain];
        auto const add = [&, &s = s, &t = t](std::span<int const> samples, float const* p,
                                             size_t stride) {
            for (size_t i = 0; i < samples.size(); ++i) {
                int const sample = samples[i];
                auto const at = [&](int c) {
                    return static_cast<double>(p[static_cast<size_t>(c) * stride + i]);
                };
                Eigen::Vector3d const ds(at(eval::kTangentSX), at(eval::kTangentSY),
                                         at(eval::kTangentSZ));
                Eigen::Vector3d const dt(at(eval::kTangentTX), at(eval::kTangentTY),
                                         at(eval::kTangentTZ));
                auto const [us, ut, vs, vt] =
                    worker.raster.GetJacobian(domain, s[sample], t[sample]);
                double const texelsPerDomain =
                    std::abs(us * vt - ut * vs) * grid.width * grid.height;
                if (!(texelsPerDomain > 0.0)) continue;
                double const area = ds.cross(dt).norm() / texelsPerDomain;
                double const curvature = at(eval::kGaussian) * area;
                sums.apart += curvature * discs.GetTexelShare(face, domain, s[sample], t[sample]);
                sums.curvature += curvature;
                sums.magnitude += std::abs(curvature);
                sums.area += area;
            }
        };
        worker.sampler.Evaluate(domain, s, t, add);
    }
}

/// Surface area per component, to tell whether texels cover it.
std::vector<double> GaussBonnetAuditor::FindAreas() const {
    std::vector<double> areas(static_cast<size_t>(_components.count), 0.0);
    eval::FaceTree tree(_input.surface, _input.model.GetPositions(), 3);
    for (Index face = 0; face < _input.surface.GetNumFaces(); ++face) {
        if (!_input.surface.HasLimit(face)) continue;
        tree.Bind(face);
        eval::ForEachGaussPoint(
            _input.surface, face, [&](eval::SurfacePlace const& place, double weight) {
                auto const x = eval::EvaluateSample(tree, place.domain, place.s, place.t);
                areas[_components.ofFace[face]] += weight * x.tangentS.cross(x.tangentT).norm();
            });
    }
    return areas;
}

/// Why a component cannot be audited, by its topology and tags; empty if it can.
std::string GaussBonnetAuditor::FindReason(int component) const {
    Level const& level = _input.level;
    if (_input.model.GetCage().scheme == Sdc::SCHEME_BILINEAR)
        return "a bilinear surface has a crease along every edge";
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        if (_components.ofFace[face] != component) continue;
        if (level.IsFaceHole(face)) return "it has a hole";
        if (!_input.isBaked[face]) return "not all of its faces are baked";
        for (Index edge : level.GetFaceEdges(face)) {
            if (level.IsEdgeBoundary(edge)) return "it is not closed";
            if (level.IsEdgeInfSharp(edge)) return "it has infinitely sharp creases";
        }
        for (Index vertex : level.GetFaceVertices(face)) {
            if (level.IsVertexInfSharp(vertex)) return "it has infinitely sharp corners";
        }
    }
    return {};
}

std::vector<GaussBonnetAudit> GaussBonnetAuditor::Run() {
    std::vector<GaussBonnetAudit> audits(static_cast<size_t>(_components.count));
    for (int c = 0; c < _components.count; ++c) {
        audits[c].component = c;
        audits[c].reason = FindReason(c);
    }
    std::vector<char> isWanted;
    for (int component : _components.ofFace) isWanted.push_back(audits[component].reason.empty());
    ExtraordinaryDiscs const discs(_input, isWanted);
    std::vector<Sums> const sums = SumTexels(discs);
    std::vector<double> integrals;
    for (Sums const& sum : sums) integrals.push_back(sum.apart);
    discs.AddIntegrals(_components.ofFace, integrals);
    std::vector<double> const areas = FindAreas();
    std::vector<int> const euler = _components.FindEulerCharacteristics(_input.level);

    for (GaussBonnetAudit& audit : audits) {
        int const c = audit.component;
        audit.integral = integrals[c];
        audit.texelSum = sums[c].curvature;
        audit.expected = 2.0 * kPi * euler[c];
        audit.relativeError =
            std::abs(audit.integral - audit.expected) / std::max(2.0 * kPi, sums[c].magnitude);
        if (audit.reason.empty() && sums[c].overlaps)
            audit.reason = "its texture coordinates overlap";
        auto const& missed = _input.bake.facesWithoutTexels;
        auto const numMissed = std::count_if(missed.begin(), missed.end(), [&](Index face) {
            return _components.ofFace[face] == c;
        });
        if (audit.reason.empty() && numMissed) {
            audit.reason =
                fmt::format("{} of its faces have no texel; more texels resolve them", numMissed);
        }
        // Texel centres miss or double-count up to half a texel along chart borders.
        if (audit.reason.empty() && std::abs(sums[c].area - areas[c]) > 0.01 * areas[c]) {
            audit.reason = fmt::format("its texels cover {:.1f} % of its area",
                                       100.0 * sums[c].area / areas[c]);
        }
        audit.wasAudited = audit.reason.empty();
    }
    return audits;
}

}  // namespace

std::vector<GaussBonnetAudit> AuditGaussBonnet(AuditInput const& input) {
    return GaussBonnetAuditor(input).Run();
}

}  // namespace limn::engine
