// SPDX-License-Identifier: Apache-2.0
//
// The operator's rows lie side by side, one in each lane, as long as their rings are those of a
// regular vertex; all others are built one at a time by the same code with a single number in place
// of a register. In a sweep the lanes are x, y, z and the width of one row. What a kernel may do,
// see eval/kernels/dispatch.h.

#include "eval/cascade/cascade_kernel.h"

namespace limn::eval {

namespace {

constexpr int kLanes = LIMN_KERNEL_LANES;
constexpr float kMost = __FLT_MAX__;

typedef float Lanes __attribute__((vector_size(4 * kLanes)));

template <class Scalar>
struct PointOf {
    typedef Scalar Type __attribute__((vector_size(4 * sizeof(Scalar))));
};
template <class Scalar>
using Point = typename PointOf<Scalar>::Type;

template <class Value>
inline Value Load(void const* from) {
    Value value;
    __builtin_memcpy(&value, from, sizeof value);
    return value;
}

inline float Sqrt(float a) {
    return __builtin_sqrtf(a);
}
inline double Sqrt(double a) {
    return __builtin_sqrt(a);
}
inline Lanes Sqrt(Lanes const& a) {
    Lanes root;
    for (int l = 0; l < kLanes; ++l) root[l] = __builtin_sqrtf(a[l]);
    return root;
}

/// The larger; b where a is no number.
template <class L>
inline L Max(L const& a, L const& b) {
    return a > b ? a : b;
}

inline Index Min(Index a, Index b) {
    return a < b ? a : b;
}

// -------- rings

/// x, y, z and width of a row, or of kLanes rows.
template <class L>
struct Row {
    L x, y, z, width;
};

template <class Scalar>
inline Row<Scalar> LoadRow(Scalar const* rows, Index index) {
    Scalar const* const row = rows + 4 * static_cast<long>(index);
    return {row[0], row[1], row[2], row[3]};
}

/// Lanes I and I + 1 of a and b in turn, of every four lanes; I is 0 or 2.
template <int I>
inline Lanes Interleave(Lanes const& a, Lanes const& b) {
#if LIMN_KERNEL_LANES == 4
    return __builtin_shufflevector(a, b, I, I + 4, I + 1, I + 5);
#elif LIMN_KERNEL_LANES == 8
    return __builtin_shufflevector(a, b, I, I + 8, I + 1, I + 9, I + 4, I + 12, I + 5, I + 13);
#else
    return __builtin_shufflevector(a, b, I, I + 16, I + 1, I + 17, I + 4, I + 20, I + 5, I + 21,  //
                                   I + 8, I + 24, I + 9, I + 25, I + 12, I + 28, I + 13, I + 29);
#endif
}

/// Four lanes after four lanes.
inline Lanes Join(Point<float> const* parts) {
#if LIMN_KERNEL_LANES == 4
    return parts[0];
#elif LIMN_KERNEL_LANES == 8
    return __builtin_shufflevector(parts[0], parts[1], 0, 1, 2, 3, 4, 5, 6, 7);
#else
    auto const low = __builtin_shufflevector(parts[0], parts[1], 0, 1, 2, 3, 4, 5, 6, 7);
    auto const high = __builtin_shufflevector(parts[2], parts[3], 0, 1, 2, 3, 4, 5, 6, 7);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}

/// \param indices  of the row in lane l: indices[l * step]
inline Row<Lanes> LoadRows(float const* rows, Index const* indices, int step) {
    Point<float> parts[4][kLanes / 4];  // rows 0, 4, 8 ..., rows 1, 5, 9 ...
    for (int l = 0; l < kLanes; ++l)
        parts[l % 4][l / 4] = Load<Point<float>>(rows + 4 * static_cast<long>(indices[l * step]));
    Lanes const a = Join(parts[0]), b = Join(parts[1]), c = Join(parts[2]), d = Join(parts[3]);
    Lanes const xy0 = Interleave<0>(a, c), xy1 = Interleave<0>(b, d), zw0 = Interleave<2>(a, c),
                zw1 = Interleave<2>(b, d);
    return {Interleave<0>(xy0, xy1), Interleave<2>(xy0, xy1), Interleave<0>(zw0, zw1),
            Interleave<2>(zw0, zw1)};
}

/// An edge of a ring, seen from the middle.
template <class L>
struct Spoke {
    L x, y, z, square, width;

