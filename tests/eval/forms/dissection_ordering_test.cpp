// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/dissection_ordering.h"

#include <atomic>
#include <csignal>
#include <iostream>  // Eigen's MetisSupport needs it
#include <thread>
#include <vector>

#include <Eigen/MetisSupport>
#include <gtest/gtest.h>
#include <unistd.h>

#include "support/meshes.h"

namespace limn {
namespace {

using eval::DissectionOrdering;
using Matrix = Eigen::SparseMatrix<double>;
using Places = std::vector<int>;

/// The Laplacian of a grid of n x n vertices, each joined to its eight neighbours; closed.
Matrix MakeGridMatrix(int n) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            for (int di : {-1, 0, 1}) {
                for (int dj : {-1, 0, 1}) {
                    int const other = (i + di + n) % n * n + (j + dj + n) % n;
                    entries.emplace_back(i * n + j, other, di == 0 && dj == 0 ? 8.0 : -1.0);
                }
            }
        }
    }
    Matrix matrix(n * n, n * n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

template <class Ordering>
Places Order(Matrix const& matrix) {
    typename Ordering::PermutationType order;
    Ordering ordering;
    ordering(matrix, order);
    return {order.indices().begin(), order.indices().end()};
}

TEST(DissectionOrdering, IsThatOfEigensMetis) {
    for (int n : {3, 5, 20, 60, 150}) {
        Matrix const matrix = MakeGridMatrix(n);
        EXPECT_EQ(Order<DissectionOrdering>(matrix), Order<Eigen::MetisOrdering<int>>(matrix)) << n;
    }
    Matrix diagonal(7, 7);
    diagonal.setIdentity();
    EXPECT_EQ(Order<DissectionOrdering>(diagonal), Order<Eigen::MetisOrdering<int>>(diagonal));
}

TEST(DissectionOrdering, IsTheSameWhateverOtherThreadsOrder) {
    Matrix const matrix = MakeGridMatrix(80), other = MakeGridMatrix(50);
    Places const alone = Order<DissectionOrdering>(matrix);
    std::atomic<bool> isDone{false};
    std::thread neighbour([&] {
        while (!isDone) Order<DissectionOrdering>(other);
    });
    for (int i = 0; i < 8; ++i) EXPECT_EQ(Order<DissectionOrdering>(matrix), alone);
    isDone = true;
    neighbour.join();
}

std::atomic<int> numHeard{0};

// Signals of the process come to any of its threads, and have to find the host's handler there.
TEST(DissectionOrdering, LeavesTheHandlersOfItsProcessAlone) {
    Matrix const matrix = MakeGridMatrix(100);
    auto const before = std::signal(SIGTERM, [](int) { ++numHeard; });
    std::atomic<bool> isDone{false};
    std::thread worker([&] {
        for (int i = 0; i < 10; ++i) Order<DissectionOrdering>(matrix);
        isDone = true;
    });
    int numSent = 0;
    for (; !isDone; ++numSent) {
        ::kill(::getpid(), SIGTERM);
        while (numHeard <= numSent && !isDone) ::usleep(10);
        ::usleep(100);
    }
    worker.join();
    EXPECT_GT(numSent, 0);
    EXPECT_GE(numHeard, numSent - 1) << "the last one may be on its way";
    ::usleep(1000);
    std::signal(SIGTERM, before);
}

}  // namespace
}  // namespace limn
