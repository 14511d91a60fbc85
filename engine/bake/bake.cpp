// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/bake.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "engine/bake/layout.h"
#include "engine/bake/preview.h"
#include "engine/bake/strip_baker.h"
#include "engine/bake/strip_packer.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

std::string NameSome(std::vector<Index> const& faces, Scene const& scene) {
    std::string text;
    for (size_t i = 0; i < std::min<size_t>(3, faces.size()); ++i)
        text += (i ? ", " : "") + scene.NameFace(faces[i]);
    if (faces.size() > 3) text += fmt::format(" and {} more", faces.size() - 3);
    return text;
}

/// The tiles that the bounds of some baked face meet. Bounds are generous: a tile may turn out
/// empty.
std::vector<int> FindTiles(BandBaker& baker, Scene const& scene, BakeOptions const& options,
                           Job& job) {
    std::set<int> tiles;
    std::vector<Index> outOfRange, elsewhere;
    for (Index face = 0; face < baker.GetNumFaces(); ++face) {
        if (!baker.IsBaked(face)) continue;
        UVBounds const& b = baker.GetBounds(face);
        if (baker.LeavesUdimRange(face)) outOfRange.push_back(face);
        if (b.minU > 0.9999f || b.minV > 0.9999f) elsewhere.push_back(face);
        auto const low = [](float x, float most) {
            return static_cast<int>(std::floor(std::clamp(x, 0.0f, most)));
        };
        for (int v = low(b.minV, 899.0f); v <= low(b.maxV, 899.0f); ++v) {
            for (int u = low(b.minU, 9.0f); u <= low(b.maxU, 9.0f); ++u)
                tiles.insert(1001 + u + 10 * v);
        }
    }
    if (!outOfRange.empty()) {
        job.Warn(
            fmt::format("{}: the texture coordinates of {} leave the UDIM range (u 0 to 10, v from "
                        "0); what lies "
                        "outside is not baked",
                        scene.path, NameSome(outOfRange, scene)));
    }
    if (!HasUdimToken(options.pattern)) {
        tiles = {1001};
        if (!elsewhere.empty()) {
            job.Warn(
                fmt::format("{}: {} lie in other tiles than 1001; put <UDIM> into the output's "
                            "name to bake them",
                            scene.path, NameSome(elsewhere, scene)));
        }
    }
    std::vector<int> wanted;
    for (int tile : tiles) {
        bool const isWanted =
            options.tiles.empty() ||
            std::find(options.tiles.begin(), options.tiles.end(), tile) != options.tiles.end();
        if (isWanted) wanted.push_back(tile);
    }
    return wanted;
}

/// Assembles rows of mip levels into tiles and writes them.
class MipWriter {
public:
    MipWriter(ExrWriter& writer, ExrSpec const& spec, FileLayout const& file, bool hasCoverage)
        : _writer(writer),
          _spec(spec),
          _hasCoverage(hasCoverage),
          _numPlanes(file.numPlanes),
          _buffers(static_cast<size_t>(spec.GetNumLevels())),
          _chain(spec.width, spec.height, spec.GetNumLevels(), file.numPlanes, file.groups,
                 [this](int level, int row, TexelRowView const& texels) {
                     AddRow(level, row, texels);
                 }) {}

    void Add(std::span<TexelRowView const> rows) { _chain.Add(rows); }
    size_t GetNumClamped() const { return _numClamped; }

private:
    void AddRow(int level, int row, TexelRowView const& texels) {
        int const T = ExrSpec::kTileSize, width = _spec.GetLevelWidth(level),
                  height = _spec.GetLevelHeight(level);
        size_t const w = static_cast<size_t>(width), planeSize = w * T;
        auto& buffer = _buffers[level];
        int const numChannels = _numPlanes + (_hasCoverage ? 1 : 0);
        buffer.resize(planeSize * numChannels);
        size_t const at = static_cast<size_t>(row % T) * w;
        for (int c = 0; c < _numPlanes; ++c) {
            std::copy_n(texels.values + c * texels.stride, w, &buffer[c * planeSize + at]);
        }
        if (_hasCoverage) std::copy_n(texels.coverage, w, &buffer[_numPlanes * planeSize + at]);
        if (row % T != T - 1 && row != height - 1) return;
        std::vector<ExrTile> tiles(static_cast<size_t>((width + T - 1) / T));
        tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t tile) {
            std::vector<float const*> channels;
            for (int c = 0; c < numChannels; ++c)
                channels.push_back(&buffer[c * planeSize + tile * T]);
            tiles[tile] = _writer.Pack(level, static_cast<int>(tile), row / T, channels.data(), w);
        });
        for (ExrTile const& tile : tiles) {
            _numClamped += tile.numClamped;
            _writer.Write(tile);
        }
    }

    ExrWriter& _writer;
    ExrSpec _spec;
    bool _hasCoverage;
    int _numPlanes;
    std::vector<std::vector<float>> _buffers;  // per level: [channel][64 rows][width]
    MipChain _chain;
    size_t _numClamped = 0;
};

