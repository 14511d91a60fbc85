// SPDX-License-Identifier: Apache-2.0
//
// A whole bake from mesh file to tiled EXR (normals, 4096 x 4096, half, ZIP) against what OpenEXR's
// own tiled writer takes for the same finished pixels alone; and with mip levels against OpenEXR's
// writer followed by maketx.

#include <mutex>

#include <tbb/parallel_for.h>

#include "engine/bake/bake.h"
#include "engine/io/mesh_reader.h"
#include "harness.h"
#include "peers/maketx.h"
#include "peers/openexr_tiles.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn::bench {
namespace {

constexpr int kSize = 4096;

void BakeFile(std::string const& mesh, std::string const& output, bool hasMips) {
    auto const model = engine::Model::Build(engine::ReadMesh(mesh));
    engine::BakeOptions options;
    options.pattern = output;
    options.maps = {"normal"};
    options.width = options.height = kSize;
    options.tiles = {1001};
    options.isHalf = true;
    options.hasMips = hasMips;
    engine::Job job;
    engine::Bake(model, options, job);
}

/// limn's writer alone: pixels in memory to a file.
void PackFile(std::array<std::vector<float>, 3> const& planes, std::string const& output) {
    engine::ExrSpec spec;
    spec.width = spec.height = kSize;
    spec.channels.assign(HalfImage::kChannels.begin(), HalfImage::kChannels.end());
    spec.isHalf.assign(spec.channels.size(), 1);
    engine::ExrWriter writer(output, spec);
    std::mutex mutex;
    constexpr int kTile = engine::ExrSpec::kTileSize, kNum = kSize / kTile;
    tbb::parallel_for(0, kNum, [&](int y) {
        for (int x = 0; x < kNum; ++x) {
            size_t const first = (static_cast<size_t>(y) * kSize + x) * kTile;
            float const* const channels[3] = {&planes[0][first], &planes[1][first],
                                              &planes[2][first]};
            engine::ExrTile const tile = writer.Pack(0, x, y, channels, kSize);
            std::lock_guard const lock(mutex);
            writer.Write(tile);
        }
    });
    writer.Seal({})->Commit();
}

/// One mesh with the files made of it.
struct Subject {
    explicit Subject(std::string const& name)
        : mesh(test::AssetPath(name)),
          limn(folder / "limn.exr"),
          packed(folder / "packed.exr"),
          peer(folder / "openexr.exr"),
          limnMips(folder / "limn_mips.exr"),
          peerMips(folder / "maketx.exr") {}

