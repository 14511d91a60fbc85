// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/maps/vector_frame.h"

#include <Eigen/Geometry>

namespace limn::engine {

void VectorFrame::AddNeeds(MapTraits& traits) const {
    bool const needsTangents = _isVector && _isTangent;
    traits.quantity = needsTangents ? eval::Quantity::Tangents : eval::Quantity::Normal;
    traits.needsJacobian = needsTangents;
    traits.hasVectorOptions = true;
    traits.isAlongNormal = !_isVector;
}

void VectorFrame::Put(SampleBlock const& block, size_t i, Eigen::Vector3d const& displacement,
                      float* out, size_t outStride) {
    Eigen::Vector3d const normal = block.GetVector(eval::kNormalX, i);
    if (!_isVector) {
        double const along = displacement.dot(normal);
        double const squared = (displacement - along * normal).squaredNorm();
        out[i] = static_cast<float>(along);
        _leftOut.Add({1, squared, std::sqrt(squared), displacement.norm()});
        return;
    }
    Eigen::Vector3d const result =
        _isTangent ? ToTangentSpace(block, i, displacement, normal) : displacement;
    for (size_t c = 0; c < 3; ++c) {
        out[c * outStride + i] = static_cast<float>(result[static_cast<int>(c)]);
    }
}

/// Components along u, along normal x u, and along the normal.
Eigen::Vector3d VectorFrame::ToTangentSpace(SampleBlock const& block, size_t i,
                                            Eigen::Vector3d const& displacement,
                                            Eigen::Vector3d const& normal) const {
    // dP/du = P_s s_u + P_t t_u, with d(s,t)/d(u,v) the inverse of the Jacobian.
    auto const& [us, ut, vs, vt] = block.jacobians[i];
    double const det = us * vt - ut * vs;
    double const sign = det < 0.0 ? -1.0 : 1.0;
    Eigen::Vector3d along = sign * (vt * block.GetVector(eval::kTangentSX, i) -
                                    vs * block.GetVector(eval::kTangentTX, i));
    along -= along.dot(normal) * normal;
    double const length = along.norm();
    along = length > 0.0 ? Eigen::Vector3d(along / length) : normal.unitOrthogonal();
    return {displacement.dot(along), displacement.dot(normal.cross(along)),
            displacement.dot(normal)};
}

}  // namespace limn::engine
