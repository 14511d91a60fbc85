// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rings/ring_weights.h"

namespace limn::far_ext {

namespace {

DenseRows MakeCorners(FaceRing const& ring) {
    int const size = ring.GetFaceSizes()[0];
    DenseRows rows{ring.GetNumPoints(),
                   std::vector<double>(static_cast<size_t>(size) * ring.GetNumPoints(), 0.0)};
    for (int i = 0; i < size; ++i) rows[i][ring.GetFacePoints()[i]] = 1.0;
    return rows;
}

}  // namespace

RingWeights::Node& RingWeights::Find(FaceRing const& ring) {
    auto const [found, isNew] = _nodes.try_emplace(ring);
    if (isNew) found->second.ring = &found->first;
    return found->second;
}

DenseRows const& RingWeights::Get(Node& node, int depth) {
    if (static_cast<int>(node.rows.size()) <= depth) node.rows.resize(depth + 1);
    if (!node.rows[depth]) {
        node.rows[depth] = std::make_unique<DenseRows>(depth == 0 ? MakeCorners(*node.ring)
                                                                  : Compose(node, depth));
    }
    return *node.rows[depth];
}

void RingWeights::Subdivide(Node& node) {
    auto subdivision = RingSubdivision::Build(*node.ring, _scheme, _options, _use);
    for (auto& child : subdivision.children) {
        node.steps.push_back(std::move(child.weights));
        node.children.push_back(&Find(child.ring));
    }
}

DenseRows RingWeights::Compose(Node& node, int depth) {
    if (node.children.empty()) Subdivide(node);
    FaceLattice const& lattice = _lattices.Get(node.ring->GetFaceSizes()[0], depth);
    int const numColumns = node.ring->GetNumPoints();
    DenseRows rows{numColumns, std::vector<double>(lattice.places.size() * numColumns, 0.0)};
    std::vector<char> isDone(lattice.places.size(), 0);
    for (size_t c = 0; c < node.children.size(); ++c) {
        DenseRows const& fine = Get(*node.children[c], depth - 1);
        SparseRows const& step = node.steps[c];
        auto const& pointOfRow = lattice.children[c].pointOfRow;
        for (int row = 0; row < static_cast<int>(pointOfRow.size()); ++row) {
            if (isDone[pointOfRow[row]]) continue;  // children share the points between them
            isDone[pointOfRow[row]] = 1;
            double* const to = rows[pointOfRow[row]];
            for (int i = 0; i < fine.numColumns; ++i) {
                double const weight = fine[row][i];
                if (weight == 0.0) continue;
                for (int k = step.offsets[i]; k < step.offsets[i + 1]; ++k) {
                    to[step.indices[k]] += weight * step.weights[k];
                }
            }
        }
    }
    return rows;
}

}  // namespace limn::far_ext
