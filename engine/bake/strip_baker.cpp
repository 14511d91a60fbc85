// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/strip_baker.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "engine/fit/bands.h"
#include "engine/images/pixel_kernel.h"
#include "engine/scene/subdivision_names.h"
#include "eval/surface/face_places.h"
#include "far_ext/error.h"
#include "far_ext/topology/refiner.h"

namespace limn::engine {

/// What one thread needs, made once.
struct BandBaker::Worker {
    eval::FaceTree tree;
    eval::SurfaceSampler sampler;
    UVRaster raster;
    std::vector<float> block;         // map values of a block of samples
    UninitializedVector<int> places;  // the texels they belong to
    std::vector<std::array<double, 4>> jacobians;
    std::optional<SurfaceNoise::Sampler> noise;
    std::vector<double> noiseValues, noiseBlock;  // of all hits, of a block of samples
    std::optional<eval::FieldSurface::Sampler> field;
    std::vector<Eigen::Vector3d> fieldValues, fieldBlock;
    std::optional<eval::FinerSurface::Sampler> finer;
    std::vector<Eigen::Vector3d> finerPoints, finerBlock;
    std::vector<float> samplePlanes, lineSums;
    TexelBand sampleTexels;

    explicit Worker(BandBaker const& baker)
        : tree(*baker._surface, baker._values),
          sampler(tree, baker._quantity, baker._options.isLeftHanded ? -1.0f : 1.0f),
          raster(*baker._uvSurface, baker._scene.uvs) {
        if (baker._noise) noise.emplace(*baker._noise);
        if (baker._field) field.emplace(*baker._field);
        if (baker._finer) finer.emplace(*baker._finer);
    }
};

namespace {

/// to[places[i]] = from[i], eight at a time where the places lie side by side.
void Scatter(std::span<int const> places, float const* from, float* to) {
    constexpr size_t kGroup = 8;
    size_t i = 0;
    for (; i + kGroup <= places.size(); i += kGroup) {
        int apart = 0;
        for (size_t k = 0; k < kGroup; ++k)
            apart |= places[i + k] - static_cast<int>(k) - places[i];
        if (apart == 0)
            std::memcpy(to + places[i], from + i, sizeof(float) * kGroup);
        else
            for (size_t k = 0; k < kGroup; ++k) to[places[i + k]] = from[i + k];
    }
    for (; i < places.size(); ++i) to[places[i]] = from[i];
}

/// So deep that a refined face is 1 to 2 texels wide, or that there are a million.
int ChooseFieldLevels(Scene const& scene, BakeOptions const& options) {
    double const numFaces = std::max<double>(1.0, scene.cage.GetNumFaces());
    std::set<std::pair<double, double>> tiles;
    for (size_t i = 0; i < scene.uvs.size(); i += 2)
        tiles.emplace(std::floor(scene.uvs[i]), std::floor(scene.uvs[i + 1]));
    double const texels =
        static_cast<double>(options.width) * options.height * static_cast<double>(tiles.size());
    int levels = 0;
    while (levels < 8 && 4.0 * numFaces * std::pow(4.0, levels) < texels &&
           numFaces * std::pow(4.0, levels + 1) < 1e6)
        ++levels;
    return levels;
}

}  // namespace

BandBaker::~BandBaker() = default;

BandBaker::Worker& BandBaker::LocalWorker() {
    auto& worker = _workers.local();
    if (!worker) worker = std::make_unique<Worker>(*this);
    return *worker;
}

BandBaker::BandBaker(Scene const& scene, Far::TopologyRefiner const& refiner, Scene const* other,
                     BakeOptions const& options, std::vector<Map> const& maps)
    : _scene(scene),
      _refiner(refiner),
      _options(options),
      _maps(maps),
      _quantity(FindQuantity(maps)),
      _hasTexels(scene.cage.faceSizes.size()) {
    if (!scene.HasUVs()) {
        throw Error(ErrorCode::BadMesh, fmt::format("{}: the mesh has no texture coordinates; a "
                                                    "bake needs them ('vt' in OBJ, s,t in PLY)",
                                                    scene.path));
    }
    for (Map const& map : maps) {
        _numPlanes += map.GetNumChannels();
        _needsJacobian |= NeedsJacobian(map, options.maps);
    }
    _surface = std::make_unique<eval::LimitSurface>(_refiner);
    _uvSurface = std::make_unique<eval::LimitSurface>(_refiner, 0);
    if (other && (other->cage.faceVertices != scene.cage.faceVertices ||
                  other->cage.faceSizes != scene.cage.faceSizes)) {
        _finer = eval::FinerSurface::Build(*_surface, scene.cage, other->cage, other->positions);
        if (!_finer) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: its faces differ from those of '{}'; --against needs the "
                                    "same faces and vertices in the same "
                                    "order, or these refined by the same --scheme ({})",
                                    other->path, scene.path, GetName(scene.cage.scheme)));
        }
    }

    _isBaked.assign(scene.cage.faceSizes.size(), 1);
    if (!options.groups.empty()) _isBaked = SelectGroups(scene, options.groups);
    for (Index face = 0; face < GetNumFaces(); ++face) {
        if (!_surface->HasLimit(face)) _isBaked[face] = 0;
    }

    // The tree's channels: positions, then primvars, then bands, then the other mesh's positions.
    _values.push_back({scene.positions, 3});
    for (Primvar const& primvar : scene.primvars) {
        _primvarValues.insert(_primvarValues.end(), primvar.values.begin(), primvar.values.end());
    }
    size_t first = 0;
    for (Primvar const& primvar : scene.primvars) {
        _values.push_back(
            {std::span(_primvarValues).subspan(first, primvar.values.size()), primvar.numChannels});
        first += primvar.values.size();
    }

    auto const has = [&](MapKind kind) {
        return std::any_of(maps.begin(), maps.end(),
                           [&](Map const& map) { return map.kind == kind; });
    };
    if (has(MapKind::Bands)) {
        int const numBands = options.maps.numBands;
        auto const bands = SplitIntoBands(scene, eval::LimitOperator::Build(refiner), numBands);
        for (size_t vertex = 0; vertex < scene.positions.size(); vertex += 3) {
            for (int band = 1; band <= numBands; ++band) {  // all but the base
                for (size_t c = 0; c < 3; ++c) _frequencyBands.push_back(bands[band][vertex + c]);
            }
        }
        _values.push_back({_frequencyBands, GetNumBandChannels(options.maps)});
    }
    if (other && !_finer) _values.push_back({other->positions, 3});
    if (has(MapKind::Noise)) _noise = std::make_unique<SurfaceNoise>(scene, options.noise);
    if (has(MapKind::Field)) {
        _field = std::make_unique<eval::FieldSurface>(scene.cage, scene.positions, options.field,
                                                      ChooseFieldLevels(scene, options));
    }

    _bounds.resize(_isBaked.size());
    tbb::parallel_for(tbb::blocked_range<Index>(0, GetNumFaces(), 512), [&](auto const& range) {
        CheckInterrupted();
        UVRaster& raster = LocalWorker().raster;
        for (Index face = range.begin(); face != range.end(); ++face) {
            if (_isBaked[face]) _bounds[face] = raster.GetBounds(face);
        }
    });
    if (has(MapKind::Stretch)) _meanArea = FindMeanArea();
}

