// SPDX-License-Identifier: Apache-2.0
//
// How cost grows with the image and with the mesh (it should grow no faster than they do), and how
// much memory the largest usual bake takes.

#include <array>
#include <optional>

#include "engine/bake/bake.h"
#include "eval/surface/surface_sampler.h"
#include "far_ext/topology/refiner.h"
#include "harness.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn::bench {
namespace {

using engine::Model;

struct Image {
    char const* map;
    int size;
    bool isHalf;
    engine::ExrCompression compression;
};

engine::BakeReport BakeImage(Model const& model, Image const& image, std::string const& path) {
    engine::BakeOptions options;
    options.pattern = path;
    options.maps = {image.map};
    options.width = options.height = image.size;
    options.isHalf = image.isHalf;
    options.compression = image.compression;
    engine::Job job;
    return engine::Bake(model, options, job);
}

/// Surface from the topology on, then four samples in every face.
double EvaluateFaces(Model const& model) {
    constexpr std::array<double, 4> kS{0.25, 0.75, 0.25, 0.75}, kT{0.25, 0.25, 0.75, 0.75};
    eval::LimitSurface const surface(model.GetRefiner());
    eval::FaceTree tree(surface, model.GetPositions(), 3);
    eval::SurfaceSampler sampler(tree, eval::Quantity::Curvature, Orientation::Right);
    double sum = 0.0;
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        sampler.Bind(face);
        sampler.Evaluate(0, kS, kT,
                         [&](std::span<int const> block, float const* planes, size_t stride) {
                             for (size_t i = 0; i < block.size(); ++i)
                                 sum += planes[eval::kNormalX * stride + i];
                         });
    }
    return sum;
}

void PrintExponent(char const* what, std::vector<double> const& sizes,
                   std::vector<double> const& seconds, bool hasTarget = true) {
    // What a run costs whatever its size flatters the first fit; the second leaves the smallest
    // size out.
    double const all = FitExponent(sizes, seconds);
    double const large =
        FitExponent({sizes.begin() + 1, sizes.end()}, {seconds.begin() + 1, seconds.end()});
    fmt::print("  => {}: exponent {:.3f}, without the smallest {:.3f}", what, all, large);
    if (hasTarget)
        fmt::print(", target at most 1.05: {}",
                   std::max(all, large) <= 1.05 ? "reached" : "MISSED");
    fmt::print("\n");
}

void MeasureImages(int numRounds) {
    fmt::print("\nNormal map of a torus of 4096 faces, half, ZIP, one thread\n");
    test::TemporaryFolder const folder;
    Model const torus = Model::Build(test::MakeTorus(64, 64));
    Rounds rounds(numRounds);
    std::vector<double> sizes;
    std::vector<size_t> numbers;
    for (int size : {1024, 2048, 4096, 8192}) {
        Image const image{"normal", size, true, engine::ExrCompression::Zip};
        double const texels = 1.0 * size * size;
        Check(static_cast<double>(BakeImage(torus, image, folder / "map.exr").texelsCovered) ==
                  texels,
              "a texel of the torus is not covered");
        sizes.push_back(texels);
        numbers.push_back(rounds.Add(
            fmt::format("{}^2", size), [&, image] { BakeImage(torus, image, folder / "map.exr"); },
            texels));
    }
    rounds.Run("texels");
    std::vector<double> seconds;
    for (size_t number : numbers) seconds.push_back(rounds.Get(number).median);
    PrintExponent("time over texels", sizes, seconds);
}

void MeasureMeshes(int numRounds) {
    fmt::print("\nToruses of 1 k to 1 M faces, one thread\n");
    test::TemporaryFolder const folder;
    Rounds rounds(numRounds);
    std::vector<double> sizes;
    std::vector<size_t> topology, evaluation, bakes;
    for (int n : {32, 100, 316, 1000}) {
        Model const torus = Model::Build(test::MakeTorus(n, n));
        double const faces = 1.0 * n * n;
        Check(std::abs(EvaluateFaces(torus)) < 4.0 * faces, "normals are longer than one");
        Image const image{"normal", 2 * n, true, engine::ExrCompression::None};
        Check(static_cast<double>(BakeImage(torus, image, folder / "map.exr").texelsCovered) ==
                  4.0 * faces,
              "a texel of the torus is not covered");
        sizes.push_back(faces);
        topology.push_back(rounds.Add(
            fmt::format("{} faces: OpenSubdiv's topology", n * n),
            [torus] { far_ext::CreateRefiner(torus.GetCage()); }, faces));
        evaluation.push_back(rounds.Add(
            fmt::format("{} faces: surface and 4 samples per face", n * n),
            [torus] { EvaluateFaces(torus); }, faces));
        bakes.push_back(rounds.Add(
            fmt::format("{} faces: bake of 4 texels per face, uncompressed", n * n),
            [&folder, torus, image] { BakeImage(torus, image, folder / "map.exr"); }, faces));
    }
    rounds.Run("faces");
    auto const print = [&](char const* what, std::vector<size_t> const& numbers,
                           bool hasTarget = true) {
        std::vector<double> seconds;
        for (size_t number : numbers) seconds.push_back(rounds.Get(number).median);
        PrintExponent(what, sizes, seconds, hasTarget);
    };
    print("OpenSubdiv's topology over faces, for comparison", topology, false);
    print("surface and samples over faces", evaluation);
    print("bake over faces", bakes);
}

/// In child processes, so before anything else.
void MeasurePeaks() {
    fmt::print(
        "Peak memory of an 8192^2 bake of four float channels (map 'curvature'), two threads, with "
        "its mesh\n");
    test::TemporaryFolder const folder;
    auto const measure = [&](char const* name, auto makeScene, engine::ExrCompression compression) {
        Memory const memory = MeasureMemory([&] {
            OnThreads(2, [&] {
                BakeImage(Model::Build(makeScene()), {"curvature", 8192, false, compression},
                          folder / "map.exr");
            });
        });
        fmt::print("  => {}: {:.0f} MiB, target below 1024: {}\n", name, memory.peak,
                   memory.peak < 1024.0 ? "reached" : "MISSED");
    };
    measure(
        "torus of 4096 faces, ZIP", [] { return test::MakeTorus(64, 64); },
        engine::ExrCompression::Zip);
    measure(
        "torus of 1 M faces, uncompressed", [] { return test::MakeTorus(1000, 1000); },
        engine::ExrCompression::None);
    constexpr char const* kHead = "control/ict_head_skin.obj";
    if (test::HasAsset(kHead))
        measure(kHead, [] { return test::LoadAsset(kHead); }, engine::ExrCompression::Zip);
}

}  // namespace
}  // namespace limn::bench

// NOLINTNEXTLINE(bugprone-exception-escape): what is thrown ends a bench, as it should
int main(int argc, char** argv) {
    using namespace limn::bench;
    int const numRounds = GetNumRounds(argc, argv);
    MeasurePeaks();
    OnThreads(1, [&] {
        MeasureImages(numRounds);
        MeasureMeshes(numRounds);
    });
    return 0;
}
