// SPDX-License-Identifier: Apache-2.0
//
// Streamlines on the limit: from many seeds, and evenly spaced ones.

#include <limits>

#include "eval/forms/field_designer.h"
#include "eval/streamlines/even_streamlines.h"
#include "far_ext/topology/boundary.h"
#include "far_ext/topology/refiner.h"
#include "harness.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn::bench {
namespace {

/// Spot, refined twice, between a source and a sink, with lines of four edges through seeds all
/// over it.
struct Problem {
    engine::Scene scene = test::Refine(test::LoadSpot(), 2);
    std::unique_ptr<Far::TopologyRefiner> refiner = far_ext::CreateRefiner(scene.cage);
    std::vector<double> form;
    std::vector<eval::SurfacePlace> seeds;
    double meanEdge = 0.0;

    explicit Problem(size_t numSeeds) {
        auto const level = refiner->GetLevel(0);
        std::vector<double> sources(level.GetNumVertices(), 0.0);
        sources[0] = 1.0;
        sources[100] = -1.0;
        eval::FieldDesigner designer(level, scene.positions, eval::AtBoundary::Tangent);
        form = designer.MakeGradient(sources);
        meanEdge = far_ext::FindMeanEdgeLength(level, scene.positions);
        auto const places = test::MakeNoise(2 * numSeeds, 1);
        for (size_t i = 0; i < numSeeds; ++i) {
            auto const face = static_cast<Index>(i * level.GetNumFaces() / numSeeds);
            seeds.push_back({face, 0, 0.5 + 0.5 * places[2 * i], 0.5 + 0.5 * places[2 * i + 1]});
        }
    }

    eval::FlowSurface MakeFlow() const { return {scene.cage, scene.positions, form}; }

    eval::StreamlineOptions MakeOptions(eval::FlowSurface const& flow) const {
        return {.step = 0.25 * meanEdge,
                .maxLength = 4.0 * meanEdge,
                .leastSpeed = 1e-6 * flow.FindRmsSpeed()};
    }
};

void CheckLines(std::vector<eval::Streamline> const& lines, Problem const& problem) {
    size_t numFull = 0;
    for (auto const& line : lines) {
        Check(line.length < 4.0 * problem.meanEdge * (1.0 + 1e-9), "no line is too long");
        numFull += line.length > 3.99 * problem.meanEdge;
    }
    Check(static_cast<double>(numFull) > 0.9 * static_cast<double>(lines.size()),
          "most lines are as long as they may be");
}

void Run(int numRounds) {
    constexpr size_t kNumSeeds = 10000;
    constexpr double kTarget = 1.0;
    Problem const problem(kNumSeeds);
    auto const flow = problem.MakeFlow();
    auto const options = problem.MakeOptions(flow);
    CheckLines(TraceStreamlines(flow, problem.seeds, options), problem);
    eval::EvenOptions even{options, 0.5 * problem.meanEdge};
    even.line.step = even.separation / 8.0;
    even.line.maxLength = std::numeric_limits<double>::infinity();

    Rounds rounds(numRounds);
    auto const seeds = static_cast<double>(kNumSeeds);
    size_t const both = rounds.Add(
        "lines of 4 edges, from nothing",
        [&] { TraceStreamlines(problem.MakeFlow(), problem.seeds, options); }, seeds);
    rounds.Add("  the flow alone", [&] { problem.MakeFlow(); }, seeds);
    rounds.Add("  the lines alone", [&] { TraceStreamlines(flow, problem.seeds, options); }, seeds);
    rounds.Add("evenly spaced, half an edge", [&] { FillEvenly(flow, even); }, seeds);
    rounds.Run("lines");
    double const seconds = rounds.Get(both).median;
    fmt::print("  => {} lines: {:.3f} s, target at most {} s: {}\n", kNumSeeds, seconds, kTarget,
               seconds <= kTarget ? "reached" : "MISSED");
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
    int const numRounds = limn::bench::GetNumRounds(argc, argv);
    limn::bench::OnThreads(2, [&] { limn::bench::Run(numRounds); });
}
