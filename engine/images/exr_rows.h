// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace limn::engine {

/// Reads some channels of a finished tiled EXR file from the top; memory holds a row of tiles.
class ExrRows {
public:
    /// \param channels  names in the file
    /// \throws Error    Io
    ExrRows(std::string const& path, std::vector<std::string> const& channels);
    ~ExrRows();

    /// A row of one channel, as floats. Rows are asked for in ascending order. \throws Error Io
    float const* GetRow(int row, size_t channel);

private:
    struct File;
    void ReadTiles(int row);

    std::unique_ptr<File> _file;
    std::string _path;
    std::vector<std::string> _channels;
    std::vector<float> _values;  // [channel][row of the tiles][column]
    int _width = 0, _tileRows = 0;
    int _firstRow = 0, _numRows = 0;  // that are in memory
};

}  // namespace limn::engine
