// SPDX-License-Identifier: Apache-2.0
#include "far_ext/stencils/stencil_groups.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "far_ext/error.h"
#include "far_ext/rows/mix.h"

namespace limn::far_ext {

namespace {

/// Hash of 32-bit entries.
template <class Entry>
uint64_t HashOf(Entry const* entries, size_t count, uint64_t hash) {
    static_assert(sizeof(Entry) == 4);
    for (size_t i = 0; i < count; ++i) {
        uint32_t bits;
        std::memcpy(&bits, entries + i, 4);
        hash = Mix(hash ^ bits);
    }
    return hash;
}

template <class Entry>
size_t BytesOf(std::vector<Entry> const& entries) {
    return entries.size() * sizeof(Entry);
}

}  // namespace

size_t StencilGroups::GetMemory() const {
    return BytesOf(blocks) + BytesOf(weights) + BytesOf(shapes) + BytesOf(runLengths) +
           BytesOf(groups) + BytesOf(controls) + BytesOf(runStarts) + BytesOf(singles.runs) +
           BytesOf(singles.indices) + BytesOf(singles.weights);
}

StencilRows StencilGroups::Expand() const {
    struct Place {
        int group = -1, run = -1;
        int row = 0;  // within the group or run
    };
    std::vector<Place> places(numRows);
    for (size_t g = 0; g < groups.size(); ++g) {
        Shape const shape = shapes[groups[g].shape];
        int inGroup = 0;
        for (int run = 0; run < shape.numRuns; ++run) {
            Index const start = runStarts[groups[g].firstStart + run];
            for (int i = 0; i < runLengths[shape.firstRun + run]; ++i) {
                places[start + i] = {static_cast<int>(g), -1, inGroup++};
            }
        }
    }
    for (size_t r = 0; r < singles.runs.size(); ++r) {
        for (int i = 0; i < singles.runs[r].numRows; ++i) {
            places[singles.runs[r].firstRow + i] = {-1, static_cast<int>(r), i};
        }
    }

    StencilRows rows(numControls, numSets);
    float entry[kMaxWeightSets];
    for (Place const& place : places) {
        if (place.run >= 0) {
            Run const& run = singles.runs[place.run];
            for (int k = 0; k < run.size; ++k) {
                for (int set = 0; set < numSets; ++set) {
                    entry[set] = singles.weights[run.firstWeight + set * run.size + k];
                }
                rows.AddEntry(singles.indices[run.firstIndex + place.row * run.size + k], entry);
            }
        } else if (place.group >= 0) {
            Group const& group = groups[place.group];
            Block const& block = blocks[group.block];
            int const panel = place.row / kRowsPerPanel, lane = place.row % kRowsPerPanel;
            for (int column = 0; column < block.numColumns; ++column) {
                size_t const at =
                    block.firstWeight +
                    static_cast<size_t>(panel * block.numColumns + column) * kRowsPerPanel + lane;
                bool isUsed = false;
                for (int set = 0; set < numSets; ++set) {
                    entry[set] = weights[at + set * block.GetSetSize()];
                    isUsed |= entry[set] != 0.0f;
                }
                if (isUsed) rows.AddEntry(controls[group.firstControl + column], entry);
            }
        }
        rows.EndRow();
    }
    return rows;
}

/// What has been kept so far, by hash; numbers are of blocks, shapes and single rows.
struct StencilGroupsBuilder::Lookup {
    std::unordered_multimap<uint64_t, int> blocks, shapes, singles;
    std::vector<float> panels;  // scratch
    std::vector<Index> starts;
    std::vector<int> lengths;
};

namespace {

/// The number kept under a hash for which isEqual holds, or -1.
template <class IsEqual>
int FindKept(std::unordered_multimap<uint64_t, int> const& kept, uint64_t hash, IsEqual isEqual) {
    auto const [first, last] = kept.equal_range(hash);
    auto const found =
        std::find_if(first, last, [&](auto const& entry) { return isEqual(entry.second); });
    return found == last ? -1 : found->second;
}

void CheckSize(size_t size) {
    constexpr size_t kLimit = static_cast<size_t>(std::numeric_limits<Index>::max());
    if (size > kLimit) throw Error(ErrorCode::TooLarge, "a stencil table passes 2^31 entries");
}

}  // namespace

StencilGroupsBuilder::StencilGroupsBuilder(Index numRows, Index numControls, int numSets)
    : _lookup(std::make_unique<Lookup>()) {
    _table.numRows = numRows;
    _table.numControls = numControls;
    _table.numSets = numSets;
}

StencilGroupsBuilder::~StencilGroupsBuilder() = default;

int StencilGroupsBuilder::AddBlock(int numRows, int numColumns, std::vector<float> const& weights) {
    constexpr int kLanes = StencilGroups::kRowsPerPanel;
    StencilGroups::Block const block{numRows, numColumns, _table.weights.size()};
    auto& panels = _lookup->panels;
    panels.assign(block.GetSetSize() * _table.numSets, 0.0f);
    auto from = weights.begin();
    for (int set = 0; set < _table.numSets; ++set) {
        for (int row = 0; row < numRows; ++row) {
            float* to =
                &panels[set * block.GetSetSize() +
                        static_cast<size_t>(row / kLanes) * numColumns * kLanes + row % kLanes];
            for (int column = 0; column < numColumns; ++column, to += kLanes) *to = *from++;
        }
    }
    uint64_t const hash =
        HashOf(panels.data(), panels.size(),
               (static_cast<uint64_t>(numRows) << 32) + static_cast<uint64_t>(numColumns));
    int const kept = FindKept(_lookup->blocks, hash, [&](int other) {
        auto const& b = _table.blocks[other];
        return b.numRows == numRows && b.numColumns == numColumns &&
               std::memcmp(&_table.weights[b.firstWeight], panels.data(), BytesOf(panels)) == 0;
    });
    if (kept >= 0) return kept;
    int const number = static_cast<int>(_table.blocks.size());
    _table.blocks.push_back(block);
    _table.weights.insert(_table.weights.end(), panels.begin(), panels.end());
    _lookup->blocks.emplace(hash, number);
    return number;
}

void StencilGroupsBuilder::AddGroup(int block, std::vector<Index> const& rows,
                                    std::vector<Index> const& controls) {
    auto& lengths = _lookup->lengths;
    auto& starts = _lookup->starts;
    lengths.clear();
    starts.clear();
    for (Index row : rows) {
        if (starts.empty() || row != starts.back() + lengths.back()) {
            starts.push_back(row);
            lengths.push_back(0);
        }
        ++lengths.back();
    }
    uint64_t const hash = HashOf(lengths.data(), lengths.size(), lengths.size());
    int shape = FindKept(_lookup->shapes, hash, [&](int other) {
        auto const& s = _table.shapes[other];
        return s.numRuns == static_cast<int>(lengths.size()) &&
               std::equal(lengths.begin(), lengths.end(), _table.runLengths.begin() + s.firstRun);
    });
    if (shape < 0) {
        shape = static_cast<int>(_table.shapes.size());
        _table.shapes.push_back(
            {static_cast<int>(_table.runLengths.size()), static_cast<int>(lengths.size())});
        _table.runLengths.insert(_table.runLengths.end(), lengths.begin(), lengths.end());
        _lookup->shapes.emplace(hash, shape);
    }
    _table.groups.push_back({block, shape, static_cast<Index>(_table.controls.size()),
                             static_cast<Index>(_table.runStarts.size())});
    _table.controls.insert(_table.controls.end(), controls.begin(), controls.end());
    _table.runStarts.insert(_table.runStarts.end(), starts.begin(), starts.end());
    CheckSize(_table.controls.size());
    CheckSize(_table.runStarts.size());
}

void StencilGroupsBuilder::AddSingle(Index row, std::vector<Index> const& controls,
                                     std::vector<float> const& weights) {
    auto& singles = _table.singles;
    int const size = static_cast<int>(controls.size());
    Single single{row, size, static_cast<Index>(singles.indices.size()),
                  static_cast<Index>(singles.weights.size())};
    auto const isEqual = [&](int other) {
        return _singles[other].size == size &&
               std::memcmp(singles.weights.data() + _singles[other].firstWeight, weights.data(),
                           BytesOf(weights)) == 0;
    };
    int kept = static_cast<int>(_singles.size()) - 1;  // most rows are like the one before
    if (kept < 0 || !isEqual(kept)) {
        uint64_t const hash = HashOf(weights.data(), weights.size(), weights.size());
        kept = FindKept(_lookup->singles, hash, isEqual);
        if (kept < 0) _lookup->singles.emplace(hash, static_cast<int>(_singles.size()));
    }
    if (kept < 0)
        singles.weights.insert(singles.weights.end(), weights.begin(), weights.end());
    else
        single.firstWeight = _singles[kept].firstWeight;
    singles.indices.insert(singles.indices.end(), controls.begin(), controls.end());
    _singles.push_back(single);
    CheckSize(singles.indices.size());
    CheckSize(singles.weights.size());
}

/// Orders the single rows and joins those that follow each other and have equal weights.
void StencilGroupsBuilder::MakeRuns() {
    auto const isBefore = [](Single const& a, Single const& b) { return a.row < b.row; };
    if (!std::is_sorted(_singles.begin(), _singles.end(), isBefore)) {
        std::sort(_singles.begin(), _singles.end(), isBefore);
        std::vector<Index> indices;
        indices.reserve(_table.singles.indices.size());
        for (Single& single : _singles) {
            auto const from = _table.singles.indices.begin() + single.firstIndex;
            single.firstIndex = static_cast<Index>(indices.size());
            indices.insert(indices.end(), from, from + single.size);
        }
        _table.singles.indices = std::move(indices);
    }
    auto& runs = _table.singles.runs;
    for (Single const& single : _singles) {
        bool const continues =
            !runs.empty() && runs.back().numRows < StencilGroups::kMostRowsPerRun &&
            runs.back().firstRow + runs.back().numRows == single.row &&
            runs.back().size == single.size && runs.back().firstWeight == single.firstWeight;
        if (continues) {
            ++runs.back().numRows;
        } else {
            runs.push_back({single.row, 1, single.size, single.firstIndex, single.firstWeight});
        }
    }
}

StencilGroups StencilGroupsBuilder::Finish() {
    MakeRuns();
    return std::move(_table);
}

}  // namespace limn::far_ext
