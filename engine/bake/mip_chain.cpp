// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/mip_chain.h"

#include <algorithm>
#include <cmath>

namespace limn::engine {

std::array<float, 3> FindMainLine(std::array<double, 6> const& m) {
    // Squaring the matrix separates its eigenvalues; the column of the largest diagonal remains.
    double a[6];
    std::copy(m.begin(), m.end(), a);
    for (int step = 0; step < 24; ++step) {
        double const trace = a[0] + a[3] + a[5];
        if (!(trace > 0.0)) return {0.0f, 0.0f, 0.0f};
        for (double& x : a) x /= trace;
        double const b[6] = {
            a[0] * a[0] + a[1] * a[1] + a[2] * a[2], a[0] * a[1] + a[1] * a[3] + a[2] * a[4],
            a[0] * a[2] + a[1] * a[4] + a[2] * a[5], a[1] * a[1] + a[3] * a[3] + a[4] * a[4],
            a[1] * a[2] + a[3] * a[4] + a[4] * a[5], a[2] * a[2] + a[4] * a[4] + a[5] * a[5]};
        std::copy(b, b + 6, a);
    }
    double v[3] = {a[0], a[1], a[2]};
    if (a[3] > a[0] && a[3] >= a[5])
        v[0] = a[1], v[1] = a[3], v[2] = a[4];
    else if (a[5] > a[0] && a[5] > a[3])
        v[0] = a[2], v[1] = a[4], v[2] = a[5];
    double const length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 0.0)) return {0.0f, 0.0f, 0.0f};
    return {static_cast<float>(v[0] / length), static_cast<float>(v[1] / length),
            static_cast<float>(v[2] / length)};
}

/// Which finer texels a coarser one holds along one axis, and how much of each.
struct Box {
    int first, count;
    float weights[3];
};

namespace {

Box FindBox(int fine, int coarse, int at) {
    if (fine == coarse) return {at, 1, {1.0f, 0.0f, 0.0f}};
    if (fine % 2 == 0) return {2 * at, 2, {0.5f, 0.5f, 0.0f}};
    // fine = 2 coarse + 1: the box [at, at + 1) * fine / coarse covers three texels.
    double const begin = static_cast<double>(at) * fine / coarse;
    double const end = static_cast<double>(at + 1) * fine / coarse;
    Box box{static_cast<int>(std::floor(begin)), 0, {0.0f, 0.0f, 0.0f}};
    for (int k = box.first; k < fine && k < end && box.count < 3; ++k) {
        double const part = std::min(end, k + 1.0) - std::max(begin, static_cast<double>(k));
        box.weights[box.count++] = static_cast<float>(part / (end - begin));
    }
    return box;
}

}  // namespace

MipChain::MipChain(int width, int height, int numLevels, int numChannels,
                   std::vector<ChannelGroup> groups, Emit emit)
    : _numChannels(numChannels), _groups(std::move(groups)), _emit(std::move(emit)) {
    _hasLines = std::any_of(_groups.begin(), _groups.end(), [](ChannelGroup const& group) {
        return group.averaging == Averaging::Line;
    });
    for (int level = 0; level < numLevels; ++level) {
        Level l;
        l.width = std::max(1, width >> level);
        l.height = std::max(1, height >> level);
        _levels.push_back(std::move(l));
    }
}

void MipChain::Add(std::span<TexelRowView const> rows) {
    for (TexelRowView const& row : rows) AddRow(0, row);
    // What a box may still ask for, once the rows given are gone.
    for (int row = std::max(0, _levels[0].numRows - 2); row < _levels[0].numRows; ++row)
        Keep(_levels[0], row);
}

/// Copies a row of the window into memory of its own.
void MipChain::Keep(Level& level, int row) {
    TexelRowView& view = level.window[row % 3];
    TexelRow& kept = level.kept[row % 3];
    if (view.coverage == kept.coverage.data()) return;
    size_t const width = static_cast<size_t>(level.width);
    kept.values.resize(width * _numChannels);
    for (size_t c = 0; c < static_cast<size_t>(_numChannels); ++c) {
        std::copy_n(view.values + c * view.stride, width, &kept.values[c * width]);
    }
    kept.coverage.assign(view.coverage, view.coverage + width);
    kept.isFilled.assign(view.isFilled, view.isFilled + width);
    view = kept.GetView();
}

void MipChain::AddRow(int level, TexelRowView const& row) {
    if (level > 0) _emit(level, _levels[level].numRows, row);
    Level& from = _levels[level];
    if (level + 1 == static_cast<int>(_levels.size())) {
        ++from.numRows;
        return;
    }
    from.window[from.numRows % 3] = row;
    ++from.numRows;
    Level& to = _levels[level + 1];
    while (to.numRows < to.height) {
        Box const box = FindBox(from.height, to.height, to.numRows);
        if (box.first + box.count > from.numRows) break;
        TexelRow& result = to.kept[to.numRows % 3];
        Reduce(from, to.numRows, to.width, to.height, result);
        AddRow(level + 1, result.GetView());
    }
}

