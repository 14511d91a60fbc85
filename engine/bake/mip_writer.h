// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "engine/bake/mip_chain.h"
#include "engine/images/exr_writer.h"

namespace limn::engine {

/// Assembles rows of mip levels into tiles and writes them.
class MipWriter {
public:
    /// \param writer  of a file with mips; kept by reference
    /// \param groups  of its channels, coverage apart
    MipWriter(ExrWriter& writer, ExrSpec const& spec, std::vector<ChannelGroup> groups,
              int numPlanes, bool hasCoverage);

    /// The next rows of level 0.
    void Add(std::span<TexelRowView const> rows) { _chain.Add(rows); }
    size_t GetNumClamped() const { return _numClamped; }

private:
    void AddRow(int level, int row, TexelRowView const& texels);
    void WriteTiles(int level, int row);

    ExrWriter& _writer;
    ExrSpec _spec;
    int _numPlanes;
    bool _hasCoverage;
    std::vector<std::vector<float>> _buffers;  // per level: [channel][64 rows][width]
    MipChain _chain;
    size_t _numClamped = 0;
};

}  // namespace limn::engine
