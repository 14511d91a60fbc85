// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/maps/maps.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

using eval::Quantity;

namespace {

struct MapRow {
    char const* name;
    MapKind kind;
    std::vector<std::string> channels;
    Averaging averaging;
    bool isSigned;
    char const* units;
    Quantity quantity;
};

std::vector<MapRow> const& GetTable() {
    static std::vector<std::string> const y{"Y"}, rgb{"R", "G", "B"};
    static std::vector<MapRow> const table{
        {"mean", MapKind::Mean, y, Averaging::Plain, true, "1/length", Quantity::Curvature},
        {"gaussian", MapKind::Gaussian, y, Averaging::Plain, true, "1/length^2",
         Quantity::Curvature},
        {"k1", MapKind::K1, y, Averaging::Plain, true, "1/length", Quantity::Curvature},
        {"k2", MapKind::K2, y, Averaging::Plain, true, "1/length", Quantity::Curvature},
        {"curvedness", MapKind::Curvedness, y, Averaging::Plain, false, "1/length",
         Quantity::Curvature},
        {"shape-index", MapKind::ShapeIndex, y, Averaging::Plain, true, "none",
         Quantity::Curvature},
        {"curvature",
         MapKind::Curvature,
         {"k1", "k2", "mean", "gaussian"},
         Averaging::Plain,
         true,
         "1/length, gaussian 1/length^2",
         Quantity::Curvature},
        {"principal-direction", MapKind::PrincipalDirection, rgb, Averaging::Line, true,
         "unit vector", Quantity::Direction},
        {"position", MapKind::Position, rgb, Averaging::Plain, true, "length", Quantity::Position},
        {"normal", MapKind::Normal, rgb, Averaging::UnitVector, true, "unit vector",
         Quantity::Normal},
        {"displacement", MapKind::Displacement, y, Averaging::Plain, true, "length",
         Quantity::Normal},
        {"stretch", MapKind::Stretch, y, Averaging::Plain, true, "log2", Quantity::Tangents},
        {"bands", MapKind::Bands, {}, Averaging::Plain, true, "length", Quantity::Normal},
        {"noise", MapKind::Noise, y, Averaging::Plain, true, "amplitude", Quantity::Position},
        {"field", MapKind::Field, rgb, Averaging::Plain, true, "as the form per length",
         Quantity::Position},
    };
    return table;
}

std::string ListNames() {
    std::string names;
    for (MapRow const& row : GetTable()) names += std::string(row.name) + ", ";
    return names + "primvar:NAME";
}

Map MakePrimvarMap(std::string const& name, Scene const& scene) {
    std::string const wanted = name.substr(std::string("primvar:").size());
    int channel = 3;
    for (Primvar const& primvar : scene.primvars) {
        if (primvar.name != wanted) {
            channel += primvar.numChannels;
            continue;
        }
        Map map{MapKind::Primvar,   name,   {}, Averaging::Plain, false, "as in the mesh",
                Quantity::Position, channel};
        static char const* const kNames[] = {"R", "G", "B", "A"};
        if (primvar.numChannels == 1)
            map.channels = {"Y"};
        else
            for (int c = 0; c < primvar.numChannels; ++c) map.channels.push_back(kNames[c]);
        return map;
    }
    std::string known;
    for (Primvar const& primvar : scene.primvars)
        known += (known.empty() ? "" : ", ") + primvar.name;
    throw Error(ErrorCode::BadOption,
                fmt::format("--maps: '{}' has no primvar '{}'; it has: {}", scene.path, wanted,
                            known.empty() ? "none" : known));
}

/// Vectors in object space, or the flow in texture coordinates.
void ChooseFieldChannels(MapOptions const& options, Map& map) {
    if (!options.hasField)
        throw Error(ErrorCode::BadOption,
                    "--maps field needs --field EDGES.csv, as limn field writes it");
    if (options.space == MapSpace::Tangent)
        throw Error(ErrorCode::BadOption,
                    "--maps field: use --space object or uv; its vectors are tangents already");
    if (options.isNormalized) {
        map.averaging = Averaging::UnitVector;
        map.units = "unit vector";
    }
    if (options.space != MapSpace::UV) return;
    map.channels = {"R", "G"};
    map.quantity = Quantity::Tangents;
    if (!options.isNormalized) map.units = "texture coordinates per unit of time";
}

}  // namespace

