// SPDX-License-Identifier: Apache-2.0
//
// Samples of the limit surface, given as (face, s, t) and grouped by face, to position, normal and
// the four curvatures: limn against OpenSubdiv's patch evaluation with second derivatives. One
// thread.

#include <array>
#include <random>

#include "eval/kernels/instruction_set.h"
#include "eval/surface/patch_polynomial.h"
#include "eval/surface/surface_sampler.h"
#include "harness.h"
#include "meshes.h"
#include "peers/bfr_surfaces.h"
#include "peers/osd_patches.h"
#include "support/meshes.h"

namespace limn::bench {
namespace {

using eval::FaceTree;
using eval::InstructionSet;

constexpr size_t kNumSamples = size_t{4} << 20;
constexpr int kNumChannels = eval::GetNumChannels(eval::Quantity::Curvature);
constexpr size_t kCheckStep = 61;  // every 61st sample is compared with double

struct Samples {
    std::vector<size_t> first;  ///< per face, and the end
    std::vector<double> s, t;

    size_t GetNum() const { return s.size(); }
    std::span<double const> GetS(Index face) const {
        return {&s[first[face]], first[face + 1] - first[face]};
    }
    std::span<double const> GetT(Index face) const {
        return {&t[first[face]], first[face + 1] - first[face]};
    }
};

/// The same number of samples in every face, row by row over a grid, moved at random within its
/// cell.
Samples MakeSamples(Index numFaces, bool isTriangle) {
    int const side =
        static_cast<int>(std::lround(std::sqrt(static_cast<double>(kNumSamples) / numFaces)));
    std::mt19937 random(1);
    auto const next = [&] { return (static_cast<double>(random()) + 0.5) / 4294967296.0; };
    Samples samples;
    for (Index face = 0; face < numFaces; ++face) {
        samples.first.push_back(samples.GetNum());
        for (int j = 0; j < side; ++j) {
            for (int i = 0; i < side; ++i) {
                double const s = (i + next()) / side, t = (j + next()) / side;
                bool const isOutside = isTriangle && s + t > 1.0;
                samples.s.push_back(isOutside ? 1.0 - s : s);
                samples.t.push_back(isOutside ? 1.0 - t : t);
            }
        }
    }
    samples.first.push_back(samples.GetNum());
    return samples;
}

/// A mesh with all that limn and its peers need to evaluate it, and their results.
struct Subject {
    Subject(engine::Scene made, int level)
        : scene(std::move(made)),
          refiner(far_ext::CreateRefiner(scene.cage)),
          surface(*refiner),
          patches(scene.cage, scene.positions, level),
          surfaces(*refiner, scene.positions),
          samples(MakeSamples(scene.cage.GetNumFaces(), surface.IsLoop())),
          planeSize(samples.GetNum() + 4096 / sizeof(float) + 16),
          limn(planeSize * kNumChannels),
          osd(samples.GetNum() * OsdPatches::kLength),
          bfr(samples.GetNum() * BfrSurfaces::kLength) {
        coords.reserve(samples.GetNum());
        for (Index face = 0; face < scene.cage.GetNumFaces(); ++face) {
            for (size_t i = samples.first[face]; i < samples.first[face + 1]; ++i) {
                coords.push_back(patches.Find(face, samples.s[i], samples.t[i]));
            }
        }
    }

    /// Hands every block of every face to visit(first sample of the face, samples, planes, stride).
    template <class Visit>
    void VisitBlocks(Visit const& visit) {
        FaceTree tree(surface, scene.positions, 3);
        eval::SurfaceSampler sampler(tree, eval::Quantity::Curvature, Orientation::Right);
        for (Index face = 0; face < scene.cage.GetNumFaces(); ++face) {
            sampler.Bind(face);
            size_t const first = samples.first[face];
            sampler.Evaluate(0, samples.GetS(face), samples.GetT(face),
                             [&](std::span<int const> block, float const* planes, size_t stride) {
                                 visit(first, block, planes, stride);
                             });
        }
    }

    void EvaluateLimn() {
        VisitBlocks([&](size_t first, std::span<int const> block, float const* planes,
                        size_t stride) {
            bool const isRow = block.back() - block.front() + 1 == static_cast<int>(block.size());
            for (int c = 0; c < kNumChannels; ++c) {
                float const* const from = planes + static_cast<size_t>(c) * stride;
                float* const to = limn.data() + static_cast<size_t>(c) * planeSize + first;
                if (isRow)
                    std::copy_n(from, block.size(), to + block.front());
                else
                    for (size_t i = 0; i < block.size(); ++i) to[block[i]] = from[i];
            }
        });
    }

    /// As a bake does it: results are used block by block, while they are in the cache.
    void EvaluateLimnInBlocks() {
        VisitBlocks([&](size_t, std::span<int const>, float const* planes, size_t) {
            checksum += planes[0];
        });
    }

