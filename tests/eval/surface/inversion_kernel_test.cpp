// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/inversion_kernel.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "eval/kernels/dispatch.h"
#include "support/instruction_sets.h"

namespace limn {
namespace {

constexpr int kNumTexels = 5 * eval::kInversionLanes;

/// u = 40 x + 6 x y + 2 x^3, v = 30 y - 3 x y about the middle of a quad's domain.
struct Map {
    double coefficients[2][16] = {};

    Map() {
        coefficients[0][1] = 40.0;
        coefficients[0][5] = 6.0;
        coefficients[0][3] = 2.0;
        coefficients[1][4] = 30.0;
        coefficients[1][5] = -3.0;
    }

    static double GetU(double x, double y) { return 40.0 * x + 6.0 * x * y + 2.0 * x * x * x; }
    static double GetV(double x, double y) { return 30.0 * y - 3.0 * x * y; }

    /// The whole domain as one cell.
    eval::InversionCell MakeCell() const {
        eval::InversionCell cell{};
        cell.coefficients = coefficients[0];
        cell.inverse[0] = 1.0 / 40.0;
        cell.inverse[3] = 1.0 / 30.0;
        cell.area = 1200.0;
        cell.reach = 0.5;
        cell.bend = 0.02;  // |J^-1|^2 times the second derivatives, 12 x and 6
        cell.centre = 0.5;
        cell.outside = 0.1;
        cell.tolerance = 1e-3;
        return cell;
    }
};

struct Answers {
    std::vector<double> x = std::vector<double>(kNumTexels), y = x;
    std::vector<eval::Whereabouts> where = std::vector<eval::Whereabouts>(kNumTexels);
    bool operator==(Answers const&) const = default;
};

/// Texels along a diagonal of the domain, and a little beyond its ends.
Answers Invert() {
    Map const map;
    std::vector<double> u(kNumTexels), v(kNumTexels);
    for (int i = 0; i < kNumTexels; ++i) {
        double const x = -0.51 + 1.02 * i / (kNumTexels - 1), y = 0.9 * x;
        u[i] = Map::GetU(x, y);
        v[i] = Map::GetV(x, y);
    }
    auto const& kernel = eval::GetKernel<eval::InversionKernel>();
    eval::InversionCell cell = map.MakeCell();
    kernel.fitInverse(cell);
    Answers answers;
    kernel.invertMap(cell, u.data(), v.data(), kNumTexels, answers.x.data(), answers.y.data(),
                     answers.where.data());
    return answers;
}

TEST(InversionKernel, FindsThePlaceOfEachTexel) {
    Answers const answers = Invert();
    for (int i = 0; i < kNumTexels; ++i) {
        double const x = -0.51 + 1.02 * i / (kNumTexels - 1), y = 0.9 * x;
        EXPECT_NEAR(answers.x[i], x, 1e-7) << i;
        EXPECT_NEAR(answers.y[i], y, 1e-7) << i;
        bool const isInside = std::abs(x) < 0.5;
        EXPECT_EQ(answers.where[i], isInside ? eval::Whereabouts::Inside : eval::Whereabouts::Edge)
            << i;
    }
}

TEST(InversionKernel, EveryInstructionSetGivesTheSameBits) {
    Answers const expected = Invert();
    test::ForEachInstructionSet(
        [&](eval::InstructionSet set) { EXPECT_EQ(Invert(), expected) << eval::GetName(set); });
}

}  // namespace
}  // namespace limn
