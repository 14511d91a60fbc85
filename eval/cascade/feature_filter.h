// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "eval/cascade/cascade_operator.h"

namespace limn::eval {

/// Area-weighted normals of rows, of length 1 or 0; those of rows that stay from the triangles they
/// share with others.
///
/// \pre the level is of triangles
std::vector<Eigen::Vector3d> FindRowNormals(far_ext::CascadeLevel const& level,
                                            CascadeRows<double> const& surface);

/// Replaces the weights of surface rows by those of a filter that hardly acts across features. Per
/// triangle
///
///     S = sym(sum n_v (x) grad phi_v),   A = (1 + S^2 / Lambda^2)^-1,   L_ij = a_T r_i.A r_j / (4
///     |T|)
///
/// with r = n x e: where the normals turn by more than Lambda over a length, little flows. Masses
/// and rows on creases stay.
///
/// \param metric   triangles and, with a negative width, sigma
/// \param normals  n_v, per row: of a surface with less noise
/// \param lambda   in 1/length; infinite: the plain filter
/// Source  [Cascade 12]
void KeepFeatures(far_ext::CascadeLevel const& level, CascadeRows<double> const& metric,
                  std::vector<Eigen::Vector3d> const& normals, double width, double lambda,
                  CascadeOperator<double>& op);

}  // namespace limn::eval
