// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/maps/portable_math.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace limn::engine {

float PortableAtan2(float y, float x) {
    double const ax = std::abs(static_cast<double>(x)), ay = std::abs(static_cast<double>(y));
    double const large = std::max(ax, ay), small = std::min(ax, ay);
    if (large == 0.0) return 0.0f;
    constexpr double kPi = 3.14159265358979323846;
    // atan(r) for r in [0, 1]: fold at tan(pi/8), then the series of the small rest.
    double r = small / large, base = 0.0;
    constexpr double kTan = 0.41421356237309503;
    if (r > kTan) {
        base = kPi / 4;
        r = (r - 1.0) / (r + 1.0);
    }
    double const z = r * r;
    double sum = 0.0;
    for (int k = 21; k >= 1; k -= 2) sum = sum * -z + 1.0 / k;
    double angle = base + r * sum;
    if (ay > ax) angle = kPi / 2 - angle;
    if (x < 0.0f) angle = kPi - angle;
    return static_cast<float>(y < 0.0f ? -angle : angle);
}

float PortableLog2(float x) {
    auto const bits = std::bit_cast<uint64_t>(static_cast<double>(x));
    int exponent = static_cast<int>(bits >> 52) - 1023;
    double mantissa = std::bit_cast<double>((bits & 0xfffffffffffffull) | 0x3ff0000000000000ull);
    if (mantissa > 1.4142135623730951) {
        mantissa *= 0.5;
        ++exponent;
    }
    // ln m = 2 artanh((m - 1) / (m + 1)), |argument| < 0.172
    double const r = (mantissa - 1.0) / (mantissa + 1.0), z = r * r;
    double sum = 0.0;
    for (int k = 15; k >= 1; k -= 2) sum = sum * z + 1.0 / k;
    constexpr double kTwoOverLn2 = 2.8853900817779268;
    return static_cast<float>(exponent + kTwoOverLn2 * r * sum);
}

}  // namespace limn::engine
