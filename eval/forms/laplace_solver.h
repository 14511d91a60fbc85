// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

namespace limn::eval {

/// Symmetric equations A x = b of which some unknowns are fixed to 0, factorised once (nested
/// dissection) for many right-hand sides.
///
/// Threads  one at a time.
class LaplaceSolver {
public:
    /// \param isFixed  per unknown
    /// \param entries  of A, all of them; those of one place add up
    /// \throws Error   BadMesh: a factorisation that fails in double precision
    LaplaceSolver(std::vector<char> const& isFixed,
                  std::vector<Eigen::Triplet<double>> const& entries);
    ~LaplaceSolver();

    /// \param right  per unknown; what fixed ones have is not looked at
    std::vector<double> Solve(std::span<double const> right);

private:
    class Factorisation;
    std::unique_ptr<Factorisation> _factorisation;
};

/// The entries that an edge between two unknowns gives a weighted graph's Laplacian.
inline void AddEdge(int a, int b, double weight, std::vector<Eigen::Triplet<double>>& entries) {
    entries.emplace_back(a, a, weight);
    entries.emplace_back(b, b, weight);
    entries.emplace_back(a, b, -weight);
    entries.emplace_back(b, a, -weight);
}

}  // namespace limn::eval
