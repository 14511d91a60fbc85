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

    std::vector<GaussBonnetAudit> Run(double bound);

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
              raster(input.faces.surface, input.faces.uvs) {}
    };

    struct FaceSum {
        Index face;
        double apart;
    };
    /// Of one strip, or of all texels.
    struct Totals {
        std::vector<Sums> ofComponent;
        std::vector<FaceSum> ofFace;  // with texels in the strip, or all that have some
    };

    std::vector<double> FindAreas() const;
    std::string FindReason(int component) const;
    std::string FindReasonInTexels(int component, Sums const& sums, double area) const;
    Totals SumTexels(ExtraordinaryDiscs const& discs) const;
    void SumStrip(Worker& worker, ExtraordinaryDiscs const& discs, TileGrid const& grid,
                  int firstRow, std::vector<Index> const& faces, Totals& totals) const;
    void SumFace(Worker& worker, ExtraordinaryDiscs const& discs, Index face, TileGrid const& grid,
                 Sums& sums) const;
    void FindWorstFace(ExtraordinaryDiscs const& discs, std::vector<FaceSum> const& ofFace,
                       GaussBonnetAudit& audit) const;

    AuditInput const& _input;
    far_ext::FaceComponents _components;
};

/// K dA over samples; strip sums are added in order, whatever the threads.
GaussBonnetAuditor::Totals GaussBonnetAuditor::SumTexels(ExtraordinaryDiscs const& discs) const {
    tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers;
    size_t const numComponents = static_cast<size_t>(_components.count);
    TexturedFaces const& faces = _input.faces;
    std::vector<Sums> total(numComponents);
    std::vector<double> ofFace(faces.isBaked.size(), 0.0);
    for (int tile : _input.bake.tiles) {
        TileGrid const grid = _input.MakeSampleGrid(tile);
        FaceBins const bins(faces.bounds, faces.isBaked, grid, kStripRows, grid.width);
        std::vector<Totals> ofStrip(static_cast<size_t>(bins.GetNumStrips()),
                                    {std::vector<Sums>(numComponents), {}});
        tbb::parallel_for(size_t{0}, ofStrip.size(), [&](size_t index) {
            _input.job.CheckStopped();
            auto& slot = workers.local();
            if (!slot) slot = std::make_unique<Worker>(_input);
            int const strip = static_cast<int>(index);
            SumStrip(*slot, discs, grid, strip * kStripRows, bins.GetStrip(strip)[0],
                     ofStrip[index]);
        });
        for (Totals const& strip : ofStrip) {
            for (size_t c = 0; c < numComponents; ++c) total[c].Add(strip.ofComponent[c]);
            for (auto const& [face, apart] : strip.ofFace) ofFace[face] += apart;
        }
    }
    Totals totals{std::move(total), {}};
    for (Index face = 0; face < static_cast<Index>(ofFace.size()); ++face)
        totals.ofFace.push_back({face, ofFace[face]});
    return totals;
}

void GaussBonnetAuditor::SumStrip(Worker& worker, ExtraordinaryDiscs const& discs,
                                  TileGrid const& grid, int firstRow,
                                  std::vector<Index> const& faces, Totals& totals) const {
    worker.strip.Reset(firstRow, std::min(kStripRows, grid.height - firstRow), grid.width);
    for (Index face : faces) {
        Sums sums;
        SumFace(worker, discs, face, grid, sums);
        if (sums.area == 0.0) continue;
        totals.ofComponent[_components.ofFace[face]].Add(sums);
        totals.ofFace.push_back({face, sums.apart});
    }
    for (size_t texel = 0; texel < worker.strip.owner.size(); ++texel) {
        if (worker.strip.overlap[texel])
            ++totals.ofComponent[_components.ofFace[worker.strip.owner[texel]]].overlaps;
    }
}

