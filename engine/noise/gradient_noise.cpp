// SPDX-License-Identifier: Apache-2.0
#include "engine/noise/gradient_noise.h"

#include <cmath>

namespace limn::engine {

namespace {

/// Mixes 64 bits so that each depends on all: a multiply-and-shift finaliser.
uint64_t Mix(uint64_t h) {
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93ull;
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93ull;
    return h ^ (h >> 32);
}

/// The product of a lattice point's gradient, a vector with components in [-1, 1], and an offset
/// from it.
double Slope(uint64_t seed, int64_t i, int64_t j, int64_t k, double x, double y, double z) {
    uint64_t hash = Mix(seed ^ Mix(static_cast<uint64_t>(i)));
    hash = Mix(hash ^ static_cast<uint64_t>(j));
    hash = Mix(hash ^ static_cast<uint64_t>(k));
    // 21 bits per component; vectors from a cube are close enough to even in direction, and their
    // mean square is that of the cube's: 1/3 per component.
    auto const component = [&](int shift) {
        return static_cast<double>((hash >> shift) & 0x1fffff) * (2.0 / 0x1fffff) - 1.0;
    };
    return component(0) * x + component(21) * y + component(42) * z;
}

/// 6 t^5 - 15 t^4 + 10 t^3: from 0 to 1 with two derivatives 0 at both ends.
double Fade(double t) {
    return t * t * t * ((6.0 * t - 15.0) * t + 10.0);
}

double Blend(double a, double b, double t) {
    return a + t * (b - a);
}

}  // namespace

double GradientNoise(uint64_t seed, double x, double y, double z) {
    constexpr double kWhole = 4503599627370496.0;  // 2^52
    if (!(std::abs(x) < kWhole && std::abs(y) < kWhole && std::abs(z) < kWhole)) return 0.0;
    double const fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
    auto const i = static_cast<int64_t>(fx), j = static_cast<int64_t>(fy),
               k = static_cast<int64_t>(fz);
    double const u = x - fx, v = y - fy, w = z - fz;
    double corner[2][2][2];
    for (int c = 0; c < 2; ++c) {
        for (int b = 0; b < 2; ++b) {
            for (int a = 0; a < 2; ++a)
                corner[c][b][a] = Slope(seed, i + a, j + b, k + c, u - a, v - b, w - c);
        }
    }
    double const s = Fade(u), t = Fade(v), r = Fade(w);
    double const low = Blend(Blend(corner[0][0][0], corner[0][0][1], s),
                             Blend(corner[0][1][0], corner[0][1][1], s), t);
    double const high = Blend(Blend(corner[1][0][0], corner[1][0][1], s),
                              Blend(corner[1][1][0], corner[1][1][1], s), t);
    // In a cell's middle all eight products can reach 3/2.
    return Blend(low, high, r) * (2.0 / 3.0);
}

}  // namespace limn::engine
