// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>
#include <opensubdiv/far/topologyRefiner.h>

#include "engine/scene/scene.h"

namespace limn::eval {
class LimitSurface;
}

namespace limn::engine {

/// A mesh as functions take it: a scene that has been checked, with its topology built. Parts that
/// belong together cannot come apart, and none of it ever changes: copies share it all, and threads
/// may read it at once. What is moved from is copied, for that costs no more, and stays whole.
class Model {
public:
    Model(Model const&) = default;
    Model& operator=(Model const&) = default;

    /// Checks a scene and builds its topology. One from arrays fills `cage` and `positions`, and
    /// what else it has; without a path it goes by its name.
    ///
    /// \throws Error  what far_ext::Validate and far_ext::CreateRefiner refuse; BadMesh: arrays of
    ///                another length than vertices, corners or faces ask for, or positions or UVs
    ///                that are not finite or beyond 1e30, as readers refuse them. Messages begin
    ///                with "PATH: ", or "mesh: " without a path or name
    static Model Build(Scene scene);

    /// The same mesh with other positions: topology, refiner, UVs and all the rest are shared.
    ///
    /// \param positions  3 per vertex
    /// \param sha256     of the bytes that these positions come from; empty: they are from arrays
    /// \throws Error     BadMesh as Build does
    Model WithPoints(std::vector<double> positions, std::string sha256 = {}) const;

    /// A scene to change or to write: a copy of everything but the checksum, since what is built
    /// from it later is another mesh.
    Scene MakeScene() const;

    std::string const& GetPath() const { return _parts->scene.path; }
    std::string const& GetName() const { return _parts->scene.name; }

    /// SHA-256 of the bytes that the mesh was read from or, of one from arrays, of its content
    /// (content_hash.h), as 64 hexadecimal digits: what tells it from other meshes of its name.
    std::string const& GetSha256() const;

    far_ext::ControlMesh const& GetCage() const { return _parts->scene.cage; }
    std::vector<double> const& GetPositions() const { return _points->positions; }
    bool HasUVs() const { return _parts->scene.HasUVs(); }
    bool HasUVs(Index face) const { return _parts->scene.HasUVs(face); }
    std::vector<char> const& GetFacesLackingUVs() const { return _parts->scene.lacksUVs; }
    std::vector<double> const& GetUVs() const { return _parts->scene.uvs; }
    std::vector<Primvar> const& GetPrimvars() const { return _parts->scene.primvars; }
    std::array<FaceGroups, 3> const& GetGroups() const { return _parts->scene.groups; }
    std::optional<WeldRecord> const& GetWeld() const { return _parts->scene.weld; }
    std::vector<uint32_t> const& GetFaceLines() const { return _parts->scene.faceLines; }

    /// The unrefined topology; its base level.
    Far::TopologyRefiner const& GetRefiner() const { return *_parts->refiner; }
    Far::TopologyLevel const& GetLevel() const { return _parts->refiner->GetLevel(0); }

    /// How the limit is put together, and that of the texture coordinates: made when first asked
    /// for and kept, for all bakes of the mesh.
    ///
    /// \throws Error  as eval::LimitSurface; of the latter BadOption: no texture coordinates
    eval::LimitSurface const& GetLimitSurface() const;
    eval::LimitSurface const& GetTextureSurface() const;

    /// As Scene's, ListGroups and SelectGroups.
    std::string NameFace(Index face) const { return _parts->scene.NameFace(face); }
    std::vector<std::string> ListGroups() const { return engine::ListGroups(_parts->scene); }
    std::vector<std::string> ListGroups(GroupKind kind) const {
        return engine::ListGroups(_parts->scene, kind);
    }
    std::vector<char> SelectGroups(std::vector<std::string> const& names) const {
        return engine::SelectGroups(_parts->scene, names);
    }

private:
    /// What models that differ in their positions share.
    struct LazySurface {
        std::mutex mutex{};
        std::shared_ptr<eval::LimitSurface const> surface{};  // complete elsewhere
    };
    struct Parts {
        Scene scene;  ///< all but positions and sha256, which are empty here
        std::unique_ptr<Far::TopologyRefiner const> refiner;
        mutable LazySurface limit{}, texture{};
    };
    struct Points {
        std::vector<double> positions;
        mutable std::string sha256;  ///< where none is given: made when first asked for
        mutable std::mutex mutex{};
    };

    Model(std::shared_ptr<Parts const> parts, std::shared_ptr<Points const> points)
        : _parts(std::move(parts)), _points(std::move(points)) {}

    eval::LimitSurface const& Get(LazySurface& lazy, int fvarChannel) const;

    std::shared_ptr<Parts const> _parts;
    std::shared_ptr<Points const> _points;
};

}  // namespace limn::engine
