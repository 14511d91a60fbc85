// SPDX-License-Identifier: Apache-2.0
//
// The cascadic geometric filter: a level against sparse matrices, its sweep against a stencil table
// in OpenSubdiv's evaluator and against the memory, the whole cascade against its finest level, and
// growth.

#include "eval/cascade/cascade.h"
#include "far_ext/cascade/cascade_stencils.h"
#include "harness.h"
#include "peers/eigen_cascade.h"
#include "peers/osd_stencils.h"
#include "support/fit_meshes.h"
#include "support/refined.h"
#include "support/stencils.h"

namespace limn::bench {
namespace {

using eval::CascadeRows;
using far_ext::CascadeLevel;

constexpr int kNumLevels = 4, kNumSweeps = 3;

double FindMeanEdge(engine::Scene const& scene) {
    double sum = 0.0;
    std::vector<Index> const& faces = scene.cage.faceVertices;
    for (size_t i = 0; i < faces.size(); ++i) {
        double const* const p = &scene.positions[3 * static_cast<size_t>(faces[i])];
        double const* const q =
            &scene.positions[3 * static_cast<size_t>(faces[i % 3 == 2 ? i - 2 : i + 1])];
        sum += std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    }
    return sum / static_cast<double>(faces.size());
}

/// A torus of quads cut along either diagonal at random (valences 4 to 8), its vertices moved a
/// little.
engine::Scene MakeIrregularTorus(int size) {
    engine::Scene scene = test::MakeTriangleTorus(5 * size, 2 * size);
    std::vector<Index>& faces = scene.cage.faceVertices;
    std::mt19937 random(3);
    for (size_t i = 0; i < faces.size(); i += 6) {  // a, b, c and a, c, d to a, b, d and d, b, c
        if (random() % 2 == 0) continue;
        faces[i + 2] = faces[i + 3] = faces[i + 5];
        faces[i + 5] = faces[i + 4];
        faces[i + 4] = faces[i + 1];
    }
    test::AddNoise(scene, 0.05, 1);
    return scene;
}

/// An irregular torus, quartered four times: 2560 size^2 vertices.
struct Case {
    engine::Scene scene;
    double width;
    std::vector<CascadeLevel> levels;
    far_ext::CascadeMesh finestMesh;

    explicit Case(int size) : scene(MakeIrregularTorus(size)) {
        width = 0.12 * FindMeanEdge(scene);
        auto const refiner = test::MakeRefiner(scene, kNumLevels);
        for (int k = 1; k <= kNumLevels; ++k) {
            finestMesh = far_ext::MakeCascadeMesh(*refiner, k);
            levels.push_back(BuildLevel(k));
        }
    }

    CascadeLevel BuildLevel(int k) const {
        std::vector<Index> const none;
        return far_ext::BuildCascadeLevel(
            finestMesh, k == 1 ? none : levels[static_cast<size_t>(k) - 2].vertices,
            far_ext::BoundaryRule::Fixed);
    }

    /// The first so many levels.
    eval::Cascade<float> Run(int sweeps, size_t numLevels = kNumLevels) const {
        eval::Cascade<float> cascade(
            scene.positions, {},
            {.solver = eval::CascadeSolver::Jacobi, .width = width, .measuresResidual = false});
        for (size_t k = 0; k < numLevels; ++k) cascade.Step(levels[k], sweeps);
        return cascade;
    }
};

/// The finest level's weights and sweeps, from a surface that is not flat between the cage's
/// vertices.
struct Level {
    CascadeLevel const& level;
    float width;
    CascadeRows<float> start, metric, x, next;
    eval::CascadeOperator<float> op;

    explicit Level(Case const& subject)
        : level(subject.levels.back()),
          width(static_cast<float>(subject.width)),
          start(subject.Run(0).GetRows()),
          metric(start) {
        auto const noise = test::MakeRandomValues(3 * metric.size(), 2);
        float const size =
            0.03f * static_cast<float>(FindMeanEdge(subject.scene)) / (1 << kNumLevels);
        for (size_t i = 0; i < noise.size(); ++i)
            metric[i / 3][static_cast<Index>(i % 3)] += size * noise[i];
        x = next = metric;
    }