/// One file of one tile while it is written.
struct OpenFile {
    FileLayout const* layout = nullptr;
    BakeOutput output;
    std::unique_ptr<MipWriter> mips;
    std::vector<PreviewBuilder> previews;
    size_t numClamped = 0;

    OpenFile() {
        output.min = std::numeric_limits<float>::infinity();
        output.max = -output.min;
    }
};

std::string PreviewPath(std::string const& path, FileLayout const& layout, size_t map) {
    std::string stem = path.ends_with(".exr") ? path.substr(0, path.size() - 4) : path;
    if (layout.maps.size() > 1) stem += "." + layout.maps[map].name;
    return stem + ".png";
}

class TileJob {
public:
    TileJob(int tile, BandBaker& baker, std::vector<FileLayout> const& layouts, Scene const& scene,
            Scene const* other, BakeOptions const& options, Job& job)
        : _tile(tile),
          _baker(baker),
          _layouts(layouts),
          _options(options),
          _job(job),
          _files(layouts.size()),
          _writers(layouts.size()) {
        for (size_t f = 0; f < layouts.size(); ++f) {
            _files[f].layout = &layouts[f];
            BakeOutput& output = _files[f].output;
            output.path = ExpandPattern(options.pattern, layouts[f].mapName, scene.name, tile);
            output.map = layouts[f].mapName;
            output.maps = layouts[f].maps;
            output.tile = tile;
            output.width = options.width;
            output.height = options.height;
            auto const attributes = MakeAttributes(options, layouts[f], scene, other);
            output.wasSkipped =
                options.skipExisting && IsUpToDate(output.path, attributes) && HasPreviews(f);
            if (!output.wasSkipped) Open(f, attributes);
        }
    }

    bool HasWork() const {
        return std::any_of(_writers.begin(), _writers.end(),
                           [](auto const& writer) { return writer != nullptr; });
    }

    void Run();
    /// Completes the files; none if no texel of the tile is covered.
    void Finish(BakeReport& report);

private:
    bool HasPreviews(size_t f) const {
        for (size_t map = 0; _options.hasPreview && map < _layouts[f].maps.size(); ++map) {
            if (!std::filesystem::exists(PreviewPath(_files[f].output.path, _layouts[f], map)))
                return false;
        }
        return true;
    }

    void Open(size_t f, std::vector<std::pair<std::string, std::string>> const& attributes) {
        ExrSpec spec;
        spec.width = _options.width;
        spec.height = _options.height;
        spec.isHalf = _options.isHalf;
        spec.hasMips = _options.hasMips;
        spec.compression = _options.compression;
        spec.channels = _layouts[f].channelNames;
        spec.attributes = attributes;
        OpenFile& file = _files[f];
        _writers[f] = std::make_unique<ExrWriter>(file.output.path, spec);
        if (_options.hasMips) {
            file.mips =
                std::make_unique<MipWriter>(*_writers[f], spec, _layouts[f], _options.hasCoverage);
        }
        if (!_options.hasPreview) return;
        for (size_t m = 0; m < _layouts[f].maps.size(); ++m) {
            file.previews.emplace_back(_layouts[f].maps[m], _layouts[f].groups[m].first, spec.width,
                                       spec.height);
        }
    }

    using Blocks = std::vector<std::vector<Index>>;  // faces per Band::kBlockColumns columns
    std::vector<Blocks> BinFaces(TileGrid const& grid) const;
    void Write(PackedBand const& band);

    int _tile;
    BandBaker& _baker;
    std::vector<FileLayout> const& _layouts;
    BakeOptions const& _options;
    Job& _job;
    std::vector<OpenFile> _files;
    std::vector<std::unique_ptr<ExrWriter>> _writers;
    bool _isAnyCovered = false;
};

