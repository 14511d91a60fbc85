// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rings/face_ring.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <unordered_set>

#include <gtest/gtest.h>

#include "far_ext/topology/refiner.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/scan_meshes.h"

namespace limn {
namespace {

using far_ext::FaceRing;

std::vector<FaceRing> GatherRings(engine::Scene const& scene, int channel = -1) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    far_ext::FaceRingGatherer gatherer(refiner->GetLevel(0), scene.cage.options, channel);
    std::vector<FaceRing> rings(static_cast<size_t>(scene.cage.GetNumFaces()));
    std::vector<Index> points;
    for (size_t face = 0; face < rings.size(); ++face)
        gatherer.Gather(static_cast<Index>(face), rings[face], points);
    return rings;
}

/// The same mesh, otherwise written: vertices and faces counted from the end, and of every face
/// that `turns` another corner first.
template <class Turns>
engine::Scene WriteOtherwise(engine::Scene const& scene, Turns turns) {
    engine::Scene other = scene;
    auto& cage = other.cage;
    auto const rename = [&](Index& vertex) { vertex = cage.numVertices - 1 - vertex; };
    std::ranges::for_each(cage.creaseVertexPairs, rename);
    std::ranges::for_each(cage.cornerVertices, rename);
    std::ranges::for_each(cage.faceVertices, rename);
    auto corner = cage.faceVertices.begin();
    std::vector<std::vector<Index>> faces;
    for (Index face = 0; face < cage.GetNumFaces(); ++face) {
        auto const end = corner + cage.faceSizes[static_cast<size_t>(face)];
        if (turns(face)) std::rotate(corner, corner + 1, end);
        faces.insert(faces.begin(), {corner, end});
        corner = end;
    }
    std::ranges::reverse(cage.faceSizes);
    cage.faceVertices.clear();
    for (auto const& face : faces)
        cage.faceVertices.insert(cage.faceVertices.end(), face.begin(), face.end());
    for (Index& hole : cage.holes) hole = cage.GetNumFaces() - 1 - hole;
    cage.fvarChannels.clear();
    return other;
}

/// Whether the level's own order round a face's corners has no bearing on its ring: orders at
/// vertices that are not manifold are kept, and so are those that Chaikin's sums are taken in.
bool IsFreeOfOrder(Far::TopologyLevel const& level, Index face) {
    auto const vertices = level.GetFaceVertices(face);
    return std::none_of(vertices.begin(), vertices.end(),
                        [&](Index vertex) { return level.IsVertexNonManifold(vertex); });
}

TEST(FaceRing, DoesNotDependOnHowTheMeshIsWritten) {
    size_t numCompared = 0;
    for (std::string const& name : test::ListShapes()) {
        engine::Scene scene = test::LoadShape(name);
        if (scene.cage.options.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN ||
            scene.cage.GetNumFaces() > 1000)
            continue;
        SCOPED_TRACE(name);
        scene.cage.fvarChannels.clear();
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        auto const rings = GatherRings(scene);
        for (int parity : {0, 1}) {
            auto const others =
                GatherRings(WriteOtherwise(scene, [&](Index face) { return face % 2 != parity; }));
            for (size_t face = 0; face < rings.size(); ++face) {
                if (static_cast<int>(face % 2) != parity ||
                    !IsFreeOfOrder(refiner->GetLevel(0), static_cast<Index>(face)))
                    continue;
                ++numCompared;
                ASSERT_EQ(rings[face], others[rings.size() - 1 - face]) << "face " << face;
            }
        }
    }
    EXPECT_GT(numCompared, 1000u);
}

TEST(FaceRing, DistinctRingsHaveDistinctHashes) {
    std::vector<engine::Scene> scenes{test::MakeScan(60), test::MakeIrregularTriangles(40, 30, 3)};
    for (std::string const& name : test::ListShapes()) scenes.push_back(test::LoadShape(name));
    for (engine::Scene const& scene : scenes) {
        SCOPED_TRACE(scene.path);
        int const numChannels = static_cast<int>(scene.cage.fvarChannels.size());
        for (int channel = -1; channel < numChannels; ++channel) {
            auto const rings = GatherRings(scene, channel);
            struct Hash {
                size_t operator()(FaceRing const& ring) const { return ring.GetHash(); }
            };
            std::unordered_set<FaceRing, Hash> const distinct(rings.begin(), rings.end());
            std::set<size_t> hashes;
            for (FaceRing const& ring : rings) hashes.insert(ring.GetHash());
            EXPECT_EQ(hashes.size(), distinct.size());
        }
    }
}

// A torus of alike faces has one ring per kind of face.
TEST(FaceRing, AlikeFacesHaveOneRing) {
    auto const count = [](engine::Scene const& scene) {
        std::set<size_t> hashes;
        for (FaceRing const& ring : GatherRings(scene)) hashes.insert(ring.GetHash());
        return hashes.size();
    };
    EXPECT_EQ(count(test::MakeTorus(9, 7)), 1u);
    EXPECT_EQ(count(test::MakeTriangleTorus(9, 7)), 1u);
}

// Inside a mesh of triangles the valences of a face's corners say how its ring is put together,
// but for faces that see one vertex from two sides, as beside valence 3.
TEST(FaceRing, IrregularTrianglesHaveFewMoreRingsThanValencesRoundAFace) {
    engine::Scene const scene = test::MakeScan(100);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const level = refiner->GetLevel(0);
    auto const rings = GatherRings(scene);
    std::set<size_t> hashes;
    std::set<std::array<int, 3>> valences;
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        if (std::any_of(vertices.begin(), vertices.end(),
                        [&](Index vertex) { return level.IsVertexBoundary(vertex); }))
            continue;
        std::array<int, 3> valence{};
        for (int i = 0; i < 3; ++i)
            valence[static_cast<size_t>(i)] = level.GetVertexFaces(vertices[i]).size();
        valences.insert(valence);
        hashes.insert(rings[static_cast<size_t>(face)].GetHash());
    }
    EXPECT_GE(hashes.size(), valences.size());
    EXPECT_LT(static_cast<double>(hashes.size()), 1.5 * static_cast<double>(valences.size()));
}

}  // namespace
}  // namespace limn
