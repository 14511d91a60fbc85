// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "engine/bake/maps/map.h"

namespace limn::engine {

/// How a displacement is written: along the normal, or as a vector in object or tangent space. One
/// per sampler.
class VectorFrame {
public:
    explicit VectorFrame(MapOptions const& options)
        : _isVector(options.isVector), _isTangent(options.space == VectorSpace::Tangent) {}

    size_t GetNumChannels() const { return _isVector ? 3 : 1; }

    /// Says in the traits what writing a displacement needs of the surface.
    void AddNeeds(MapTraits& traits) const;

    /// Writes a displacement at sample i of a block: out[c * outStride + i].
    void Put(SampleBlock const& block, size_t i, Eigen::Vector3d const& displacement, float* out,
             size_t outStride);

    /// What Put has left out since the last call.
    TangentialPart TakeTangentialPart() { return std::exchange(_leftOut, {}); }

private:
    Eigen::Vector3d ToTangentSpace(SampleBlock const& block, size_t i,
                                   Eigen::Vector3d const& displacement,
                                   Eigen::Vector3d const& normal) const;

    bool _isVector, _isTangent;
    TangentialPart _leftOut;
};

}  // namespace limn::engine