    void BuildWeights() { eval::BuildOperator(level, metric, width, op); }
    void Sweep() { eval::SweepJacobi(level, op, metric, start, next, x, kNumSweeps); }

    /// Bytes of memory that one sweep must move: rows of x, X0 and the result, each once, and the
    /// operator.
    double GetBytesOfSweep() const {
        double const numRows = level.numUnknowns,
                     numEntries = static_cast<double>(level.neighbours.size());
        return numRows * (3 * 16 + 4 + 4 + 4) + numEntries * (4 + 4);
    }
};

EigenCascade::Points ToPoints(CascadeRows<float> const& rows) {
    EigenCascade::Points points(static_cast<Index>(rows.size()), 3);
    for (Index i = 0; i < points.rows(); ++i)
        points.row(i) = rows[i].head<3>().cast<double>().transpose();
    return points;
}

/// In the rows' order, which its sweeps are faster in.
EigenCascade MakePeer(Case const& subject, CascadeRows<float> const& start) {
    std::vector<Index> const& vertices = subject.levels.back().vertices;
    std::vector<Index> rows(vertices.size()), triangles;
    for (size_t row = 0; row < rows.size(); ++row) rows[vertices[row]] = static_cast<Index>(row);
    for (Index vertex : subject.finestMesh.faces) triangles.push_back(rows[vertex]);
    return {std::move(triangles), ToPoints(start)};
}

/// The sweep as a table for OpenSubdiv's evaluator, over [X; X0].
struct OsdSweep {
    far_ext::CascadeStencils table;
    std::vector<float> source, target;
    int length;

    OsdSweep(Level const& subject, int rowLength)
        : table(subject.level),
          source(2 * subject.start.size() * rowLength),
          target(source.size() / 2),
          length(rowLength) {
        std::vector<float> scales;
        for (float diagonal : subject.op.diagonals)
            scales.push_back(diagonal > 0.0f ? 0.75f / diagonal : 0.0f);
        table.SetWeights(subject.level, subject.op.edges, subject.op.masses, scales);
        for (size_t i = 0; i < source.size(); ++i) {
            size_t const row = i / length, n = subject.start.size();
            source[i] = (row < n ? subject.metric[row]
                                 : subject.start[row - n])[static_cast<Index>(i % length)];
        }
    }

    void Run() { EvaluateWithOsd(table, source.data(), target.data(), length); }

    double FindDifference(CascadeRows<float> const& rows) const {
        float worst = 0.0f;
        for (size_t i = 0; i < target.size(); ++i)
            worst = std::max(
                worst, std::abs(target[i] - rows[i / length][static_cast<Index>(i % length)]));
        return static_cast<double>(worst);
    }
};

void Judge(char const* what, double value, double target, bool isUpperBound) {
    bool const isReached = isUpperBound ? value <= target : value >= target;
    fmt::print("  => {}: {:.3f}, target at {} {}: {}\n", what, value,
               isUpperBound ? "most" : "least", target, isReached ? "reached" : "MISSED");
    std::fflush(stdout);
}

/// One level in the hands of limn and of its peers.
struct LevelPeers {
    Level limn;
    double size, diffusion;
    EigenCascade eigen;
    EigenCascade::Points metric, x;
    OsdSweep osd3, osd4;

    explicit LevelPeers(Case const& subject)
        : limn(WithWeights(subject)),
          size(test::BoxDiagonal(subject.scene.positions)),
          diffusion(subject.width * subject.width / 2),
          eigen(MakePeer(subject, limn.start)),
          metric(ToPoints(limn.metric)),
          x(metric),
          osd3(limn, 3),
          osd4(limn, 4) {}

