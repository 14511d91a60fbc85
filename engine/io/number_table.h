// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace limn::engine {

/// Numbers from a comma-separated file with a header.
struct NumberTable {
    size_t layout = 0;  ///< which of the layouts asked for its header has
    size_t numColumns = 0;
    std::vector<double> values;  ///< row after row, in the layout's order
    std::vector<size_t> lines;   ///< of each row in the file, from 1

    size_t GetNumRows() const { return lines.size(); }
    double Get(size_t row, size_t column) const { return values[row * numColumns + column]; }
};

/// Reads a table whose header names the columns of one of the layouts, in any order and in small or
/// capital letters; other columns are skipped. Fields are parted by commas, or all by semicolons,
/// and may be quoted. A column "kind=circulation|flux" is `kind`, of these words for numbers: 0 is
/// the first of them.
///
/// \throws Error  BadMesh: another header, one that names a column twice, a row with more fields
/// than
///                the header, a field that is no finite number (file and line named).  Io
NumberTable ReadNumberTable(std::string const& path,
                            std::vector<std::vector<std::string>> const& layouts);

/// A number of a table as an index from 0 to `count` - 1.
///
/// \throws Error  BadMesh: it is none; `what` ("vertex") is named with file and line
int GetIndex(NumberTable const& table, std::string const& path, size_t row, size_t column,
             int count, char const* what);

}  // namespace limn::engine
