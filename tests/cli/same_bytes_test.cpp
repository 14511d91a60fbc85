// SPDX-License-Identifier: Apache-2.0
//
// The same input gives the same bytes, however it is computed.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

/// Bytes of a bake of everything that can depend on how it was computed.
class SameBytes : public Cli {
protected:
    std::string BytesOf(std::string const& mesh, Words const& more,
                        test::RunOptions const& options = {}) const {
        Words const all{
            "--maps",
            "position,normal,curvature,principal-direction,curvedness,shape-index,stretch",
            "--size",
            "160x96",
            "--samples",
            "2",
            "--padding",
            "70",
            "--mip",
            "--coverage"};
        Outcome const outcome = Bake(mesh, "a.exr", all + more, options);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return outcome.status == 0 ? test::ReadText(folder / "a.exr") : outcome.err;
    }
    std::string BytesOfEval(test::RunOptions const& options) const {
        std::string places = "face,s,t\n";
        for (int i = 0; i < 600; ++i)
            places += fmt::format("{},0.{},0.{}\n", i % 32, (i * 7) % 10, (i * 3) % 10);
        Outcome const outcome = Limn({"eval", Shape("catmark_torus_creases0"), "--at",
                                      folder.Write("p.csv", places), "--precision", "double"},
                                     options);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return outcome.out;
    }
};

TEST_F(SameBytes, ForAnyNumberOfThreads) {
    for (std::string const shape :
         {"catmark_torus_creases0", "catmark_cube_corner2", "catmark_nonquads"}) {
        std::string const one = BytesOf(Shape(shape), {"--threads", "1"});
        EXPECT_TRUE(one == BytesOf(Shape(shape), {"--threads", "4"})) << shape;
        EXPECT_TRUE(one == BytesOf(Shape(shape), {"--threads", "3"})) << shape;
    }
}

TEST_F(SameBytes, ForEveryInstructionSet) {
    for (std::string const shape :
         {"catmark_torus_creases0", "catmark_cube_corner2", "catmark_nonquads"}) {
        std::string const plain = BytesOf(Shape(shape), {}, {.environment = {"LIMN_SIMD=sse2"}});
        for (std::string const set : {"avx2", "avx512"}) {
            EXPECT_TRUE(plain == BytesOf(Shape(shape), {}, {.environment = {"LIMN_SIMD=" + set}}))
                << shape << " " << set;
        }
    }
    EXPECT_EQ(BytesOfEval({.environment = {"LIMN_SIMD=sse2"}}),
              BytesOfEval({.environment = {"LIMN_SIMD=avx512"}}));
}

TEST_F(SameBytes, WhateverMathTheCLibraryChooses) {
    // glibc picks its versions of sin, exp, ... by CPU; this hides the wide ones from it.
    test::RunOptions const old{
        .environment = {"GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-AVX512F,-FMA,-AVX512VL,-FMA4"}};
    for (std::string const shape :
         {"catmark_torus_creases0", "catmark_cube_corner2", "catmark_nonquads"}) {
        EXPECT_TRUE(BytesOf(Shape(shape), {}) == BytesOf(Shape(shape), {}, old)) << shape;
    }
    EXPECT_EQ(BytesOfEval({}), BytesOfEval(old));
}

TEST_F(SameBytes, WhereverTheMeshAndTheOutputLie) {
    folder.Write("copy.obj", test::ReadText(Shape("catmark_cube")));
    EXPECT_TRUE(BytesOf(Shape("catmark_cube"), {}) ==
                BytesOf("copy.obj", {}, {.folder = folder.GetPath()}));
}

}  // namespace
}  // namespace limn
