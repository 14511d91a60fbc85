// SPDX-License-Identifier: Apache-2.0
//
// Lanes are rows (or the components of one point); no sum crosses lanes, so the width of a register
// decides how many sums run side by side and never how one of them is made. What else a kernel may
// do, see eval/kernels/dispatch.h.

#include "eval/stencils/stencil_kernel.h"

namespace limn::eval {

namespace {

using far_ext::StencilGroups;

constexpr int kLanes = LIMN_KERNEL_LANES;
constexpr int kRows = StencilGroups::kRowsPerPanel;
constexpr int kMostComponents = 4;  // of a point, at a time

typedef float Lanes __attribute__((vector_size(4 * kLanes)));
typedef float Point __attribute__((vector_size(4 * kMostComponents)));

inline Lanes LoadLanes(float const* from) {
    Lanes lanes;
    __builtin_memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

/// C components of a point: a register for four, scalars for fewer, which would have to be put
/// together first.
template <int C>
struct Sum {
    float value[C] = {};
    inline void Add(float weight, float const* point) {
#pragma GCC unroll 4
        for (int c = 0; c < C; ++c) value[c] += weight * point[c];
    }
    inline void Store(Sum const& other, float* to) const {
#pragma GCC unroll 4
        for (int c = 0; c < C; ++c) to[c] = value[c] + other.value[c];
    }
};
template <>
struct Sum<4> {
    Point value{};
    inline void Add(float weight, float const* point) {
        Point loaded;
        __builtin_memcpy(&loaded, point, sizeof loaded);
        value += weight * loaded;
    }
    inline void Store(Sum const& other, float* to) const {
        Point const sum = value + other.value;
        __builtin_memcpy(to, &sum, sizeof sum);
    }
};

/// Calls visit.operator()<C>(c) for the components c, c + 1, ... c + C - 1 of a point, at most four
/// at a time.
template <class Visit>
inline void ForEachComponents(int length, Visit visit) {
    int c = 0;
    for (; length - c >= 4; c += 4) visit.template operator()<4>(c);
    if (length - c == 3) visit.template operator()<3>(c);
    if (length - c == 2) visit.template operator()<2>(c);
    if (length - c == 1) visit.template operator()<1>(c);
}

// -------- single rows

/// Even entries and odd ones, then both: two sums at once, in an order that is the row's alone
/// [Limit 11].
///
/// \tparam Stride  of the source, or 0 where it is not known: multiplying takes time
/// \tparam Size    number of weights, or 0 where it is not known: so few are better unrolled
template <int C, int Stride, int Size>
inline void EvaluateRow(StencilSource const& source, Index const* indices, float const* weights,
                        int size, float* to) {
    std::ptrdiff_t const stride = Stride ? Stride : source.stride;
    int const count = Size ? Size : size;
    Sum<C> even, odd;
    int k = 0;
    for (; k + 1 < count; k += 2) {
        even.Add(weights[k], source.values + indices[k] * stride);
        odd.Add(weights[k + 1], source.values + indices[k + 1] * stride);
    }
    if (k < count) even.Add(weights[k], source.values + indices[k] * stride);
    even.Store(odd, to);
}

/// Rows of equal weights, `count` of them.
template <int C, int Stride, int Size>
void EvaluateEqualRows(StencilSource const& source, Index const* indices, float const* weights,
                       int size, int count, float* to, std::ptrdiff_t stride) {
    for (int i = 0; i < count; ++i, to += stride) {
        EvaluateRow<C, Stride, Size>(source, indices, weights, size, to);
        indices += Size ? Size : size;
    }
}

template <int C, int Stride>
void EvaluateEqualRows(StencilSource const& source, Index const* indices, float const* weights,
                       int size, int count, float* to, std::ptrdiff_t stride) {
    auto const run = [&]<int Size>() {
        EvaluateEqualRows<C, Stride, Size>(source, indices, weights, size, count, to, stride);
    };
    switch (Stride ? size : 0) {  // the sizes that one step of refinement makes of regular faces
        case 2:
            return run.template operator()<2>();
        case 3:
            return run.template operator()<3>();
        case 4:
            return run.template operator()<4>();
        case 6:
            return run.template operator()<6>();
        case 7:
            return run.template operator()<7>();
        case 9:
            return run.template operator()<9>();
        default:
            return run.template operator()<0>();
    }
}

template <int C, int Stride>
void EvaluateRows(StencilJob const& job, StencilRowArrays const& rows, Index first, Index last,
                  int component) {
    StencilSource const source{job.source.values + component, job.source.stride};
    for (Index row = first; row < last; ++row) {
        Index const begin = rows.offsets[row];
        for (int set = 0; set < job.numSets; ++set) {
            StencilTarget const& target = job.targets[set];
            EvaluateEqualRows<C, Stride>(
                source, rows.indices + begin, rows.weights[set] + begin, rows.sizes[row], 1,
                target.values + row * target.stride + component, target.stride);
        }
    }
}

// -------- groups

/// Where the rows of a group go, one stretch after another: a face's points are few runs of the
/// table's rows (inside, along each edge, at corners).
class RowCursor {
public:
    RowCursor(int const* lengths, Index const* starts) : _lengths(lengths), _starts(starts) {}

    /// Calls copy(from, row, count) for the next `count` rows; `from` counts from 0.
    template <class Copy>
    inline void Take(int count, Copy copy) {
        for (int done = 0; done < count;) {
            int const left = *_lengths - _used, some = left < count - done ? left : count - done;
            copy(done, *_starts + _used, some);
            done += some;
            _used += some;
            if (_used == *_lengths) {
                ++_lengths;
                ++_starts;
                _used = 0;
            }
        }
    }

private:
    int const* _lengths;
    Index const* _starts;
    int _used = 0;
};

/// N registers of rows times C components: sums over all columns. Lanes are rows, a column is one
/// point for all of them: no sum crosses lanes [Limit 11]. Register n's weights start at weights +
/// n * step, column j's lie j * kRows further.
template <int C, int N>
inline void SumColumns(float const* weights, std::ptrdiff_t step, int numColumns,
                       float const* points, float* sums /* [C][N * kLanes] */) {
    Lanes sum[C][N] = {};
    for (int j = 0; j < numColumns; ++j, weights += kRows, points += C) {
#pragma GCC unroll 4
        for (int n = 0; n < N; ++n) {
            Lanes const w = LoadLanes(weights + n * step);
#pragma GCC unroll 4
            for (int c = 0; c < C; ++c) sum[c][n] += w * points[c];
        }
    }
    __builtin_memcpy(sums, sum, sizeof sum);
}

/// Writes `count` rows of sums ([C][stride]) to consecutive rows of the target.
template <int C>
inline void WriteRows(float const* sums, int sumStride, float* to, std::ptrdiff_t stride,
                      int count) {
    if (stride == C) {
        for (int i = 0; i < count; ++i) {
#pragma GCC unroll 4
            for (int c = 0; c < C; ++c) to[C * i + c] = sums[c * sumStride + i];
        }
    } else {
        for (int i = 0; i < count; ++i, to += stride) {
#pragma GCC unroll 4
            for (int c = 0; c < C; ++c) to[c] = sums[c * sumStride + i];
        }
    }
}

template <int C>
void EvaluateBlock(StencilJob const& job, StencilGroups::Block const& block, float const* weights,
                   int const* lengths, Index const* starts, float const* points,
                   StencilTarget target) {
    constexpr int kTwo = 2 * kLanes;
    float sums[C * kTwo];
    RowCursor cursor(lengths, starts);
    std::ptrdiff_t const panel = static_cast<std::ptrdiff_t>(block.numColumns) * kRows;
    // Two registers side by side: of one panel, or of two where a register is a whole panel.
    std::ptrdiff_t const step = kLanes < kRows ? kLanes : panel;
    for (int row = 0; row < block.numRows; row += kTwo) {
        int const count = block.numRows - row < kTwo ? block.numRows - row : kTwo;
        float const* const from = weights + row / kRows * panel + row % kRows;
        int sumStride = kTwo;
        if (count > kLanes) {
            SumColumns<C, 2>(from, step, block.numColumns, points, sums);
        } else {
            SumColumns<C, 1>(from, step, block.numColumns, points, sums);
            sumStride = kLanes;
        }
        cursor.Take(count, [&](int done, Index start, int some) {
            int const skip = start < job.begin ? static_cast<int>(job.begin - start) : 0;
            int const stop = start + some > job.end ? static_cast<int>(job.end - start) : some;
            if (skip < stop) {
                WriteRows<C>(sums + done + skip, sumStride,
                             target.values + (start + skip) * target.stride, target.stride,
                             stop - skip);
            }
        });
    }
}

/// Floats of one weight set of a block. (The block's own functions are inline: see dispatch.h.)
inline std::ptrdiff_t SetSize(StencilGroups::Block const& block) {
    return static_cast<std::ptrdiff_t>((block.numRows + kRows - 1) / kRows) * block.numColumns *
           kRows;
}

/// False if none of the group's rows is among those asked for.
inline bool Touches(StencilJob const& job, StencilGroups::Shape const& shape, int const* lengths,
                    Index const* starts) {
    for (int run = 0; run < shape.numRuns; ++run) {
        if (starts[run] < job.end && starts[run] + lengths[run] > job.begin) return true;
    }
    return false;
}

// -------- slices

template <bool IsUnitStride>
inline void EvaluateSlice(StencilSource const& source, Index const* indices, float const* weights,
                          std::size_t size, float* sums) {
    constexpr int W = StencilSliceArrays::kLanes,
                  H = kLanes < 8 ? kLanes : 8;  // more are put together slowly
    typedef float Part __attribute__((vector_size(4 * H)));
    Part sum[W / H] = {};
    for (std::size_t k = 0; k < size; ++k, indices += W, weights += W) {
#pragma GCC unroll 4
        for (int n = 0; n < W / H; ++n) {
            Part values, weight;
#pragma GCC unroll 8
            for (int l = 0; l < H; ++l) {
                Index const index = indices[n * H + l];
                values[l] = source.values[IsUnitStride ? index : index * source.stride];
            }
            __builtin_memcpy(&weight, weights + n * H, sizeof weight);
            sum[n] += weight * values;
        }
    }
    __builtin_memcpy(sums, sum, sizeof sum);
}

/// Four components of all rows at once. A row alone would wait for each of its additions; eight run
/// side by side, each still entry after entry [Limit 11].
template <bool IsUnitStride>
inline void EvaluateSliceOfPoints(StencilSource const& source, Index const* indices,
                                  float const* weights, std::size_t size, Point* sums) {
    constexpr int W = StencilSliceArrays::kLanes, kAbreast = 8;
    std::ptrdiff_t const stride = IsUnitStride ? kMostComponents : source.stride;
    for (int first = 0; first < W; first += kAbreast) {
        Point sum[kAbreast] = {};
        for (std::size_t k = 0; k < size; ++k) {
#pragma GCC unroll 8
            for (int l = 0; l < kAbreast; ++l) {
                std::size_t const at = k * W + static_cast<std::size_t>(first + l);
                Point point;
                __builtin_memcpy(&point, source.values + indices[at] * stride, sizeof point);
                sum[l] += weights[at] * point;
            }
        }
        __builtin_memcpy(sums + first, sum, sizeof sum);
    }
}

// -------- the kernel

void EvaluateStencilRows(StencilJob const& job, StencilRowArrays const& rows, Index first,
                         Index last) {
    ForEachComponents(job.length, [&]<int C>(int component) {
        job.source.stride == C ? EvaluateRows<C, C>(job, rows, first, last, component)
                               : EvaluateRows<C, 0>(job, rows, first, last, component);
    });
}

void EvaluateStencilRuns(StencilJob const& job, StencilRunArrays const& table, Index first,
                         Index last) {
    for (Index r = first; r < last; ++r) {
        StencilGroups::Run const& run = table.runs[r];
        int const skip = run.firstRow < job.begin ? static_cast<int>(job.begin - run.firstRow) : 0;
        int const stop = run.firstRow + run.numRows > job.end
                             ? static_cast<int>(job.end - run.firstRow)
                             : run.numRows;
        if (skip >= stop) continue;
        Index const* const indices =
            table.indices + run.firstIndex + static_cast<std::ptrdiff_t>(skip) * run.size;
        for (int set = 0; set < job.numSets; ++set) {
            float const* const weights =
                table.weights + run.firstWeight + static_cast<std::ptrdiff_t>(set) * run.size;
            StencilTarget const& target = job.targets[set];
            float* const to = target.values + (run.firstRow + skip) * target.stride;
            ForEachComponents(job.length, [&]<int C>(int component) {
                StencilSource const source{job.source.values + component, job.source.stride};
                auto const evaluate =
                    source.stride == C ? EvaluateEqualRows<C, C> : EvaluateEqualRows<C, 0>;
                evaluate(source, indices, weights, run.size, stop - skip, to + component,
                         target.stride);
            });
        }
    }
}

void EvaluateStencilGroups(StencilJob const& job, StencilGroupArrays const& table, Index first,
                           Index last) {
    float points[StencilGroups::kMaxColumns * kMostComponents];
    ForEachComponents(job.length, [&]<int C>(int component) {
        for (Index g = first; g < last; ++g) {
            StencilGroups::Group const& group = table.groups[g];
            StencilGroups::Block const& block = table.blocks[group.block];
            StencilGroups::Shape const& shape = table.shapes[group.shape];
            int const* const lengths = table.runLengths + shape.firstRun;
            Index const* const starts = table.runStarts + group.firstStart;
            if (!Touches(job, shape, lengths, starts)) continue;
            Index const* const controls = table.controls + group.firstControl;
            for (int j = 0; j < block.numColumns; ++j) {
                __builtin_memcpy(points + C * j,
                                 job.source.values + controls[j] * job.source.stride + component,
                                 4 * C);
            }
            for (int set = 0; set < job.numSets; ++set) {
                StencilTarget target = job.targets[set];
                target.values += component;
                EvaluateBlock<C>(job, block,
                                 table.weights + block.firstWeight + set * SetSize(block), lengths,
                                 starts, points, target);
            }
        }
    });
}

void EvaluateStencilSlices(StencilJob const& job, StencilSliceArrays const& slices, Index first,
                           Index last) {
    constexpr int W = StencilSliceArrays::kLanes;
    float sums[W];
    for (Index slice = first; slice < last; ++slice) {
        std::size_t const begin = slices.sliceOffsets[slice],
                          size = slices.sliceOffsets[slice + 1] - begin;
        Index const* const indices = slices.indices + begin * W;
        for (int set = 0; set < job.numSets; ++set) {
            float const* const weights = slices.weights[set] + begin * W;
            StencilTarget const& target = job.targets[set];
            int c = 0;
            for (; c + kMostComponents <= job.length; c += kMostComponents) {
                StencilSource const source{job.source.values + c, job.source.stride};
                Point points[W];
                source.stride == kMostComponents
                    ? EvaluateSliceOfPoints<true>(source, indices, weights, size, points)
                    : EvaluateSliceOfPoints<false>(source, indices, weights, size, points);
                for (int l = 0; l < W; ++l) {
                    Index const row = slices.rows[static_cast<std::size_t>(slice) * W + l];
                    if (row >= job.begin && row < job.end)
                        __builtin_memcpy(target.values + row * target.stride + c, &points[l],
                                         sizeof(Point));
                }
            }
            for (; c < job.length; ++c) {
                StencilSource const source{job.source.values + c, job.source.stride};
                source.stride == 1 ? EvaluateSlice<true>(source, indices, weights, size, sums)
                                   : EvaluateSlice<false>(source, indices, weights, size, sums);
                for (int l = 0; l < W; ++l) {
                    Index const row = slices.rows[static_cast<std::size_t>(slice) * W + l];
                    if (row >= job.begin && row < job.end)
                        target.values[row * target.stride + c] = sums[l];
                }
            }
        }
    }
}

}  // namespace

constinit StencilKernel const StencilKernel::LIMN_KERNEL = {
    .evaluateRows = EvaluateStencilRows,
    .evaluateRuns = EvaluateStencilRuns,
    .evaluateGroups = EvaluateStencilGroups,
    .evaluateSlices = EvaluateStencilSlices,
};

}  // namespace limn::eval