/// Per band and block of columns, the faces whose bounds reach a sample of it, in ascending order.
std::vector<TileJob::Blocks> TileJob::BinFaces(TileGrid const& grid) const {
    int const numBands = (grid.height + Band::kRows - 1) / Band::kRows;
    int const numBlocks = (grid.width + Band::kBlockColumns - 1) / Band::kBlockColumns;
    std::vector<Blocks> bins(static_cast<size_t>(numBands), Blocks(static_cast<size_t>(numBlocks)));
    for (Index face = 0; face < _baker.GetNumFaces(); ++face) {
        if (!_baker.IsBaked(face)) continue;
        UVBounds const& b = _baker.GetBounds(face);
        // Samples lie up to half a texel beside a texel's centre, and a face covers 1e-4 beyond it.
        double const slack = 1.0;
        double const left = grid.ToX(b.minU) - slack, right = grid.ToX(b.maxU) + slack;
        double const top = grid.ToY(b.maxV) - slack, bottom = grid.ToY(b.minV) + slack;
        if (!(right >= 0.0 && left <= grid.width - 1.0 && bottom >= 0.0 &&
              top <= grid.height - 1.0))
            continue;
        int const firstBlock = static_cast<int>(std::max(left, 0.0)) / Band::kBlockColumns;
        int const lastBlock =
            static_cast<int>(std::min(right, grid.width - 1.0)) / Band::kBlockColumns;
        int const firstBand = static_cast<int>(std::max(top, 0.0)) / Band::kRows;
        int const lastBand = static_cast<int>(std::min(bottom, grid.height - 1.0)) / Band::kRows;
        for (int band = firstBand; band <= lastBand; ++band) {
            for (int block = firstBlock; block <= lastBlock; ++block)
                bins[band][block].push_back(face);
        }
    }
    return bins;
}

void TileJob::Run() {
    TileGrid grid;
    grid.width = _options.width;
    grid.height = _options.height;
    grid.tileU = (_tile - 1001) % 10;
    grid.tileV = (_tile - 1001) / 10;
    auto const bins = BinFaces(grid);
    int const numBands = static_cast<int>(bins.size());
    int const halo = (_options.padding + Band::kRows - 1) / Band::kRows;
    bool const needsRows = _options.hasMips || _options.hasPreview;

    using Window = std::vector<std::shared_ptr<Band>>;
    struct Work {  // a band with the neighbours its padding reads; `at` is its place among them
        Window window;
        size_t at = 0;
    };
    Window recent;
    int next = 0, nextOut = 0;
    // The last filter keeps what it catches until the pipeline has run dry: TBB drops, and never
    // frees, the bands that wait before a serial filter when a filter throws.
    std::exception_ptr failure;
    std::atomic<bool> hasFailed{false};
    size_t const numTokens = static_cast<size_t>(tbb::this_task_arena::max_concurrency()) + 2;
    // Input runs `halo` beyond the last band, so that the last bands, too, come out of the window.
    tbb::parallel_pipeline(
        numTokens,
        tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order,
                                    [&](tbb::flow_control& control) {
                                        if (next == numBands + halo || hasFailed) control.stop();
                                        return next++;
                                    }) &
            tbb::make_filter<int, std::shared_ptr<Band>>(tbb::filter_mode::parallel,
                                                         [&](int band) -> std::shared_ptr<Band> {
                                                             if (band >= numBands) return nullptr;
                                                             return _baker.MakeBand(band, grid,
                                                                                    bins[band]);
                                                         }) &
            tbb::make_filter<std::shared_ptr<Band>, Work>(
                tbb::filter_mode::serial_in_order,
                [&](std::shared_ptr<Band> band) {
                    if (band) recent.push_back(std::move(band));
                    Work work;
                    int const newest = recent.back()->index;
                    bool const isFull = newest == nextOut + halo || newest == numBands - 1;
                    if (!isFull || nextOut >= numBands) return work;
                    while (recent.front()->index < nextOut - halo) recent.erase(recent.begin());
                    work.window = recent;
                    work.at = static_cast<size_t>(nextOut++ - recent.front()->index);
                    return work;
                }) &
            tbb::make_filter<Work, std::shared_ptr<PackedBand>>(
                tbb::filter_mode::parallel,
                [&](Work work) -> std::shared_ptr<PackedBand> {
                    if (work.window.empty()) return nullptr;
                    return std::make_shared<PackedBand>(
                        PackBand(work.window, work.at, _options.padding, _layouts, _writers,
                                 _options.hasCoverage, needsRows));
                }) &
            tbb::make_filter<std::shared_ptr<PackedBand>, void>(
                tbb::filter_mode::serial_in_order, [&](std::shared_ptr<PackedBand> const& band) {
                    if (!band || hasFailed) return;
                    try {
                        CheckInterrupted();
                        Write(*band);
                        _job.Advance();
                    } catch (...) {
                        failure = std::current_exception();
                        hasFailed = true;
                    }
                }));
    if (failure) std::rethrow_exception(failure);
}

