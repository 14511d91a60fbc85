// SPDX-License-Identifier: Apache-2.0
//
// Welding of faces in no order at all.

#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "engine/scene/model.h"
#include "engine/scene/weld.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::Scene;
using test::AtCorners;

/// What each corner has of a list with `length` numbers per vertex.
/// Faces without any order between vertices of a few places.
Scene MakeSoup(unsigned seed) {
    std::mt19937 random(seed);
    std::vector<double> positions;
    for (int i = 0; i < 30; ++i) {
        for (int c = 0; c < 3; ++c) positions.push_back(static_cast<double>(random() % 2));
    }
    std::vector<std::vector<Index>> faces;
    for (int i = 0; i < 12; ++i) {
        std::vector<Index> all(30);
        for (size_t k = 0; k < all.size(); ++k) all[k] = static_cast<Index>(k);
        std::shuffle(all.begin(), all.end(), random);
        faces.push_back({all.begin(), all.begin() + 3 + random() % 3});
    }
    return test::MakeScene(positions, faces);
}

/// Per side of each face, the two vertices it joins.
std::vector<std::pair<Index, Index>> ListSides(Scene const& scene) {
    std::vector<std::pair<Index, Index>> sides;
    size_t first = 0;
    for (int size : scene.cage.faceSizes) {
        for (int i = 0; i < size; ++i) {
            Index const a = scene.cage.faceVertices[first + i],
                        b = scene.cage.faceVertices[first + (i + 1) % size];
            sides.push_back(std::minmax(a, b));
        }
        first += size;
    }
    return sides;
}

TEST(Weld, WhateverIsWeldedIsSoundAndHasNoNewEdgeOfThreeFaces) {
    Index numJoined = 0;
    for (unsigned seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        Scene const soup = MakeSoup(seed), welded = engine::Weld(soup, 0.0);
        EXPECT_NO_THROW(engine::Model::Build(welded));
        EXPECT_EQ(welded.cage.numVertices, soup.cage.numVertices - welded.weld->numJoined);
        EXPECT_EQ(AtCorners(welded, welded.positions, 3), AtCorners(soup, soup.positions, 3));
        auto const before = ListSides(soup), after = ListSides(welded);
        std::map<std::pair<Index, Index>, int> countBefore, countAfter, largestBefore;
        for (auto const& side : before) ++countBefore[side];
        for (size_t i = 0; i < after.size(); ++i) {
            ++countAfter[after[i]];
            largestBefore[after[i]] = std::max(largestBefore[after[i]], countBefore[before[i]]);
        }
        for (auto const& [side, count] : countAfter)
            EXPECT_TRUE(count < 3 || largestBefore[side] > 2) << side.first << " " << side.second;
        numJoined += welded.weld->numJoined;
    }
    EXPECT_GT(numJoined, 100);
}

}  // namespace
}  // namespace limn
