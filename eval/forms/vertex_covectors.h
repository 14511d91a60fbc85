// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opensubdiv/far/topologyRefiner.h>

#include "eval/stencils/table_evaluator.h"
#include "far_ext/forms/form_wheel.h"
#include "far_ext/rows/sparse_rows.h"

namespace limn::eval {

/// The limit of a 1-form at a vertex, on a pair of tangents of the limit surface: w(T_a) and the
/// T_a themselves, from the control points. Tangents and values share a scale that drops out of the
/// vector they make.
struct VertexCovector {
    std::array<Eigen::Vector3d, 2> tangents;
    std::array<double, 2> values{};

    /// V = sum_ab (g^-1)_ab w(T_b) T_a, the tangent vector that w stands for; 0 where the tangents
    /// span no plane.
    Eigen::Vector3d GetVector() const;
    /// T_0 x T_1, of length 1 or 0: the limit normal.
    Eigen::Vector3d GetNormal() const;
};

/// Limits at the vertices of one level.
///
/// Exact      at smooth interior vertices, on boundaries and infinitely sharp creases (the side of
///            the first fan) for fans of up to 5 triangles or 2 to 3 quads, at corners. Semi-sharp
///            features count as sharp: refine until they have faded. Larger fans and single quads
///            on a smooth boundary have no limit, and darts no exact mask: the value is an
///            approximation there.
/// Threads    immutable; Find may run on many.
/// \param form       per edge of the level
/// \param positions  3 per vertex of the level
/// \pre    faces are all quads (Catmull-Clark) or triangles (Loop); CheckForms has passed
/// Source  [Wang06] Sec. 4.1; [Forms 7.2]
/// Errors  BadOption: a level or vertex that does not exist, an array that does not reach all edges
///         or vertices
class VertexCovectors {
public:
    /// \param refiner  kept by reference, it must outlive this
    VertexCovectors(Far::TopologyRefiner const& refiner, int level);

    VertexCovector Find(Index vertex, std::span<double const> form,
                        std::span<double const> positions) const;

    /// At each of many vertices, on all threads.
    ///
    /// \param evaluator  null: in double; else applies their values as a table, in float
    std::vector<VertexCovector> FindAll(std::span<Index const> vertices,
                                        std::span<double const> form,
                                        std::span<double const> positions,
                                        TableEvaluator* evaluator = nullptr) const;

    /// The vector at a vertex as weights over the edges of the level: x, y and z.
    std::array<far_ext::WeightRow, 3> FindVectorRows(Index vertex,
                                                     std::span<double const> positions) const;

    /// The name of FindAll's table among those that an evaluator counts.
    static constexpr char const* kTable = "covectors";

private:
    /// The tangents at a vertex, and w(T_a) as weights over the edges of the level.
    struct ValueRows {
        std::array<Eigen::Vector3d, 2> tangents;
        std::array<far_ext::WeightRow, 2> values;
    };

    /// The weights behind T and w(T) at a vertex.
    struct Row {
        double vertex = 0.0;
        std::vector<double> ends, corners;  ///< of T: ends of the spokes, far corners of quads
        std::vector<double> edges;          ///< of w(T): the wheel's edges, spokes outwards first
    };
    using Rows = std::array<Row, 2>;
    class RowMaker;

    static Rows MakeRows(Sdc::SchemeType scheme, far_ext::Wheel const& wheel);
    ValueRows FindValueRows(Index vertex, std::span<double const> positions) const;
    void Check(Index vertex, std::span<double const> positions) const;
    template <class AddEdge>
    std::array<Eigen::Vector3d, 2> Walk(Index vertex, std::span<double const> positions,
                                        AddEdge addEdge) const;

    Far::TopologyRefiner const& _refiner;
    Far::TopologyLevel _level;
    std::vector<std::optional<Rows>> _plainRows;  // of smooth interior vertices, by valence
};

}  // namespace limn::eval
