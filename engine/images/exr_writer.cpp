// SPDX-License-Identifier: Apache-2.0
#include "engine/images/exr_writer.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <new>
#include <numeric>
#include <span>
#include <system_error>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <OpenEXR/openexr.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <libdeflate.h>

#include "engine/images/deflate/tile_deflate.h"
#include "engine/images/pixel_kernel.h"
#include "engine/io/descriptor.h"
#include "engine/io/file.h"
#include "eval/kernels/dispatch.h"
#include "far_ext/error.h"

namespace limn::engine {

size_t ExrSpec::GetWordsPerTexel() const {
    size_t words = 0;
    for (size_t channel = 0; channel < channels.size(); ++channel) words += IsHalf(channel) ? 1 : 2;
    return words;
}

std::string RequireSeeking(std::string path) {
    if (FindOutputKind(path) == OutputKind::Stream) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("'{}' is a pipe or a device, in which an EXR file cannot be "
                                "written: its index needs seeking; name a file, or /dev/null",
                                path));
    }
    return path;
}

int ExrSpec::GetNumLevels() const {
    int levels = 1;
    for (int size = std::max(width, height); hasMips && size > 1; size /= 2) ++levels;
    return levels;
}
int ExrSpec::GetLevelWidth(int level) const {
    return std::max(1, width >> level);
}
int ExrSpec::GetLevelHeight(int level) const {
    return std::max(1, height >> level);
}

int ExrSpec::GetNumColumns(int level) const {
    return (GetLevelWidth(level) - 1) / kTileSize + 1;
}
int ExrSpec::GetNumRows(int level) const {
    return (GetLevelHeight(level) - 1) / kTileSize + 1;
}

struct ExrWriter::Backend {
    virtual ~Backend() = default;
    virtual void Write(ExrTile const& tile) = 0;
    virtual void Finish() = 0;
    virtual bool TakesFinishedChunks() const = 0;
};

namespace {

[[noreturn]] void ThrowWriteError(std::string const& path, std::string const& reason) {
    // The library says what failed; the system's reason, where there is one, says why.
    std::string const why = errno != 0 ? std::strerror(errno) : reason;
    throw Error(ErrorCode::Io, fmt::format("'{}' cannot be written: {}", path, why));
}

exr_compression_t ToCore(ExrCompression compression) {
    switch (compression) {
        case ExrCompression::Zip:
            return EXR_COMPRESSION_ZIP;
        case ExrCompression::Zips:
            return EXR_COMPRESSION_ZIPS;
        default:
            return EXR_COMPRESSION_NONE;
    }
}

Imf::Compression ToLibrary(ExrCompression compression) {
    switch (compression) {
        case ExrCompression::Rle:
            return Imf::RLE_COMPRESSION;
        case ExrCompression::Piz:
            return Imf::PIZ_COMPRESSION;
        default:
            return Imf::DWAA_COMPRESSION;
    }
}

// Level 2 of libdeflate makes files of floats at most 5 % larger than OpenEXR's zlib level 4 in
// half of the time; see bench/README.md.
constexpr int kDeflateLevel = 2;

/// One per thread: compressors and their buffers.
class Scratch {
public:
    Scratch() = default;
    Scratch(Scratch const&) = delete;
    Scratch& operator=(Scratch const&) = delete;
    ~Scratch() { libdeflate_free_compressor(_compressor); }

    std::vector<uint16_t> words;  ///< a tile's pixels

    /// The words as EXR's ZIP has them.
    ///
    /// \return empty if that is not smaller
    std::span<uint8_t const> Zip(size_t wordsPerRow, bool isHalf) {
        size_t const numBytes = 2 * words.size();
        _split.resize(numBytes);
        _zipped.resize(numBytes);
        std::span<uint8_t> const predicted = _tileDeflate.Prepare(numBytes, wordsPerRow);
        eval::GetKernel<PixelKernel>().splitAndPredict(words.data(), words.size(), _split.data(),
                                                       predicted.data());
        size_t const size = isHalf ? _tileDeflate.Compress(_zipped) : Deflate(predicted);
        return std::span(_zipped).first(size);
    }

private:
    size_t Deflate(std::span<uint8_t const> bytes) {
        if (!_compressor) _compressor = libdeflate_alloc_compressor(kDeflateLevel);
        if (!_compressor) throw std::bad_alloc();
        return libdeflate_zlib_compress(_compressor, bytes.data(), bytes.size(), _zipped.data(),
                                        _zipped.size() - 1);
    }

    std::vector<uint8_t> _split, _zipped;
    TileDeflate _tileDeflate;
    libdeflate_compressor* _compressor = nullptr;
};

}  // namespace