/// Surface area over texture area of all that is baked.
double BandBaker::FindMeanArea() {
    struct Areas {
        double surface = 0.0, texture = 0.0;
    };
    std::vector<Areas> areas(_isBaked.size());
    tbb::parallel_for(tbb::blocked_range<Index>(0, GetNumFaces(), 64), [&](auto const& range) {
        CheckInterrupted();
        Worker& worker = LocalWorker();
        for (Index face = range.begin(); face != range.end(); ++face) {
            if (!_isBaked[face]) continue;
            worker.tree.Bind(face);
            worker.raster.Bind(face);
            eval::ForEachGaussPoint(
                *_surface, face, [&](eval::FacePlace const& place, double weight) {
                    auto const sample =
                        eval::EvaluateSample(worker.tree, place.domain, place.s, place.t, 1.0);
                    auto const [us, ut, vs, vt] =
                        worker.raster.GetJacobian(place.domain, place.s, place.t);
                    areas[face].surface += weight * sample.tangentS.cross(sample.tangentT).norm();
                    areas[face].texture += weight * std::abs(us * vt - ut * vs);
                });
        }
    });
    Areas total;
    for (Areas const& face : areas) {  // in order: the same sum for any number of threads
        total.surface += face.surface;
        total.texture += face.texture;
    }
    return total.texture > 0.0 && total.surface > 0.0 ? total.surface / total.texture : 1.0;
}