std::vector<Map> MakeMaps(MapOptions const& options, Scene const& scene) {
    int numPrimvarChannels = 0;
    for (Primvar const& primvar : scene.primvars) numPrimvarChannels += primvar.numChannels;
    std::vector<Map> maps;
    for (std::string const& name : options.names) {
        auto const isSame = [&](Map const& map) { return map.name == name; };
        if (std::any_of(maps.begin(), maps.end(), isSame)) {
            throw Error(ErrorCode::BadOption, fmt::format("--maps: '{}' is asked for twice", name));
        }
        if (name.starts_with("primvar:")) {
            maps.push_back(MakePrimvarMap(name, scene));
            continue;
        }
        auto const row = std::find_if(GetTable().begin(), GetTable().end(),
                                      [&](MapRow const& r) { return name == r.name; });
        if (row == GetTable().end()) {
            throw Error(
                ErrorCode::BadOption,
                fmt::format("--maps: there is no map '{}'; there are: {}", name, ListNames()));
        }
        Map map{row->kind,     name,       row->channels, row->averaging,
                row->isSigned, row->units, row->quantity, 0};
        if (map.kind == MapKind::Displacement) {
            if (!options.hasOtherMesh) {
                throw Error(ErrorCode::BadOption, "--maps displacement needs --against MESH");
            }
            bool const hasBands = std::find(options.names.begin(), options.names.end(), "bands") !=
                                  options.names.end();
            map.extraChannel =
                3 + numPrimvarChannels + (hasBands ? GetNumBandChannels(options) : 0);
            if (options.isVector) map.channels = {"R", "G", "B"};
        }
        if (map.kind == MapKind::Bands) {
            map.extraChannel = 3 + numPrimvarChannels;
            for (int band = 1; band <= options.numBands; ++band) {
                std::string const part =
                    band < options.numBands ? fmt::format("band{}", band) : "remainder";
                for (char const* axis : {".R", ".G", ".B"}) {
                    if (options.isVector) map.channels.push_back(part + axis);
                }
                if (!options.isVector) map.channels.push_back(part);
            }
        }
        bool const isVector =
            options.isVector && (map.kind == MapKind::Displacement || map.kind == MapKind::Bands);
        if (isVector && options.space == MapSpace::Tangent) map.quantity = Quantity::Tangents;
        if (map.kind == MapKind::Noise && (options.ramp || options.isNormalized)) {
            map.isSigned = false;
            map.units = options.ramp ? "colour" : "share of the range";
            if (options.ramp) map.channels = {"R", "G", "B"};
        }
        if (map.kind == MapKind::Field)
            ChooseFieldChannels(options, map);
        else if (options.space == MapSpace::UV)
            throw Error(ErrorCode::BadOption,
                        fmt::format("--space uv is for the map field alone, not for '{}'", name));
        map.zero = options.hasEncoding ? static_cast<float>(options.encodeOffset) : 0.0f;
        maps.push_back(std::move(map));
    }
    if (maps.empty())
        throw Error(ErrorCode::BadOption, fmt::format("--maps: choose from {}", ListNames()));
    return maps;
}

eval::Quantity FindQuantity(std::span<Map const> maps) {
    Quantity most = Quantity::Position;
    for (Map const& map : maps) most = std::max(most, map.quantity);
    return most;
}

bool NeedsJacobian(Map const& map, MapOptions const& options) {
    bool const isDisplacement = map.kind == MapKind::Displacement || map.kind == MapKind::Bands;
    if (map.kind == MapKind::Field) return options.space == MapSpace::UV;
    return map.kind == MapKind::Stretch ||
           (isDisplacement && options.isVector && options.space == MapSpace::Tangent);
}

int GetNumBandChannels(MapOptions const& options) {
    return 3 * options.numBands;
}

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

