// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/model.h"

#include <utility>

#include <tbb/task_arena.h>

#include "engine/scene/content_hash.h"
#include "engine/scene/scene_checks.h"
#include "eval/surface/limit_surface.h"
#include "far_ext/error.h"
#include "far_ext/topology/refiner.h"

namespace limn::engine {

Model Model::Build(Scene scene) {
    if (scene.path.empty()) scene.path = scene.name.empty() ? kNameless : scene.name;
    auto refiner = NamingMesh(scene.path, [&] {
        CheckScene(scene);
        CheckMagnitudes(scene);
        return far_ext::CreateRefiner(scene.cage);
    });
    std::shared_ptr<Points const> points(
        new Points{std::exchange(scene.positions, {}), std::exchange(scene.sha256, {})});
    scene.normals.clear();  // for writers only: limits have their own
    return {std::shared_ptr<Parts const>(new Parts{std::move(scene), std::move(refiner)}),
            std::move(points)};
}

Model Model::WithPoints(std::vector<double> positions, std::string sha256) const {
    NamingMesh(GetPath(), [&] {
        CheckPositions(GetCage(), positions);
        CheckMagnitudes(positions);
    });
    return {_parts,
            std::shared_ptr<Points const>(new Points{std::move(positions), std::move(sha256)})};
}

Scene Model::MakeScene() const {
    Scene scene = _parts->scene;
    scene.positions = _points->positions;
    return scene;
}

eval::LimitSurface const& Model::GetLimitSurface() const {
    return Get(_parts->limit, -1);
}

eval::LimitSurface const& Model::GetTextureSurface() const {
    return Get(_parts->texture, 0);
}

// By mutexes, not std::call_once: where memory is short, the C library ends the process rather than
// let an exception leave a call that is made once.

eval::LimitSurface const& Model::Get(LazySurface& lazy, int fvarChannel) const {
    std::lock_guard const lock(lazy.mutex);
    if (!lazy.surface) {
        // Isolated, for a thread that waits for its own workers must not take up work of another
        // one that waits for this surface.
        tbb::this_task_arena::isolate([&] {
            lazy.surface = std::make_shared<eval::LimitSurface const>(GetRefiner(), fvarChannel);
        });
    }
    return *lazy.surface;
}

std::string const& Model::GetSha256() const {
    std::lock_guard const lock(_points->mutex);
    if (_points->sha256.empty()) _points->sha256 = HashContent(_parts->scene, _points->positions);
    return _points->sha256;
}

}  // namespace limn::engine
