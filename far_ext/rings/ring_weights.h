// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "far_ext/rings/face_lattice.h"
#include "far_ext/rings/ring_subdivision.h"

namespace limn::far_ext {

/// Rows of doubles, all of one length.
struct DenseRows {
    int numColumns = 0;
    std::vector<double> values;

    double* operator[](int row) { return &values[static_cast<size_t>(row) * numColumns]; }
    double const* operator[](int row) const {
        return &values[static_cast<size_t>(row) * numColumns];
    }
};

/// The weights of all refined points of rings, each ring and depth worked out once.
class RingWeights {
public:
    /// \param lattices  kept by reference
    RingWeights(Far::TopologyRefiner const& refiner, bool isVarying, LatticeCache& lattices)
        : _scheme(refiner.GetSchemeType()),
          _options(refiner.GetSchemeOptions()),
          _use(isVarying ? RingSubdivision::Use::VaryingRefinement
                         : RingSubdivision::Use::Refinement),
          _lattices(lattices) {}

    struct Node {
        FaceRing const* ring = nullptr;
        std::vector<SparseRows> steps;  // per child: its points over this ring's
        std::vector<Node*> children;
        std::vector<std::unique_ptr<DenseRows>>
            rows;  // per depth: the lattice's points over the ring's
    };

    Node& Find(FaceRing const& ring);

    /// One row per point of the lattice of the ring's face, one column per point of the ring.
    DenseRows const& Get(Node& node, int depth);

private:
    struct Hash {
        size_t operator()(FaceRing const& ring) const { return ring.GetHash(); }
    };

    void Subdivide(Node& node);
    DenseRows Compose(Node& node, int depth);

    Sdc::SchemeType _scheme;
    Sdc::Options _options;
    RingSubdivision::Use _use;
    LatticeCache& _lattices;
    std::unordered_map<FaceRing, Node, Hash> _nodes;
};

}  // namespace limn::far_ext