/// Adds what lies of a face in the worker's strip.
void GaussBonnetAuditor::SumFace(Worker& worker, ExtraordinaryDiscs const& discs, Index face,
                                 TileGrid const& grid, Sums& sums) const {
    auto const& hits = worker.raster.Rasterise(face, grid, worker.strip);
    worker.sampler.Bind(face);
    for (int domain = 0; domain < _input.surface.GetNumDomains(face); ++domain) {
        auto const& [texels, s, t] = hits[domain];
        auto const add = [&](std::span<int const> samples, float const* p, size_t stride) {
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
        if (!_input.faces.isBaked[face]) return "not all of its faces are baked";
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

/// Why a component's texels cannot tell its integral; empty if they can.
std::string GaussBonnetAuditor::FindReasonInTexels(int component, Sums const& sums,
                                                   double area) const {
    if (sums.overlaps) return "its texture coordinates overlap";
    auto const& missed = _input.bake.facesWithoutTexels;
    auto const numMissed = std::count_if(missed.begin(), missed.end(), [&](Index face) {
        return _components.ofFace[face] == component;
    });
    if (numMissed) {
        return fmt::format("{} of its faces have no texel; more texels resolve them", numMissed);
    }
    // Texel centres miss or double-count up to half a texel along chart borders.
    if (std::abs(sums.area - area) > 0.01 * area)
        return fmt::format("its texels cover {:.1f} % of its area", 100.0 * sums.area / area);
    return {};
}

/// Compares each face's texels with cubature on it.
void GaussBonnetAuditor::FindWorstFace(ExtraordinaryDiscs const& discs,
                                       std::vector<FaceSum> const& ofFace,
                                       GaussBonnetAudit& audit) const {
    eval::FaceTree tree(_input.surface, _input.model.GetPositions(), 3);
    for (auto const& [face, apart] : ofFace) {
        if (_components.ofFace[face] != audit.component) continue;
        _input.job.CheckStopped();
        tree.Bind(face);
        double integral = 0.0;
        auto const add = [&](eval::SurfacePlace const& place, double weight) {
            auto const x = eval::EvaluateSample(tree, place.domain, place.s, place.t);
            integral += weight * x.curvature.gaussian * x.tangentS.cross(x.tangentT).norm() *
                        discs.GetTexelShare(face, place.domain, place.s, place.t);
        };
        eval::ForEachGaussPoint(_input.surface, face, add);
        double const error = std::abs(apart - integral);
        if (audit.worstFace >= 0 && !(error > audit.worstFaceError)) continue;
        audit.worstFace = face;
        audit.worstFaceError = error;
    }
}

std::vector<GaussBonnetAudit> GaussBonnetAuditor::Run(double bound) {
    std::vector<GaussBonnetAudit> audits(static_cast<size_t>(_components.count));
    for (int c = 0; c < _components.count; ++c) {
        audits[c].component = c;
        audits[c].reason = FindReason(c);
    }
    std::vector<char> isWanted;
    for (int component : _components.ofFace) isWanted.push_back(audits[component].reason.empty());
    ExtraordinaryDiscs const discs(_input, isWanted);
    Totals const totals = SumTexels(discs);
    std::vector<double> integrals;
    for (Sums const& sum : totals.ofComponent) integrals.push_back(sum.apart);
    discs.AddIntegrals(_components.ofFace, integrals);
    std::vector<double> const areas = FindAreas();
    std::vector<int> const euler = _components.FindEulerCharacteristics(_input.level);

    for (GaussBonnetAudit& audit : audits) {
        int const c = audit.component;
        Sums const& sums = totals.ofComponent[c];
        audit.integral = integrals[c];
        audit.texelSum = sums.curvature;
        audit.expected = 2.0 * kPi * euler[c];
        audit.relativeError =
            std::abs(audit.integral - audit.expected) / std::max(2.0 * kPi, sums.magnitude);
        if (audit.reason.empty()) audit.reason = FindReasonInTexels(c, sums, areas[c]);
        audit.wasAudited = audit.reason.empty();
        audit.isWithin = !audit.wasAudited || audit.relativeError <= bound;
        if (!audit.isWithin) FindWorstFace(discs, totals.ofFace, audit);
    }
    return audits;
}

}  // namespace

std::vector<GaussBonnetAudit> AuditGaussBonnet(AuditInput const& input, double bound) {
    return GaussBonnetAuditor(input).Run(bound);
}

}  // namespace limn::engine
