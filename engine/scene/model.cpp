// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/model.h"

#include <utility>

#include "engine/scene/content_hash.h"
#include "engine/scene/scene_checks.h"
#include "far_ext/error.h"
#include "far_ext/topology/refiner.h"

namespace limn::engine {

Model Model::Build(Scene scene) {
    if (scene.path.empty()) scene.path = scene.name;
    auto refiner = NamingMesh(scene.path, [&] {
        CheckScene(scene);
        return far_ext::CreateRefiner(scene.cage);
    });
    std::shared_ptr<Points const> points(
        new Points{std::exchange(scene.positions, {}), std::exchange(scene.sha256, {})});
    scene.normals.clear();  // for writers only: limits have their own
    return {std::make_shared<Parts const>(Parts{std::move(scene), std::move(refiner)}),
            std::move(points)};
}

Model Model::WithPoints(std::vector<double> positions, std::string sha256) const {
    NamingMesh(GetPath(), [&] { CheckPositions(GetCage(), positions); });
    return {_parts,
            std::shared_ptr<Points const>(new Points{std::move(positions), std::move(sha256)})};
}

Scene Model::MakeScene() const {
    Scene scene = _parts->scene;
    scene.positions = _points->positions;
    return scene;
}

std::string const& Model::GetSha256() const {
    std::call_once(_points->isHashed, [this] {
        if (_points->sha256.empty())
            _points->sha256 = HashContent(_parts->scene, _points->positions);
    });
    return _points->sha256;
}

}  // namespace limn::engine
