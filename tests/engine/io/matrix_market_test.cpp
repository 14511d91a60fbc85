// SPDX-License-Identifier: Apache-2.0
#include "engine/io/matrix_market.h"

#include <sstream>

#include <gtest/gtest.h>

#include "support/program/program.h"

namespace limn {
namespace {

std::string WriteRows(test::TemporaryFolder const& folder, far_ext::SparseRows const& rows,
                      Index numColumns) {
    engine::AtomicFile file(folder / "m.mtx");
    engine::WriteMatrixMarket(file, far_ext::AsMatrix(rows, numColumns), {"sums", "points"});
    file.Commit();
    return test::ReadText(folder / "m.mtx");
}

TEST(MatrixMarket, EntriesAreNumberedFromOneAndSortedAndTinyOnesAreLeftOut) {
    far_ext::SparseRows rows;
    far_ext::WeightRow first, second;
    first.Add(2, 0.1);
    first.Add(0, -1.0);
    first.Add(1, 9e-16);
    second.Add(1, 1e-15);
    rows.AddRow(first);
    rows.AddRow({});
    rows.AddRow(second);
    test::TemporaryFolder const folder;
    std::string const text = WriteRows(folder, rows, 4);
    std::istringstream lines(text);
    std::string head, comment, line, rest;
    std::getline(lines, head);
    EXPECT_EQ(head, "%%MatrixMarket matrix coordinate real general");
    std::getline(lines, comment);
    EXPECT_TRUE(comment.starts_with("% limn ") &&
                comment.ends_with("rows are sums, columns are points"))
        << comment;
    while (std::getline(lines, line)) rest += line + "\n";
    EXPECT_EQ(rest, "3 4 3\n1 1 -1\n1 3 0.10000000000000001\n3 2 1.0000000000000001e-15\n");
}

TEST(MatrixMarket, ALargeMatrixComesBackWhole) {
    far_ext::SparseRows rows;
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
        far_ext::WeightRow row;
        row.Add(i, 1.0 / (i + 1));
        rows.AddRow(row);
    }
    test::TemporaryFolder const folder;
    std::istringstream text(WriteRows(folder, rows, kCount));
    std::string line;
    for (int i = 0; i < 3; ++i) std::getline(text, line);
    EXPECT_EQ(line, "20000 20000 20000");
    for (int i = 0; i < kCount; ++i) {
        int row = 0, column = 0;
        double value = 0.0;
        text >> row >> column >> value;
        ASSERT_EQ(row, i + 1);
        ASSERT_EQ(column, i + 1);
        ASSERT_EQ(value, 1.0 / (i + 1));
    }
}

}  // namespace
}  // namespace limn
