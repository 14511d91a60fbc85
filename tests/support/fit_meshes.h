// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/scene/scene.h"

namespace limn::test {

/// A torus of triangles whose edges have been flipped at random: valences 3 to about 11.
engine::Scene MakeIrregularTriangles(int n, int m, unsigned seed);

/// A scene refined by its own scheme. Triangles refined once by Catmull-Clark are quads with the
/// valences of the triangles, 4 at edges and 3 in faces.
engine::Scene Refine(engine::Scene const& scene, int levels);

/// A cube refined and moved to the unit sphere: 8, 26, 98, 386, 1538, 6146 vertices.
engine::Scene MakeQuadSphere(int levels);

/// A Loop icosphere: 12, 42, 162, 642, 2562 vertices.
engine::Scene MakeIcosphere(int levels);

/// Two n-gonal pyramids, base to base, as a Loop cage.
engine::Scene MakeBipyramid(int n);

/// A prism over an n-gon: all valences 3; singular where n is even.
engine::Scene MakePrism(int n);

/// A flat grid of n x m quads with its middle face missing, slightly bent.
engine::Scene MakeGridWithHole(int n, int m);

/// Adds Gaussian noise of `share` times the mean edge length.
void AddNoise(engine::Scene& scene, double share, unsigned seed);

/// Closed and open, regular and creased, quads and triangles, all with noise.
std::vector<engine::Scene> MakeNoisyScenes();

/// The meshes and creases of several scenes in one, with the first's rules.
engine::Scene Join(std::vector<engine::Scene> const& scenes);

}  // namespace limn::test