    test::TemporaryFolder folder;
    std::string mesh, limn, packed, peer, limnMips, peerMips;
    HalfImage image;
    std::array<std::vector<float>, 3> planes;
};

double GetSize(std::string const& path) {
    return static_cast<double>(std::filesystem::file_size(path));
}

/// Writes every file once and compares what OpenEXR reads back.
void CheckFiles(Subject& subject, bool hasMaketx) {
    BakeFile(subject.mesh, subject.limn, false);
    subject.image = ReadTiledExr(subject.limn);
    size_t numFilled = 0;
    for (size_t c = 0; c < 3; ++c)
        subject.planes[c].assign(subject.image.planes[c].begin(), subject.image.planes[c].end());
    for (size_t i = 0; i < subject.planes[0].size(); ++i) {
        double length = 0.0;
        for (auto const& plane : subject.planes) length += plane[i] * plane[i];
        if (length == 0.0) continue;
        Check(std::abs(length - 1.0) < 5e-3, "a normal's length is not one");
        ++numFilled;
    }
    WriteTiledExr(subject.peer, subject.image, 1);
    PackFile(subject.planes, subject.packed);
    BakeFile(subject.mesh, subject.limnMips, true);
    Check(ReadTiledExr(subject.peer) == subject.image, "OpenEXR's file has other pixels");
    Check(ReadTiledExr(subject.packed) == subject.image,
          "the file packed from memory has other pixels");
    Check(ReadTiledExr(subject.limnMips) == subject.image, "the file with mips has other pixels");
    fmt::print("  {:.1f} % of the texels are filled\n",
               100.0 * static_cast<double>(numFilled) / (1.0 * kSize * kSize));
    double const ratio = GetSize(subject.limn) / GetSize(subject.peer);
    fmt::print("  file size: limn {:.2f} MB, OpenEXR {:.2f} MB\n", GetSize(subject.limn) * 1e-6,
               GetSize(subject.peer) * 1e-6);
    fmt::print("  => size against OpenEXR {:.3f}, target at most 1.05: {}\n", ratio,
               ratio <= 1.05 ? "reached" : "MISSED");
    if (!hasMaketx) return;
    Check(RunMaketx(subject.peer, subject.peerMips, 1), "maketx failed");
    Check(ReadTiledExr(subject.peerMips) == subject.image, "maketx' file has other pixels");
    fmt::print("  file size with mips: limn {:.2f} MB, maketx {:.2f} MB\n",
               GetSize(subject.limnMips) * 1e-6, GetSize(subject.peerMips) * 1e-6);
}

void Measure(std::string const& name, int numRounds) {
    fmt::print("\n{}, normal map, {}^2, half, ZIP\n", name, kSize);
    if (!test::HasAsset(name)) {
        fmt::print("  skipped: there is no {}\n", test::AssetPath(name));
        return;
    }
    bool const hasMaketx = HasMaketx();
    if (!hasMaketx) fmt::print("  the program maketx is not installed: mip levels are skipped\n");
    Subject subject(name);
    CheckFiles(subject, hasMaketx);

    Rounds rounds(numRounds);
    double const texels = 1.0 * kSize * kSize;
    struct Numbers {
        size_t bake, peer, pack, mips, peerMips;
    };
    std::array<Numbers, 2> numbers{};
    for (int T = 1; T <= 2; ++T) {
        auto const add = [&](char const* what, auto work) {
            return rounds.Add(
                fmt::format("{}, T{}", what, T), [T, work] { OnThreads(T, work); }, texels);
        };
        Numbers& n = numbers[T - 1];
        n.bake =
            add("limn: read, bake, write", [&] { BakeFile(subject.mesh, subject.limn, false); });
        n.pack = add("limn: compress and write alone",
                     [&] { PackFile(subject.planes, subject.packed); });
        n.peer = add("OpenEXR: compress and write alone",
                     [&, T] { WriteTiledExr(subject.peer, subject.image, T); });
        if (!hasMaketx) continue;
        n.mips = add("limn: read, bake, write with mips",
                     [&] { BakeFile(subject.mesh, subject.limnMips, true); });
        n.peerMips = add("OpenEXR: compress and write, then maketx", [&, T] {
            WriteTiledExr(subject.peer, subject.image, T);
            Check(RunMaketx(subject.peer, subject.peerMips, T), "maketx failed");
        });
    }
    rounds.Run("texels");
    for (int T = 1; T <= 2; ++T) {
        Numbers const& n = numbers[T - 1];
        rounds.Compare(fmt::format("whole bake against OpenEXR's writer alone, T{}", T).c_str(),
                       n.bake, n.peer, 1.6);
        rounds.Compare(fmt::format("compress and write alone against OpenEXR's, T{}", T).c_str(),
                       n.pack, n.peer, 2.0);
        if (!hasMaketx) continue;
        rounds.Compare(
            fmt::format("whole bake with mips against OpenEXR's writer and maketx, T{}", T).c_str(),
            n.mips, n.peerMips, 4.0);
    }
    rounds.Compare("whole bake, T2 against T1", numbers[1].bake, numbers[0].bake);
}

}  // namespace
}  // namespace limn::bench

/// bench_bake [--rounds N] [--mesh NAME]: both meshes, or one of the assets.
// NOLINTNEXTLINE(bugprone-exception-escape): what is thrown ends a bench, as it should
int main(int argc, char** argv) {
    int const numRounds = limn::bench::GetNumRounds(argc, argv);
    std::vector<std::string> names{"control/chess_rook.obj", "control/ict_head_skin.obj"};
    for (int i = 1; i + 1 < argc; ++i) {
        if (std::string_view(argv[i]) == "--mesh") names = {argv[i + 1]};
    }
    for (std::string const& name : names) limn::bench::Measure(name, numRounds);
    return 0;
}
