// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <opensubdiv/far/topologyLevel.h>

#include "eval/forms/dissection_ordering.h"
#include "far_ext/forms/hodge_star.h"

namespace limn::eval {

/// What a 1-form is to fulfil: rows over the edges, whose squares add up to an integral.
struct FormWishes {
    Eigen::SparseMatrix<double, Eigen::RowMajor> rows;
    Eigen::VectorXd right;

    Eigen::VectorXd FindMissing(Eigen::VectorXd const& form) const { return right - rows * form; }
};

/// Each vertex' share of its faces.
std::vector<double> FindDualAreas(Far::TopologyLevel const& level,
                                  std::vector<double> const& faceAreas);

/// Finds a form that meets wishes, one among all that do.
///
/// Source  [Forms 8]
class WishMatcher {
public:
    /// \param stars   of the level; kept by reference, as is
    /// \param onStep  called now and then; may throw to end the work
    WishMatcher(Far::TopologyLevel const& level, far_ext::HodgeStars const& stars,
                FormWishes wishes, std::function<void()> const& onStep);

    /// The one with the least curl and divergence, by squares.
    Eigen::VectorXd FindSmooth();

    /// The one with the least sum of |inflow| and |curl|, which finds the one that few sources and
    /// vortices make; none, if it is no such form.
    std::optional<Eigen::VectorXd> FindFewSources(Eigen::VectorXd const& smooth);

private:
    using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
    using ColumnMatrix = Eigen::SparseMatrix<double>;
    using Vector = Eigen::VectorXd;

    /// What counts beside the wishes: squares of inflow, curl and values, each with a weight.
    struct Weights {
        Vector ofInflow, ofCurl, ofValues;
    };
    Vector Meet(Weights const& weights, double tolerance);
    bool IsMet(Vector const& form, double share) const {
        return _wishes.FindMissing(form).norm() <= share * _wishes.right.norm();
    }
    bool TurnsInFewFaces(Vector const& form, double largest) const;

    std::function<void()> const& _onStep;
    far_ext::HodgeStars const& _stars;
    std::vector<double> _dualAreas;
    FormWishes _wishes;
    ColumnMatrix _normal;  // of the wishes
    RowMatrix _inflow, _curl;
    Eigen::SimplicialLDLT<ColumnMatrix, Eigen::Lower, DissectionOrdering> _solver;
    bool _isOrdered = false;
};

}  // namespace limn::eval