namespace {

using eval::SurfaceChannel;

float ShapeIndex(float k1, float k2) {
    if (k1 == 0.0f && k2 == 0.0f) return 0.0f;
    return PortableAtan2(k1 + k2, k1 - k2) * 0.63661977236758134f;
}

Eigen::Vector3d GetVector(MapSamples const& samples, size_t channel, size_t i) {
    float const* const at = samples.planes + channel * samples.stride + i;
    return {at[0], at[samples.stride], at[2 * samples.stride]};
}

/// A displacement as it is asked for: along the normal, or as a vector in object or tangent space.
void PutDisplacement(MapOptions const& options, MapSamples const& samples, size_t i,
                     Eigen::Vector3d const& displacement, float* out, size_t outStride) {
    Eigen::Vector3d const normal = GetVector(samples, eval::kNormalX, i);
    if (!options.isVector) {
        out[i] = static_cast<float>(displacement.dot(normal));
        return;
    }
    Eigen::Vector3d result = displacement;
    if (options.space == MapSpace::Tangent) {
        // dP/du = P_s s_u + P_t t_u, with d(s,t)/d(u,v) the inverse of the Jacobian.
        auto const& [us, ut, vs, vt] = samples.jacobians[i];
        double const det = us * vt - ut * vs;
        double const sign = det < 0.0 ? -1.0 : 1.0;
        Eigen::Vector3d along = sign * (vt * GetVector(samples, eval::kTangentSX, i) -
                                        vs * GetVector(samples, eval::kTangentTX, i));
        along -= along.dot(normal) * normal;
        double const length = along.norm();
        along = length > 0.0 ? Eigen::Vector3d(along / length) : normal.unitOrthogonal();
        result = {displacement.dot(along), displacement.dot(normal.cross(along)),
                  displacement.dot(normal)};
    }
    for (size_t c = 0; c < 3; ++c)
        out[c * outStride + i] = static_cast<float>(result[static_cast<int>(c)]);
}

/// Where the tree's channel `extraChannel` is among the planes.
size_t FindPlane(MapSamples const& samples, int extraChannel) {
    return static_cast<size_t>(eval::GetNumChannels(samples.quantity) + extraChannel - 3);
}

void EvaluateBands(Map const& map, MapOptions const& options, MapSamples const& samples, float* out,
                   size_t outStride) {
    size_t const first = FindPlane(samples, map.extraChannel),
                 numChannels = options.isVector ? 3 : 1;
    for (size_t band = 0; band < static_cast<size_t>(options.numBands);
         ++band, out += numChannels * outStride) {
        for (size_t i = 0; i < samples.count; ++i) {
            PutDisplacement(options, samples, i, GetVector(samples, first + 3 * band, i), out,
                            outStride);
        }
    }
}

float Stretch(MapSamples const& samples, size_t i) {
    auto const& jacobian = samples.jacobians[i];
    double const area = GetVector(samples, eval::kTangentSX, i)
                            .cross(GetVector(samples, eval::kTangentTX, i))
                            .norm();
    double const texture = std::abs(jacobian[0] * jacobian[3] - jacobian[1] * jacobian[2]);
    double const ratio = area / (texture * samples.meanArea);
    // A point without area or without texture area has no stretch; the bounds keep it a number.
    if (!(ratio > 0x1p-60)) return -60.0f;
    return ratio < 0x1p60 ? PortableLog2(static_cast<float>(ratio)) : 60.0f;
}

void EvaluateNoise(MapOptions const& options, MapSamples const& samples, float* out,
                   size_t outStride) {
    double const low = samples.noiseLow, range = samples.noiseHigh - low;
    for (size_t i = 0; i < samples.count; ++i) {
        double const value = samples.noise[i];
        double const share = range > 0.0 ? std::clamp((value - low) / range, 0.0, 1.0) : 0.5;
        if (options.ramp) {
            auto const colour = options.ramp->Evaluate(share);
            for (size_t c = 0; c < 3; ++c) out[c * outStride + i] = static_cast<float>(colour[c]);
        } else {
            out[i] = static_cast<float>(options.isNormalized ? share : value);
        }
    }
}

/// d(u,v) along a tangent vector a P_s + b P_t.
Eigen::Vector2d FindFlow(MapSamples const& samples, size_t i) {
    Eigen::Vector3d const ds = GetVector(samples, eval::kTangentSX, i),
                          dt = GetVector(samples, eval::kTangentTX, i);
    Eigen::Vector3d const& v = samples.field[i];
    double const e = ds.squaredNorm(), f = ds.dot(dt), g = dt.squaredNorm(),
                 determinant = e * g - f * f;
    if (!(determinant > 1e-14 * e * g)) return Eigen::Vector2d::Zero();
    double const a = (g * ds.dot(v) - f * dt.dot(v)) / determinant,
                 b = (e * dt.dot(v) - f * ds.dot(v)) / determinant;
    auto const& [us, ut, vs, vt] = samples.jacobians[i];
    return {us * a + ut * b, vs * a + vt * b};
}

void EvaluateField(MapOptions const& options, MapSamples const& samples, float* out,
                   size_t outStride) {
    for (size_t i = 0; i < samples.count; ++i) {
        Eigen::Vector3d vector = samples.field[i];
        if (options.space == MapSpace::UV) vector << FindFlow(samples, i), 0.0;
        double const length = vector.norm();
        if (options.isNormalized && length > 0.0) vector /= length;
        for (int c = 0; c < (options.space == MapSpace::UV ? 2 : 3); ++c)
            out[static_cast<size_t>(c) * outStride + i] = static_cast<float>(vector[c]);
    }
}

}  // namespace