/// OpenEXR Core takes finished chunks.
struct ExrWriter::CoreBackend : ExrWriter::Backend {
    exr_context_t context = nullptr;
    int part = 0;
    std::string path;

    CoreBackend(std::string const& shownPath, std::string const& temporary, ExrSpec const& spec,
                std::vector<int> const& sorted)
        : path(shownPath) {
        exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
        initializer.error_handler_fn = [](exr_const_context_t, exr_result_t, char const*) {};
        errno = 0;
        Check(exr_start_write(&context, temporary.c_str(), EXR_WRITE_FILE_DIRECTLY, &initializer));
        Check(exr_add_part(context, "limn", EXR_STORAGE_TILED, &part));
        Check(exr_initialize_required_attr_simple(context, part, spec.width, spec.height,
                                                  ToCore(spec.compression)));
        Check(exr_set_lineorder(context, part, EXR_LINEORDER_RANDOM_Y));
        Check(exr_set_tile_descriptor(context, part, ExrSpec::kTileSize, ExrSpec::kTileSize,
                                      spec.hasMips ? EXR_TILE_MIPMAP_LEVELS : EXR_TILE_ONE_LEVEL,
                                      EXR_TILE_ROUND_DOWN));
        for (int channel : sorted) {
            Check(exr_add_channel(context, part, spec.channels[channel].c_str(),
                                  spec.IsHalf(channel) ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                                  EXR_PERCEPTUALLY_LINEAR, 1, 1));
        }
        for (auto const& [name, value] : spec.attributes) {
            Check(exr_attr_set_string(context, part, name.c_str(), value.c_str()));
        }
        Check(exr_attr_set_string(context, part, kSealAttribute, kBlankSeal.c_str()));
        exr_attr_v2f_t const blank{};
        Check(exr_attr_set_v2f(context, part, kRangeAttribute, &blank));
        Check(exr_write_header(context));
    }
    ~CoreBackend() override {
        if (context) exr_finish(&context);
    }

    void Check(exr_result_t result) const {
        if (result == EXR_ERR_OUT_OF_MEMORY) throw std::bad_alloc();
        if (result != EXR_ERR_SUCCESS) ThrowWriteError(path, exr_get_default_error_message(result));
    }
    void Write(ExrTile const& tile) override {
        errno = 0;
        Check(exr_write_tile_chunk(context, part, tile.x, tile.y, tile.level, tile.level,
                                   tile.bytes.data(), tile.bytes.size()));
    }
    void Finish() override {
        errno = 0;
        Check(exr_finish(&context));
    }
    bool TakesFinishedChunks() const override { return true; }
};

namespace {

/// OpenEXR's own stream notices a full disk only if that happens before its buffer's last flush.
class UnbufferedStream : public Imf::OStream {
public:
    explicit UnbufferedStream(std::string const& path)
        : OStream(path.c_str()), _file(::open(path.c_str(), O_WRONLY | O_CLOEXEC)) {
        Require(_file.IsOpen());
    }

    void write(char const bytes[], int size) override {
        for (ssize_t count = 0; size > 0; bytes += count, size -= static_cast<int>(count)) {
            count = ::pwrite(_file.Get(), bytes, static_cast<size_t>(size), _position);
            if (count < 0 && errno == EINTR) count = 0;
            Require(count >= 0);
            _position += count;
        }
    }
    uint64_t tellp() override { return static_cast<uint64_t>(_position); }
    void seekp(uint64_t position) override { _position = static_cast<off_t>(position); }

    /// The library's destructors swallow what is thrown while they write.
    int GetReason() const { return _reason; }

private:
    void Require(bool isDone) {
        if (isDone) return;
        _reason = errno;
        throw std::system_error(_reason, std::generic_category());
    }

    Descriptor _file;
    off_t _position = 0;
    int _reason = 0;
};

}  // namespace

/// OpenEXR's C++ library compresses PIZ, RLE and DWAA itself.
struct ExrWriter::LibraryBackend : ExrWriter::Backend {
    std::string path;
    UnbufferedStream stream;
    std::unique_ptr<Imf::TiledOutputFile> file;
    ExrSpec spec;
    std::vector<int> sorted;

