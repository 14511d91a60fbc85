// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <type_traits>
#include <vector>

#include "eval/fit/value_row.h"
#include "far_ext/limit/limit_row.h"

namespace limn::eval {

/// The limit matrix A without its weights: rows of alike vertices share one set of them, so that a
/// row is the list of its neighbours and a class number (38 bytes for a vertex among quads). Only
/// rows whose weights are unlike each other (mixed faces, semi-sharp creases) carry their own.
///
/// Order    A is block triangular: fixed vertices first, then curves that end at those (or close),
///          which need nothing else, then the rest. Solvers take the stages one after the other.
/// Threads  immutable; its methods use the pool, with the same bits for any number of threads.
/// Source   [LaiCheng11] Sec. 3 and 4; [Limit 2], [Limit 5].
class LimitOperator {
public:
    enum class Stage : unsigned char { Fixed, Curve, Rest };

    /// What rows have in common.
    struct RowClass {
        std::array<double, 3> weights{1.0, 0.0,
                                      0.0};  ///< centre, edge ends, others; unused where isExplicit
        std::array<float, 3> floatWeights{1.0f, 0.0f, 0.0f};
        double scale = 1.0;  ///< of D, see far_ext::LimitRow
        int numEdges = 0;
        Stage stage = Stage::Fixed;
        far_ext::LimitRow::Kind kind = far_ext::LimitRow::Kind::Fixed;
        bool isExplicit = false;
        bool isEvenCubic = false;
        bool operator==(RowClass const&) const = default;

        template <class Scalar>
        Scalar Weight(size_t which) const {
            if constexpr (std::is_same_v<Scalar, float>)
                return floatWeights[which];
            else
                return weights[which];
        }
    };

    /// Builds the operator in linear time, straight from the topology.
    ///
    /// \throws Error  as far_ext::LimitRowBuilder; TooLarge: 2^31 neighbours, or 65536 classes
    static LimitOperator Build(Far::TopologyRefiner const& refiner, int level = 0,
                               far_ext::LimitOptions const& options = {});

    /// The same operator with its rows in an order that is swept fast: breadth-first (see
    /// far_ext/rows/breadth_first.h), and within blocks of 2048 rows by class, so that the
    /// processor can guess what comes next.
    ///
    /// \param vertices  receives per row the vertex it belongs to
    LimitOperator Reorder(std::vector<Index>& vertices) const;

    /// Largest distance between a row and one of its neighbours.
    Index GetBandwidth() const { return _bandwidth; }

    Index GetNumVertices() const { return static_cast<Index>(_classes.size()); }
    Index GetNumRows(Stage stage) const { return _numRows[static_cast<int>(stage)]; }
    RowClass const& GetClass(Index row) const { return _table[_classes[row]]; }

    /// All neighbours of a row, edge neighbours first; one may come twice.
    std::span<Index const> GetNeighbours(Index row) const;

    /// A lower bound of the rest's eigenvalues that follows from valences alone; 0 where they say
    /// nothing.
    double GetEigenvalueBound() const { return _eigenvalueBound; }

    /// True if D A is symmetric among the rest: no darts, semi-sharp or non-manifold vertices, no
    /// open creases.
    bool IsSymmetric() const { return _isSymmetric; }

    /// Bytes of all its arrays.
    size_t GetNumBytes() const;

    /// y = A x, for rows of `length` doubles. \pre x and y do not overlap
    void Apply(std::span<double const> x, int length, std::span<double> y) const;

    /// Calls visit(row, class, own, y) with y = (A x)[row] and own = x[row] for the rows of a range
    /// whose stage is `first` or later. Row is one of the types of value_row.h.
    template <class Row, class Visit>
    void ForEachRow(Index begin, Index end, Stage first, typename Row::Scalar const* x,
                    Visit visit) const;

    /// Calls visit(column, weight) for the entries of a row, the diagonal first; a column may come
    /// twice.
    template <class Visit>
    void ForEachEntry(Index row, Visit visit) const;

private:
    void Append(far_ext::LimitRow const& row);
    unsigned short FindClass(RowClass const& wanted);
    void FindStages();
    std::vector<Index> OrderForSweeps() const;
    void Summarise(Sdc::SchemeType scheme, far_ext::LimitOptions const& options);

