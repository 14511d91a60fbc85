// SPDX-License-Identifier: Apache-2.0
//
// What changes in a program that refines points with Osd::CpuEvaluator when it takes limn's
// evaluator instead. Prints the largest difference between the two; see docs/evaluators.md.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include <limn/eval/stencils/simd_evaluator.h>
#include <limn/far_ext/error.h>
#include <limn/far_ext/stencils/refined_stencils.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;
namespace Sdc = OpenSubdiv::Sdc;

namespace {

std::unique_ptr<Far::TopologyRefiner> MakeRefinedCube(int level) {
    static int const sizes[6] = {4, 4, 4, 4, 4, 4};
    static int const vertices[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4,
                                     1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    Far::TopologyDescriptor cube;
    cube.numVertices = 8;
    cube.numFaces = 6;
    cube.numVertsPerFace = sizes;
    cube.vertIndicesPerFace = vertices;
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(cube, Factory::Options(Sdc::SCHEME_CATMARK)));
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(level));
    return refiner;
}

double LargestDifference(Osd::CpuVertexBuffer& a, Osd::CpuVertexBuffer& b) {
    double largest = 0.0;
    for (int i = 0; i < a.GetNumVertices() * a.GetNumElements(); ++i) {
        largest = std::max(
            largest, std::abs(static_cast<double>(a.BindCpuBuffer()[i]) - b.BindCpuBuffer()[i]));
    }
    return largest;
}

int Run() {
    auto const refiner = MakeRefinedCube(4);
    Far::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    options.generateOffsets = true;
    std::unique_ptr<Far::StencilTable const> const table(
        Far::StencilTableFactory::Create(*refiner, options));

    float const points[24] = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                              -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
    int const numRefined = table->GetNumStencils();
    std::unique_ptr<Osd::CpuVertexBuffer> const source(Osd::CpuVertexBuffer::Create(3, 8)),
        before(Osd::CpuVertexBuffer::Create(3, numRefined)),
        after(Osd::CpuVertexBuffer::Create(3, numRefined));
    source->UpdateData(points, 0, 8);
    Osd::BufferDescriptor const xyz(0, 3, 3);

    // What the program does today:
    Osd::CpuEvaluator::EvalStencils(source.get(), xyz, before.get(), xyz, table.get());

    // 1. Another name, nothing else:
    limn::eval::SimdEvaluator::EvalStencils(source.get(), xyz, after.get(), xyz, table.get());
    double const asItStands = LargestDifference(*before, *after);

    // 2. The table compiled once, for evaluating it every frame:
    auto const compiled = limn::eval::CompiledStencils::Compile(*table);
    limn::eval::SimdEvaluator::EvalStencils(source.get(), xyz, after.get(), xyz, &compiled);
    double const afterCompiling = LargestDifference(*before, *after);

    // 3. No table of Far's at all:
    limn::eval::CompiledStencils const built(limn::far_ext::BuildRefinedStencils(*refiner));
    limn::eval::SimdEvaluator::EvalStencils(source.get(), xyz, after.get(), xyz, &built);
    double const fromTopology = LargestDifference(*before, *after);

    std::printf("largest difference: as it stands %.1e, compiled %.1e, from the topology %.1e\n",
                asItStands, afterCompiling, fromTopology);
    return std::max({asItStands, afterCompiling, fromTopology}) < 1e-6 ? 0 : 1;
}

}  // namespace

int main() {
    try {
        return Run();
    } catch (limn::Error const& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