    LibraryBackend(std::string const& shownPath, std::string const& temporary, ExrSpec const& s,
                   std::vector<int> const& order)
        : path(shownPath), stream(temporary), spec(s), sorted(order) {
        Imf::Header header(spec.width, spec.height);
        header.compression() = ToLibrary(spec.compression);
        header.lineOrder() = Imf::RANDOM_Y;
        header.setTileDescription({ExrSpec::kTileSize, ExrSpec::kTileSize,
                                   spec.hasMips ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL,
                                   Imf::ROUND_DOWN});
        for (size_t channel = 0; channel < spec.channels.size(); ++channel) {
            header.channels().insert(spec.channels[channel],
                                     Imf::Channel(GetType(channel), 1, 1, true));
        }
        for (auto const& [name, value] : spec.attributes) {
            header.insert(name, Imf::StringAttribute(value));
        }
        header.insert(kSealAttribute, Imf::StringAttribute(kBlankSeal));
        header.insert(kRangeAttribute, Imf::V2fAttribute(Imath::V2f(0.0f)));
        Guard([&] { file = std::make_unique<Imf::TiledOutputFile>(stream, header, 0); });
    }

    Imf::PixelType GetType(size_t channel) const {
        return spec.IsHalf(channel) ? Imf::HALF : Imf::FLOAT;
    }

    template <class Action>
    void Guard(Action action) const {
        errno = 0;
        try {
            action();
        } catch (std::bad_alloc const&) {
            throw;
        } catch (std::exception const& error) {
            ThrowWriteError(path, error.what());
        }
    }
    void Write(ExrTile const& tile) override {
        int const T = ExrSpec::kTileSize;
        int const width = std::min(T, spec.GetLevelWidth(tile.level) - tile.x * T);
        size_t const line = 2 * spec.GetWordsPerTexel() * static_cast<size_t>(width);
        char* row = const_cast<char*>(reinterpret_cast<char const*>(tile.bytes.data()));
        Imf::FrameBuffer buffer;
        for (int channel : sorted) {
            size_t const pixel = spec.IsHalf(channel) ? 2 : 4;
            // OpenEXR counts from the level's first texel.
            char* const base = row -
                               static_cast<ptrdiff_t>(tile.x) * T * static_cast<ptrdiff_t>(pixel) -
                               static_cast<ptrdiff_t>(tile.y) * T * static_cast<ptrdiff_t>(line);
            buffer.insert(spec.channels[channel], Imf::Slice(GetType(channel), base, pixel, line));
            row += pixel * static_cast<size_t>(width);
        }
        Guard([&] {
            file->setFrameBuffer(buffer);
            file->writeTile(tile.x, tile.y, tile.level);
        });
    }
    void Finish() override {
        Guard([&] { file.reset(); });
        errno = stream.GetReason();
        if (errno != 0) ThrowIoError(path, "cannot be written");
    }
    bool TakesFinishedChunks() const override { return false; }
};

namespace {

void CheckSpec(std::string const& path, ExrSpec const& spec) {
    if (spec.width < 1 || spec.height < 1) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("'{}': an image of {} x {} texels; at least 1 x 1 is needed", path,
                                spec.width, spec.height));
    }
    if (spec.isHalf.empty() || spec.isHalf.size() == spec.channels.size()) return;
    throw Error(ErrorCode::BadOption,
                fmt::format("'{}': isHalf has {} values; {} are needed, one per channel", path,
                            spec.isHalf.size(), spec.channels.size()));
}

size_t CountTiles(ExrSpec const& spec) {
    size_t count = 0;
    for (int level = 0; level < spec.GetNumLevels(); ++level)
        count += static_cast<size_t>(spec.GetNumColumns(level)) *
                 static_cast<size_t>(spec.GetNumRows(level));
    return count;
}

}  // namespace

ExrWriter::ExrWriter(std::string const& path, ExrSpec const& spec)
    : _path(path), _spec(spec), _sortedChannels(spec.channels.size()) {
    CheckSpec(path, spec);
    _numTilesToCome = CountTiles(spec);
    _file = std::make_unique<AtomicFile>(RequireSeeking(path));
    std::iota(_sortedChannels.begin(), _sortedChannels.end(), 0);
    std::sort(_sortedChannels.begin(), _sortedChannels.end(),
              [&](int a, int b) { return spec.channels[a] < spec.channels[b]; });
    bool const isOwn = spec.compression == ExrCompression::None ||
                       spec.compression == ExrCompression::Zip ||
                       spec.compression == ExrCompression::Zips;
    if (isOwn) {
        _backend =
            std::make_unique<CoreBackend>(path, _file->GetPathToWrite(), spec, _sortedChannels);
    } else {
        _backend =
            std::make_unique<LibraryBackend>(path, _file->GetPathToWrite(), spec, _sortedChannels);
    }
}

ExrWriter::~ExrWriter() = default;

