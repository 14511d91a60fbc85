// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/types.h"

namespace limn::far_ext {

/// All points of a face with `size` corners that are refined `depth` times, whatever the mesh round
/// it: which corners of which descendant faces they are, and how they follow from the children's.
/// Descendants are numbered as OpenSubdiv does, which is how they are numbered in any mesh.
struct FaceLattice {
    struct Place {
        int face, corner;  ///< one of the places where the point is found
    };
    struct Child {
        std::vector<int> pointOfRow;  ///< of this lattice, per point of the child's own lattice
        int size;                     ///< corners of the child
    };
    std::vector<Place> places;             ///< per point
    std::vector<int> inside;               ///< points within the face, in OpenSubdiv's order
    std::vector<std::vector<int>> onEdge;  ///< per edge, without its ends
    std::vector<int> atCorner;             ///< per corner
    std::vector<Child> children;
};

/// The lattices of one scheme, each made once.
class LatticeCache {
public:
    explicit LatticeCache(Sdc::SchemeType scheme) : _scheme(scheme) {}

    FaceLattice const& Get(int size, int depth);

private:
    FaceLattice Build(int size, int depth);
    void AddChildren(Far::TopologyRefiner const& refiner, int depth, FaceLattice& lattice);

    Sdc::SchemeType _scheme;
    std::map<std::pair<int, int>, std::unique_ptr<FaceLattice>> _lattices;
};

}  // namespace limn::far_ext
