// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/strip_baker.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "engine/bake/overlap_log.h"
#include "engine/images/pixel_kernel.h"
#include "engine/scene/extent.h"
#include "eval/kernels/dispatch.h"
#include "far_ext/error.h"

namespace limn::engine {

/// Maps that are evaluated together, with the bits that each would have alone.
struct StripBaker::Pass {
    struct Entry {
        size_t map;      // into _maps
        int firstPlane;  // of the strip
        int firstValue;  // among the pass's values
    };
    std::vector<Entry> maps;
    eval::Quantity quantity = eval::Quantity::Position;
    eval::SurfaceSampler::Values values{};
    bool needsJacobian = false;
};

/// What one thread needs, made once.
struct StripBaker::Worker {
    eval::FaceTree tree;
    std::vector<eval::SurfaceSampler> surfaces;     // per pass
    std::vector<std::unique_ptr<MapSampler>> maps;  // per map
    UVRaster raster;
    std::vector<float> values;        // of a map, for a block of samples
    far_ext::LargeArray<int> places;  // the texels they belong to
    std::vector<std::array<double, 4>> jacobians;
    OverlapLog overlaps;
    SampleAverages averages;
    TexelStrip sampleTexels, centreTexels;
    std::vector<int> numFaces;  // over texels
    std::vector<float> samplePlanes;

