// SPDX-License-Identifier: Apache-2.0
#include "engine/field/field_levels.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace limn::engine {

int ChooseFieldLevels(Model const& model, int width, int height) {
    double const numFaces = std::max<double>(1.0, model.GetCage().GetNumFaces());
    std::set<std::pair<double, double>> tiles;
    for (size_t i = 0; i < model.GetUVs().size(); i += 2)
        tiles.emplace(std::floor(model.GetUVs()[i]), std::floor(model.GetUVs()[i + 1]));
    double const texels = static_cast<double>(width) * height * static_cast<double>(tiles.size());
    int levels = 0;
    double refined = numFaces;
    while (levels < 8 && 4.0 * refined < texels && 4.0 * refined < 1e6) {
        refined *= 4.0;
        ++levels;
    }
    return levels;
}

}  // namespace limn::engine