    void EvaluateBfr() {
        for (Index face = 0; face < scene.cage.GetNumFaces(); ++face) {
            surfaces.Bind(face);
            for (size_t i = samples.first[face]; i < samples.first[face + 1]; ++i) {
                surfaces.Evaluate(samples.s[i], samples.t[i], &bfr[i * BfrSurfaces::kLength]);
            }
        }
    }

    engine::Scene scene;
    std::unique_ptr<Far::TopologyRefiner> refiner;
    eval::LimitSurface surface;
    OsdPatches patches;
    BfrSurfaces surfaces;
    Samples samples;
    std::vector<Osd::PatchCoord> coords;
    size_t planeSize;  ///< floats from channel to channel: no power of two, for the cache's sake
    std::vector<float> limn;  ///< [channel][sample]
    std::vector<float> osd, bfr;
    double checksum = 0.0;
};

/// Largest error of some values, against the largest value of them all.
struct Error {
    double error = 0.0, scale = 0.0;

    void Add(double value, double truth) {
        error = std::max(error, std::abs(value - truth));
        scale = std::max(scale, std::abs(truth));
    }
    double Get() const { return error / scale; }
};

/// Errors of one peer's eighteen floats: as they are, and as the mean curvature they give.
struct PeerErrors {
    Error second, mean;

    void Add(float const* sample, std::array<std::array<double, 6>, 3> const& truth,
             double trueMean) {
        std::array<Eigen::Vector3d, 6> d;
        for (int k = 0; k < 6; ++k) {
            for (int c = 0; c < 3; ++c) {
                d[k][c] = sample[3 * k + c];
                if (k >= 3) second.Add(d[k][c], truth[c][k]);
            }
        }
        mean.Add(eval::ComputeCurvature(d[1], d[2], d[3], d[4], d[5]).mean, trueMean);
    }
};

/// Errors of limn's floats.
struct LimnErrors {
    Error position, normal, mean, gaussian, k1, k2;