ExrWriter::Size ExrWriter::FindTileSize(int level, int x, int y) const {
    bool const isThere = level >= 0 && level < _spec.GetNumLevels() && x >= 0 && y >= 0 &&
                         x < _spec.GetNumColumns(level) && y < _spec.GetNumRows(level);
    if (!isThere) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("'{}': there is no tile {} {} of level {}; level 0 has {} x {}, "
                                "and levels are 0 to {}",
                                _path, x, y, level, _spec.GetNumColumns(0), _spec.GetNumRows(0),
                                _spec.GetNumLevels() - 1));
    }
    int const T = ExrSpec::kTileSize;
    return {std::min(T, _spec.GetLevelWidth(level) - x * T),
            std::min(T, _spec.GetLevelHeight(level) - y * T)};
}

ExrTile ExrWriter::Pack(int level, int x, int y, float const* const* planes, size_t stride) const {
    auto const [width, height] = FindTileSize(level, x, y);
    size_t const w = static_cast<size_t>(width), h = static_cast<size_t>(height);
    size_t const wordsPerRow = _spec.GetWordsPerTexel() * w;

    thread_local Scratch scratch;
    scratch.words.resize(wordsPerRow * h);
    ExrTile tile{level, x, y, {}, 0};
    // Pixels as EXR has them: row after row, in each the channels one after another.
    uint16_t* to = scratch.words.data();
    PixelKernel const& kernel = eval::GetKernel<PixelKernel>();
    for (int channel : _sortedChannels) {
        if (_spec.IsHalf(channel)) {
            tile.numClamped += kernel.convertToHalf(planes[channel], stride, to, wordsPerRow, w, h);
            to += w;
        } else {
            for (size_t row = 0; row < h; ++row) {
                std::memcpy(to + row * wordsPerRow, planes[channel] + row * stride,
                            sizeof(float) * w);
            }
            to += 2 * w;
        }
    }
    std::span<uint8_t const> bytes;
    if (_spec.compression == ExrCompression::Zip || _spec.compression == ExrCompression::Zips)
        bytes = scratch.Zip(wordsPerRow, _spec.GetWordsPerTexel() == _spec.channels.size());
    // A chunk that does not become smaller is stored as it is, which readers tell by its size.
    if (bytes.empty()) {
        bytes = {reinterpret_cast<uint8_t const*>(scratch.words.data()), 2 * scratch.words.size()};
    }
    tile.bytes.assign(bytes.begin(), bytes.end());
    return tile;
}

ExrTile ExrWriter::PackEmpty(int level, int x, int y) const {
    int const T = ExrSpec::kTileSize;
    auto const [width, height] = FindTileSize(level, x, y);
    std::lock_guard const lock(_emptyMutex);
    auto& bytes = _emptyTiles[{width, height}];
    if (bytes.empty()) {
        std::vector<float> const zeros(static_cast<size_t>(T * T), 0.0f);
        std::vector<float const*> const planes(_spec.channels.size(), zeros.data());
        bytes = Pack(level, x, y, planes.data(), static_cast<size_t>(T)).bytes;
    }
    return {level, x, y, bytes, 0};
}

void ExrWriter::Write(ExrTile const& tile) {
    _backend->Write(tile);
    --_numTilesToCome;
}

std::unique_ptr<AtomicFile> ExrWriter::Seal(ValueRange const& range,
                                            std::function<void()> const& check) {
    if (_numTilesToCome != 0) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("'{}' lacks {} of its {} tiles; all are written before it is "
                                "sealed",
                                _path, _numTilesToCome, CountTiles(_spec)));
    }
    _backend->Finish();
    if (_file->IsTemporary()) SealExr(_file->GetPathToWrite(), range, check);
    return std::move(_file);
}

std::vector<std::pair<std::string, std::string>> ReadExrAttributes(std::string const& path,
                                                                   std::string const& prefix) {
    std::vector<std::pair<std::string, std::string>> found;
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.error_handler_fn = [](exr_const_context_t, exr_result_t, char const*) {};
    exr_context_t context = nullptr;
    if (exr_start_read(&context, path.c_str(), &initializer) != EXR_ERR_SUCCESS) return found;
    int32_t count = 0;
    exr_get_attribute_count(context, 0, &count);
    for (int32_t i = 0; i < count; ++i) {
        exr_attribute_t const* attribute = nullptr;
        if (exr_get_attribute_by_index(context, 0, EXR_ATTR_LIST_FILE_ORDER, i, &attribute) !=
            EXR_ERR_SUCCESS) {
            continue;
        }
        if (attribute->type == EXR_ATTR_STRING &&
            std::string(attribute->name).starts_with(prefix)) {
            found.emplace_back(attribute->name,
                               std::string(attribute->string->str,
                                           static_cast<size_t>(attribute->string->length)));
        }
    }
    exr_finish(&context);
    return found;
}

}  // namespace limn::engine
