// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/limit_operator.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "eval/parallel/rows.h"
#include "far_ext/error.h"
#include "far_ext/rows/breadth_first.h"

namespace limn::eval {

using far_ext::LimitRow;

std::span<Index const> LimitOperator::GetNeighbours(Index row) const {
    int const start = _starts[row] + GetClass(row).isExplicit;
    return {_indices.data() + start, static_cast<size_t>(_starts[row + 1] - start)};
}

size_t LimitOperator::GetNumBytes() const {
    return _starts.capacity() * sizeof(int) + _classes.capacity() * sizeof(short) +
           _indices.capacity() * sizeof(Index) + _weights.capacity() * sizeof(double);
}

unsigned short LimitOperator::FindClass(RowClass const& wanted) {
    // Meshes have a few dozen classes; the latest ones come back soonest.
    for (size_t i = _table.size(); i-- > 0;) {
        if (_table[i] == wanted) return static_cast<unsigned short>(i);
    }
    if (_table.size() > std::numeric_limits<unsigned short>::max()) {
        throw Error(ErrorCode::TooLarge,
                    "the limit matrix has more than 65536 kinds of rows (valences and face sizes)");
    }
    _table.push_back(wanted);
    return static_cast<unsigned short>(_table.size() - 1);
}

void LimitOperator::Append(LimitRow const& row) {
    RowClass wanted;
    wanted.scale = row.scale;
    wanted.numEdges = row.numEdges;
    wanted.kind = row.kind;
    wanted.stage = row.kind == LimitRow::Kind::Fixed ? Stage::Fixed : Stage::Rest;
    wanted.isExplicit = !row.IsUniform();
    wanted.isEvenCubic = row.isEvenCubic;
    if (wanted.isExplicit) {
        _indices.push_back(static_cast<Index>(_weights.size()));
        _weights.push_back(row.centre);
        _weights.insert(_weights.end(), row.weights.begin(), row.weights.end());
    } else {
        wanted.weights = {row.centre, row.edge, row.other};
        for (size_t i = 0; i < 3; ++i)
            wanted.floatWeights[i] = static_cast<float>(wanted.weights[i]);
    }
    _indices.insert(_indices.end(), row.indices.begin(), row.indices.end());
    if (std::max(_indices.size(), _weights.size()) >
        static_cast<size_t>(std::numeric_limits<int>::max())) {
        throw Error(ErrorCode::TooLarge, "the limit matrix passes 2^31 entries");
    }
    _starts.push_back(static_cast<int>(_indices.size()));
    _classes.push_back(FindClass(wanted));
}

/// Curve rows form a stage of their own, less the curves that reach a vertex of the rest (a dart):
/// there the curve hangs on the surface as the surface hangs on the curve.
void LimitOperator::FindStages() {
    std::vector<Index> open;
    for (Index row = 0; row < GetNumVertices(); ++row) {
        RowClass wanted = GetClass(row);
        if (wanted.kind != LimitRow::Kind::Curve) continue;
        wanted.stage = Stage::Curve;
        _classes[row] = FindClass(wanted);
        open.push_back(row);
    }
    auto const isRest = [&](Index row) { return GetClass(row).stage == Stage::Rest; };
    std::erase_if(open, [&](Index row) {
        return std::none_of(GetNeighbours(row).begin(), GetNeighbours(row).end(), isRest);
    });
    while (!open.empty()) {
        Index const row = open.back();
        open.pop_back();
        RowClass wanted = GetClass(row);
        if (wanted.stage == Stage::Rest) continue;
        wanted.stage = Stage::Rest;
        _classes[row] = FindClass(wanted);
        for (Index neighbour : GetNeighbours(row)) {
            if (GetClass(neighbour).stage == Stage::Curve) open.push_back(neighbour);
        }
    }
}

/// Bounds of the smallest eigenvalue, from B = D A as a sum of squares over edges, faces and
/// vertices: only the vertices' part counts, (n^2 - 3n + 2 n alpha) / D, for Loop (3/(8 beta) -
/// n/2) / (3/(8 beta) + n).
void LimitOperator::Summarise(Sdc::SchemeType scheme, far_ext::LimitOptions const& options) {
    for (Index row = 0; row < GetNumVertices(); ++row)
        ++_numRows[static_cast<int>(GetClass(row).stage)];
    std::vector<char> isUsed(_table.size(), 0);
    for (unsigned short c : _classes) isUsed[c] = 1;
    for (size_t i = 0; i < _table.size(); ++i) {
        RowClass const& c = _table[i];
        if (!isUsed[i] || c.stage != Stage::Rest) continue;
        double const n = c.numEdges;
        double bound = 0.0;
        if (c.kind == LimitRow::Kind::Smooth) {
            bool const isStationary =
                options.alphaRule == far_ext::LimitOptions::AlphaRule::Stationary;
            if (scheme == Sdc::SCHEME_LOOP)
                bound = (c.scale - 1.5 * n) / c.scale;  // scale = n + 3/(8 beta)
            else if (!isStationary || options.alpha == 0.0)
                bound = (n * n - 3.0 * n + 2.0 * n * options.alpha) / c.scale;
        } else {
            _isSymmetric = false;
        }
        _eigenvalueBound = std::min(_eigenvalueBound, std::max(0.0, bound));
    }
}

LimitOperator LimitOperator::Build(Far::TopologyRefiner const& refiner, int level,
                                   far_ext::LimitOptions const& options) {
    far_ext::LimitRowBuilder builder(refiner, level, options);
    auto const topology = refiner.GetLevel(level);
    LimitOperator result;
    size_t numNeighbours = 0;  // each corner sees the next corner and those across the face
    for (Index face = 0; face < topology.GetNumFaces(); ++face) {
        size_t const size = topology.GetFaceVertices(face).size();
        numNeighbours += size * (size - 2);
    }
    size_t const numVertices = builder.GetNumVertices();
    result._starts.reserve(numVertices + 1);
    result._classes.reserve(numVertices);
    result._indices.reserve(numNeighbours);
    LimitRow row;
    for (Index vertex = 0; vertex < builder.GetNumVertices(); ++vertex) {
        builder.Build(vertex, row);
        result.Append(row);
    }
    result.FindStages();
    result.Summarise(refiner.GetSchemeType(), options);
    return result;
}

std::vector<Index> LimitOperator::OrderForSweeps() const {
    auto const visitNeighbours = [&](Index row, auto const& visit) {
        for (Index neighbour : GetNeighbours(row)) visit(neighbour);
    };
    auto order = far_ext::OrderBreadthFirst(GetNumVertices(), visitNeighbours).rows;
    for (auto begin = order.begin(); begin != order.end();) {
        auto const end = begin + std::min(std::ptrdiff_t{kRowsPerBlock}, order.end() - begin);
        std::stable_sort(begin, end, [&](Index a, Index b) { return _classes[a] < _classes[b]; });
        begin = end;
    }
    return order;
}

LimitOperator LimitOperator::Reorder(std::vector<Index>& vertices) const {
    vertices = OrderForSweeps();
    auto const rows = far_ext::InvertOrder(vertices);
    LimitOperator result;
    result._starts.reserve(_starts.size());
    result._classes.reserve(_classes.size());
    result._indices.reserve(_indices.size());
    result._weights = _weights;
    result._table = _table;
    std::copy(std::begin(_numRows), std::end(_numRows), std::begin(result._numRows));
    result._eigenvalueBound = _eigenvalueBound;
    result._isSymmetric = _isSymmetric;
    for (Index row = 0; row < GetNumVertices(); ++row) {
        Index const vertex = vertices[row];
        if (GetClass(vertex).isExplicit) result._indices.push_back(_indices[_starts[vertex]]);
        for (Index neighbour : GetNeighbours(vertex)) {
            result._indices.push_back(rows[neighbour]);
            result._bandwidth = std::max(result._bandwidth, std::abs(rows[neighbour] - row));
        }
        result._classes.push_back(_classes[vertex]);
        result._starts.push_back(static_cast<int>(result._indices.size()));
    }
    return result;
}

void LimitOperator::Apply(std::span<double const> x, int length, std::span<double> y) const {
    WithLength(length, [&]<int Length>() {
        ForEachBlock(GetNumVertices(), kRowsPerBlock, [&](Index begin, Index end) {
            using Row = DoubleRow<Length>;
            ForEachRow<Row>(begin, end, Stage::Fixed, x.data(),
                            [&](Index row, RowClass const&, Row const&, Row const& limit) {
                                limit.Store(y.data(), row);
                            });
        });
    });
}

}  // namespace limn::eval
