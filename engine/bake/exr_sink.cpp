// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/exr_sink.h"

#include <cstring>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "engine/bake/mip_writer.h"
#include "engine/bake/output_names.h"
#include "engine/bake/preview_files.h"
#include "engine/io/file.h"

namespace limn::engine {

namespace {

ExrSpec MakeSpec(BakeOptions const& options, FileLayout const& file, Attributes const& attributes) {
    ExrSpec spec;
    spec.width = options.width;
    spec.height = options.height;
    spec.hasMips = options.hasMips;
    spec.compression = options.compression;
    spec.channels = file.channelNames;
    spec.isHalf = file.FindHalfChannels(options);
    spec.attributes = attributes;
    return spec;
}

/// \param path  where the output is for the time being
void AddChecksum(BakeOutput& output, std::string const& path, BakeOptions const& options,
                 std::function<void()> const& check) {
    if (options.wantsChecksums && FindOutputKind(path) == OutputKind::File)
        output.sha256 = Sha256OfFile(path, check);
}

/// Compressed tiles of a strip.
struct PackedTiles : PackedRows {
    std::vector<ExrTile> tiles;
};

class ExrSink : public TexelSink {
public:
    ExrSink(Model const& model, std::string const& path, FileLayout const& file,
            BakeOptions const& options, ExrSpec const& spec, PreviewFiles previews, Job const& job)
        : _model(model),
          _options(options),
          _job(job),
          _numPlanes(file.numPlanes),
          _writer(path, spec),
          _previews(std::move(previews)) {
        if (options.hasMips) {
            _mips = std::make_unique<MipWriter>(_writer, spec, file.groups, file.numPlanes,
                                                options.hasCoverage);
        }
    }

    bool WantsCoverage() const override {
        return _options.hasCoverage || _mips || _previews.IsAnyWanted();
    }

    std::unique_ptr<PackedRows> Pack(StripView const& strip) override {
        auto packed = std::make_unique<PackedTiles>();
        int const numTiles = (strip.width + kTile - 1) / kTile;
        packed->tiles.resize(static_cast<size_t>(numTiles));
        tbb::parallel_for(0, numTiles,
                          [&](int tile) { packed->tiles[tile] = PackTile(strip, tile); });
        return packed;
    }

    void Write(StripView const& strip, PackedRows& rows) override {
        for (ExrTile const& tile : static_cast<PackedTiles&>(rows).tiles) {
            _numClamped += tile.numClamped;
            _writer.Write(tile);
        }
        if (!_mips && !_previews.IsAnyWanted()) return;
        std::vector<TexelRowView> views;
        for (int row = 0; row < strip.numRows; ++row) {
            size_t const texel = strip.GetTexel(row);
            views.push_back({strip.GetRow(0, row), strip.planeSize, strip.coverage + texel,
                             strip.isFilled + texel});
        }
        if (_mips) _mips->Add(views);
        _previews.Add(strip.firstRow, views);
    }

    size_t Commit(BakeOutput& output) override {
        auto const check = [this] { _job.CheckStopped(); };
        auto exr = _writer.Seal({output.min, output.max}, check);
        AddChecksum(output, exr->GetPathToWrite(), _options, check);
        auto files = _previews.Write(exr->GetPathToWrite(),
                                     fmt::format("{} {}", DescribeMesh(), output.tile), _job);
        files.push_back(std::move(exr));
        _previews.RemoveStale(_model);
        CommitTogether(files);
        return _numClamped + (_mips ? _mips->GetNumClamped() : 0);
    }

private:
    static constexpr int kTile = ExrSpec::kTileSize;

    static bool IsEmpty(StripView const& strip, int firstColumn) {
        size_t const count = static_cast<size_t>(std::min(kTile, strip.width - firstColumn));
        for (int row = 0; row < strip.numRows; ++row) {
            uint8_t const* const at = strip.isFilled + strip.GetTexel(row) + firstColumn;
            if (std::memchr(at, 1, count)) return false;
        }
        return true;
    }

    ExrTile PackTile(StripView const& strip, int tile) const {
        if (IsEmpty(strip, tile * kTile)) return _writer.PackEmpty(0, tile, strip.index);
        std::vector<float const*> channels;
        for (int c = 0; c < _numPlanes; ++c) channels.push_back(strip.GetRow(c, 0) + tile * kTile);
        if (_options.hasCoverage) channels.push_back(strip.coverage + tile * kTile);
        return _writer.Pack(0, tile, strip.index, channels.data(),
                            static_cast<size_t>(strip.width));
    }

    std::string DescribeMesh() const {
        return _options.group.empty() ? _model.GetName()
                                      : fmt::format("{} {}", _model.GetName(), _options.group);
    }

    Model const& _model;
    BakeOptions const& _options;
    Job const& _job;
    int _numPlanes;
    ExrWriter _writer;
    std::unique_ptr<MipWriter> _mips;
    PreviewFiles _previews;
    size_t _numClamped = 0;
};

}  // namespace

std::string ExrDestination::NameFile(std::string const& map, int tile) const {
    return ExpandPattern(
        _options.pattern,
        {.map = map, .mesh = _model.GetName(), .group = _options.group, .tile = tile});
}

void ExrDestination::CheckPlace(FileLayout const& file, int tile) const {
    RequireSeeking(NameFile(file.mapName, tile));
}

std::unique_ptr<TexelSink> ExrDestination::Open(FileLayout const& file, BakeOutput& output) {
    output.path = NameFile(output.map, output.tile);
    Attributes const attributes = MakeAttributes(_options, file, _model, output.tile);
    PreviewFiles previews(output.path, file, _options, attributes);
    output.previews = previews.GetNames();
    if (_options.skipsExisting && previews.AreUpToDate() && IsThere(output, attributes))
        return nullptr;
    return std::make_unique<ExrSink>(_model, output.path, file, _options,
                                     MakeSpec(_options, file, attributes), std::move(previews),
                                     _job);
}

/// Fills in what the report says of an output that is skipped.
bool ExrDestination::IsThere(BakeOutput& output, Attributes const& attributes) const {
    auto const check = [this] { _job.CheckStopped(); };
    auto const range = FindUpToDate(output.path, attributes, check);
    if (!range) return false;
    output.wasSkipped = true;
    output.min = range->min;
    output.max = range->max;
    AddChecksum(output, output.path, _options, check);
    return true;
}

}  // namespace limn::engine
