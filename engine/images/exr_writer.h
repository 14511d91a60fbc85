// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "engine/images/exr_seal.h"
#include "engine/io/atomic_file.h"

namespace limn::engine {

enum class ExrCompression { None, Rle, Zips, Zip, Piz, Dwaa };

struct ExrSpec {
    int width = 0, height = 0;
    bool hasMips = false;
    ExrCompression compression = ExrCompression::Zip;
    std::vector<std::string> channels;  ///< in the order of the planes given to Pack
    std::vector<char> isHalf;           ///< per channel: 16 bits, not 32; empty for none
    std::vector<std::pair<std::string, std::string>> attributes;

    static constexpr int kTileSize = 64;

    bool IsHalf(size_t channel) const { return !isHalf.empty() && isHalf[channel]; }
    size_t GetWordsPerTexel() const;  ///< of 16 bits, all channels

    int GetNumLevels() const;  ///< 1 without mips; ROUND_DOWN otherwise
    int GetLevelWidth(int level) const;
    int GetLevelHeight(int level) const;
    int GetNumColumns(int level) const;  ///< of tiles
    int GetNumRows(int level) const;
};

/// The bytes of one finished tile.
struct ExrTile {
    int level = 0, x = 0, y = 0;  ///< in tiles
    std::vector<uint8_t> bytes;
    size_t numClamped = 0;  ///< finite values beyond the range of half
};

/// A tiled EXR file that appears complete or not at all. Tiles are compressed wherever they were
/// made (Pack, any thread) and written one after the other (Write, one thread at a time), in the
/// order of the calls, which the file keeps (RANDOM_Y). A finished file is sealed (exr_seal.h).
///
/// ZIP, ZIPS and uncompressed tiles are finished here and handed to OpenEXR Core as chunks; the
/// other kinds go through OpenEXR's own compressors when they are written.
class ExrWriter {
public:
    /// \throws Error  Io.  BadOption: the path leads to what cannot seek, /dev/null aside; an image
    ///                without texels; kinds of other channels than there are
    ExrWriter(std::string const& path, ExrSpec const& spec);
    ~ExrWriter();

    /// Makes a tile of `width` x `height` texels (a full tile, or what the level's edge leaves).
    ///
    /// \param planes  one per channel of the spec, the tile's first texel; rows `stride` floats
    ///                apart
    /// \throws Error  BadOption: a tile that there is not
    ExrTile Pack(int level, int x, int y, float const* const* planes, size_t stride) const;

    /// A tile of zeros; those of one size are compressed once. As Pack
    ExrTile PackEmpty(int level, int x, int y) const;

    /// \throws Error  Io: a full disk, ...
    void Write(ExrTile const& tile);

    /// Writes the file's index and seals it. Called once, as the last, with all tiles there.
    ///
    /// \param check  called now and then; what it throws ends the work
    /// \return       the complete file, to be committed by the caller
    /// \throws Error  Io.  BadOption: tiles are missing
    std::unique_ptr<AtomicFile> Seal(ValueRange const& range,
                                     std::function<void()> const& check = {});

private:
    struct Backend;
    struct CoreBackend;
    struct LibraryBackend;

    /// Of a tile, in texels.
    struct Size {
        int width = 0, height = 0;
    };
    Size FindTileSize(int level, int x, int y) const;

    std::string _path;
    ExrSpec _spec;
    size_t _numTilesToCome = 0;
    std::vector<int> _sortedChannels;  // EXR keeps channels sorted by name
    std::unique_ptr<AtomicFile> _file;
    std::unique_ptr<Backend> _backend;
    mutable std::mutex _emptyMutex;
    mutable std::map<std::pair<int, int>, std::vector<uint8_t>> _emptyTiles;  // by size
};

/// Refuses a path that leads to what cannot seek, such as a pipe; the null device need not.
///
/// \return        the path
/// \throws Error  BadOption
std::string RequireSeeking(std::string path);

/// String attributes of an EXR file's header whose names start with `prefix`.
///
/// \return empty if the file does not exist or is no EXR file
std::vector<std::pair<std::string, std::string>> ReadExrAttributes(std::string const& path,
                                                                   std::string const& prefix);

}  // namespace limn::engine
