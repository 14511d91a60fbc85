// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/exr_sink.h"

#include <cstring>
#include <filesystem>

#include <tbb/parallel_for.h>

#include "engine/bake/mip_writer.h"
#include "engine/bake/preview.h"
#include "engine/images/png.h"

namespace limn::engine {

namespace {

/// Where the previews of a file's maps go.
std::vector<std::string> NamePreviews(std::string const& path, FileLayout const& file) {
    std::string const stem = path.ends_with(".exr") ? path.substr(0, path.size() - 4) : path;
    std::vector<std::string> paths;
    for (MapTraits const& map : file.maps) {
        paths.push_back(stem + (file.maps.size() > 1 ? "." + map.name : "") + ".png");
    }
    return paths;
}

bool DoAllExist(std::vector<std::string> const& paths) {
    return std::all_of(paths.begin(), paths.end(),
                       [](std::string const& path) { return std::filesystem::exists(path); });
}

ExrSpec MakeSpec(BakeOptions const& options, FileLayout const& file, Attributes const& attributes) {
    ExrSpec spec;
    spec.width = options.width;
    spec.height = options.height;
    spec.isHalf = options.isHalf;
    spec.hasMips = options.hasMips;
    spec.compression = options.compression;
    spec.channels = file.channelNames;
    spec.attributes = attributes;
    return spec;
}

/// Compressed tiles of a strip.
struct PackedTiles : PackedRows {
    std::vector<ExrTile> tiles;
};

class ExrSink : public TexelSink {
public:
    ExrSink(std::string const& path, FileLayout const& file, BakeOptions const& options,
            ExrSpec const& spec)
        : _options(options), _numPlanes(file.numPlanes), _writer(path, spec) {
        if (options.hasMips) {
            _mips = std::make_unique<MipWriter>(_writer, spec, file.groups, file.numPlanes,
                                                options.hasCoverage);
        }
        if (!options.hasPreview) return;
        _previewPaths = NamePreviews(path, file);
        float const zero = options.encoding ? static_cast<float>(options.encoding->offset) : 0.0f;
        int firstChannel = 0;
        for (MapTraits const& map : file.maps) {
            _previews.emplace_back(map.range, map.GetNumChannels(), firstChannel, spec.width,
                                   spec.height, zero);
            firstChannel += map.GetNumChannels();
        }
    }

    bool WantsCoverage() const override {
        return _options.hasCoverage || _mips || !_previews.empty();
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
        if (!_mips && _previews.empty()) return;
        std::vector<TexelRowView> views;
        for (int row = 0; row < strip.numRows; ++row) {
            size_t const texel = strip.GetTexel(row);
            views.push_back({strip.GetRow(0, row), strip.planeSize, strip.coverage + texel,
                             strip.isFilled + texel});
        }
        if (_mips) _mips->Add(views);
        for (PreviewBuilder& preview : _previews) {
            for (int row = 0; row < strip.numRows; ++row) {
                preview.Add(strip.firstRow + row, views[row]);
            }
        }
    }

    size_t Commit(BakeOutput& output) override {
        _writer.Commit();
        for (size_t map = 0; map < _previews.size(); ++map) {
            WritePng(_previewPaths[map], _previews[map].Draw());
        }
        if (_options.wantsChecksums) output.sha256 = Sha256OfFile(output.path);
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

    BakeOptions const& _options;
    int _numPlanes;
    ExrWriter _writer;
    std::unique_ptr<MipWriter> _mips;
    std::vector<PreviewBuilder> _previews;
    std::vector<std::string> _previewPaths;
    size_t _numClamped = 0;
};

}  // namespace

std::unique_ptr<TexelSink> ExrDestination::Open(FileLayout const& file, BakeOutput& output) {
    output.path = ExpandPattern(_options.pattern, output.map, _model.GetName(), output.tile);
    Attributes const attributes = MakeAttributes(_options, file, _model);
    bool const hasPreviews = !_options.hasPreview || DoAllExist(NamePreviews(output.path, file));
    output.wasSkipped =
        _options.skipsExisting && IsUpToDate(output.path, attributes) && hasPreviews;
    if (output.wasSkipped) {
        if (_options.wantsChecksums) output.sha256 = Sha256OfFile(output.path);
        return nullptr;
    }
    return std::make_unique<ExrSink>(output.path, file, _options,
                                     MakeSpec(_options, file, attributes));
}

}  // namespace limn::engine