void EvaluateMap(Map const& map, MapOptions const& options, MapSamples const& samples, float* out,
                 size_t outStride) {
    float const* const planes = samples.planes;
    size_t const stride = samples.stride, count = samples.count;
    auto const copy = [&](int channel, int to) {
        std::copy_n(planes + static_cast<size_t>(channel) * stride, count,
                    out + static_cast<size_t>(to) * outStride);
    };
    auto const copyVector = [&](int channel) {
        for (int c = 0; c < 3; ++c) copy(channel + c, c);
    };
    float const* const k1 = planes + eval::kK1 * stride;
    float const* const k2 = planes + eval::kK2 * stride;
    switch (map.kind) {
        case MapKind::Mean:
            copy(eval::kMean, 0);
            break;
        case MapKind::Gaussian:
            copy(eval::kGaussian, 0);
            break;
        case MapKind::K1:
            copy(eval::kK1, 0);
            break;
        case MapKind::K2:
            copy(eval::kK2, 0);
            break;
        case MapKind::Curvature:
            copy(eval::kK1, 0);
            copy(eval::kK2, 1);
            copy(eval::kMean, 2);
            copy(eval::kGaussian, 3);
            break;
        case MapKind::Curvedness:
            for (size_t i = 0; i < count; ++i)
                out[i] = std::sqrt(0.5f * (k1[i] * k1[i] + k2[i] * k2[i]));
            break;
        case MapKind::ShapeIndex:
            for (size_t i = 0; i < count; ++i) out[i] = ShapeIndex(k1[i], k2[i]);
            break;
        case MapKind::PrincipalDirection:
            copyVector(eval::kDirectionX);
            break;
        case MapKind::Position:
            copyVector(eval::kPositionX);
            break;
        case MapKind::Normal:
            copyVector(eval::kNormalX);
            break;
        case MapKind::Displacement:
            for (size_t i = 0; i < count; ++i) {
                Eigen::Vector3d const there =
                    samples.other.empty()
                        ? GetVector(samples, FindPlane(samples, map.extraChannel), i)
                        : samples.other[i];
                PutDisplacement(options, samples, i,
                                there - GetVector(samples, eval::kPositionX, i), out, outStride);
            }
            break;
        case MapKind::Stretch:
            for (size_t i = 0; i < count; ++i) out[i] = Stretch(samples, i);
            break;
        case MapKind::Primvar:
            for (int c = 0; c < map.GetNumChannels(); ++c) {
                copy(static_cast<int>(FindPlane(samples, map.extraChannel)) + c, c);
            }
            break;
        case MapKind::Bands:
            EvaluateBands(map, options, samples, out, outStride);
            break;
        case MapKind::Noise:
            EvaluateNoise(options, samples, out, outStride);
            break;
        case MapKind::Field:
            EvaluateField(options, samples, out, outStride);
            break;
    }
    if (options.hasEncoding) {
        auto const scale = static_cast<float>(options.encodeScale);
        auto const offset = static_cast<float>(options.encodeOffset);
        for (int c = 0; c < map.GetNumChannels(); ++c) {
            float* const plane = out + static_cast<size_t>(c) * outStride;
            for (size_t i = 0; i < count; ++i) plane[i] = plane[i] * scale + offset;
        }
    }
}

}  // namespace limn::engine