bool BandBaker::LeavesUdimRange(Index face) {
    constexpr double kSlack = 1e-4;
    UVBounds const& b = _bounds[face];
    if (b.minU >= -kSlack && b.maxU <= 10.0 + kSlack && b.minV >= -kSlack) return false;
    // The bounds are loose; look at the surface itself.
    UVRaster& raster = LocalWorker().raster;
    raster.Bind(face);
    constexpr int kSteps = 4;
    for (int domain = 0; domain < _uvSurface->GetNumDomains(face); ++domain) {
        for (int j = 0; j <= kSteps; ++j) {
            for (int i = 0; i <= kSteps - (_uvSurface->IsLoop() ? j : 0); ++i) {
                auto const [u, v] = raster.Evaluate(domain, static_cast<double>(i) / kSteps,
                                                    static_cast<double>(j) / kSteps);
                if (u < -kSlack || u > 10.0 + kSlack || v < -kSlack) return true;
            }
        }
    }
    return false;
}

/// A band of the pool, or a new one; it goes back when the last holder lets go of it.
std::shared_ptr<Band> BandBaker::AcquireBand(int index, TileGrid const& grid) {
    std::unique_ptr<Band> band;
    {
        std::lock_guard const lock(_poolMutex);
        if (!_pool.empty()) {
            band = std::move(_pool.back());
            _pool.pop_back();
        }
    }
    if (!band) band = std::make_unique<Band>();
    band->index = index;
    int const firstRow = index * Band::kRows;
    band->texels.Resize(firstRow, std::min(Band::kRows, grid.height - firstRow), grid.width);
    size_t const numTexels = band->texels.owner.size();
    band->planes.resize(numTexels * _numPlanes);
    band->isCovered.resize(numTexels);
    band->coverage.clear();
    band->low.assign(static_cast<size_t>(_numPlanes), std::numeric_limits<float>::infinity());
    band->high.assign(static_cast<size_t>(_numPlanes), -std::numeric_limits<float>::infinity());
    band->numCovered = 0;
    return {band.release(), [this](Band* done) {
                std::unique_ptr<Band> owned(done);
                std::lock_guard const lock(_poolMutex);
                _pool.push_back(std::move(owned));
            }};
}

std::shared_ptr<Band> BandBaker::MakeBand(int index, TileGrid grid,
                                          std::vector<std::vector<Index>> const& blocks) {
    CheckInterrupted();
    Worker& worker = LocalWorker();
    std::shared_ptr<Band> band = AcquireBand(index, grid);
    auto const finish = [&](int firstColumn, int numColumns) {
        FinishBlock(*band, firstColumn, numColumns);
    };
    if (_options.samplesPerSide == 1) {
        RasterSamples(worker, grid, blocks, band->texels, band->planes.data(),
                      [&](int firstColumn, int numColumns) {
                          for (int row = 0; row < band->texels.numRows; ++row) {
                              size_t const at = static_cast<size_t>(row) * grid.width + firstColumn;
                              for (size_t i = at; i < at + numColumns; ++i)
                                  band->isCovered[i] = band->texels.owner[i] >= 0;
                          }
                          finish(firstColumn, numColumns);
                      });
    } else {
        Supersample(worker, grid, blocks, *band);
        finish(0, grid.width);
    }
    _texelsCovered += band->numCovered;
    return band;
}

