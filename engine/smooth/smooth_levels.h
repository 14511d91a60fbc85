// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "far_ext/cascade/bisection.h"
#include "far_ext/cascade/cascade_level.h"

namespace limn::engine {

enum class SmoothRefinement { Quadrisect, Bisect };

/// The scheme to refine by where none is asked for: triangles stay triangles and all else becomes
/// quads, since the filter has no subdivision rule.
Sdc::SchemeType ChooseCascadeScheme(far_ext::ControlMesh const& cage);

/// A cascade's meshes, made level after level, with what hangs on their faces and corners.
class SmoothLevels {
public:
    /// \param model         kept by reference
    /// \param keepsCreases  whether creases and corners split the filter, as long as their
    ///                      sharpness lasts; bisection keeps infinitely sharp ones only
    /// \throws Error        BadMesh: bisection of faces that are no triangles.  As
    ///                      RefineUniformly
    SmoothLevels(Model const& model, int numLevels, SmoothRefinement refinement, bool keepsCreases);

    /// The model's own mesh as a level, for a filter without refinement.
    ///
    /// \throws Error  BadMesh: faces that are not all triangles or all quads
    far_ext::CascadeMesh const& MakeUnrefined();

    /// Makes the next level's mesh. \return it, until the next call
    far_ext::CascadeMesh const& MakeNext();

    /// The same by a bisection of marked triangles only, see far_ext::Bisection.
    far_ext::CascadeMesh const& MakeNext(std::span<char const> isMarked);

    /// The mesh made last; before that the model's own where it is to be bisected, otherwise none.
    far_ext::CascadeMesh const& GetMesh() const { return _mesh; }

    /// Per face of the mesh made last: the face of the model it lies in.
    std::vector<Index> FindBaseFaces() const;

    /// Texture coordinates of the mesh made last, 2 per corner of its faces. Needs a model that has
    /// some.
    std::vector<double> FindCornerUVs();

    /// The last level as a scene, all but positions: topology, texture coordinates, groups,
    /// primvars, holes; creases and corners only where they were kept.
    Scene MakeScene(Job& job) const;

private:
    void DropTags();
    far_ext::CascadeMesh const& TakeBisected(far_ext::CascadeMesh const& fine);
    Scene MakeBisectedScene() const;
    Scene MakeQuarteredScene(Job& job) const;

    Model const& _model;
    bool _keepsCreases;
    int _level = 0;
    far_ext::CascadeMesh _mesh;
    std::unique_ptr<Far::TopologyRefiner> _refiner;  // of one of these
    std::optional<far_ext::Bisection> _bisection;
    std::vector<double> _uvs;  // of the level's face-varying values
    int _uvLevel = 0;
    std::vector<Primvar> _primvars;  // of a bisected level
};

}  // namespace limn::engine
