// SPDX-License-Identifier: Apache-2.0
//
// The adaptive filter against the uniform cascade at equal error, on a window frame. Errors are
// largest distances, both ways, to a uniform result so fine that its last two levels differ by less
// than half of what is asked for, all settled, over the diagonal of the frame.

#include "engine/smooth/smooth.h"
#include "harness.h"
#include "support/adaptive_meshes.h"
#include "support/values.h"

namespace limn::bench {
namespace {

constexpr double kAsked = 3e-4, kWidthShare = 0.02;
constexpr int kUniformLevel = 5;

struct Frame {
    engine::Scene scene = test::MakeWindowFrame();
    engine::Model model = engine::Model::Build(scene);
    double diagonal = test::BoxDiagonal(scene.positions);

    engine::SmoothResult Smooth(engine::SmoothOptions const& options) const {
        engine::Job job;
        return engine::Smooth(model, engine::ConstantWidth{kWidthShare * diagonal}, options, job);
    }
    /// To the moves that an adaptive run leaves, too.
    engine::Scene MakeUniform(int levels) const {
        return Smooth({.levels = levels, .settle = 3e-5}).mesh.value();
    }
    engine::SmoothResult Adapt() const { return Smooth({.levels = 8, .adaptive = kAsked}); }

    /// Infinite above 1.5e-3.
    double FindError(engine::Scene const& found, engine::Scene const& reference) const {
        return test::FindLargestDistance(found, reference, 1.5e-3 * diagonal) / diagonal;
    }
};

/// A settled uniform result, near enough to what the filter converges to.
engine::Scene MakeReference(Frame const& frame) {
    engine::Scene last = frame.MakeUniform(kUniformLevel);
    for (int level = kUniformLevel + 1;; ++level) {
        engine::Scene finer = frame.MakeUniform(level);
        double const change = frame.FindError(last, finer);
        fmt::print("  levels {} and {} differ by {:.2g}\n", level - 1, level, change);
        if (change < kAsked / 2.0) return finer;
        last = std::move(finer);
    }
}

void Bench(int numRounds) {
    Frame const frame;
    fmt::print("\nA window frame, width {} of its diagonal, asked {:.2g}\n", kWidthShare, kAsked);
    auto const reference = MakeReference(frame);
    auto const adapted = frame.Adapt();
    auto const uniform = frame.MakeUniform(kUniformLevel);
    double const error = frame.FindError(*adapted.mesh, reference),
                 uniformError = frame.FindError(uniform, reference),
                 vertices = adapted.mesh->cage.numVertices,
                 uniformVertices = uniform.cage.numVertices;
    Check(error <= 1.1 * kAsked, fmt::format("the error is {:.3g}", error));
    fmt::print("  adaptive: {} vertices, error {:.3g}, estimated {:.3g}, {} passes, {} to settle\n",
               vertices, error, adapted.report.adaption->estimated, adapted.report.adaption->passes,
               adapted.report.settleMoves.size());
    fmt::print("  uniform, level {}: {} vertices, error {:.3g}\n", kUniformLevel, uniformVertices,
               uniformError);

    Rounds rounds(numRounds);
    size_t const ours = rounds.Add("limn: adaptive", [&] { frame.Adapt(); });
    size_t const theirs =
        rounds.Add("limn: uniform, settled", [&] { frame.MakeUniform(kUniformLevel); });
    rounds.Run();
    // An error falls as 1 / vertices, and conjugate gradients take vertices^1.5.
    double const growth = uniformError / error;
    auto const judge = [](char const* what, double ratio) {
        fmt::print("  => {}: 1/{:.2f}, target 1/3: {}\n", what, ratio,
                   ratio >= 3.0 ? "reached" : "MISSED");
    };
    judge("vertices at equal error", growth * uniformVertices / vertices);
    judge("time at equal error",
          std::pow(growth, 1.5) * rounds.Get(theirs).median / rounds.Get(ours).median);
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
    limn::bench::Bench(limn::bench::GetNumRounds(argc, argv));
}
