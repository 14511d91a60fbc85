// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/ring_cache.h"

#include <gtest/gtest.h>

#include "eval/surface/surface_sample.h"
#include "far_ext/topology/refiner.h"
#include "support/meshes.h"

namespace limn {
namespace {

struct Gathered {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    far_ext::FaceRing ring;
};

/// The ring of a fan's first face.
Gathered GatherRing(engine::Scene const& scene) {
    Gathered made{far_ext::CreateRefiner(scene.cage), {}};
    std::vector<Index> points;
    far_ext::FaceRingGatherer(made.refiner->GetLevel(0), scene.cage.options, -1)
        .Gather(0, made.ring, points);
    return made;
}

TEST(RingCache, KeepsItsStoreUntilThatIsFull) {
    engine::Scene const fan = test::MakeFan(5, Sdc::SCHEME_CATMARK, 0.1, 0.1);
    auto const [refiner, ring] = GatherRing(fan);
    for (size_t mostBytes : {size_t{0}, eval::LimitSurface::kMostRingBytes}) {
        eval::RingCache cache(fan.cage.scheme, fan.cage.options, mostBytes);
        std::shared_ptr<eval::RingStore> store;
        cache.Renew(store);
        auto const first = store;
        cache.Renew(store);
        EXPECT_EQ(store, first) << "a store without rings is not full";
        store->Find(ring);
        cache.Renew(store);
        EXPECT_EQ(store == first, mostBytes > 0);
        EXPECT_EQ(first->GetNumRings(), 1u) << "who still uses it finds what it had";
    }
}

TEST(RingStore, SubdividesEachRingOnce) {
    engine::Scene const fan = test::MakeFan(5, Sdc::SCHEME_CATMARK, 0.1, 0.1);
    auto const [refiner, ring] = GatherRing(fan);
    eval::RingStore store(fan.cage.scheme, fan.cage.options);
    auto const* const node = store.Find(ring);
    EXPECT_EQ(store.Find(ring), node);
    EXPECT_EQ(store.FindChild(*node, 0), node) << "the extraordinary corner's ring repeats";
    EXPECT_EQ(store.GetNumRings(), 1u);
    size_t const numBytes = store.GetNumBytes();
    auto const* const regular = store.FindChild(*node, 1);
    EXPECT_EQ(store.FindChild(*node, 1), regular);
    EXPECT_EQ(store.GetNumRings(), 2u);
    EXPECT_GT(store.GetNumBytes(), numBytes);
}

/// Position and curvature at a place near each face's first corner.
std::vector<double> SampleFaces(engine::Scene const& scene, size_t mostRingBytes) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    eval::LimitSurface const surface(*refiner, -1, mostRingBytes);
    eval::FaceTree tree(surface, scene.positions, 3);
    std::vector<double> values;
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (!surface.HasLimit(face)) continue;
        tree.Bind(face);
        auto const sample = eval::EvaluateSample(tree, 0, 0.01, 0.02);
        values.insert(values.end(), {sample.position.x(), sample.position.y(), sample.position.z(),
                                     sample.curvature.k1, sample.curvature.k2});
    }
    return values;
}

TEST(RingCache, WhatIsRememberedChangesNoBit) {
    for (char const* name : {"catmark_car", "catmark_cubes_semisharp", "loop_saddle_edgecorner"}) {
        SCOPED_TRACE(name);
        engine::Scene const scene = test::LoadShape(name);
        EXPECT_EQ(SampleFaces(scene, 0), SampleFaces(scene, eval::LimitSurface::kMostRingBytes));
    }
}

}  // namespace
}  // namespace limn
