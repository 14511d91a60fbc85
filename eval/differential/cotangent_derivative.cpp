// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "eval/differential/laplacian_derivative.h"
#include "eval/parallel/rows.h"
#include "far_ext/differential/triangle.h"

namespace limn::eval {

namespace {

/// What an entry of the graph says about the vertices i and j at its ends.
struct Block {
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();   // of the mesh's area, by i and j
    Eigen::Vector3d share = Eigen::Vector3d::Zero();     // d A_i / d v_j
    Eigen::Vector3d mirrored = Eigen::Vector3d::Zero();  // d A_j / d v_i
};

/// With cotangents L(V) V is the gradient of the mesh's area, so that its derivative is symmetric.
class CotangentDerivative final : public LaplacianDerivative {
public:
    CotangentDerivative(Far::TopologyLevel const& level, MultigridLevel const& graph,
                        std::span<Index const> rowsOf, far_ext::Points points)
        : _graph(graph), _diagonals(graph.numUnknowns), _blocks(graph.neighbours.size()) {
        ForEachRow(graph.numUnknowns, [&](Index row) {
            Index const vertex = graph.vertices[row];
            for (Index face : level.GetVertexFaces(vertex)) {
                auto const triangle = far_ext::MeasureTriangle(level, points, face);
                far_ext::TriangleDerivatives const derivatives(triangle, points);
                auto const& corners = triangle.vertices;
                size_t const k =
                    std::find(corners.begin(), corners.end(), vertex) - corners.begin();
                for (size_t l = 0; l < 3; ++l) {
                    Block* const block = FindBlock(row, rowsOf[corners[l]]);
                    if (!block) continue;
                    block->hessian += derivatives.FindHessian(k, l);
                    block->share += derivatives.FindShareGradient(k, l);
                    block->mirrored += derivatives.FindShareGradient(l, k);
                }
            }
        });
    }

    void Apply(LaneRows const& move, LaneRows& change) const override {
        ForEachRow(_graph.numUnknowns, [&](Index row) {
            Eigen::Vector4d sum = Eigen::Vector4d::Zero();
            VisitBlocks(row, [&](Block const& block, Index other) {
                auto const m = move[other].head<3>().matrix();
                sum.head<3>() += block.hessian * m;
                sum[3] += block.share.dot(m);
            });
            change[row] = sum.array();
        });
    }

    void ApplyTransposed(LaneRows const& factors, LaneRows& gradient) const override {
        ForEachRow(_graph.numUnknowns, [&](Index row) {
            Eigen::Vector3d sum = Eigen::Vector3d::Zero();
            VisitBlocks(row, [&](Block const& block, Index other) {
                sum += block.hessian * factors[other].head<3>().matrix();
                sum += factors[other][3] * block.mirrored;
            });
            gradient[row] << sum.array(), 0.0;
        });
    }

private:
    /// The block of two rows; null where the second is fixed.
    Block* FindBlock(Index row, Index other) {
        if (other == row) return &_diagonals[row];
        if (other >= _graph.numUnknowns) return nullptr;
        auto const begin = _graph.neighbours.begin() + _graph.offsets[row],
                   end = _graph.neighbours.begin() + _graph.offsets[row + 1];
        return &_blocks[std::find(begin, end, other) - _graph.neighbours.begin()];
    }

    template <class Visit>
    void VisitBlocks(Index row, Visit const& visit) const {
        visit(_diagonals[row], row);
        for (int k = _graph.offsets[row]; k < _graph.offsets[row + 1]; ++k) {
            if (_graph.neighbours[k] < _graph.numUnknowns) visit(_blocks[k], _graph.neighbours[k]);
        }
    }

    MultigridLevel const& _graph;
    std::vector<Block> _diagonals, _blocks;  // per unknown; per entry of the graph
};

}  // namespace

std::unique_ptr<LaplacianDerivative> DifferentiateCotangents(Far::TopologyLevel const& level,
                                                             MultigridLevel const& graph,
                                                             std::span<Index const> rowsOf,
                                                             std::span<double const> positions) {
    return std::make_unique<CotangentDerivative>(level, graph, rowsOf, positions);
}

}  // namespace limn::eval