    Spoke(Row<L> const& from, Row<L> const& to)
        : x(to.x - from.x),
          y(to.y - from.y),
          z(to.z - from.z),
          square((x * x + y * y) + z * z),
          width(to.width) {}
};

template <class L>
inline L Dot(Spoke<L> const& a, Spoke<L> const& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

constexpr float GetLeastSine(float) {
    return 1e-3f;
}
constexpr double GetLeastSine(double) {
    return 1e-7;
}

constexpr float GetLeastArea(float) {
    return __FLT_MIN__;
}  // whose inverse is finite
constexpr double GetLeastArea(double) {
    return __DBL_MIN__;
}

/// The triangles round one row, or kLanes of them: each adds to -L of its two spokes a_T cot / 2 of
/// the angle opposite, and to the area [Cascade 3].
template <class Scalar, class L, bool IsLocal>
class Fan {
public:
    /// \param weights  per entry of the ring: what is added to
    Fan(Row<L> const& own, Scalar diffusion, L* weights, CascadeShapes<L>& shapes)
        : _own(own), _diffusion(diffusion), _weights(weights), _shapes(shapes) {}

    /// The triangle of the middle and spokes i and j; `share` is half of its weight.
    inline void Add(Spoke<L> const& a, Spoke<L> const& b, int i, int j, Scalar share) {
        L const ab = Dot(a, b);
        // Not from squares and dot products, whose difference cancels at slivers [Cascade 3].
        L const x = a.y * b.z - a.z * b.y, y = a.z * b.x - a.x * b.z, z = a.x * b.y - a.y * b.x;
        L const cross = Sqrt((x * x + y * y) + z * z);
        // The bound is half of the sum of the squared edges: the same from all three corners, so
        // that L is symmetric.
        L const doubleArea = Max(cross, GetLeastSine(Scalar()) * (a.square + b.square - ab));
        L const inverse = doubleArea >= L{} + GetLeastArea(Scalar()) ? Scalar(1) / doubleArea : L{};
        L const scale = share * FindDiffusion(a, b) * inverse;
        _weights[i] += (b.square - ab) * scale;
        _weights[j] += (a.square - ab) * scale;
        _area += share * doubleArea;
        _shapes.maxCotangent =
            Max(Max(ab, Max(a.square, b.square) - ab) * inverse, _shapes.maxCotangent);
        _shapes.minArea = cross < _shapes.minArea ? cross : _shapes.minArea;
    }

    L const& GetArea() const { return _area; }

private:
    /// The mean of sigma^2 / 2 of a linear sigma: exact, so that a triangle's children have the
    /// same mean [Cascade 3].
    inline L FindDiffusion(Spoke<L> const& a, Spoke<L> const& b) const {
        if constexpr (!IsLocal) return L{} + _diffusion;
        L const& h = _own.width;
        return (h * h + a.width * a.width + b.width * b.width + h * a.width + a.width * b.width +
                b.width * h) /
               Scalar(12);
    }

    Row<L> const& _own;
    Scalar _diffusion;
    L* _weights;
    CascadeShapes<L>& _shapes;
    L _area{};
};

/// Weights of a ring. \return  the area round its middle
///
/// \param load  load(k): entry k of the ring
template <class Scalar, class L, bool IsLocal, class LoadEntry>
inline L BuildRing(Row<L> const& own, Scalar diffusion, int faceSize, int size, bool isClosed,
                   LoadEntry load, L* weights, CascadeShapes<L>& shapes) {
    Fan<Scalar, L, IsLocal> fan(own, diffusion, weights, shapes);
    int const step = faceSize - 2, last = isClosed ? size : size - 1;
    for (int k = 0; k < size; ++k) weights[k] = L{};
    Spoke<L> const first(own, load(0));
    Spoke<L> here = first;
#pragma GCC unroll 8
    for (int k = 0; k < last; k += step) {
        int const next = k + step < size ? k + step : 0;
        Spoke<L> const there = next ? Spoke<L>(own, load(next)) : first;
        if (step == 1) {
            fan.Add(here, there, k, next, Scalar(0.5));
        } else {
            // A quad is both pairs of triangles that its diagonals make, half each; of the pair
            // that does not part this corner, one triangle is here [Cascade 3].
            Spoke<L> const diagonal(own, load(k + 1));
            fan.Add(here, diagonal, k, k + 1, Scalar(0.25));
            fan.Add(diagonal, there, k + 1, next, Scalar(0.25));
            fan.Add(here, there, k, next, Scalar(0.25));
        }
        here = there;
    }
    return fan.GetArea();
}

/// The diagonal's entry; 0 where nothing moves the row: such rows keep X0 to the bit,
/// which the equation would give but for rounding [Cascade 3].
template <class L>
inline L FindDiagonal(L const* weights, int size, L const& mass) {
    L sum{}, absolute{};
    for (int k = 0; k < size; ++k) {
        sum += weights[k];
        absolute += weights[k] < L{} ? -weights[k] : weights[k];
    }
    L const diagonal = absolute > L{} ? mass + sum : L{};
    return mass > L{} ? diagonal : L{};
}

template <class Scalar, bool IsLocal>
inline void BuildSurfaceRow(CascadeBuildJob<Scalar> const& job, Index row,
                            CascadeShapes<Scalar>& shapes) {
    int const begin = job.rings.offsets[row], size = job.rings.offsets[row + 1] - begin;
    Index const* const ring = job.rings.neighbours + begin;
    Scalar* const weights = job.edges + begin;
    Scalar const area = BuildRing<Scalar, Scalar, IsLocal>(
        LoadRow(job.metric, row), job.diffusion, job.rings.faceSize, size,
        row < job.rings.numClosed, [&](int k) { return LoadRow(job.metric, ring[k]); }, weights,
        shapes);
    job.masses[row] = area / Scalar(3);
    job.diagonals[row] = FindDiagonal(weights, size, job.masses[row]);
}

/// A row on a crease: its two neighbours along it. The same filter on a curve, mass by length
/// [Cascade 3].
template <class Scalar, bool IsLocal>
inline void BuildCreaseRow(CascadeBuildJob<Scalar> const& job, Index row) {
    int const begin = job.rings.offsets[row], end = job.rings.offsets[row + 1];
    Row<Scalar> const own = LoadRow(job.metric, row);
    Scalar mass(0);
    for (int k = begin; k < end; ++k) {
        Spoke<Scalar> const spoke(own, LoadRow(job.metric, job.rings.neighbours[k]));
        Scalar const length = Sqrt(spoke.square), h = spoke.width;
        Scalar const diffusion =
            IsLocal ? (h * h + h * own.width + own.width * own.width) / Scalar(6) : job.diffusion;
        job.edges[k] = length > Scalar(0) ? diffusion / length : Scalar(0);
        mass += Scalar(0.5) * length;
    }
    job.masses[row] = mass;
    job.diagonals[row] = FindDiagonal(job.edges + begin, end - begin, mass);
}

// -------- regular rings side by side

template <int FaceSize, int Size, bool IsLocal>
inline void BuildRegularRows(CascadeBuildJob<float> const& job, Index row,
                             CascadeShapes<Lanes>& shapes) {
    int const begin = job.rings.offsets[row];
    Index const* const rings = job.rings.neighbours + begin;
    Index rows[kLanes];
    for (int l = 0; l < kLanes; ++l) rows[l] = row + l;
    Lanes weights[Size];
    Lanes const area = BuildRing<float, Lanes, IsLocal>(
        LoadRows(job.metric, rows, 1), job.diffusion, FaceSize, Size, true,
        [&](int k) { return LoadRows(job.metric, rings + k, Size); }, weights, shapes);
    Lanes const mass = area / 3.0f, diagonal = FindDiagonal(weights, Size, mass);
    __builtin_memcpy(job.masses + row, &mass, sizeof mass);
    __builtin_memcpy(job.diagonals + row, &diagonal, sizeof diagonal);
    float entries[Size][kLanes];
    __builtin_memcpy(entries, weights, sizeof weights);
    for (int l = 0; l < kLanes; ++l) {
        for (int k = 0; k < Size; ++k) job.edges[begin + l * Size + k] = entries[k][l];
    }
}

/// Builds the regular ones of closed rows.
template <int FaceSize, int Size, bool IsLocal>
CascadeShapes<float> BuildClosedRows(CascadeBuildJob<float> const& job, Index begin, Index end,
                                     CascadeShapes<float> shapes) {
    CascadeShapes<Lanes> all{Lanes{} + shapes.maxCotangent, Lanes{} + shapes.minArea};
    for (Index row = begin; row < end;) {
        Index const first = row;
        while (row < end && job.rings.offsets[row + 1] - job.rings.offsets[row] == Size) ++row;
        if (row - first >= kLanes) {  // the last ones partly again
            for (Index at = first; at < row; at += kLanes)
                BuildRegularRows<FaceSize, Size, IsLocal>(job, Min(at, row - kLanes), all);
        } else {
            for (Index at = first; at < row; ++at) BuildSurfaceRow<float, IsLocal>(job, at, shapes);
        }
        if (row < end) BuildSurfaceRow<float, IsLocal>(job, row++, shapes);
    }
    for (int l = 0; l < kLanes; ++l) {
        shapes.maxCotangent = Max(all.maxCotangent[l], shapes.maxCotangent);
        shapes.minArea = all.minArea[l] < shapes.minArea ? all.minArea[l] : shapes.minArea;
    }
    return shapes;
}

template <class Scalar, bool IsLocal>
CascadeShapes<Scalar> BuildRowsAs(CascadeBuildJob<Scalar> const& job, Index begin, Index end) {
    CascadeShapes<Scalar> shapes{-kMost, kMost};
    Index row = begin;
    if constexpr (sizeof(Scalar) == sizeof(float)) {
        Index const endClosed = Min(end, job.rings.numClosed);
        if (row < endClosed) {
            shapes = job.rings.faceSize == 3
                         ? BuildClosedRows<3, 6, IsLocal>(job, row, endClosed, shapes)
                         : BuildClosedRows<4, 8, IsLocal>(job, row, endClosed, shapes);
            row = endClosed;
        }
    }
    for (; row < Min(end, job.rings.numSurface); ++row)
        BuildSurfaceRow<Scalar, IsLocal>(job, row, shapes);
    for (; row < end; ++row) BuildCreaseRow<Scalar, IsLocal>(job, row);
    return shapes;
}

template <class Scalar>
CascadeShapes<Scalar> BuildRows(CascadeBuildJob<Scalar> const& job, Index begin, Index end) {
    return job.isLocal ? BuildRowsAs<Scalar, true>(job, begin, end)
                       : BuildRowsAs<Scalar, false>(job, begin, end);
}

// -------- sweeps

/// The sum over a ring of edge times difference: -L X, since rows of L add up to 0, and without the
/// cancellation of large terms. \tparam Size  of the ring, or 0 where it is not known
template <int Size, class Scalar>
inline Point<Scalar> SumRing(Scalar const* x, Point<Scalar> const& own, Index const* neighbours,
                             Scalar const* edges, int size, Point<Scalar> even) {
    int const count = Size ? Size : size;
    // Two sums at once, at every width [Limit 11]: an addition takes several cycles.
    Point<Scalar> odd{};
    auto const get = [&](int k) {
        return edges[k] * (Load<Point<Scalar>>(x + 4 * static_cast<long>(neighbours[k])) - own);
    };
    int k = 0;
#pragma GCC unroll 4
    for (; k + 1 < count; k += 2) {
        even += get(k);
        odd += get(k + 1);
    }
    if (k < count) even += get(k);
    return even + odd;
}

template <class Scalar>
void SweepRows(CascadeSweepJob<Scalar> const& job, Index begin, Index end) {
    Scalar const *const x = job.x, *const x0 = job.x0, *const masses = job.masses,
                        *const diagonals = job.diagonals;
    Scalar* const to = job.to;
    Scalar const damping = job.damping;
    int const* const offsets = job.rings.offsets;
    Index const* neighbours = job.rings.neighbours + offsets[begin];
    Scalar const* edges = job.edges + offsets[begin];
    for (Index row = begin; row < end; ++row) {
        long const at = 4 * static_cast<long>(row);
        int const size = offsets[row + 1] - offsets[row];
        Point<Scalar> const own = Load<Point<Scalar>>(x + at);
        Point<Scalar> sum = masses[row] * (Load<Point<Scalar>>(x0 + at) - own);
        sum = size == 6 ? SumRing<6>(x, own, neighbours, edges, size, sum)
                        : SumRing<0>(x, own, neighbours, edges, size, sum);
        Scalar const diagonal = diagonals[row],
                     scale = diagonal > Scalar(0) ? damping / diagonal : Scalar(0);
        Point<Scalar> const result = own + scale * sum;
        __builtin_memcpy(to + at, &result, sizeof result);
        neighbours += size;
        edges += size;
    }
}

}  // namespace

constinit CascadeKernel const CascadeKernel::LIMN_KERNEL = {{BuildRows<float>, SweepRows<float>},
                                                            {BuildRows<double>, SweepRows<double>}};

}  // namespace limn::eval
