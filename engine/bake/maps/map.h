// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/bake/maps/channel_group.h"
#include "engine/bake/maps/map_options.h"
#include "engine/bake/maps/tangential_part.h"
#include "engine/scene/job.h"
#include "eval/surface/face_tree.h"
#include "eval/surface/surface_kernel.h"

namespace limn::engine {

// A map of a bake is a file of its own: what it has (MapTraits), what it needs of the surface, and
// how its values come about (MapSampler). Whoever bakes, lays out, audits or shows maps asks these
// and knows no map by its name. A new map is a file beside this one and a line in map_table.cpp.
//
// A map has the same bits whatever is baked beside it: it is evaluated as it would be alone.
//
// Source  [Bake 5]

/// What a map's values are to the eye: which colours show them, and between which limits.
enum class RangeKind {
    Signed,      ///< of both signs: zero in the middle
    Positive,    ///< of one sign, or of none in particular
    Vector,      ///< three components as colours, each between its own limits
    UnitVector,  ///< three components from -1 to 1
    Colours,     ///< three components from 0 to 1, to be shown as they are
    Line,        ///< three components whose common sign is free
    Flow         ///< two components along the texture coordinates
};

/// What is known of a map before anything is evaluated.
struct MapTraits {
    std::string name;                   ///< as the user wrote it
    std::vector<std::string> channels;  ///< EXR names within the map, e.g. "R", "G", "B"
    std::string units;
    RangeKind range = RangeKind::Signed;
    std::optional<std::array<float, 2>> limits;  ///< of its values, where these are always the same
    std::vector<ChannelGroup> groups;            ///< how channels are averaged; none: all plainly

    eval::Quantity quantity = eval::Quantity::Position;  ///< what it needs of the surface
    bool needsJacobian = false;                          ///< d(u,v)/d(s,t) at its samples
    bool needsFaceCounts = false;  ///< nothing of it, but how many faces lie over a texel's centre

    bool isPlace = false;                         ///< told by its distance to the origin
    std::optional<std::array<double, 3>> origin;  ///< taken off, where that was asked for
    bool isSameAcrossCreases = false;             ///< along infinitely sharp edges both sides agree
    bool isComparableAtSeams = true;              ///< along texture seams both sides agree

    std::string optionText;              ///< its own options that affect pixels: "bands=4"
    std::optional<std::string> against;  ///< SHA-256 of the mesh that it leads to
    bool hasVectorOptions = false;       ///< isVector and space affect it, too
    bool isAlongNormal = false;          ///< of displacements it has the part along the normal

    int GetNumChannels() const { return static_cast<int>(channels.size()); }
    /// "X,Y,Z"; empty where no origin, or 0, is taken off.
    std::string GetOriginText() const;
    /// The groups, or the one that all channels are in.
    std::vector<ChannelGroup> GetGroups() const;
};

/// What is baked: the mesh, its limit and that of its texture coordinates, and which faces.
struct BakedSurface {
    Model const& model;
    eval::LimitSurface const& surface;
    eval::LimitSurface const& uvSurface;
    std::vector<char> const& isBaked;  ///< per face
    int width, height;                 ///< texels of a tile
    /// What positions among samples are relative to, 0 where floats hold them as they are.
    std::array<double, 3> floatOrigin{};
};

/// Samples of one domain of a face: the texels it covers.
struct FaceSamples {
    Index face;
    int domain;
    std::span<double const> s, t;
};

/// A block of a face's samples, with what the surface is there.
struct SampleBlock {
    std::span<int const> samples;  ///< which of the FaceSamples
    float const* planes;           ///< [channel of eval::SurfaceChannel][stride]
    float const* values;           ///< [channel of the map's GetValues][stride]
    size_t stride;
    std::span<std::array<double, 4> const> jacobians;  ///< us, ut, vs, vt; empty unless needed

    size_t GetCount() const { return samples.size(); }
    float const* GetPlane(int channel) const {
        return planes + static_cast<size_t>(channel) * stride;
    }
    /// Three channels from `channel` on, of sample i of the block.
    Eigen::Vector3d GetVector(int channel, size_t i) const { return Gather(GetPlane(channel) + i); }
    Eigen::Vector3d GetValue(int channel, size_t i) const {
        return Gather(values + static_cast<size_t>(channel) * stride + i);
    }

private:
    Eigen::Vector3d Gather(float const* at) const { return {at[0], at[stride], at[2 * stride]}; }
};

/// Evaluates a map; one per thread.
class MapSampler {
public:
    virtual ~MapSampler() = default;

    /// Tells which samples the next blocks are taken from.
    virtual void Start(FaceSamples const& /*samples*/) {}

    /// The map's channels at a block of samples: out[c * outStride + i].
    virtual void Evaluate(SampleBlock const& block, float* out, size_t outStride) = 0;

    /// Instead, of a map that needs face counts: its channel at texels that numFaces[i] >= 1 faces
    /// lie over.
    virtual void EvaluateCounts(std::span<int const> /*numFaces*/, float* /*out*/) {}

    /// Samples for which the map had to look at a place nearby.
    virtual size_t GetNumDegenerate() const { return 0; }

    /// What was left out of displacements since the last call.
    virtual TangentialPart TakeTangentialPart() { return {}; }
};

/// A map of a bake. Made by MakeMaps, prepared once, sampled on many threads.
class Map {
public:
    explicit Map(MapTraits traits) : _traits(std::move(traits)) {}
    virtual ~Map() = default;

    MapTraits const& GetTraits() const { return _traits; }

    /// Finds what holds for the whole surface, before samplers are made.
    ///
    /// \param baked   outlives the map's samplers
    /// \throws Error  BadMesh where what was given beside the mesh does not fit it
    virtual void Prepare(BakedSurface const& /*baked*/, Job& /*job*/) {}

    /// Values at vertices to be subdivided along with the positions, after Prepare: part after
    /// part.
    virtual std::vector<eval::FaceTree::Values> GetValues() const { return {}; }

    virtual std::unique_ptr<MapSampler> MakeSampler() const = 0;

    /// Levels of refinement on which what is interpolated had to be changed to have a solution.
    virtual std::vector<int> GetSingularLevels() const { return {}; }

private:
    MapTraits _traits;
};

/// A map whose values follow from the surface's at the same sample.
using EvaluateBlock = void (*)(SampleBlock const& block, float* out, size_t outStride);
std::unique_ptr<Map> MakePointwiseMap(MapTraits traits, EvaluateBlock evaluate);

/// Copies three channels of the surface, from `First` on: an EvaluateBlock.
template <int First>
void CopyVector(SampleBlock const& block, float* out, size_t outStride) {
    for (size_t c = 0; c < 3; ++c) {
        std::copy_n(block.GetPlane(First + static_cast<int>(c)), block.GetCount(),
                    out + c * outStride);
    }
}

}  // namespace limn::engine