/// Counts and ranges of a block whose texels are all known.
void BandBaker::FinishBlock(Band& band, int firstColumn, int numColumns) {
    size_t const count = static_cast<size_t>(numColumns), numTexels = band.GetNumTexels();
    for (int row = 0; row < band.texels.numRows; ++row) {
        size_t const at = static_cast<size_t>(row) * band.texels.width + firstColumn;
        uint8_t const* const covered = &band.isCovered[at];
        size_t numCovered = 0;
        for (size_t i = 0; i < count; ++i) numCovered += covered[i];
        band.numCovered += numCovered;
        if (uint8_t const* const overlap = &band.texels.overlap[at];
            std::memchr(overlap, 1, count)) {
            _overlaps += static_cast<size_t>(std::count(overlap, overlap + count, 1));
        }
        if (uint8_t const* const failed = &band.texels.failed[at]; std::memchr(failed, 1, count)) {
            for (size_t i = 0; i < count; ++i) _newtonFailures += failed[i] && !covered[i];
        }
        for (size_t plane = 0; numCovered > 0 && plane < band.low.size(); ++plane) {
            FindRange(&band.planes[plane * numTexels + at], covered, count, &band.low[plane],
                      &band.high[plane]);
        }
    }
}

/// Texels that no face has been asked about yet: no owner, zeros.
void BandBaker::ClearBlock(TexelBand& texels, float* planes, int firstColumn,
                           int numColumns) const {
    size_t const count = static_cast<size_t>(numColumns), numTexels = texels.owner.size();
    for (int row = 0; row < texels.numRows; ++row) {
        size_t const at = static_cast<size_t>(row) * texels.width + firstColumn;
        std::fill_n(&texels.owner[at], count, -1);
        std::fill_n(&texels.overlap[at], count, uint8_t{0});
        std::fill_n(&texels.failed[at], count, uint8_t{0});
        for (int plane = 0; plane < _numPlanes; ++plane)
            std::fill_n(planes + plane * numTexels + at, count, 0.0f);
    }
}

/// Fills `texels` and `planes` block by block, while the block is in the cache; finish(first
/// column, number of columns) is called after each.
template <class Finish>
void BandBaker::RasterSamples(Worker& worker, TileGrid const& grid,
                              std::vector<std::vector<Index>> const& blocks, TexelBand& texels,
                              float* planes, Finish finish) {
    size_t const planeSize = texels.owner.size();
    size_t untilCheck = 0;
    for (size_t block = 0; block < blocks.size(); ++block) {
        int const firstColumn = static_cast<int>(block) * Band::kBlockColumns;
        int const numColumns = std::min(Band::kBlockColumns, texels.width - firstColumn);
        ClearBlock(texels, planes, firstColumn, numColumns);
        for (Index face : blocks[block]) {
            if (untilCheck-- == 0) {
                CheckInterrupted();
                untilCheck = 256;
            }
            auto const& hits = worker.raster.Rasterise(face, grid, texels, firstColumn, numColumns);
            bool isBound = false;
            for (int domain = 0; domain < _surface->GetNumDomains(face); ++domain) {
                if (hits[domain].texel.empty()) continue;
                if (!isBound) worker.sampler.Bind(face);
                isBound = true;
                EvaluateHits(worker, face, domain, hits[domain], planes, planeSize);
            }
        }
        finish(firstColumn, numColumns);
    }
}

