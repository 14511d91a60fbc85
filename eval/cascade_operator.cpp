#include "eval/cascade_operator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::eval {

namespace {

using far_ext::CascadeLevel;

/// Of the triangles seen so far: the largest cotangent, and twice their areas.
template <class Scalar>
struct Shapes {
    Scalar maxCotangent = -std::numeric_limits<Scalar>::max();
    Scalar minArea = std::numeric_limits<Scalar>::max();
    double sumArea = 0.0;
    double count = 0.0;
};

template <class Scalar>
constexpr Scalar kLeastSine = std::is_same_v<Scalar, float> ? Scalar(1e-3) : Scalar(1e-7);

/// An edge of a ring, seen from the middle.
template <class Scalar>
struct Spoke {
    CascadeRow<Scalar> vector;
    Scalar square, width;
};

template <class Scalar>
inline Scalar Dot(CascadeRow<Scalar> const& a, CascadeRow<Scalar> const& b) {
    CascadeRow<Scalar> const p = a * b;
    return (p[0] + p[1]) + p[2];
}

template <class Scalar>
Scalar FindCrossSquare(CascadeRow<Scalar> const& a, CascadeRow<Scalar> const& b) {
    Scalar const x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    return (x * x + y * y) + z * z;
}

/// Builds the operator's rows one after another. IsLocal: widths come with the rows.
template <class Scalar, bool IsLocal>
class RowBuilder {
public:
    RowBuilder(CascadeLevel const& level, CascadeRows<Scalar> const& metric, Scalar width, CascadeOperator<Scalar>& op)
        : _level(level), _metric(metric), _a(Scalar(0.5) * width * width), _op(op) {}

    void BuildSurface(Index row) {
        int const begin = _level.offsets[row], end = _level.offsets[row + 1];
        bool const isClosed = row < _level.numClosed;
        _own = _metric[row];
        _edges = &_op.edges[begin];
        _area = Scalar(0);
        std::fill(_edges, _edges + (end - begin), Scalar(0));
        int const step = _level.faceSize - 2, numFaces = (end - begin - (isClosed ? 0 : 1)) / step;
        Spoke<Scalar> last = GetSpoke(_level.neighbours[begin]);
        for (int k = 0; k < numFaces; ++k) {
            int const here = k * step, next = isClosed && k + 1 == numFaces ? 0 : here + step;
            Spoke<Scalar> const spoke = GetSpoke(_level.neighbours[begin + next]);
            if (step == 1) {
                AddTriangle(last, spoke, here, next, Scalar(0.5));
            } else {
                Spoke<Scalar> const diagonal = GetSpoke(_level.neighbours[begin + here + 1]);
                AddTriangle(last, diagonal, here, here + 1, Scalar(0.25));
                AddTriangle(diagonal, spoke, here + 1, next, Scalar(0.25));
                AddTriangle(last, spoke, here, next, Scalar(0.25));
            }
            last = spoke;
        }
        Finish(row, begin, end, _area / Scalar(3));
    }

    void BuildCrease(Index row) {
        int const begin = _level.offsets[row], end = _level.offsets[row + 1];
        _own = _metric[row];
        Scalar mass(0);
        for (int k = begin; k < end; ++k) {
            Spoke<Scalar> const spoke = GetSpoke(_level.neighbours[k]);
            Scalar const length = std::sqrt(spoke.square), h = spoke.width, own = _own[3];
            Scalar const a = IsLocal ? (h * h + h * own + own * own) / Scalar(6) : _a;
            _op.edges[k] = length > Scalar(0) ? a / length : Scalar(0);
            mass += Scalar(0.5) * length;
        }
        Finish(row, begin, end, mass);
    }

    Shapes<Scalar> const& GetShapes() const { return _shapes; }

private:
    Spoke<Scalar> GetSpoke(Index row) const {
        CascadeRow<Scalar> const& other = _metric[row];
        CascadeRow<Scalar> const vector = other - _own;
        return {vector, Dot<Scalar>(vector, vector), IsLocal ? other[3] : Scalar(0)};
    }

