// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "engine/bake/bake_report.h"

namespace limn::engine {

/// Finished rows of one output: a strip's planes, padded.
struct StripView {
    int index = 0;  ///< of the strip
    int firstRow = 0, numRows = 0, width = 0;
    float const* planes = nullptr;  ///< channel c, row r from `firstRow`: GetRow(c, r)
    size_t planeSize = 0;
    float const* coverage = nullptr;    ///< [row][column], 0 to 1; null unless the sink wants it
    uint8_t const* isFilled = nullptr;  ///< [row][column]: covered or padded

    float const* GetRow(int channel, int row) const {
        return planes + static_cast<size_t>(channel) * planeSize + GetTexel(row);
    }
    size_t GetTexel(int row) const { return static_cast<size_t>(row) * static_cast<size_t>(width); }
};

/// What a sink has made of a strip before its turn to be written.
class PackedRows {
public:
    virtual ~PackedRows() = default;
};

/// Where the finished texels of one output go: an EXR file, or memory.
class TexelSink {
public:
    virtual ~TexelSink() = default;

    virtual bool WantsCoverage() const = 0;

    /// Does with a strip what needs no order. Many threads, strips as they come.
    virtual std::unique_ptr<PackedRows> Pack(StripView const& strip) = 0;

    /// Takes a strip and what Pack has made of it. One thread, strips in order.
    virtual void Write(StripView const& strip, PackedRows& rows) = 0;

    /// All strips are there. Without this call nothing is left of the output.
    ///
    /// \param output  receives what only the sink knows
    /// \return        values beyond what the output can hold, which were clamped
    virtual size_t Commit(BakeOutput& output) = 0;
};

/// Where a bake goes: one sink per output.
class BakeDestination {
public:
    virtual ~BakeDestination() = default;

    /// Refuses a place where an output cannot go, before any is baked. \throws Error BadOption
    virtual void CheckPlace(FileLayout const&, int /*tile*/) const {}

    /// A sink for one output.
    ///
    /// \param output  has map, tile and size; receives what the destination decides
    /// \return        null where nothing is to be done: output.wasSkipped
    virtual std::unique_ptr<TexelSink> Open(FileLayout const& file, BakeOutput& output) = 0;
};

}  // namespace limn::engine
