// SPDX-License-Identifier: Apache-2.0
//
// Compressing baked half tiles as limn does, against zlib at the level at which OpenEXR calls it,
// and against libdeflate at the level at which limn calls it for floats: time and size, per map.

#include <Imath/half.h>
#include <libdeflate.h>
#include <zlib.h>

#include "engine/bake/bake.h"
#include "engine/images/deflate/tile_deflate.h"
#include "engine/images/exr_writer.h"
#include "engine/images/pixel_kernel.h"
#include "engine/io/mesh_reader.h"
#include "eval/kernels/dispatch.h"
#include "harness.h"
#include "support/inflate.h"
#include "support/meshes.h"

namespace limn::bench {
namespace {

constexpr int kSize = 4096, kTile = engine::ExrSpec::kTileSize;
constexpr int kEvery = 4;  // of a map's tiles one in so many

/// Tiles in the form in which EXR's ZIP compresses them.
struct Tiles {
    std::string map;
    size_t numChannels = 0, numTexels = 0;
    std::vector<std::vector<uint8_t>> tiles;
};

/// Bytes of the tile whose first texel this is; nothing if all are zero, as such tiles are
/// compressed once.
std::vector<uint8_t> MakeTile(engine::BakedImage const& image, int firstRow, int firstColumn) {
    std::vector<uint16_t> words;
    for (int row = firstRow; row < firstRow + kTile; ++row) {
        for (size_t c = 0; c < image.channels.size(); ++c) {
            for (int column = firstColumn; column < firstColumn + kTile; ++column) {
                float const value = image.GetTexel(row, column)[c];
                words.push_back(Imath::half(std::clamp(value, -65504.0f, 65504.0f)).bits());
            }
        }
    }
    if (std::all_of(words.begin(), words.end(), [](uint16_t word) { return word == 0; })) return {};
    std::vector<uint8_t> scratch(2 * words.size()), bytes(2 * words.size());
    eval::GetKernel<engine::PixelKernel>().splitAndPredict(words.data(), words.size(),
                                                           scratch.data(), bytes.data());
    return bytes;
}

Tiles BakeTiles(engine::Model const& model, std::string const& map) {
    engine::BakeOptions options;
    options.maps = {map};
    options.width = options.height = kSize;
    options.tiles = {1001};
    engine::Job job;
    engine::BakedImage const image = engine::BakeToMemory(model, options, job).images.at(0);
    Tiles tiles{map, image.channels.size()};
    constexpr int kPerRow = kSize / kTile;
    for (int i = 0; i < kPerRow * kPerRow; ++i) {
        if ((i + i / kPerRow) % kEvery != 0) continue;
        std::vector<uint8_t> tile = MakeTile(image, i / kPerRow * kTile, i % kPerRow * kTile);
        if (tile.empty()) continue;
        tiles.tiles.push_back(std::move(tile));
        tiles.numTexels += size_t{kTile} * kTile;
    }
    return tiles;
}

/// One way to compress a tile. Returns the size of what is in `to`.
using Compress = std::function<size_t(std::vector<uint8_t> const& tile, std::span<uint8_t> to)>;

Compress MakeOwn(size_t numChannels) {
    auto const deflate = std::make_shared<engine::TileDeflate>();
    return [=](std::vector<uint8_t> const& tile, std::span<uint8_t> to) {
        std::copy(tile.begin(), tile.end(),
                  deflate->Prepare(tile.size(), kTile * numChannels).begin());
        return deflate->Compress(to);
    };
}

Compress MakeLibdeflate(int level) {
    std::shared_ptr<libdeflate_compressor> const compressor(libdeflate_alloc_compressor(level),
                                                            libdeflate_free_compressor);
    return [=](std::vector<uint8_t> const& tile, std::span<uint8_t> to) {
        return libdeflate_zlib_compress(compressor.get(), tile.data(), tile.size(), to.data(),
                                        to.size());
    };
}

/// As OpenEXR 3.1 does, with all that zlib allocates made anew for each tile.
size_t CompressByZlib(std::vector<uint8_t> const& tile, std::span<uint8_t> to) {
    uLongf size = to.size();
    Check(compress2(to.data(), &size, tile.data(), tile.size(), 4) == Z_OK, "zlib failed");
    return size;
}

/// Compresses all tiles, has zlib and libdeflate read them back, and returns their size.
size_t CheckTiles(Tiles const& tiles, Compress const& compress) {
    size_t total = 0;
    std::vector<uint8_t> to(2 * tiles.tiles[0].size());
    for (auto const& tile : tiles.tiles) {
        size_t const size = compress(tile, to);
        std::span<uint8_t const> const stream = std::span(to).first(size);
        Check(test::InflateByZlib(stream, tile.size()) == tile, "zlib reads other bytes");
        Check(test::InflateByLibdeflate(stream, tile.size()) == tile,
              "libdeflate reads other bytes");
        total += size;
    }
    return total;
}

void MeasureMap(Tiles const& tiles, int numRounds) {
    fmt::print("\n{}, {} channels, {} tiles\n", tiles.map, tiles.numChannels, tiles.tiles.size());
    struct Way {
        char const* name;
        Compress compress;
        size_t size = 0, number = 0;
    };
    std::array<Way, 3> ways{{{"limn", MakeOwn(tiles.numChannels)},
                             {"zlib, level 4", CompressByZlib},
                             {"libdeflate, level 2", MakeLibdeflate(2)}}};
    Rounds rounds(numRounds);
    std::vector<uint8_t> to(2 * tiles.tiles[0].size());
    for (Way& way : ways) {
        way.size = CheckTiles(tiles, way.compress);
        auto const run = [&] {
            for (auto const& tile : tiles.tiles) way.compress(tile, to);
        };
        way.number = rounds.Add(way.name, run, static_cast<double>(tiles.numTexels));
    }
    rounds.Run("texels");
    auto const& [own, zlib, libdeflate] = ways;
    rounds.Compare("against zlib", own.number, zlib.number, 3.5);
    rounds.Compare("against libdeflate", own.number, libdeflate.number);
    auto const getRatio = [&](Way const& way) {
        return static_cast<double>(way.size) / static_cast<double>(zlib.size);
    };
    fmt::print("  => size against zlib's {:.3f}, target at most 1.05: {} (libdeflate's {:.3f})\n",
               getRatio(own), getRatio(own) <= 1.05 ? "reached" : "MISSED", getRatio(libdeflate));
}

}  // namespace
}  // namespace limn::bench

/// bench_deflate [--rounds N]
// NOLINTNEXTLINE(bugprone-exception-escape): what is thrown ends a bench, as it should
int main(int argc, char** argv) {
    using namespace limn;
    int const numRounds = bench::GetNumRounds(argc, argv);
    for (std::string const name : {"control/chess_rook.obj", "control/ict_head_skin.obj"}) {
        if (!test::HasAsset(name)) {
            fmt::print("skipped: there is no {}\n", test::AssetPath(name));
            continue;
        }
        auto const model = engine::Model::Build(engine::ReadMesh(test::AssetPath(name)));
        for (char const* map : {"normal", "position", "principal-direction", "curvature", "mean"}) {
            fmt::print("\n{}", name);
            bench::MeasureMap(bench::BakeTiles(model, map), numRounds);
        }
    }
    return 0;
}
