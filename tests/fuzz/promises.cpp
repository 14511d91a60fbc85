// SPDX-License-Identifier: Apache-2.0
#include "fuzz/promises.h"

#include <utility>

#include "fuzz/fuzzer.h"

namespace limn::fuzz {

void RequireInHull(engine::Model const& model, std::vector<double> const& points) {
    Require(Hull(model.GetPositions()).Holds(std::span<double const>(points), 1e-9),
            "limits lie within four times the hull of the control points");
}

void RequireMesh(engine::Scene scene) {
    Require(scene.positions.size() == 3 * static_cast<size_t>(scene.cage.numVertices),
            "a mesh has three coordinates per vertex");
    Require(AreFinite(scene.positions), "positions of a result are numbers");
    MustSucceed("a result is a mesh that can be read again",
                [&] { return engine::Model::Build(std::move(scene)); });
}

void RequirePositions(engine::Model const& model, std::vector<double> const& positions) {
    Require(positions.size() == model.GetPositions().size(), "a filter keeps every vertex");
    Require(AreFinite(positions), "positions of a result are numbers");
}

}  // namespace limn::fuzz