    /// The triangle of the middle and spokes i and j; `share` is half of its weight.
    void AddTriangle(Spoke<Scalar> const& a, Spoke<Scalar> const& b, int i, int j, Scalar share) {
        Scalar const ab = Dot<Scalar>(a.vector, b.vector);
        Scalar const squares = a.square * b.square;
        Scalar crossSquare = squares - ab * ab;
        if (crossSquare < Scalar(0.01) * squares) crossSquare = FindCrossSquare<Scalar>(a.vector, b.vector);  // the difference cancels
        Scalar const cross = std::sqrt(crossSquare);
        // The bound is half of the sum of the squared edges: the same from all three corners, so that L is symmetric.
        Scalar const doubleArea = std::max(cross, kLeastSine<Scalar> * (a.square + b.square - ab));
        Scalar const inverse = doubleArea >= std::numeric_limits<Scalar>::min() ? Scalar(1) / doubleArea : Scalar(0);
        Scalar const cotA = (a.square - ab) * inverse, cotB = (b.square - ab) * inverse;
        Scalar diffusion = _a;
        if constexpr (IsLocal) {  // the mean of sigma^2 / 2 of a linear sigma
            Scalar const h = _own[3];
            diffusion = (h * h + a.width * a.width + b.width * b.width + h * a.width + a.width * b.width + b.width * h) / Scalar(12);
        }
        _edges[i] += share * diffusion * cotB;
        _edges[j] += share * diffusion * cotA;
        _area += share * doubleArea;
        _shapes.maxCotangent = std::max(_shapes.maxCotangent, std::max(ab * inverse, std::max(cotA, cotB)));
        _shapes.minArea = std::min(_shapes.minArea, cross);
        _rowArea += cross;
        ++_rowCount;
    }

    void Finish(Index row, int begin, int end, Scalar mass) {
        Scalar sum(0);
        bool isMoved = false;
        for (int k = begin; k < end; ++k) {
            sum += _op.edges[k];
            isMoved |= _op.edges[k] != Scalar(0);
        }
        _op.masses[row] = mass;
        _op.diagonals[row] = isMoved && mass > Scalar(0) ? mass + sum : Scalar(0);
        _shapes.sumArea += static_cast<double>(_rowArea);
        _shapes.count += _rowCount;
        _rowArea = Scalar(0);
        _rowCount = 0;
    }

    CascadeLevel const& _level;
    CascadeRows<Scalar> const& _metric;
    Scalar _a;
    CascadeOperator<Scalar>& _op;
    CascadeRow<Scalar> _own;
    Scalar* _edges = nullptr;
    Scalar _area = Scalar(0), _rowArea = Scalar(0);
    int _rowCount = 0;
    Shapes<Scalar> _shapes;
};

template <bool IsLocal, class Scalar>
std::vector<Shapes<Scalar>> BuildRows(CascadeLevel const& level, CascadeRows<Scalar> const& metric, Scalar width,
                                      CascadeOperator<Scalar>& op) {
    std::vector<Shapes<Scalar>> shapes(static_cast<size_t>(level.numUnknowns / kRowsPerBlock) + 1);
    ForEachBlock(level.numUnknowns, [&](Index begin, Index end, size_t block) {
        RowBuilder<Scalar, IsLocal> builder(level, metric, width, op);
        for (Index row = begin; row < std::min(end, level.numSurface); ++row) builder.BuildSurface(row);
        for (Index row = std::max(begin, level.numSurface); row < end; ++row) builder.BuildCrease(row);
        shapes[block] = builder.GetShapes();
    });
    return shapes;
}

template <class Scalar>
MetricQuality Build(CascadeLevel const& level, CascadeRows<Scalar> const& metric, Scalar width, CascadeOperator<Scalar>& op) {
    op.edges.resize(level.neighbours.size());
    op.masses.resize(static_cast<size_t>(level.numUnknowns));
    op.diagonals.resize(static_cast<size_t>(level.numUnknowns));
    auto const shapes = width < Scalar(0) ? BuildRows<true>(level, metric, width, op) : BuildRows<false>(level, metric, width, op);
    Shapes<Scalar> all;
    for (auto const& part : shapes) {
        all.maxCotangent = std::max(all.maxCotangent, part.maxCotangent);
        all.minArea = std::min(all.minArea, part.minArea);
        all.sumArea += part.sumArea;
        all.count += part.count;
    }
    if (!(all.sumArea > 0.0)) return {};
    return {std::atan2(1.0, static_cast<double>(all.maxCotangent)), static_cast<double>(all.minArea) * all.count / all.sumArea};
}

}  // namespace

MetricQuality BuildOperator(CascadeLevel const& level, CascadeRows<float> const& metric, float width, CascadeOperator<float>& op) {
    return Build(level, metric, width, op);
}

MetricQuality BuildOperator(CascadeLevel const& level, CascadeRows<double> const& metric, double width, CascadeOperator<double>& op) {
    return Build(level, metric, width, op);
}

}  // namespace limn::eval
