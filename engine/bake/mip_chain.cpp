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
        double const b[6] = {a[0] * a[0] + a[1] * a[1] + a[2] * a[2], a[0] * a[1] + a[1] * a[3] + a[2] * a[4],
                             a[0] * a[2] + a[1] * a[4] + a[2] * a[5], a[1] * a[1] + a[3] * a[3] + a[4] * a[4],
                             a[1] * a[2] + a[3] * a[4] + a[4] * a[5], a[2] * a[2] + a[4] * a[4] + a[5] * a[5]};
        std::copy(b, b + 6, a);
    }
    double v[3] = {a[0], a[1], a[2]};
    if (a[3] > a[0] && a[3] >= a[5]) v[0] = a[1], v[1] = a[3], v[2] = a[4];
    else if (a[5] > a[0] && a[5] > a[3]) v[0] = a[2], v[1] = a[4], v[2] = a[5];
    double const length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 0.0)) return {0.0f, 0.0f, 0.0f};
    return {static_cast<float>(v[0] / length), static_cast<float>(v[1] / length), static_cast<float>(v[2] / length)};
}

namespace {

/// Which finer texels a coarser one holds along one axis, and how much of each.
struct Box {
    int first, count;
    float weights[3];
};

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

MipChain::MipChain(int width, int height, int numLevels, int numChannels, std::vector<ChannelGroup> groups,
                   Emit emit)
    : _numChannels(numChannels), _groups(std::move(groups)), _emit(std::move(emit)) {
    _hasLines = std::any_of(_groups.begin(), _groups.end(),
                            [](ChannelGroup const& group) { return group.averaging == Averaging::Line; });
    for (int level = 0; level < numLevels; ++level) {
        Level l;
        l.width = std::max(1, width >> level);
        l.height = std::max(1, height >> level);
        l.window.resize(3);
        _levels.push_back(std::move(l));
    }
}

void MipChain::AddRow(int level, TexelRow const& row) {
    if (level > 0) _emit(level, _levels[level].numRows, row);
    Level& from = _levels[level];
    if (level + 1 == static_cast<int>(_levels.size())) {
        ++from.numRows;
        return;
    }
    from.window[from.numRows % 3] = row;
    ++from.numRows;
    Level const& to = _levels[level + 1];
    while (to.numRows < to.height) {
        Box const box = FindBox(from.height, to.height, to.numRows);
        if (box.first + box.count > from.numRows) break;
        AddRow(level + 1, Reduce(from, to.width, to.height, to.numRows));
    }
}

void MipChain::AverageTexel(std::span<float const> weights, std::span<float const* const> values,
                            std::span<size_t const> at, size_t stride, float* out, size_t outStride) const {
    for (ChannelGroup const& group : _groups) {
        if (group.averaging == Averaging::Line) {
            std::array<double, 6> sum{};
            for (size_t k = 0; k < weights.size(); ++k) {
                double d[3];
                for (int c = 0; c < 3; ++c) d[c] = values[k][static_cast<size_t>(group.first + c) * stride + at[k]];
                int index = 0;
                for (int a = 0; a < 3; ++a) {
                    for (int b = a; b < 3; ++b) sum[index++] += static_cast<double>(weights[k]) * d[a] * d[b];
                }
            }
            auto const line = FindMainLine(sum);
            for (int c = 0; c < 3; ++c) out[static_cast<size_t>(group.first + c) * outStride] = line[c];
            continue;
        }
        float lengthSquared = 0.0f, total = 0.0f;
        for (float weight : weights) total += weight;
        for (int c = group.first; c < group.first + group.count; ++c) {
            float sum = 0.0f;
            for (size_t k = 0; k < weights.size(); ++k) {
                sum += weights[k] * values[k][static_cast<size_t>(c) * stride + at[k]];
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

/// The two common cases of a 2 x 2 box: fully covered (no lines among the channels), and empty.
bool MipChain::ReduceQuarter(Level const& from, int row, int x, TexelRow& result) const {
    TexelRow const &top = from.window[row % 3], &bottom = from.window[(row + 1) % 3];
    size_t const at = 2 * static_cast<size_t>(x), fineWidth = static_cast<size_t>(from.width);
    if (!(top.isFilled[at] | top.isFilled[at + 1] | bottom.isFilled[at] | bottom.isFilled[at + 1])) return true;
    bool const isCovered = top.coverage[at] == 1.0f && top.coverage[at + 1] == 1.0f && bottom.coverage[at] == 1.0f &&
                           bottom.coverage[at + 1] == 1.0f;
    if (!isCovered || _hasLines) return false;
    size_t const width = result.coverage.size(), to = static_cast<size_t>(x);
    for (ChannelGroup const& group : _groups) {
        float lengthSquared = 0.0f;
        for (int c = group.first; c < group.first + group.count; ++c) {
            size_t const plane = static_cast<size_t>(c) * fineWidth + at;
            float const mean = 0.25f * ((top.values[plane] + top.values[plane + 1]) +
                                        (bottom.values[plane] + bottom.values[plane + 1]));
            result.values[static_cast<size_t>(c) * width + to] = mean;
            lengthSquared += mean * mean;
        }
        if (group.averaging != Averaging::UnitVector || !(lengthSquared > 0.0f)) continue;
        float const toUnit = 1.0f / std::sqrt(lengthSquared);
        for (int c = group.first; c < group.first + group.count; ++c) {
            result.values[static_cast<size_t>(c) * width + to] *= toUnit;
        }
    }
    result.coverage[to] = 1.0f;
    result.isFilled[to] = 1;
    return true;
}

TexelRow MipChain::Reduce(Level const& from, int width, int height, int row) const {
    TexelRow result;
    size_t const w = static_cast<size_t>(width), fineWidth = static_cast<size_t>(from.width);
    result.values.assign(w * _numChannels, 0.0f);
    result.coverage.assign(w, 0.0f);
    result.isFilled.assign(w, 0);
    Box const rows = FindBox(from.height, height, row);
    bool const isQuarter = rows.count == 2 && from.width == 2 * width;  // boxes of 2 x 2
    float weights[9];
    float const* values[9];
    size_t at[9];
    for (int x = 0; x < width; ++x) {
        if (isQuarter && ReduceQuarter(from, rows.first, x, result)) continue;
        Box const columns = FindBox(from.width, width, x);
        // First what is covered; where nothing is, the padding.
        float covered = 0.0f;
        size_t count = 0;
        for (bool const isPadding : {false, true}) {
            if (isPadding && count > 0) break;
            for (int j = 0; j < rows.count; ++j) {
                TexelRow const& fine = from.window[(rows.first + j) % 3];
                for (int i = 0; i < columns.count; ++i) {
                    size_t const column = static_cast<size_t>(columns.first + i);
                    float const area = rows.weights[j] * columns.weights[i];
                    float const weight = isPadding ? (fine.isFilled[column] ? area : 0.0f)
                                                   : area * fine.coverage[column];
                    if (!(weight > 0.0f)) continue;
                    weights[count] = weight;
                    values[count] = fine.values.data();
                    at[count] = column;
                    ++count;
                    if (!isPadding) covered += weight;
                }
            }
        }
        if (count == 0) continue;
        result.coverage[x] = covered;
        result.isFilled[x] = 1;
        AverageTexel({weights, count}, {values, count}, {at, count}, fineWidth, &result.values[x], w);
    }
    return result;
}

}  // namespace limn::engine