void TileJob::Write(PackedBand const& band) {
    for (size_t f = 0; f < _files.size(); ++f) {
        if (!_writers[f]) continue;
        OpenFile& file = _files[f];
        PackedBand::File const& packed = band.files[f];
        for (ExrTile const& tile : packed.tiles) {
            file.numClamped += tile.numClamped;
            _writers[f]->Write(tile);
        }
        if (file.mips) file.mips->Add(packed.rows);
        for (size_t row = 0; row < packed.rows.size(); ++row) {
            for (PreviewBuilder& preview : file.previews)
                preview.Add(band.index * Band::kRows + static_cast<int>(row), packed.rows[row]);
        }
        file.output.min = std::min(file.output.min, packed.min);
        file.output.max = std::max(file.output.max, packed.max);
        _isAnyCovered |= packed.min <= packed.max;
    }
}

void TileJob::Finish(BakeReport& report) {
    for (size_t f = 0; f < _files.size(); ++f) {
        OpenFile& file = _files[f];
        if (_writers[f]) {
            if (!_isAnyCovered) continue;
            _writers[f]->Commit();
            for (size_t map = 0; map < file.previews.size(); ++map) {
                WritePng(PreviewPath(file.output.path, *file.layout, map),
                         file.previews[map].Draw());
            }
            report.clamped += file.numClamped + (file.mips ? file.mips->GetNumClamped() : 0);
        }
        if (_options.wantsChecksums) file.output.sha256 = Sha256OfFile(file.output.path);
        report.outputs.push_back(file.output);
    }
    bool const wasMade = !report.outputs.empty() && report.outputs.back().tile == _tile;
    if (wasMade) report.tiles.push_back(_tile);
}

}  // namespace

BakeReport Bake(Scene const& scene, Far::TopologyRefiner const& refiner, Scene const* other,
                BakeOptions const& options, Job& job) {
    std::vector<Map> const maps = MakeMaps(options.maps, scene);
    std::vector<FileLayout> const layouts = LayOutFiles(maps, options.pattern, options.hasCoverage);
    BandBaker baker(scene, refiner, other, options, maps);
    std::vector<int> const tiles = FindTiles(baker, scene, options, job);

    BakeReport report;
    size_t const numBands = static_cast<size_t>((options.height + Band::kRows - 1) / Band::kRows);
    job.Start(fmt::format("baking {}", scene.name), numBands * tiles.size());
    for (int tile : tiles) {
        TileJob tileJob(tile, baker, layouts, scene, other, options, job);
        if (tileJob.HasWork()) tileJob.Run();
        tileJob.Finish(report);
    }
    job.Finish();

    std::vector<std::string> movedPlaces;
    baker.AddCounts(report, movedPlaces);
    if (report.outputs.empty()) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: no texel is covered in the tiles asked for; see limn info for "
                                "where the texture coordinates lie",
                                scene.path));
    }
    if (!movedPlaces.empty()) {
        movedPlaces.resize(std::min<size_t>(movedPlaces.size(), 8));
        job.Warn(
            fmt::format("{}: {} samples lie within 2^-16 of an extraordinary vertex, where "
                        "curvature is taken at "
                        "that distance: {}",
                        scene.path, report.movedSamples, fmt::join(movedPlaces, ", ")));
    }
    if (report.newtonFailures) {
        job.Warn(
            fmt::format("{}: the texture map could not be inverted at {} texels, which stay empty",
                        scene.path, report.newtonFailures));
    }
    if (report.clamped) {
        job.Warn(
            fmt::format("{}: {} values were beyond the range of half and were clamped; bake "
                        "without --half to keep "
                        "them",
                        scene.path, report.clamped));
    }
    return report;
}

}  // namespace limn::engine