    void Filter() {
        limn.BuildWeights();
        limn.Sweep();
    }
    void SweepOnce() { eval::SweepJacobi(limn.level, limn.op, limn.metric, limn.start, limn.next); }
    void SweepWithEigen() { eigen.Sweep(x, kNumSweeps, eval::kJacobiDamping); }
    void FilterWithEigen() {
        eigen.Assemble(metric, diffusion);
        SweepWithEigen();
    }

private:
    /// The sweeps as tables need them.
    static Level WithWeights(Case const& subject) {
        Level level(subject);
        level.BuildWeights();
        return level;
    }
};

/// \return  how far limn is from Eigen, in diagonals
double CheckLevel(LevelPeers& peers) {
    peers.Filter();
    peers.FilterWithEigen();
    double const miss = (ToPoints(peers.limn.next) - peers.x).cwiseAbs().maxCoeff() / peers.size;
    Check(miss < 1e-6 && (peers.x - peers.metric).cwiseAbs().maxCoeff() > 1e-4 * peers.size,
          "a level as sparse matrices in double filter it");
    peers.SweepOnce();
    for (OsdSweep* osd : {&peers.osd3, &peers.osd4}) {
        osd->Run();
        Check(osd->FindDifference(peers.limn.next) < 1e-6 * peers.size,
              "a sweep as OpenSubdiv evaluates it");
    }
    return miss;
}

/// Numbers of the variants; limn's with one thread and with two.
struct LevelVariants {
    std::array<size_t, 2> level, sweep;
    size_t eigen, osd3, osd4;
};

LevelVariants AddVariants(LevelPeers& peers, Rounds& rounds) {
    double const items = peers.limn.level.numUnknowns;
    LevelVariants variants{};
    for (int numThreads : {1, 2}) {
        auto const add = [&](char const* what, auto work) {
            return rounds.Add(
                fmt::format("limn: {}, T{}", what, numThreads),
                [work, numThreads] { OnThreads(numThreads, work); }, items);
        };
        size_t const at = static_cast<size_t>(numThreads) - 1;
        add("weights", [&] { peers.limn.BuildWeights(); });
        variants.sweep[at] = add("a sweep", [&] { peers.SweepOnce(); });
        variants.level[at] = add("weights and 3 sweeps", [&] { peers.Filter(); });
    }
    variants.eigen =
        rounds.Add("Eigen: assembly and 3 sweeps", [&] { peers.FilterWithEigen(); }, items);
    rounds.Add("Eigen: 3 sweeps", [&] { peers.SweepWithEigen(); }, items);
    variants.osd3 =
        rounds.Add("Osd::CpuEvaluator: a sweep, length 3", [&] { peers.osd3.Run(); }, items);
    variants.osd4 =
        rounds.Add("Osd::CpuEvaluator: a sweep, length 4", [&] { peers.osd4.Run(); }, items);
    return variants;
}

void ReportBandwidth(Level const& level, Rounds const& rounds, size_t sweep) {
    double const items = level.level.numUnknowns,
                 bandwidth = level.GetBytesOfSweep() / rounds.Get(sweep).median;
    fmt::print(
        "  a sweep must move {:.0f} bytes per vertex (x, X0, result 48, entries {:.0f} with index "
        "and weight, mass, diagonal, offset 12): {:.1f} GB/s\n",
        level.GetBytesOfSweep() / items,
        8.0 * static_cast<double>(level.level.neighbours.size()) / items, bandwidth * 1e-9);
    Judge("a sweep's bandwidth over that of copying, T1", bandwidth / rounds.GetCopyBandwidth(),
          0.5, false);
}

void BenchLevel(Case const& subject, int numRounds) {
    LevelPeers peers(subject);
    double const miss = CheckLevel(peers);
    fmt::print(
        "\nOne level of {} vertices: weights and {} sweeps; float differs from Eigen's double by "
        "{:.1e} of the diagonal\n",
        peers.limn.level.GetNumRows(), kNumSweeps, miss);
    Rounds rounds(numRounds);
    LevelVariants const variants = AddVariants(peers, rounds);
    rounds.Run("vertices");
    auto const& [level, sweep, eigen, osd3, osd4] = variants;
    rounds.Compare("the level against Eigen, T1", level[0], eigen, 15.0);
    rounds.Compare("the level with two threads against Eigen with one", level[1], eigen, 20.0);
    rounds.Compare("a sweep against OpenSubdiv, length 3, T1", sweep[0], osd3, 2.0);
    rounds.Compare("a sweep against OpenSubdiv, length 4, T1", sweep[0], osd4, 2.0);
    ReportBandwidth(peers.limn, rounds, sweep[0]);
}

void BenchWhole(Case const& subject, int numRounds) {
    auto const refiner = test::MakeRefiner(subject.scene, kNumLevels);
    Level finest(subject);
    double const items = subject.levels.back().numUnknowns;
    fmt::print("\nThe whole cascade, {} levels to {} vertices, one thread\n", kNumLevels, items);
    OnThreads(1, [&] {
        Rounds rounds(numRounds);
        size_t const sweeps = rounds.Add(
            "limn: finest level's weights and 3 sweeps, in place",
            [&] {
                finest.BuildWeights();
                finest.Sweep();
            },
            items);
        size_t const coarse = rounds.Add("limn: all levels but the finest",
                                         [&] { subject.Run(kNumSweeps, kNumLevels - 1); });
        size_t const whole =
            rounds.Add("limn: all levels", [&] { subject.Run(kNumSweeps); }, items);
        size_t const build = rounds.Add(
            "limn: BuildCascadeLevel, finest", [&] { subject.BuildLevel(kNumLevels); }, items);
        size_t const mesh = rounds.Add(
            "limn: MakeCascadeMesh, finest",
            [&] { far_ext::MakeCascadeMesh(*refiner, kNumLevels); }, items);
        rounds.Add(
            "OpenSubdiv: topology of all levels",
            [&] { test::MakeRefiner(subject.scene, kNumLevels); }, items);
        rounds.Run("vertices");
        double const all = rounds.Get(whole).median;
        Judge("all levels over the finest, prolongation and memory included",
              all / (all - rounds.Get(coarse).median), 1.6, true);
        fmt::print("  => all levels over the finest's weights and sweeps alone: {:.2f}\n",
                   all / rounds.Get(sweeps).median);
        Judge("seconds per million vertices to build the finest level",
              rounds.Get(build).median / items * 1e6, 0.3, true);
        fmt::print("  => building the finest level over filtering all: {:.2f}\n",
                   (rounds.Get(build).median + rounds.Get(mesh).median) / all);
    });
}

void BenchGrowth(int numRounds, bool isLarge) {
    fmt::print("\nGrowth: the whole cascade, one thread\n");
    std::vector<double> sizes, times;
    for (int size : {2, 6, 20, 63}) {
        if (size > 50 && !isLarge) continue;
        Case const subject(size);
        double const count = subject.levels.back().GetNumRows();
        double best = 1e30;
        OnThreads(1, [&] {
            for (int round = -1; round < numRounds; ++round) {
                auto const start = std::chrono::steady_clock::now();
                subject.Run(kNumSweeps);
                best = std::min(
                    best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
                              .count());
            }
        });
        sizes.push_back(count);
        times.push_back(best);
        fmt::print("  {:>9} vertices: best {:9.2f} ms, {:5.1f} ns per vertex\n", count, best * 1e3,
                   best / count * 1e9);
        std::fflush(stdout);
    }
    Judge("exponent of time", FitExponent(sizes, times), 1.05, true);
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    fmt::print("  peak memory of this program, OpenSubdiv's topology included: {:.1f} GB\n",
               static_cast<double>(usage.ru_maxrss) * 1024e-9);
}

}  // namespace
}  // namespace limn::bench

/// --rounds N; --large: growth up to 10 M vertices, too
int main(int argc, char** argv) {
    using namespace limn::bench;
    int const numRounds = GetNumRounds(argc, argv);
    {
        Case const subject(20);
        BenchLevel(subject, numRounds);
        BenchWhole(subject, numRounds);
    }
    BenchGrowth(numRounds,
                std::find(argv + 1, argv + argc, std::string_view("--large")) != argv + argc);
}
