// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/bake/uv_raster.h"
#include "engine/images/colour_ramp.h"
#include "engine/scene/scene.h"
#include "eval/surface/surface_kernel.h"

namespace limn::engine {

enum class MapKind {
    Mean,
    Gaussian,
    K1,
    K2,
    Curvedness,
    ShapeIndex,
    Curvature,
    PrincipalDirection,
    Position,
    Normal,
    Displacement,
    Stretch,
    Primvar,
    Noise,
    Bands,
    Field
};

/// How texels of a map are averaged (supersampling, mip levels): plainly, or as what they are.
enum class Averaging { Plain, UnitVector, Line };

enum class MapSpace { Object, Tangent, UV };

/// One map of a bake: what is measured, and the channels it fills [Bake 5].
struct Map {
    MapKind kind;
    std::string name;                   ///< as the user wrote it
    std::vector<std::string> channels;  ///< EXR names within the map, e.g. "R", "G", "B"
    Averaging averaging = Averaging::Plain;
    bool isSigned = true;
    std::string units;
    eval::Quantity quantity;  ///< what it needs of the surface
    int extraChannel =
        0;  ///< of the tree's values: where a primvar, the bands or the other mesh start
    float zero = 0.0f;  ///< what 0 is written as: the offset of --encode

    int GetNumChannels() const { return static_cast<int>(channels.size()); }
};

struct MapOptions {
    std::vector<std::string> names;
    bool isVector = false;  ///< --vector
    MapSpace space = MapSpace::Object;
    bool hasOtherMesh = false;  ///< --against was given
    int numBands = 4;           ///< --bands: of the map 'bands', its smooth base included
    bool hasEncoding = false;
    double encodeScale = 1.0, encodeOffset = 0.0;
    bool isNormalized = false;       ///< --normalize: noise from 0 to 1, a field of length 1
    bool hasField = false;           ///< --field was given
    std::optional<ColourRamp> ramp;  ///< --noise-ramp: noise as colours
};

/// Turns names into maps. \throws Error BadOption, listing the maps there are
std::vector<Map> MakeMaps(MapOptions const& options, Scene const& scene);

/// The least quantity that serves all maps.
eval::Quantity FindQuantity(std::span<Map const> maps);

/// Number of the tree's channels that the bands take: three for each but the base, and the
/// remainder's.
int GetNumBandChannels(MapOptions const& options);

/// True where a map needs d(u,v)/d(s,t): tangent space, flow in texture space and stretch.
bool NeedsJacobian(Map const& map, MapOptions const& options);

/// A block of samples with everything that maps are made of.
struct MapSamples {
    eval::Quantity quantity;  ///< what the planes hold
    float const* planes;      ///< a block of SurfaceSampler: planes[c * stride + i]
    size_t stride, count;
    std::span<std::array<double, 4> const> jacobians;  ///< per sample; empty unless NeedsJacobian
    double meanArea;                ///< surface area per texture area over the whole mesh (stretch)
    std::span<double const> noise;  ///< per sample; empty unless a map shows it
    double noiseLow, noiseHigh;     ///< its range over the whole surface
    std::span<Eigen::Vector3d const> field;  ///< per sample; empty unless a map shows it
    std::span<Eigen::Vector3d const>
        other;  ///< per sample: limit of a finer mesh to compare with; empty: the tree has it
};

/// Computes one map's channels for a block of samples: out[c * outStride + i].
void EvaluateMap(Map const& map, MapOptions const& options, MapSamples const& samples, float* out,
                 size_t outStride);

/// arctangent of y / x in all quadrants and the binary logarithm, from basic operations only: the
/// same bits on every CPU, accurate to 1e-7 (libm's depend on the CPU).
float PortableAtan2(float y, float x);
float PortableLog2(float x);

}  // namespace limn::engine