    explicit Worker(StripBaker const& baker)
        : tree(baker._surface, baker._values),
          raster(baker._faces.surface, baker._faces.uvs),
          overlaps(baker._model),
          averages(baker._groups) {
        for (Pass const& pass : baker._passes) {
            surfaces.emplace_back(tree, pass.quantity, baker._options.orientation, pass.values);
        }
        for (auto const& map : baker._maps) maps.push_back(map->MakeSampler());
    }
};

namespace {

/// to[places[i]] = from[i], eight at a time where the places lie side by side.
void Scatter(std::span<int const> places, float const* from, float* to) {
    constexpr size_t kGroup = 8;
    size_t i = 0;
    for (; i + kGroup <= places.size(); i += kGroup) {
        int apart = 0;
        for (size_t k = 0; k < kGroup; ++k) {
            apart |= places[i + k] - static_cast<int>(k) - places[i];
        }
        if (apart == 0) {
            std::memcpy(to + places[i], from + i, sizeof(float) * kGroup);
        } else {
            for (size_t k = 0; k < kGroup; ++k) to[places[i + k]] = from[i + k];
        }
    }
    for (; i < places.size(); ++i) to[places[i]] = from[i];
}

void Encode(Encoding const& encoding, std::span<float> values) {
    auto const scale = static_cast<float>(encoding.scale);
    auto const offset = static_cast<float>(encoding.offset);
    for (float& value : values) value = value * scale + offset;
}

}  // namespace

StripBaker::~StripBaker() = default;

StripBaker::Worker& StripBaker::LocalWorker() {
    auto& worker = _workers.local();
    if (!worker) worker = std::make_unique<Worker>(*this);
    return *worker;
}

StripBaker::StripBaker(Model const& model, TexturedFaces const& faces, BakeOptions const& options,
                       std::vector<std::unique_ptr<Map>> const& maps, Job& job)
    : _model(model),
      _faces(faces),
      _options(options),
      _maps(maps),
      _job(job),
      _surface(model.GetLimitSurface()),
      _baked{model,
             _surface,
             faces.surface,
             faces.isBaked,
             options.width,
             options.height,
             FindFloatOrigin(FindExtent(model.GetPositions()))},
      _positions(Subtract(model.GetPositions(), _baked.floatOrigin)),
      _hasTexels(model.GetCage().faceSizes.size()) {
    for (auto const& map : maps) map->Prepare(_baked, job);
    ArrangePasses();
}

/// Sorts maps by the precision they are evaluated at, which the least of what they need decides:
/// curvature is taken in double where pieces are deep, and not nearer to a corner than 2^-16.
void StripBaker::ArrangePasses() {
    _values.push_back({_positions, 3});
    int numChannels = 3;
    for (eval::Quantity least : {eval::Quantity::Position, eval::Quantity::Curvature}) {
        Pass pass;
        pass.quantity = least;
        pass.values.first = numChannels;
        int firstPlane = 0;
        for (size_t m = 0; m < _maps.size(); ++m) {
            MapTraits const& traits = _maps[m]->GetTraits();
            int const plane = firstPlane;
            firstPlane += traits.GetNumChannels();
            if (traits.needsFaceCounts) continue;
            if (!eval::SurfaceSampler::SharesBits(traits.quantity, least)) continue;
            pass.quantity = std::max(pass.quantity, traits.quantity);
            pass.needsJacobian |= traits.needsJacobian;
            pass.maps.push_back({m, plane, pass.values.count});
            for (eval::FaceTree::Values const& values : _maps[m]->GetValues()) {
                _values.push_back(values);
                pass.values.count += values.length;
            }
        }
        numChannels += pass.values.count;
        if (!pass.maps.empty()) _passes.push_back(std::move(pass));
    }
    for (size_t m = 0; m < _maps.size(); ++m) {
        MapTraits const& traits = _maps[m]->GetTraits();
        if (traits.needsFaceCounts) _countedMaps.push_back({m, _numPlanes});
        for (ChannelGroup group : traits.GetGroups()) {
            group.first += _numPlanes;
            _groups.push_back(group);
        }
        _numPlanes += traits.GetNumChannels();
    }
}

std::shared_ptr<Strip> StripBaker::MakeStrip(int index, TileGrid const& grid,
                                             FaceBins::Blocks const& blocks) {
    _job.CheckStopped();
    Worker& worker = LocalWorker();
    bool const isSupersampled = _options.samplesPerSide > 1;
    std::shared_ptr<Strip> strip =
        _pool.Acquire(index, _numPlanes, grid, !_countedMaps.empty() && !isSupersampled);
    if (isSupersampled) {
        Supersample(worker, grid, blocks, *strip);
        if (!_countedMaps.empty()) CountCentres(worker, grid, blocks, *strip);
        FinishBlock(worker, *strip, 0, grid.width);
    } else {
        BakeCentres(worker, grid, blocks, *strip);
    }
    for (auto const& map : worker.maps) strip->leftOut.push_back(map->TakeTangentialPart());
    _texelsCovered += strip->numCovered;
    return strip;
}

/// One sample per texel.
void StripBaker::BakeCentres(Worker& worker, TileGrid const& grid, FaceBins::Blocks const& blocks,
                             Strip& strip) {
    auto const finish = [&](int firstColumn, int numColumns) {
        for (int row = 0; row < strip.texels.numRows; ++row) {
            size_t const at = static_cast<size_t>(row) * grid.width + firstColumn;
            for (size_t i = at; i < at + numColumns; ++i) {
                strip.isCovered[i] = strip.texels.owner[i] >= 0;
            }
        }
        FillCounts(worker, strip.texels, firstColumn, numColumns, strip.planes.data());
        FinishBlock(worker, strip, firstColumn, numColumns);
    };
    RasterSamples(worker, grid, blocks, strip.texels, strip.planes.data(), finish);
}

/// Lets the maps that need face counts fill their planes, in a block whose texels are all known.
void StripBaker::FillCounts(Worker& worker, TexelStrip const& texels, int firstColumn,
                            int numColumns, float* planes) const {
    if (_countedMaps.empty()) return;
    worker.places.clear();
    worker.numFaces.clear();
    for (int row = 0; row < texels.numRows; ++row) {
        for (int column = firstColumn; column < firstColumn + numColumns; ++column) {
            int const texel = row * texels.width + column;
            int const numFaces = texels.CountFaces(static_cast<size_t>(texel));
            if (numFaces == 0) continue;
            worker.places.push_back(texel);
            worker.numFaces.push_back(numFaces);
        }
    }
    for (CountedMap const& counted : _countedMaps) {
        worker.values.resize(worker.numFaces.size());
        worker.maps[counted.map]->EvaluateCounts(worker.numFaces, worker.values.data());
        if (_options.encoding) Encode(*_options.encoding, worker.values);
        size_t const plane = static_cast<size_t>(counted.plane);
        Scatter(worker.places, worker.values.data(), planes + plane * texels.owner.size());
    }
}

/// Face counts beside supersampled maps: they are those of the texels' centres all the same.
void StripBaker::CountCentres(Worker& worker, TileGrid const& grid, FaceBins::Blocks const& blocks,
                              Strip& strip) {
    TexelStrip& texels = worker.centreTexels;
    texels.countsFaces = true;
    texels.Reset(strip.texels.firstRow, strip.texels.numRows, strip.texels.width);
    for (size_t block = 0; block < blocks.size(); ++block) {
        int const firstColumn = static_cast<int>(block) * Strip::kBlockColumns;
        int const numColumns = std::min(Strip::kBlockColumns, texels.width - firstColumn);
        _job.CheckStopped();
        for (Index face : blocks[block])
            worker.raster.Rasterise(face, grid, texels, firstColumn, numColumns);
    }
    FillCounts(worker, texels, 0, texels.width, strip.planes.data());
}

/// Counts and ranges of a block whose texels are all known.
void StripBaker::FinishBlock(Worker& worker, Strip& strip, int firstColumn, int numColumns) {
    size_t const count = static_cast<size_t>(numColumns);
    for (int row = 0; row < strip.texels.numRows; ++row) {
        size_t const at = static_cast<size_t>(row) * strip.texels.width + firstColumn;
        uint8_t const* const covered = &strip.isCovered[at];
        size_t numCovered = 0;
        for (size_t i = 0; i < count; ++i) numCovered += covered[i];
        strip.numCovered += numCovered;
        worker.overlaps.Count({&strip.texels.overlap[at], count});
        if (uint8_t const* const failed = &strip.texels.failed[at]; std::memchr(failed, 1, count)) {
            for (size_t i = 0; i < count; ++i) _newtonFailures += failed[i] && !covered[i];
        }
        for (int plane = 0; numCovered > 0 && plane < _numPlanes; ++plane) {
            eval::GetKernel<PixelKernel>().findRange(strip.GetPlane(plane) + at, covered, count,
                                                     &strip.low[plane], &strip.high[plane]);
        }
    }
}

/// Texels that no face has been asked about yet: no owner, zeros.
void StripBaker::ClearBlock(TexelStrip& texels, float* planes, int firstColumn,
                            int numColumns) const {
    size_t const count = static_cast<size_t>(numColumns), numTexels = texels.owner.size();
    texels.ClearColumns(firstColumn, numColumns);
    for (int row = 0; row < texels.numRows; ++row) {
        size_t const at = static_cast<size_t>(row) * texels.width + firstColumn;
        for (int plane = 0; plane < _numPlanes; ++plane) {
            std::fill_n(planes + plane * numTexels + at, count, 0.0f);
        }
    }
}

/// Fills `texels` and `planes` block by block, while the block is in the cache; finish(first
/// column, number of columns) is called after each.
template <class Finish>
void StripBaker::RasterSamples(Worker& worker, TileGrid const& grid, FaceBins::Blocks const& blocks,
                               TexelStrip& texels, float* planes, Finish finish) {
    size_t const planeSize = texels.owner.size();
    size_t untilCheck = 0;
    for (size_t block = 0; block < blocks.size(); ++block) {
        int const firstColumn = static_cast<int>(block) * Strip::kBlockColumns;
        int const numColumns = std::min(Strip::kBlockColumns, texels.width - firstColumn);
        ClearBlock(texels, planes, firstColumn, numColumns);
        for (Index face : blocks[block]) {
            if (untilCheck-- == 0) {
                _job.CheckStopped();
                untilCheck = 256;
            }
            auto const& hits = worker.raster.Rasterise(face, grid, texels, firstColumn, numColumns);
            for (int domain = 0; domain < _surface.GetNumDomains(face); ++domain) {
                auto const& [places, s, t] = hits[domain];
                if (places.empty()) continue;
                EvaluateHits(worker, {face, domain, s, t}, places, planes, planeSize);
            }
        }
        worker.overlaps.Take(texels);
        finish(firstColumn, numColumns);
    }
}

void StripBaker::EvaluateHits(Worker& worker, FaceSamples const& samples,
                              far_ext::LargeArray<int> const& texels, float* planes,
                              size_t planeSize) {
    _hasTexels[samples.face].store(true, std::memory_order_relaxed);
    for (auto const& map : worker.maps) map->Start(samples);
    for (size_t p = 0; p < _passes.size(); ++p) {
        worker.surfaces[p].Bind(samples.face);
        auto const visit = [&](std::span<int const> block, float const* surface, size_t stride) {
            worker.places.resize(block.size());
            for (size_t i = 0; i < block.size(); ++i) worker.places[i] = texels[block[i]];
            SampleBlock sampleBlock{block, surface, nullptr, stride, {}};
            EvaluateBlock(worker, p, samples, sampleBlock, surface, planes, planeSize);
        };
        worker.surfaces[p].Evaluate(samples.domain, samples.s, samples.t, visit);
    }
}

/// Lets the maps of a pass compute a block, and puts their values into the strip's planes.
void StripBaker::EvaluateBlock(Worker& worker, size_t pass, FaceSamples const& samples,
                               SampleBlock& block, float const* surface, float* planes,
                               size_t planeSize) {
    worker.jacobians.clear();
    for (size_t i = 0; _passes[pass].needsJacobian && i < block.samples.size(); ++i) {
        int const sample = block.samples[i];
        worker.jacobians.push_back(
            worker.raster.GetJacobian(samples.domain, samples.s[sample], samples.t[sample]));
    }
    block.jacobians = worker.jacobians;
    for (Pass::Entry const& entry : _passes[pass].maps) {
        int const firstValue = worker.surfaces[pass].GetFirstValue() + entry.firstValue;
        block.values = surface + static_cast<size_t>(firstValue) * block.stride;
        size_t const numChannels =
            static_cast<size_t>(_maps[entry.map]->GetTraits().GetNumChannels());
        worker.values.resize(numChannels * block.stride);
        worker.maps[entry.map]->Evaluate(block, worker.values.data(), block.stride);
        for (size_t c = 0; c < numChannels; ++c) {
            std::span const values(&worker.values[c * block.stride], block.GetCount());
            if (_options.encoding) Encode(*_options.encoding, values);
            size_t const plane = static_cast<size_t>(entry.firstPlane) + c;
            Scatter(worker.places, values.data(), planes + plane * planeSize);
        }
    }
}

/// N x N samples per texel, in rows.
void StripBaker::Supersample(Worker& worker, TileGrid const& grid, FaceBins::Blocks const& blocks,
                             Strip& strip) {
    int const n = _options.samplesPerSide;
    worker.averages.Start(strip);
    worker.samplePlanes.resize(strip.planes.size());
    for (int sample = 0; sample < n * n; ++sample) {
        TileGrid offset = grid;
        offset.offsetX = (sample % n + 0.5) / n;
        offset.offsetY = (sample / n + 0.5) / n;
        worker.sampleTexels.Resize(strip.texels.firstRow, strip.texels.numRows, strip.texels.width);
        RasterSamples(worker, offset, blocks, worker.sampleTexels, worker.samplePlanes.data(),
                      [](int, int) {});
        worker.averages.Add(worker.sampleTexels, worker.samplePlanes, strip);
    }
    worker.averages.Finish(n * n, strip);
}

std::string StripBaker::NamePlace(eval::SurfacePlace const& place) const {
    auto const vertices = _model.GetLevel().GetFaceVertices(place.face);
    int corner;
    if (_surface.GetNumDomains(place.face) > 1) {
        if (place.s + place.t > 1.0) {
            return fmt::format("the centre of {}", _model.NameFace(place.face));
        }
        corner = place.domain;
    } else if (_surface.IsLoop()) {
        corner = place.s > 0.5 ? 1 : place.t > 0.5 ? 2 : 0;
    } else {
        bool const farS = place.s > 0.5, farT = place.t > 0.5;
        corner = farT ? (farS ? 2 : 3) : (farS ? 1 : 0);
    }
    return fmt::format("vertex {}", vertices[corner]);
}

void StripBaker::AddCounts(BakeReport& report, std::vector<std::string>& movedPlaces) const {
    report.texelsCovered = _texelsCovered;
    report.newtonFailures = _newtonFailures;
    std::set<std::string> places;
    for (auto const& worker : _workers) {
        if (!worker) continue;
        worker->overlaps.AddTo(report);
        for (auto const& map : worker->maps) report.degenerateSamples += map->GetNumDegenerate();
        if (worker->surfaces.empty()) continue;
        auto const& counts = worker->surfaces.back().GetCounts();  // of the pass that needs most
        report.movedSamples += counts.moved;
        report.degenerateSamples += counts.degenerate;
        for (auto const& place : counts.movedPlaces) places.insert(NamePlace(place));
    }
    movedPlaces.assign(places.begin(), places.end());
    for (Index face = 0; face < _surface.GetNumFaces(); ++face) {
        if (_faces.isBaked[face] && !_hasTexels[face]) report.facesWithoutTexels.push_back(face);
    }
}

}  // namespace limn::engine
