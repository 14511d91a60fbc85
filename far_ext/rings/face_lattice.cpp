// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rings/face_lattice.h"

#include <algorithm>

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

namespace limn::far_ext {

using Level = Far::TopologyLevel;

namespace {

/// Follows the face's corners and edges down to the last level.
void SortByBoundary(Far::TopologyRefiner const& refiner, int depth, FaceLattice& lattice) {
    Level const& base = refiner.GetLevel(0);
    std::vector<char> isInside(lattice.places.size(), 1);
    auto const descend = [&](int level, Index vertex) {
        for (; level < depth; ++level)
            vertex = refiner.GetLevel(level).GetVertexChildVertex(vertex);
        isInside[vertex] = 0;
        return vertex;
    };
    for (Index corner : base.GetFaceVertices(0)) lattice.atCorner.push_back(descend(0, corner));
    for (Index edge : base.GetFaceEdges(0)) {
        std::vector<int> points;
        std::vector<Index> pieces{edge};
        for (int level = 0; level < depth; ++level) {
            std::vector<Index> halves;
            for (Index piece : pieces) {
                points.push_back(
                    descend(level + 1, refiner.GetLevel(level).GetEdgeChildVertex(piece)));
                for (Index half : refiner.GetLevel(level).GetEdgeChildEdges(piece))
                    halves.push_back(half);
            }
            pieces = std::move(halves);
        }
        std::sort(points.begin(), points.end());
        lattice.onEdge.push_back(std::move(points));
    }
    for (size_t point = 0; point < isInside.size(); ++point) {
        if (isInside[point]) lattice.inside.push_back(static_cast<int>(point));
    }
}

}  // namespace

FaceLattice const& LatticeCache::Get(int size, int depth) {
    auto& slot = _lattices[{size, depth}];
    if (!slot) slot = std::make_unique<FaceLattice>(Build(size, depth));
    return *slot;
}

FaceLattice LatticeCache::Build(int size, int depth) {
    std::vector<Index> corners(size);
    for (int i = 0; i < size; ++i) corners[i] = i;
    Far::TopologyDescriptor face;
    face.numVertices = size;
    face.numFaces = 1;
    face.numVertsPerFace = &size;
    face.vertIndicesPerFace = corners.data();
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> const refiner(
        Factory::Create(face, Factory::Options(_scheme)));
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(depth));

    FaceLattice lattice;
    Level const& fine = refiner->GetLevel(depth);
    lattice.places.assign(fine.GetNumVertices(), {-1, -1});
    for (Index f = 0; f < fine.GetNumFaces(); ++f) {
        auto const vertices = fine.GetFaceVertices(f);
        for (int i = 0; i < vertices.size(); ++i) {
            if (lattice.places[vertices[i]].face < 0) lattice.places[vertices[i]] = {f, i};
        }
    }
    SortByBoundary(*refiner, depth, lattice);
    if (depth > 0) AddChildren(*refiner, depth, lattice);
    return lattice;
}

void LatticeCache::AddChildren(Far::TopologyRefiner const& refiner, int depth,
                               FaceLattice& lattice) {
    Level const& fine = refiner.GetLevel(depth);
    auto const children = refiner.GetLevel(0).GetFaceChildFaces(0);
    int const perChild = fine.GetNumFaces() / children.size();
    for (int c = 0; c < children.size(); ++c) {
        FaceLattice::Child child;
        child.size = refiner.GetLevel(1).GetFaceVertices(children[c]).size();
        for (auto const& [face, corner] : Get(child.size, depth - 1).places) {
            child.pointOfRow.push_back(fine.GetFaceVertices(c * perChild + face)[corner]);
        }
        lattice.children.push_back(std::move(child));
    }
}

}  // namespace limn::far_ext
