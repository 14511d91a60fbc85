// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/audit/extraordinary_discs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace limn::engine {

namespace {

// Of spot, the chess knight and others at 500 to 2200 texels: 2 is as good as 4, 1 is twice as bad.
constexpr double kTexelsOfFall = 4.0;
// With 2 or 3 texels the knight's discs made its error four times what texels alone have; from 8 to
// 30 on they help.
constexpr double kTexelsOfDisc = 16.0;
// Far from the depth at which curvature is no longer taken where it is asked for
// (eval::FaceTree::kCurvatureDepth).
constexpr double kSmallest = 0x1p-10;

}  // namespace

ExtraordinaryDiscs::ExtraordinaryDiscs(AuditInput const& input, std::vector<char> const& isWanted)
    : _input(input) {
    auto const& surface = input.surface;
    size_t count = 0;
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        _firstOfFace.push_back(count);
        count += 4 * static_cast<size_t>(surface.GetNumDomains(face));
    }
    _radii.assign(count, 0.0);

    int const regularValence = surface.IsLoop() ? 6 : 4;
    for (Index vertex = 0; vertex < input.level.GetNumVertices(); ++vertex) {
        auto const faces = input.level.GetVertexFaces(vertex);
        if (faces.size() == 0 || faces.size() == regularValence || !isWanted[faces[0]]) continue;
        auto sectors = FindSectors(vertex);
        if (!sectors.empty()) _discs.push_back({std::move(sectors)});
    }
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        int const numDomains = surface.GetNumDomains(face);
        if (numDomains == 1 || !isWanted[face]) continue;
        Disc disc;
        for (int domain = 0; domain < numDomains; ++domain)
            disc.sectors.push_back({face, domain, 2, 0.5});
        _discs.push_back(std::move(disc));
    }
    UVRaster raster(input.faces.surface, input.faces.uvs);
    std::erase_if(_discs, [&](Disc& disc) { return !ChooseRadius(disc.sectors, raster); });
    Integrate();
}

/// The corners at a vertex in order, each disc as large as it may be; empty where they are not one
/// fan.
std::vector<eval::DiscSector> ExtraordinaryDiscs::FindSectors(Index vertex) const {
    auto const& level = _input.level;
    auto const faces = level.GetVertexFaces(vertex);
    auto const corners = level.GetVertexFaceLocalIndices(vertex);
    std::map<Index, int>
        leaving;  // per edge the corner that it leaves from, as the face goes round
    bool hasSubQuads = false;
    for (int i = 0; i < faces.size(); ++i) {
        leaving[level.GetFaceEdges(faces[i])[corners[i]]] = i;
        hasSubQuads |= _input.surface.GetNumDomains(faces[i]) > 1;
    }
    std::vector<eval::DiscSector> sectors;
    for (int at = 0; sectors.size() < static_cast<size_t>(faces.size());) {
        Index const face = faces[at];
        bool const isSubQuad = _input.surface.GetNumDomains(face) > 1;
        // A sub-quad's side is half an edge: what is a quarter for quads is half for their
        // neighbours of other sizes.
        double const radius = hasSubQuads && !isSubQuad ? 0.25 : 0.5;
        sectors.push_back({face, isSubQuad ? corners[at] : 0, isSubQuad ? 0 : corners[at], radius});
        auto const edges = level.GetFaceEdges(face);
        auto const next = leaving.find(edges[(corners[at] + edges.size() - 1) % edges.size()]);
        if (next == leaving.end()) return {};
        at = next->second;
        if (at == 0) break;
    }
    if (sectors.size() != static_cast<size_t>(faces.size())) sectors.clear();
    return sectors;
}

/// \return false where a disc has too few texels
bool ExtraordinaryDiscs::ChooseRadius(std::vector<eval::DiscSector>& sectors,
                                      UVRaster& raster) const {
    bool const isLoop = _input.surface.IsLoop();
    int const samples = _input.options.samplesPerSide;
    double const width = samples * _input.options.width, height = samples * _input.options.height;
    double count = 0.0, fall = std::numeric_limits<double>::infinity();  // of texels; the latter of
                                                                         // the sparsest sector
    for (eval::DiscSector const& sector : sectors) {
        raster.Bind(sector.face);
        auto const [s, t] = eval::FromCorner(isLoop, sector.corner, 0.25, 0.25);
        auto const [us, ut, vs, vt] = raster.GetJacobian(sector.domain, s, t);
        double const area = sector.radius * sector.radius * (isLoop ? 0.5 : 1.0);
        count += area * std::abs(us * vt - ut * vs) * width * height;
        fall = std::min({fall, 0.5 * sector.radius * std::hypot(us * width, vs * height),
                         0.5 * sector.radius * std::hypot(ut * width, vt * height)});
    }
    double scale = 1.0;
    while (fall * scale >= 2.0 * kTexelsOfFall && scale > kSmallest) scale *= 0.5;
    for (eval::DiscSector& sector : sectors) sector.radius *= scale;
    return count >= kTexelsOfDisc;
}

void ExtraordinaryDiscs::Integrate() {
    tbb::enumerable_thread_specific<eval::FaceTree> trees(
        [&] { return eval::FaceTree(_input.surface, _input.model.GetPositions(), 3); });
    tbb::parallel_for(size_t{0}, _discs.size(), [&](size_t i) {
        _input.job.CheckStopped();
        _discs[i].integral = eval::IntegrateDisc(trees.local(), _discs[i].sectors);
    });
    // Without a tangent plane somewhere on the border the theorem says nothing: texels are the
    // better guess.
    std::erase_if(_discs, [](Disc const& disc) { return !std::isfinite(disc.integral); });
    for (Disc const& disc : _discs) {
        for (eval::DiscSector const& sector : disc.sectors) RadiusAt(sector) = sector.radius;
    }
}

double ExtraordinaryDiscs::GetTexelShare(Index face, int domain, double s, double t) const {
    bool const isLoop = _input.surface.IsLoop();
    double const* const radii = &_radii[_firstOfFace[face] + 4 * static_cast<size_t>(domain)];
    double share = 1.0;
    for (int corner = 0; corner < (isLoop ? 3 : 4); ++corner) {
        if (radii[corner] == 0.0) continue;
        auto const [a, b] = eval::ToCorner(isLoop, corner, s, t);
        share -= eval::GetDiscWeight(isLoop, a, b, radii[corner]);
    }
    return share;
}

void ExtraordinaryDiscs::AddIntegrals(std::vector<int> const& componentOfFace,
                                      std::vector<double>& integrals) const {
    for (Disc const& disc : _discs)
        integrals[componentOfFace[disc.sectors[0].face]] += disc.integral;
}

}  // namespace limn::engine