    void Add(Subject const& subject, size_t i, eval::SurfaceSample const& truth) {
        auto const get = [&](int c) {
            return static_cast<double>(
                subject.limn[static_cast<size_t>(c) * subject.planeSize + i]);
        };
        for (int c = 0; c < 3; ++c) {
            position.Add(get(eval::kPositionX + c), truth.position[c]);
            normal.Add(get(eval::kNormalX + c), truth.normal[c]);
        }
        mean.Add(get(eval::kMean), truth.curvature.mean);
        gaussian.Add(get(eval::kGaussian), truth.curvature.gaussian);
        k1.Add(get(eval::kK1), truth.curvature.k1);
        k2.Add(get(eval::kK2), truth.curvature.k2);
    }
};

/// Value and derivatives of the three coordinates; the second derivatives, which are compared, to
/// the face's own parameters.
std::array<std::array<double, 6>, 3> FindDerivatives(FaceTree const& tree, bool isLoop,
                                                     eval::PatchPoint const& point) {
    std::array<std::array<double, 6>, 3> derivatives;
    for (int c = 0; c < 3; ++c) {
        double const* const coefficients = point.coefficients + c * tree.GetNumCoefficients();
        derivatives[c] = isLoop ? eval::EvaluateTrianglePolynomial(coefficients, point.x, point.y)
                                : eval::EvaluateQuadPolynomial(coefficients, point.x, point.y);
        for (int k = 3; k < 6; ++k) derivatives[c][k] *= point.scale * point.scale;
    }
    return derivatives;
}

struct Errors {
    LimnErrors limn;
    PeerErrors osd, bfr;
};

/// Compares every kCheckStep'th sample with limn's own evaluation in double.
Errors FindErrors(Subject const& subject) {
    FaceTree tree(subject.surface, subject.scene.positions, 3);
    Samples const& samples = subject.samples;
    Errors errors;
    for (Index face = 0; face < subject.scene.cage.GetNumFaces(); ++face) {
        tree.Bind(face);
        size_t const step = kCheckStep;
        for (size_t i = (samples.first[face] + step - 1) / step * step; i < samples.first[face + 1];
             i += step) {
            double const s = samples.s[i], t = samples.t[i];
            eval::SurfaceSample const truth = eval::EvaluateSample(tree, 0, s, t);
            errors.limn.Add(subject, i, truth);
            eval::PatchPoint const point = tree.Locate(0, s, t, FaceTree::kCurvatureDepth);
            if (point.isMoved) continue;
            auto const derivatives = FindDerivatives(tree, subject.surface.IsLoop(), point);
            double const mean = truth.curvature.mean;
            errors.osd.Add(&subject.osd[i * OsdPatches::kLength], derivatives, mean);
            errors.bfr.Add(&subject.bfr[i * BfrSurfaces::kLength], derivatives, mean);
        }
    }
    return errors;
}

void PrintErrors(Errors const& errors) {
    auto const& [position, normal, mean, gaussian, k1, k2] = errors.limn;
    fmt::print("  largest error / largest value, against double:\n");
    fmt::print(
        "    limn         position {:.1e}  normal {:.1e}  mean {:.1e}  gaussian {:.1e}  k1 {:.1e}  "
        "k2 {:.1e}\n",
        position.Get(), normal.Get(), mean.Get(), gaussian.Get(), k1.Get(), k2.Get());
    fmt::print("    EvalPatches  mean {:.1e}  second derivatives {:.1e}\n", errors.osd.mean.Get(),
               errors.osd.second.Get());
    fmt::print("    Bfr          mean {:.1e}  second derivatives {:.1e}\n", errors.bfr.mean.Get(),
               errors.bfr.second.Get());
}

/// Evaluates everything once. Fails if limn's floats are off.
void CheckResults(Subject& subject, double tolerance) {
    subject.EvaluateLimn();
    subject.patches.Evaluate(subject.coords, subject.osd.data());
    subject.EvaluateBfr();
    Errors const errors = FindErrors(subject);
    PrintErrors(errors);
    Check(errors.limn.position.Get() <= 1e-6 && errors.limn.normal.Get() <= 1e-5,
          "positions or normals differ from double");
    constexpr double kTarget = 1e-6;
    double const mean = errors.limn.mean.Get();
    fmt::print("  => mean curvature in float: error {:.1e}, target at most {:.0e}: {}\n", mean,
               kTarget, mean <= kTarget ? "reached" : "MISSED");
    Check(mean <= tolerance,
          fmt::format("mean curvature is off by {:.1e}, more than {:.0e}", mean, tolerance));
}

double ShareOfExtraordinaryFaces(eval::LimitSurface const& surface) {
    Index num = 0;
    for (Index face = 0; face < surface.GetNumFaces(); ++face) num += !surface.IsPlainPatch(face);
    return static_cast<double>(num) / surface.GetNumFaces();
}

struct Targets {
    std::optional<double> best, sse2;
};

void Measure(char const* name, engine::Scene scene, double tolerance, Targets const& targets,
             int numRounds) {
    constexpr int kLevel = 5;
    Subject subject(std::move(scene), kLevel);
    double const num = static_cast<double>(subject.samples.GetNum());
    fmt::print(
        "\n{}: {} faces, {:.1f} % of them not plain patches, {} samples; EvalPatches: level {}, {} "
        "patches\n",
        name, subject.scene.cage.GetNumFaces(), 100.0 * ShareOfExtraordinaryFaces(subject.surface),
        subject.samples.GetNum(), kLevel, subject.patches.GetNumPatches());
    CheckResults(subject, tolerance);

    InstructionSet const widest = eval::GetInstructionSet();
    Rounds rounds(numRounds);
    auto const with = [&](InstructionSet set, auto evaluate) {
        return [&subject, set, widest, evaluate] {
            eval::SelectInstructionSet(set);
            evaluate(subject);
            eval::SelectInstructionSet(widest);
        };
    };
    auto const stored = [](Subject& s) { s.EvaluateLimn(); };
    size_t const limn = rounds.Add(fmt::format("limn, {}, 10 channels", eval::GetName(widest)),
                                   with(widest, stored), num);
    size_t const blocks =
        rounds.Add("  the same, results left in the cache",
                   with(widest, [](Subject& s) { s.EvaluateLimnInBlocks(); }), num);
    size_t const sse2 =
        rounds.Add("limn, sse2, 10 channels", with(InstructionSet::Sse2, stored), num);
    size_t const osd = rounds.Add(
        "Osd::CpuEvaluator::EvalPatches, 18 floats",
        [&] { subject.patches.Evaluate(subject.coords, subject.osd.data()); }, num);
    size_t const bfr =
        rounds.Add("Bfr::Surface::Evaluate, 18 floats", [&] { subject.EvaluateBfr(); }, num);
    rounds.Run("samples");
    rounds.Compare("limn against EvalPatches", limn, osd, targets.best);
    rounds.Compare("limn with sse2 against EvalPatches", sse2, osd, targets.sse2);
    rounds.Compare("limn in the cache against EvalPatches", blocks, osd);
    rounds.Compare("limn against Bfr", limn, bfr);
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
    using namespace limn;
    int const numRounds = bench::GetNumRounds(argc, argv);
    bench::OnThreads(1, [&] {
        bench::Measure("Regular torus", test::MakeTorus(64, 64), 1e-6, {25.0, {}}, numRounds);
        bench::Measure("Torus with few insets", bench::MakeInsetTorus(64, 0.0044), 1e-3, {15.0, {}},
                       numRounds);
        bench::Measure("Torus with 7 % of its quads inset", bench::MakeInsetTorus(57, 0.07), 1e-3,
                       {15.0, {}}, numRounds);
        bench::Measure("Regular torus of triangles (Loop)", test::MakeTriangleTorus(45, 46), 1e-5,
                       {}, numRounds);
    });
    return 0;
}
