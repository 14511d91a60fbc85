// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <utility>
#include <vector>

#include "support/meshes.h"

namespace limn::bench {

/// A torus of quads of which a share, chosen at random, gets a smaller quad set into it: vertices
/// of valence 3 inside and 5 round it (more where insets meet).
inline engine::Scene MakeInsetTorus(int n, double share) {
    engine::Scene const torus = test::MakeTorus(n, n);
    std::vector<double> positions = torus.positions;
    std::vector<std::vector<Index>> faces;
    std::mt19937 random(7);
    for (Index face = 0; face < torus.cage.GetNumFaces(); ++face) {
        Index const* const outer = &torus.cage.faceVertices[static_cast<size_t>(face) * 4];
        if (static_cast<double>(random()) >= share * 4294967296.0) {
            faces.push_back({outer[0], outer[1], outer[2], outer[3]});
            continue;
        }
        Index const inner = static_cast<Index>(positions.size() / 3);
        for (int corner = 0; corner < 4; ++corner) {
            for (int c = 0; c < 3; ++c) {
                double sum = 4.0 * torus.positions[static_cast<size_t>(outer[corner]) * 3 + c];
                for (int k = 0; k < 4; ++k)
                    sum += torus.positions[static_cast<size_t>(outer[k]) * 3 + c];
                positions.push_back(sum / 8.0);
            }
        }
        faces.push_back({inner, inner + 1, inner + 2, inner + 3});
        for (int k = 0; k < 4; ++k) {
            int const l = (k + 1) % 4;
            faces.push_back({outer[k], outer[l], inner + l, inner + k});
        }
    }
    return test::MakeScene(std::move(positions), faces);
}

}  // namespace limn::bench