void BandBaker::EvaluateHits(Worker& worker, Index face, int domain, TexelHits const& hits,
                             float* planes, size_t planeSize) {
    _hasTexels[face].store(true, std::memory_order_relaxed);
    if (_noise) {
        worker.noiseValues.resize(hits.s.size());
        worker.noise->Evaluate(face, domain, hits.s, hits.t, worker.noiseValues);
    }
    if (_field) {
        worker.fieldValues.resize(hits.s.size());
        worker.field->Evaluate(face, domain, hits.s, hits.t, worker.fieldValues);
    }
    if (_finer) {
        worker.finerPoints.resize(hits.s.size());
        worker.finer->Evaluate(face, domain, hits.s, hits.t, worker.finerPoints);
    }
    worker.sampler.Evaluate(
        domain, hits.s, hits.t,
        [&](std::span<int const> samples, float const* values, size_t stride) {
            worker.places.resize(samples.size());
            for (size_t i = 0; i < samples.size(); ++i) worker.places[i] = hits.texel[samples[i]];
            worker.jacobians.clear();
            if (_needsJacobian) {
                for (int sample : samples) {
                    worker.jacobians.push_back(
                        worker.raster.GetJacobian(domain, hits.s[sample], hits.t[sample]));
                }
            }
            worker.noiseBlock.clear();
            worker.fieldBlock.clear();
            worker.finerBlock.clear();
            for (int sample : samples) {
                if (_noise) worker.noiseBlock.push_back(worker.noiseValues[sample]);
                if (_field) worker.fieldBlock.push_back(worker.fieldValues[sample]);
                if (_finer) worker.finerBlock.push_back(worker.finerPoints[sample]);
            }
            MapSamples const block{_quantity,
                                   values,
                                   stride,
                                   samples.size(),
                                   worker.jacobians,
                                   _meanArea,
                                   worker.noiseBlock,
                                   _noise ? _noise->GetLow() : 0.0,
                                   _noise ? _noise->GetHigh() : 0.0,
                                   worker.fieldBlock,
                                   worker.finerBlock};
            float* plane = planes;
            for (Map const& map : _maps) {
                size_t const numChannels = static_cast<size_t>(map.GetNumChannels());
                worker.block.resize(numChannels * stride);
                EvaluateMap(map, _options.maps, block, worker.block.data(), stride);
                for (size_t c = 0; c < numChannels; ++c, plane += planeSize) {
                    Scatter(worker.places, &worker.block[c * stride], plane);
                }
            }
        });
}