void MipChain::AverageTexel(std::span<float const> weights, std::span<float const* const> values,
                            std::span<size_t const> strides, float* out, size_t outStride) const {
    for (ChannelGroup const& group : _groups) {
        if (group.averaging == Averaging::Line) {
            std::array<double, 6> sum{};
            for (size_t k = 0; k < weights.size(); ++k) {
                double d[3];
                for (int c = 0; c < 3; ++c)
                    d[c] = values[k][static_cast<size_t>(group.first + c) * strides[k]];
                int index = 0;
                for (int a = 0; a < 3; ++a) {
                    for (int b = a; b < 3; ++b)
                        sum[index++] += static_cast<double>(weights[k]) * d[a] * d[b];
                }
            }
            auto const line = FindMainLine(sum);
            for (int c = 0; c < 3; ++c)
                out[static_cast<size_t>(group.first + c) * outStride] = line[c];
            continue;
        }
        if (group.averaging == Averaging::Count) {
            for (int c = group.first; c < group.first + group.count; ++c) {
                float most = 0.0f;
                for (size_t k = 0; k < weights.size(); ++k)
                    most = std::max(most, values[k][static_cast<size_t>(c) * strides[k]]);
                out[static_cast<size_t>(c) * outStride] = most;
            }
            continue;
        }
        float lengthSquared = 0.0f, total = 0.0f;
        for (float weight : weights) total += weight;
        for (int c = group.first; c < group.first + group.count; ++c) {
            float sum = 0.0f;
            for (size_t k = 0; k < weights.size(); ++k) {
                sum += weights[k] * values[k][static_cast<size_t>(c) * strides[k]];
            }
            float const mean = sum / total;
            out[static_cast<size_t>(c) * outStride] = mean;
            lengthSquared += mean * mean;
        }
        if (group.averaging == Averaging::UnitVector && lengthSquared > 0.0f) {
            float const length = std::sqrt(lengthSquared);
            for (int c = group.first; c < group.first + group.count; ++c) {
                out[static_cast<size_t>(c) * outStride] /= length;
            }
        }
    }
}

/// All boxes of 2 x 2 as if they were covered, which most are, or empty; the others are for
/// ReduceBox.
void MipChain::ReduceQuarters(TexelRowView const& top, TexelRowView const& bottom,
                              TexelRow& result) const {
    size_t const width = result.coverage.size();
    std::vector<float> squares;
    for (ChannelGroup const& group : _groups) {
        bool const isUnit = group.averaging == Averaging::UnitVector;
        squares.assign(isUnit ? width : 0, 0.0f);
        for (int c = group.first; c < group.first + group.count; ++c) {
            float const* const a = top.values + static_cast<size_t>(c) * top.stride;
            float const* const b = bottom.values + static_cast<size_t>(c) * bottom.stride;
            float* const out = &result.values[static_cast<size_t>(c) * width];
            if (group.averaging == Averaging::Count) {
                for (size_t x = 0; x < width; ++x)
                    out[x] = std::max({a[2 * x], a[2 * x + 1], b[2 * x], b[2 * x + 1]});
                continue;
            }
            for (size_t x = 0; x < width; ++x)
                out[x] = 0.25f * ((a[2 * x] + a[2 * x + 1]) + (b[2 * x] + b[2 * x + 1]));
            if (isUnit)
                for (size_t x = 0; x < width; ++x) squares[x] += out[x] * out[x];
        }
        if (!isUnit) continue;
        for (float& square : squares) square = square > 0.0f ? 1.0f / std::sqrt(square) : 1.0f;
        for (int c = group.first; c < group.first + group.count; ++c) {
            float* const out = &result.values[static_cast<size_t>(c) * width];
            for (size_t x = 0; x < width; ++x) out[x] *= squares[x];
        }
    }
}

/// Any box: the mean of what is covered in it, by area and coverage; where nothing is, of the
/// padding.
void MipChain::ReduceBox(Level const& from, Box const& rows, Box const& columns, int x,
                         TexelRow& result) const {
    float weights[9], covered = 0.0f;
    float const* values[9];
    size_t strides[9], count = 0;
    for (bool const isPadding : {false, true}) {
        if (isPadding && count > 0) break;
        for (int j = 0; j < rows.count; ++j) {
            TexelRowView const& fine = from.window[(rows.first + j) % 3];
            for (int i = 0; i < columns.count; ++i) {
                int const column = columns.first + i;
                float const area = rows.weights[j] * columns.weights[i];
                float const weight = isPadding ? (fine.isFilled[column] ? area : 0.0f)
                                               : area * fine.coverage[column];
                if (!(weight > 0.0f)) continue;
                weights[count] = weight;
                values[count] = fine.values + column;
                strides[count++] = fine.stride;
                if (!isPadding) covered += weight;
            }
        }
    }
    size_t const width = result.coverage.size();
    result.coverage[x] = covered;
    result.isFilled[x] = count > 0;
    for (size_t c = 0; c < static_cast<size_t>(_numChannels); ++c)
        result.values[c * width + x] = 0.0f;
    if (count > 0)
        AverageTexel({weights, count}, {values, count}, {strides, count}, &result.values[x], width);
}

void MipChain::Reduce(Level const& from, int row, int width, int height, TexelRow& result) const {
    size_t const w = static_cast<size_t>(width);
    result.values.resize(w * _numChannels);
    result.coverage.resize(w);
    result.isFilled.resize(w);
    Box const rows = FindBox(from.height, height, row);
    bool const isQuarter =
        rows.count == 2 && from.width == 2 * width && !_hasLines;  // boxes of 2 x 2
    TexelRowView const &top = from.window[rows.first % 3],
                       &bottom = from.window[(rows.first + 1) % 3];
    if (isQuarter) ReduceQuarters(top, bottom, result);
    for (int x = 0; x < width; ++x) {
        int const at = 2 * x;
        if (isQuarter) {
            float const least = std::min(std::min(top.coverage[at], top.coverage[at + 1]),
                                         std::min(bottom.coverage[at], bottom.coverage[at + 1]));
            int const anyFilled = top.isFilled[at] | top.isFilled[at + 1] | bottom.isFilled[at] |
                                  bottom.isFilled[at + 1];
            result.coverage[x] = least;
            result.isFilled[x] = static_cast<uint8_t>(anyFilled);
            if (least == 1.0f || !anyFilled) continue;
        }
        ReduceBox(from, rows, FindBox(from.width, width, x), x, result);
    }
}

}  // namespace limn::engine
