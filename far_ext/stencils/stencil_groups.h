// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "far_ext/stencils/stencil_rows.h"

namespace limn::far_ext {

/// Stencil rows in the form that is evaluated fastest and takes least memory.
///
/// Rows that use the same control vertices form a group: those vertices once, and a block of
/// weights, rows x columns. Equal blocks are kept once: on a refined mesh a handful of them serves
/// all faces. Rows that group with few others stay single, and their weights too are kept once
/// where equal.
///
/// Shape    numRows rows of weights over numControls control vertices, numSets times (values, then
///          derivatives in the order of WeightSet). Every row is in one group or single.
/// Usable from C++17.
struct StencilGroups {
    static constexpr int kRowsPerPanel = 16;
    static constexpr int kMaxColumns = 128;  ///< rows over more controls stay single

    /// Weights lie as [set][panel][column][kRowsPerPanel], the last panel filled up with zeros.
    struct Block {
        int numRows, numColumns;
        size_t firstWeight;

        int GetNumPanels() const { return (numRows + kRowsPerPanel - 1) / kRowsPerPanel; }
        size_t GetSetSize() const {
            return static_cast<size_t>(GetNumPanels()) * numColumns * kRowsPerPanel;
        }
    };

    /// How a group's rows lie in the table: runs of rows that follow each other.
    struct Shape {
        int firstRun, numRuns;  ///< into runLengths
    };

    struct Group {
        int block, shape;
        Index firstControl;  ///< into controls
        Index firstStart;    ///< into runStarts: where in the table each run starts
    };

    /// Rows on their own that follow each other and have equal weights: row firstRow + i has the
    /// controls indices[firstIndex + i * size + k] and, in set s, the weights weights[firstWeight +
    /// s * size + k].
    struct Run {
        Index firstRow;
        int numRows;  ///< at most kMostRowsPerRun, so that runs can be shared out
        int size;
        Index firstIndex, firstWeight;
    };
    static constexpr int kMostRowsPerRun = 1024;

    struct Singles {
        std::vector<Run> runs;  ///< by row
        std::vector<Index> indices;
        std::vector<float> weights;
    };

    Index numRows = 0, numControls = 0;
    int numSets = 1;
    std::vector<Block> blocks;
    std::vector<float> weights;
    std::vector<Shape> shapes;
    std::vector<int> runLengths;
    std::vector<Group> groups;
    std::vector<Index> controls;
    std::vector<Index> runStarts;
    Singles singles;

    /// Bytes of all arrays.
    size_t GetMemory() const;

    /// The same rows as plain arrays, without the zeros that fill a group's columns.
    StencilRows Expand() const;
};

/// Puts groups together and keeps equal blocks, shapes and single rows' weights once.
///
/// \throws Error  TooLarge: an array passes 2^31 entries
class StencilGroupsBuilder {
public:
    StencilGroupsBuilder(Index numRows, Index numControls, int numSets);
    ~StencilGroupsBuilder();

    /// Adds a block, or finds an equal one. `weights` lie as [set][row][column].
    int AddBlock(int numRows, int numColumns, std::vector<float> const& weights);

    /// Adds a group: `rows` and `controls` in the order of the block's rows and columns.
    void AddGroup(int block, std::vector<Index> const& rows, std::vector<Index> const& controls);

    /// Adds a row on its own, in any order; `weights` lie as [set][control].
    void AddSingle(Index row, std::vector<Index> const& controls,
                   std::vector<float> const& weights);

    StencilGroups Finish();

private:
    struct Lookup;
    struct Single {
        Index row;
        int size;
        Index firstIndex, firstWeight;
    };

    void MakeRuns();

    StencilGroups _table;
    std::vector<Single> _singles;
    std::unique_ptr<Lookup> _lookup;
};

/// Groups the rows of a finished table: rows with the same control vertices, where enough of them
/// are found for a block to pay, single rows otherwise.
///
/// \pre    Validate(rows)
/// \throws Error  TooLarge: as StencilGroupsBuilder
StencilGroups GroupRows(StencilRowsView const& rows);

}  // namespace limn::far_ext
