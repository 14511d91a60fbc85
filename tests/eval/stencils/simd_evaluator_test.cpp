// SPDX-License-Identifier: Apache-2.0
#include "eval/stencils/simd_evaluator.h"

#include <atomic>
#include <cstring>
#include <limits>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>
#include <tbb/global_control.h>

#include "eval/stencils/stencil_evaluator.h"
#include "far_ext/error.h"
#include "far_ext/stencils/refined_stencils.h"
#include "support/instruction_sets.h"
#include "support/meshes.h"
#include "support/stencils.h"

namespace limn::eval {
namespace {

using far_ext::RefinedStencilOptions;
using Factory = Far::StencilTableFactory;
using Osd::BufferDescriptor;
using test::MakeFarTable;

BufferDescriptor Tight(int length) {
    return {0, length, length};
}

std::vector<float> EvaluateWithOsd(test::FarTable const& table, std::vector<float> const& source,
                                   int length) {
    std::vector<float> target(static_cast<size_t>(table.GetNumStencils()) * length);
    Osd::CpuEvaluator::EvalStencils(source.data(), Tight(length), target.data(), Tight(length),
                                    table.GetSizes().data(), table.GetOffsets().data(),
                                    table.GetControlIndices().data(), table.GetWeights().data(), 0,
                                    table.GetNumStencils());
    return target;
}

/// Tight rows of start..end-1 in a target for the whole table, the rest of it as it was filled.
constexpr float kUntouched = 12345.0f;

std::vector<float> EvaluateCompiled(CompiledStencils const& table, std::vector<float> const& source,
                                    int length, int start, int end) {
    std::vector<float> target(static_cast<size_t>(table.GetNumStencils()) * length, kUntouched);
    SimdEvaluator::EvalStencils(source.data(), Tight(length), target.data(), Tight(length), table,
                                start, end);
    return target;
}

std::vector<float> EvaluateCompiled(CompiledStencils const& table, std::vector<float> const& source,
                                    int length) {
    return EvaluateCompiled(table, source, length, 0, table.GetNumStencils());
}

std::vector<float> EvaluateRaw(test::FarTable const& table, std::vector<float> const& source,
                               int length, int start, int end) {
    std::vector<float> target(static_cast<size_t>(table.GetNumStencils()) * length, kUntouched);
    SimdEvaluator::EvalStencils(source.data(), Tight(length), target.data(), Tight(length),
                                table.GetSizes().data(), table.GetOffsets().data(),
                                table.GetControlIndices().data(), table.GetWeights().data(), start,
                                end);
    return target;
}

bool AreSameBytes(std::vector<float> const& a, std::vector<float> const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// All of limn's ways against OpenSubdiv's, for one refined cage.
void ExpectOsdsValues(Far::TopologyRefiner const& refiner, RefinedStencilOptions const& options,
                      std::string const& name) {
    constexpr double kBound = 1e-6;
    auto const far = MakeFarTable(refiner, static_cast<int>(options.mode));
    ASSERT_GT(far->GetNumStencils(), 0) << name;
    auto const source =
        test::MakeRandomValues(static_cast<size_t>(far->GetNumControlVertices()) * 3, 1);
    auto const expected = EvaluateWithOsd(*far, source, 3);
    CompiledStencils const fromTopology(far_ext::BuildRefinedStencils(refiner, options));
    auto const fromFar = CompiledStencils::Compile(*far);
    auto const slicedTable = CompiledStencils::Compile(*far, {.isSliced = true});
    EXPECT_LT(test::RelativeDifference(EvaluateCompiled(fromTopology, source, 3), expected), kBound)
        << name;
    EXPECT_LT(test::RelativeDifference(EvaluateCompiled(fromFar, source, 3), expected), kBound)
        << name;
    EXPECT_LT(test::RelativeDifference(EvaluateCompiled(slicedTable, source, 3), expected), kBound)
        << name;
    EXPECT_LT(
        test::RelativeDifference(EvaluateRaw(*far, source, 3, 0, far->GetNumStencils()), expected),
        kBound)
        << name;
    for (auto kind : {EvaluatorKind::Simd, EvaluatorKind::OsdCpu}) {
        StencilEvaluator const evaluator(kind, far_ext::BuildRefinedStencils(refiner, options));
        std::vector<float> target(expected.size());
        evaluator.EvalStencils(source.data(), Tight(3), {{target.data(), Tight(3)}}, 0,
                               far->GetNumStencils());
        EXPECT_LT(test::RelativeDifference(target, expected), kBound)
            << name << ", " << GetName(kind);
    }
}

TEST(SimdEvaluator, EqualsOpenSubdivOnEveryCage) {
    for (std::string const& shape : test::ListShapes()) {
        auto const scene = test::LoadShape(shape);
        for (int level = 1; level <= 4; ++level) {
            auto const refiner = test::RefineUniformly(scene.cage, level);
            std::string const name = fmt::format("{} level {}", shape, level);
            ExpectOsdsValues(*refiner, {RefinedStencilOptions::Mode::Vertex, 0}, name);
            if (level > 2) continue;
            ExpectOsdsValues(*refiner, {RefinedStencilOptions::Mode::Varying, 0},
                             name + ", varying");
            if (!scene.HasUVs()) continue;
            ExpectOsdsValues(*refiner, {RefinedStencilOptions::Mode::FaceVarying, 0},
                             name + ", face-varying");
        }
    }
}

/// Six weight sets of a compiled table.
std::vector<float> EvaluateSets(CompiledStencils const& table, std::vector<float> const& source) {
    size_t const size = static_cast<size_t>(table.GetNumStencils()) * 3;
    std::vector<float> out(6 * size);
    float* const to = out.data();
    SimdEvaluator::EvalStencils(source.data(), Tight(3), to, Tight(3), to + size, Tight(3),
                                to + 2 * size, Tight(3), to + 3 * size, Tight(3), to + 4 * size,
                                Tight(3), to + 5 * size, Tight(3), table, 0,
                                table.GetNumStencils());
    return out;
}

TEST(SimdEvaluator, LimitsAndDerivativesEqualOpenSubdivOnEveryCage) {
    int numTables = 0;
    for (std::string const& shape : test::ListShapes()) {
        auto const scene = test::LoadShape(shape);
        for (int level = 1; level <= 4; ++level) {
            auto const refiner = far_ext::CreateRefiner(scene.cage);
            refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(level));
            auto const far = test::MakeFarLimitTable(*refiner);
            if (!far || far->GetNumStencils() == 0) continue;
            ++numTables;
            auto const source =
                test::MakeRandomValues(static_cast<size_t>(far->GetNumControlVertices()) * 3, 2);
            auto const expected = test::EvaluateSets<Osd::CpuEvaluator>(*far, source);
            std::string const name = fmt::format("{} level {}", shape, level);
            test::ExpectNearBySets(test::EvaluateSets<SimdEvaluator>(*far, source), expected, name);
            test::ExpectNearBySets(EvaluateSets(CompiledStencils::Compile(*far), source), expected,
                                   name + ", compiled");
        }
    }
    EXPECT_GT(numTables, 200);
}

TEST(SimdEvaluator, BuffersAndTablesGoInAsIntoOpenSubdivs) {
    auto const scene = test::LoadShape("catmark_cube");
    auto const refiner = test::RefineUniformly(scene.cage, 3);
    auto const far = MakeFarTable(*refiner, Factory::INTERPOLATE_VERTEX);
    std::vector<float> const positions(scene.positions.begin(), scene.positions.end());
    std::unique_ptr<Osd::CpuVertexBuffer> const source(
        Osd::CpuVertexBuffer::Create(3, scene.cage.numVertices)),
        ours(Osd::CpuVertexBuffer::Create(3, far->GetNumStencils())),
        theirs(Osd::CpuVertexBuffer::Create(3, far->GetNumStencils()));
    source->UpdateData(positions.data(), 0, scene.cage.numVertices);
    Osd::CpuEvaluator::EvalStencils(source.get(), Tight(3), theirs.get(), Tight(3), far.get());
    auto const expectEqual = [&] {
        size_t const size = static_cast<size_t>(far->GetNumStencils()) * 3;
        EXPECT_LT(
            test::RelativeDifference({ours->BindCpuBuffer(), ours->BindCpuBuffer() + size},
                                     {theirs->BindCpuBuffer(), theirs->BindCpuBuffer() + size}),
            1e-6);
    };
    EXPECT_TRUE(
        SimdEvaluator::EvalStencils(source.get(), Tight(3), ours.get(), Tight(3), far.get()));
    expectEqual();
    CompiledStencils const compiled(far_ext::BuildRefinedStencils(*refiner));
    EXPECT_TRUE(
        SimdEvaluator::EvalStencils(source.get(), Tight(3), ours.get(), Tight(3), &compiled));
    expectEqual();
}

/// OpenSubdiv's evaluator puts stencils start.. into row 0 (length 3), or the wrong ones into row
/// start (lengths 4 and 8).
TEST(SimdEvaluator, ASubRangeIsThoseRowsOfTheWhole) {
    auto const scene = test::LoadShape("catmark_dart_edgecorner");
    for (int level : {1, 3}) {
        auto const refiner = test::RefineUniformly(scene.cage, level);
        auto const far = MakeFarTable(*refiner, Factory::INTERPOLATE_VERTEX);
        CompiledStencils const compiled(far_ext::BuildRefinedStencils(*refiner));
        CompiledStencils const sliced(far_ext::BuildRefinedStencils(*refiner), {.isSliced = true});
        int const count = far->GetNumStencils();
        for (int length = 1; length <= 9; ++length) {
            auto const source = test::MakeRandomValues(
                static_cast<size_t>(far->GetNumControlVertices()) * length, 3);
            auto const whole = EvaluateCompiled(compiled, source, length),
                       slicedWhole = EvaluateCompiled(sliced, source, length);
            auto const rawWhole = EvaluateRaw(*far, source, length, 0, count);
            EXPECT_LT(test::RelativeDifference(slicedWhole, rawWhole), 1e-6) << length;
            for (auto const& [start, end] : {std::pair{0, 1},
                                             {1, 2},
                                             {7, 60},
                                             {count / 2, count},
                                             {5, 5},
                                             {count - 1, count}}) {
                auto const expected = [&](std::vector<float> values) {
                    std::fill(values.begin(), values.begin() + start * length, kUntouched);
                    std::fill(values.begin() + end * length, values.end(), kUntouched);
                    return values;
                };
                EXPECT_TRUE(AreSameBytes(EvaluateCompiled(compiled, source, length, start, end),
                                         expected(whole)))
                    << length;
                EXPECT_TRUE(AreSameBytes(EvaluateCompiled(sliced, source, length, start, end),
                                         expected(slicedWhole)))
                    << length;
                EXPECT_TRUE(
                    AreSameBytes(EvaluateRaw(*far, source, length, start, end), expected(rawWhole)))
                    << length;
                for (auto kind : {EvaluatorKind::OsdCpu, EvaluatorKind::Simd}) {
                    StencilEvaluator const evaluator(kind, far_ext::BuildRefinedStencils(*refiner));
                    std::vector<float> target(whole.size(), kUntouched);
                    evaluator.EvalStencils(source.data(), Tight(length),
                                           {{target.data(), Tight(length)}}, start, end);
                    EXPECT_LT(test::RelativeDifference(target, expected(whole)), 1e-6)
                        << GetName(kind) << length;
                }
            }
        }
    }
}

TEST(SimdEvaluator, StridesAndOffsetsAreKept) {
    auto const scene = test::LoadShape("catmark_edgeonly");
    for (int level : {1, 2, 4}) {
        auto const refiner = test::RefineUniformly(scene.cage, level);
        CompiledStencils const table(far_ext::BuildRefinedStencils(*refiner));
        for (int length = 1; length <= 6; ++length) {
            auto const tight = test::MakeRandomValues(
                static_cast<size_t>(table.GetNumControlVertices()) * length, 4);
            auto const expected = EvaluateCompiled(table, tight, length);
            BufferDescriptor const from(2, length, length + 3), to(1, length, length + 2);
            std::vector<float> source(
                static_cast<size_t>(table.GetNumControlVertices()) * from.stride,
                std::numeric_limits<float>::quiet_NaN());
            for (size_t i = 0; i < tight.size(); ++i)
                source[i / length * from.stride + 2 + i % length] = tight[i];
            std::vector<float> target(static_cast<size_t>(table.GetNumStencils()) * to.stride,
                                      kUntouched);
            SimdEvaluator::EvalStencils(source.data(), from, target.data(), to, table, 0,
                                        table.GetNumStencils());
            for (Index row = 0; row < table.GetNumStencils(); ++row) {
                float const* const values = &target[static_cast<size_t>(row) * to.stride];
                ASSERT_EQ(values[0], kUntouched);
                ASSERT_EQ(std::memcmp(values + 1, &expected[static_cast<size_t>(row) * length],
                                      sizeof(float) * length),
                          0);
                ASSERT_EQ(values[length + 1], kUntouched);
            }
        }
    }
}

TEST(SimdEvaluator, SameBytesOnEveryInstructionSetAndNumberOfThreads) {
    for (char const* shape : {"catmark_car", "loop_saddle_edgecorner"}) {
        auto const scene = test::LoadShape(shape);
        for (int level : {1, 3}) {
            auto const refiner = test::RefineUniformly(scene.cage, level);
            auto const far = MakeFarTable(*refiner, Factory::INTERPOLATE_VERTEX);
            CompiledStencils const compiled(far_ext::BuildRefinedStencils(*refiner));
            CompiledStencils const sliced(far_ext::BuildRefinedStencils(*refiner),
                                          {.isSliced = true});
            for (int length : {1, 3, 6}) {
                auto const source = test::MakeRandomValues(
                    static_cast<size_t>(far->GetNumControlVertices()) * length, 5);
                std::vector<float> first;
                test::ForEachInstructionSet([&](InstructionSet set) {
                    for (size_t threads : {1, 4}) {
                        tbb::global_control const limit(
                            tbb::global_control::max_allowed_parallelism, threads);
                        auto all = EvaluateCompiled(compiled, source, length);
                        auto const more = EvaluateCompiled(sliced, source, length),
                                   raw =
                                       EvaluateRaw(*far, source, length, 0, far->GetNumStencils());
                        all.insert(all.end(), more.begin(), more.end());
                        all.insert(all.end(), raw.begin(), raw.end());
                        if (first.empty()) first = all;
                        EXPECT_TRUE(AreSameBytes(all, first))
                            << shape << level << ", length " << length << ", " << GetName(set)
                            << threads;
                    }
                });
            }
        }
    }
}

TEST(SimdEvaluator, ManyThreadsMayCallAtOnce) {
    auto const refiner = test::RefineUniformly(test::LoadShape("catmark_cube_creases0").cage, 3);
    auto const far = MakeFarTable(*refiner, Factory::INTERPOLATE_VERTEX);
    CompiledStencils const compiled(far_ext::BuildRefinedStencils(*refiner));
    auto const source =
        test::MakeRandomValues(static_cast<size_t>(far->GetNumControlVertices()) * 3, 5);
    auto const expected = EvaluateCompiled(compiled, source, 3),
               expectedRaw = EvaluateRaw(*far, source, 3, 0, far->GetNumStencils());
    std::atomic<int> numRight = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 20; ++k) {
                numRight += AreSameBytes(EvaluateCompiled(compiled, source, 3), expected) &&
                            AreSameBytes(EvaluateRaw(*far, source, 3, 0, far->GetNumStencils()),
                                         expectedRaw);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(numRight, 4 * 20);
}

TEST(SimdEvaluator, DerivativesHaveTheSameBytesOnEveryInstructionSet) {
    auto const refiner = far_ext::CreateRefiner(test::LoadShape("catmark_cube_creases0").cage);
    refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(3));
    auto const far = test::MakeFarLimitTable(*refiner);
    auto const compiled = CompiledStencils::Compile(*far);
    EXPECT_EQ(compiled.GetNumSets(), 6);
    auto const source =
        test::MakeRandomValues(static_cast<size_t>(far->GetNumControlVertices()) * 3, 6);
    std::vector<float> first;
    test::ForEachInstructionSet([&](InstructionSet set) {
        auto const all = EvaluateSets(compiled, source);
        if (first.empty()) first = all;
        EXPECT_TRUE(AreSameBytes(all, first)) << GetName(set);
    });
}

TEST(SimdEvaluator, ManyRowsOfUnequalSizesAreSliced) {
    far_ext::StencilRows rows(50, 1);
    std::mt19937 random(8);
    for (int row = 0; row < 1003; ++row) {
        for (unsigned long k = 0, size = random() % 12; k < size; ++k) {
            float const weight = static_cast<float>(random()) * 0x1p-32f;
            rows.AddEntry(static_cast<Index>(random() % 50), &weight);
        }
        rows.EndRow();
    }
    auto const source = test::MakeRandomValues(50, 9);
    std::vector<float> expected(1003), raw(1003);
    SimdEvaluator::Apply(source.data(), Tight(1), {{raw.data(), Tight(1)}}, rows.GetView(), 0,
                         1003);
    for (int row = 0; row < 1003; ++row) {
        double sum = 0.0;
        for (int k = rows.GetOffsets()[row]; k < rows.GetOffsets()[row] + rows.GetSizes()[row];
             ++k) {
            sum += static_cast<double>(rows.GetWeights()[k]) * source[rows.GetControlIndices()[k]];
        }
        expected[row] = static_cast<float>(sum);
    }
    EXPECT_LT(test::RelativeDifference(raw, expected), 1e-6);
    for (bool isSliced : {false, true}) {
        auto const table = CompiledStencils::Compile(rows.GetView(), {isSliced});
        EXPECT_LT(test::RelativeDifference(EvaluateCompiled(table, source, 1), expected), 1e-6);
    }
}

TEST(SimdEvaluator, EmptyTablesAndRangesAreDoneAtOnce) {
    far_ext::StencilRows const none(4, 1);
    auto const table = CompiledStencils::Compile(none.GetView(), {});
    std::vector<float> const source(4, 1.0f);
    float target = kUntouched;
    EXPECT_TRUE(
        SimdEvaluator::EvalStencils(source.data(), Tight(1), &target, Tight(1), table, 0, 0));
    EXPECT_TRUE(SimdEvaluator::EvalStencils(source.data(), Tight(1), &target, Tight(1), nullptr,
                                            nullptr, nullptr, nullptr, 0, 0));
    EXPECT_EQ(target, kUntouched);
    EXPECT_EQ(table.GetNumStencils(), 0);
}

TEST(SimdEvaluator, BadInputIsRefused) {
    auto const refiner = test::RefineUniformly(test::MakeCube().cage, 2);
    auto const far = MakeFarTable(*refiner, Factory::INTERPOLATE_VERTEX);
    auto const table = CompiledStencils::Compile(*far);
    std::vector<float> const source(64, 1.0f);
    std::vector<float> target(1000);
    auto const evaluate = [&](BufferDescriptor const& from, BufferDescriptor const& to, int start,
                              int end) {
        SimdEvaluator::EvalStencils(source.data(), from, target.data(), to, table, start, end);
    };
    EXPECT_THROW(evaluate(Tight(3), Tight(4), 0, 1), Error);
    EXPECT_THROW(evaluate(Tight(0), Tight(0), 0, 1), Error);
    EXPECT_THROW(evaluate({0, 3, 2}, Tight(3), 0, 1), Error);
    EXPECT_THROW(evaluate(Tight(3), {-1, 3, 3}, 0, 1), Error);
    EXPECT_THROW(evaluate(Tight(3), Tight(3), -1, 1), Error);
    EXPECT_THROW(evaluate(Tight(3), Tight(3), 0, table.GetNumStencils() + 1), Error);
    float* const nowhere = nullptr;
    EXPECT_THROW(
        SimdEvaluator::EvalStencils(source.data(), Tight(3), nowhere, Tight(3), table, 0, 1),
        Error);
    float* const to = target.data();
    EXPECT_THROW(SimdEvaluator::EvalStencils(source.data(), Tight(3), to, Tight(3), to, Tight(3),
                                             to, Tight(3), table, 0, 1),
                 Error)
        << "no derivatives in this table";
    Osd::CpuVertexBuffer* volatile noBuffer = nullptr;  // or g++ 12 warns of it
    EXPECT_THROW(SimdEvaluator::EvalStencils(noBuffer, Tight(3), noBuffer, Tight(3), &table),
                 Error);
    far_ext::StencilGroups wide;
    wide.blocks.push_back({1, 1000, 0});
    EXPECT_THROW(CompiledStencils{wide}, Error);
    StencilEvaluator const reference(EvaluatorKind::OsdCpu,
                                     far_ext::BuildRefinedStencils(*refiner));
    EXPECT_THROW(reference.EvalStencils(source.data(), Tight(3), {{to, Tight(4)}}, 0, 1), Error);
    EXPECT_THROW(reference.EvalStencils(source.data(), Tight(3), {{to, Tight(3)}}, 0, 10000),
                 Error);
}

TEST(SimdEvaluator, BadTablesAreRefused) {
    auto const compile = [](Index control, float weight) {
        far_ext::StencilRows rows(3, 1);
        rows.AddEntry(control, &weight);
        rows.EndRow();
        CompiledStencils::Compile(rows.GetView(), {});
    };
    EXPECT_NO_THROW(compile(2, 1.0f));
    EXPECT_THROW(compile(3, 1.0f), Error);
    EXPECT_THROW(compile(-1, 1.0f), Error);
    EXPECT_THROW(compile(0, std::numeric_limits<float>::quiet_NaN()), Error);
    EXPECT_THROW(compile(0, std::numeric_limits<float>::infinity()), Error);
    far_ext::StencilRowsView lacking;
    lacking.numRows = 1;
    EXPECT_THROW(CompiledStencils::Compile(lacking, {}), Error);
}

}  // namespace
}  // namespace limn::eval
