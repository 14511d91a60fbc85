// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "eval/surface/face_tree.h"
#include "eval/surface/refined_faces.h"
#include "far_ext/topology/control_mesh.h"

namespace limn::eval {

/// The limit of a mesh whose faces are those of another cage, uniformly refined: at places of that
/// cage.
///
/// Threads  immutable once built; a Sampler per thread.
class FinerSurface {
public:
    /// \param base       limit of the cage that places are given on; kept only while this is built
    /// \param finer      mesh with the faces of the cage refined once or more, in OpenSubdiv's
    ///                   order, and the cage's scheme
    /// \param positions  3 per vertex of it
    /// \return           none where its faces are others, or one has no limit where the cage has
    /// \throws Error     BadOption: positions that do not reach all of its vertices
    static std::optional<FinerSurface> Build(LimitSurface const& base,
                                             far_ext::ControlMesh const& cage,
                                             far_ext::ControlMesh const& finer,
                                             std::span<double const> positions);

    /// Keeps a view of the surface, which must outlive it.
    class Sampler {
    public:
        explicit Sampler(FinerSurface const& surface);

        /// Limit positions.
        ///
        /// \param face    of the cage, with a limit; \param domain as in LimitSurface
        /// \param points  one per place
        /// \throws Error  BadOption: those of RefinedFaces; less room than there are places
        void Evaluate(Index face, int domain, std::span<double const> s, std::span<double const> t,
                      std::span<Eigen::Vector3d> points);

    private:
        FinerSurface const& _surface;
        FaceTree _tree;
        std::vector<RefinedFaces::Sample> _places;
    };

private:
    FinerSurface(LimitSurface const& base, int levels) : _faces(base, levels) {}

    RefinedFaces _faces;
    std::vector<double> _positions;
    std::unique_ptr<Far::TopologyRefiner> _refiner;
    std::unique_ptr<LimitSurface> _limit;
};

}  // namespace limn::eval