/// Averages N x N ordered samples per texel over those that are covered.
void BandBaker::Supersample(Worker& worker, TileGrid const& grid,
                            std::vector<std::vector<Index>> const& blocks, Band& band) {
    int const n = _options.samplesPerSide;
    size_t const numTexels = band.GetNumTexels();
    std::vector<int> numHits(numTexels, 0);
    ClearBlock(band.texels, band.planes.data(), 0, grid.width);
    size_t numLines = 0;
    for (Map const& map : _maps) numLines += map.averaging == Averaging::Line;
    worker.lineSums.assign(numLines * 6 * numTexels, 0.0f);
    auto& sample = worker.samplePlanes;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            TileGrid offset = grid;
            offset.offsetX = (i + 0.5) / n;
            offset.offsetY = (j + 0.5) / n;
            worker.sampleTexels.Resize(band.texels.firstRow, band.texels.numRows,
                                       band.texels.width);
            sample.resize(band.planes.size());
            RasterSamples(worker, offset, blocks, worker.sampleTexels, sample.data(),
                          [](int, int) {});
            size_t plane = 0, line = 0;
            for (Map const& map : _maps) {
                size_t const numChannels = static_cast<size_t>(map.GetNumChannels());
                if (map.averaging == Averaging::Line) {
                    float* sum = &worker.lineSums[line++ * 6 * numTexels];
                    for (size_t a = 0; a < 3; ++a) {
                        for (size_t b = a; b < 3; ++b, sum += numTexels) {
                            float const* const da = &sample[(plane + a) * numTexels];
                            float const* const db = &sample[(plane + b) * numTexels];
                            for (size_t k = 0; k < numTexels; ++k) sum[k] += da[k] * db[k];
                        }
                    }
                } else {
                    for (size_t k = plane * numTexels; k < (plane + numChannels) * numTexels; ++k) {
                        band.planes[k] += sample[k];
                    }
                }
                plane += numChannels;
            }
            for (size_t k = 0; k < numTexels; ++k) {
                numHits[k] += worker.sampleTexels.owner[k] >= 0;
                band.texels.overlap[k] |= worker.sampleTexels.overlap[k];
                band.texels.failed[k] |= worker.sampleTexels.failed[k];
            }
        }
    }
    band.coverage.resize(numTexels);
    for (size_t k = 0; k < numTexels; ++k) {
        band.isCovered[k] = numHits[k] > 0;
        band.coverage[k] = static_cast<float>(numHits[k]) / static_cast<float>(n * n);
        if (numHits[k] == 0) continue;
        size_t plane = 0, line = 0;
        for (Map const& map : _maps) {
            size_t const numChannels = static_cast<size_t>(map.GetNumChannels());
            float* const values = &band.planes[plane * numTexels + k];
            if (map.averaging == Averaging::Line) {
                std::array<double, 6> sum;
                for (size_t c = 0; c < 6; ++c)
                    sum[c] = worker.lineSums[(line * 6 + c) * numTexels + k];
                auto const direction = FindMainLine(sum);
                for (size_t c = 0; c < 3; ++c) values[c * numTexels] = direction[c];
                ++line;
            } else {
                float divisor = static_cast<float>(numHits[k]);
                if (map.averaging == Averaging::UnitVector) {
                    float squares = 0.0f;
                    for (size_t c = 0; c < numChannels; ++c)
                        squares += values[c * numTexels] * values[c * numTexels];
                    if (squares > 0.0f) divisor = std::sqrt(squares);
                }
                for (size_t c = 0; c < numChannels; ++c) values[c * numTexels] /= divisor;
            }
            plane += numChannels;
        }
    }
}

std::string BandBaker::NamePlace(eval::SurfaceSampler::Place const& place) const {
    auto const level = _refiner.GetLevel(0);
    auto const vertices = level.GetFaceVertices(place.face);
    int corner;
    if (_surface->GetNumDomains(place.face) > 1) {
        if (place.s + place.t > 1.0)
            return fmt::format("the centre of {}", _scene.NameFace(place.face));
        corner = place.domain;
    } else if (_surface->IsLoop()) {
        corner = place.s > 0.5 ? 1 : place.t > 0.5 ? 2 : 0;
    } else {
        bool const farS = place.s > 0.5, farT = place.t > 0.5;
        corner = farT ? (farS ? 2 : 3) : (farS ? 1 : 0);
    }
    return fmt::format("vertex {}", vertices[corner]);
}

void BandBaker::AddCounts(BakeReport& report, std::vector<std::string>& movedPlaces) const {
    report.texelsCovered = _texelsCovered;
    report.overlaps = _overlaps;
    report.newtonFailures = _newtonFailures;
    std::set<std::string> places;
    for (auto const& worker : _workers) {
        auto const& counts = worker->sampler.GetCounts();
        report.movedSamples += counts.moved;
        report.degenerateSamples += counts.degenerate;
        for (auto const& place : counts.movedPlaces) places.insert(NamePlace(place));
    }
    movedPlaces.assign(places.begin(), places.end());
    for (Index face = 0; face < GetNumFaces(); ++face) {
        if (_isBaked[face] && !_hasTexels[face]) report.facesWithoutTexels.push_back(face);
    }
}

}  // namespace limn::engine