    std::vector<int> _starts{0};  // into _indices, with the end of the last row
    std::vector<unsigned short> _classes;
    std::vector<Index> _indices;   // an explicit row's first one is the place of its weights
    std::vector<double> _weights;  // of explicit rows: centre, then one per neighbour
    std::vector<RowClass> _table;
    Index _numRows[3] = {0, 0, 0};
    Index _bandwidth = 0;
    double _eigenvalueBound = 1.0;
    bool _isSymmetric = true;
};

/// Values of so many vertices, added up in order: without a loop, which would cost as much as the
/// sums.
template <int Count, class Row>
[[gnu::always_inline]] inline Row SumOf(Index const* vertices, typename Row::Scalar const* x) {
    Row sum = Row::Load(x, vertices[0]);
    for (int i = 1; i < Count; ++i) sum = sum + Row::Load(x, vertices[i]);
    return sum;
}

template <class Row, class Visit>
void LimitOperator::ForEachRow(Index begin, Index end, Stage first, typename Row::Scalar const* x,
                               Visit visit) const {
    using Scalar = typename Row::Scalar;
    for (Index row = begin; row < end;) {  // runs of one class
        unsigned short const number = _classes[row];
        Index runEnd = row + 1;
        while (runEnd < end && _classes[runEnd] == number) ++runEnd;
        RowClass const& c = _table[number];
        if (c.stage < first) {
            row = runEnd;
            continue;
        }
        Scalar const w0 = c.Weight<Scalar>(0), w1 = c.Weight<Scalar>(1), w2 = c.Weight<Scalar>(2);
        auto const finish = [&](Index at, Row const& edges, Row const& others) {
            Row const own = Row::Load(x, at);
            visit(at, c, own, w0 * own + w1 * edges + w2 * others);
        };
        // Vertices with as many faces as edges, among quads.
        auto const sweep = [&]<int Valence>() {
            Index const* k = _indices.data() + _starts[row];
            for (; row < runEnd && _starts[row + 1] - _starts[row] == 2 * Valence;
                 ++row, k += 2 * Valence) {
                finish(row, SumOf<Valence, Row>(k, x), SumOf<Valence, Row>(k + Valence, x));
            }
        };
        if (!c.isExplicit) {
            if (c.numEdges == 4) sweep.template operator()<4>();
            if (c.numEdges == 3) sweep.template operator()<3>();
            if (c.numEdges == 5) sweep.template operator()<5>();
            if (c.numEdges == 6) sweep.template operator()<6>();
            if (c.numEdges == 7) sweep.template operator()<7>();
        }
        for (; row < runEnd; ++row) {
            Index const* k = _indices.data() + _starts[row];
            Index const* const stop = _indices.data() + _starts[row + 1];
            if (c.isExplicit) {
                Row const own = Row::Load(x, row);
                double const* weight = _weights.data() + *k;
                Row y = static_cast<Scalar>(*weight) * own;
                for (++k; k < stop; ++k) y = y + static_cast<Scalar>(*++weight) * Row::Load(x, *k);
                visit(row, c, own, y);
            } else {
                Row edges, others;
                for (Index const* const middle = k + c.numEdges; k < middle; ++k)
                    edges = edges + Row::Load(x, *k);
                for (; k < stop; ++k) others = others + Row::Load(x, *k);
                finish(row, edges, others);
            }
        }
    }
}

template <class Visit>
void LimitOperator::ForEachEntry(Index row, Visit visit) const {
    RowClass const& c = GetClass(row);
    double const* const own = c.isExplicit ? &_weights[_indices[_starts[row]]] : nullptr;
    visit(row, own ? own[0] : c.weights[0]);
    auto const neighbours = GetNeighbours(row);
    for (size_t k = 0; k < neighbours.size(); ++k) {
        double const shared = c.weights[static_cast<int>(k) < c.numEdges ? 1 : 2];
        visit(neighbours[k], own ? own[k + 1] : shared);
    }
}

}  // namespace limn::eval
