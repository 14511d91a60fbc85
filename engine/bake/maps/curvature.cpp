// SPDX-License-Identifier: Apache-2.0
//
// Curvature of the limit surface, in 1/length: its principal values, what they make, and all at
// once.

#include <algorithm>
#include <cmath>

#include "engine/bake/maps/map_table.h"
#include "engine/bake/maps/portable_math.h"

namespace limn::engine {

namespace {

template <int Channel>
void Copy(SampleBlock const& block, float* out, size_t) {
    std::copy_n(block.GetPlane(Channel), block.GetCount(), out);
}

void CopyAll(SampleBlock const& block, float* out, size_t outStride) {
    for (int channel : {eval::kK1, eval::kK2, eval::kMean, eval::kGaussian}) {
        std::copy_n(block.GetPlane(channel), block.GetCount(), out);
        out += outStride;
    }
}

/// The root of the mean square of k1 and k2. Squares of what floats hold may be beyond floats.
float GetCurvedness(float k1, float k2) {
    float const square = 0.5f * (k1 * k1 + k2 * k2);
    if (std::isfinite(square)) return std::sqrt(square);
    double const a = k1, b = k2;
    return static_cast<float>(std::sqrt(0.5 * (a * a + b * b)));
}

void FindCurvedness(SampleBlock const& block, float* out, size_t) {
    float const *const k1 = block.GetPlane(eval::kK1), *const k2 = block.GetPlane(eval::kK2);
    for (size_t i = 0; i < block.GetCount(); ++i) out[i] = GetCurvedness(k1[i], k2[i]);
}

/// 2/pi arctan((k1 + k2) / (k1 - k2)), from -1 (cup) over 0 (saddle) to 1 (cap); 0 where flat.
void FindShapeIndex(SampleBlock const& block, float* out, size_t) {
    float const *const k1 = block.GetPlane(eval::kK1), *const k2 = block.GetPlane(eval::kK2);
    for (size_t i = 0; i < block.GetCount(); ++i) {
        bool const isFlat = k1[i] == 0.0f && k2[i] == 0.0f;
        out[i] = isFlat ? 0.0f : PortableAtan2(k1[i] + k2[i], k1[i] - k2[i]) * 0.63661977236758134f;
    }
}

struct Row {
    char const* name;
    char const* units;
    RangeKind range;
    EvaluateBlock evaluate;
};

constexpr Row kRows[] = {
    {"mean", "1/length", RangeKind::Signed, Copy<eval::kMean>},
    {"gaussian", "1/length^2", RangeKind::Signed, Copy<eval::kGaussian>},
    {"k1", "1/length", RangeKind::Signed, Copy<eval::kK1>},
    {"k2", "1/length", RangeKind::Signed, Copy<eval::kK2>},
    {"curvedness", "1/length", RangeKind::Positive, FindCurvedness},
    {"shape-index", "none", RangeKind::Signed, FindShapeIndex},
    {"curvature", "1/length, gaussian 1/length^2", RangeKind::Signed, CopyAll}};

}  // namespace

std::unique_ptr<Map> MakeCurvatureMap(std::string const& name, MapOptions const&, Model const&) {
    Row const& row = *std::find_if(std::begin(kRows), std::end(kRows),
                                   [&](Row const& r) { return name == r.name; });
    MapTraits traits{.name = name, .channels = {"Y"}, .units = row.units, .range = row.range};
    traits.quantity = eval::Quantity::Curvature;
    if (name == "shape-index") traits.limits = {-1.0f, 1.0f};
    if (name == "curvature") traits.channels = {"k1", "k2", "mean", "gaussian"};
    return MakePointwiseMap(std::move(traits), row.evaluate);
}

}  // namespace limn::engine
