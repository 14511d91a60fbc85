// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "eval/forms/quad_form_patch.h"
#include "eval/forms/triangle_form_patch.h"
#include "eval/stencils/table_evaluator.h"
#include "eval/surface/face_tree.h"
#include "eval/surface/refined_faces.h"
#include "far_ext/topology/control_mesh.h"

namespace limn::eval {

/// The tangent vector field of a subdivided 1-form at any place of the limit surface: V = sum g^ab
/// w(x_a) x_b with the limit's own tangents.
///
/// Exact    in regular faces, by QuadFormPatch and TriangleFormPatch.
/// Else     next to extraordinary vertices, boundaries and creases: the exact vectors at the
///          refined face's corners, blended and projected on the tangent plane.
/// Threads  immutable once built; a Sampler per thread.
/// Source   [Wang06] Sec. 4.1; [Forms 7.3]
class FieldSurface {
public:
    /// \param refiner    unrefined topology of the cage
    /// \param positions  3 per vertex of the cage
    /// \param form       per edge of the cage
    /// \param levels     refinements; 1 is done at least where faces are not all quads (Loop:
    ///                   triangles)
    /// \param evaluator  null: all in double; else applies refinement and vectors at vertices as
    ///                   tables, in float
    /// \throws Error     as far_ext::CheckForms; TooLarge: 2^31 indices; BadOption: arrays that do
    ///                   not reach all vertices or edges
    FieldSurface(far_ext::ControlMesh const& cage, std::span<double const> positions,
                 std::span<double const> form, int levels, TableEvaluator* evaluator = nullptr);

    /// The refined cage, whose limit is the cage's, with what lies on it; edges have the numbers of
    /// the surface's refiner.
    far_ext::ControlMesh const& GetRefinedCage() const { return _cage; }
    std::vector<double> const& GetPositions() const { return _positions; }
    std::vector<double> const& GetForm() const { return _form; }
    LimitSurface const& GetSurface() const { return *_surface; }
    RefinedFaces const& GetRefinedFaces() const { return *_faces; }

    /// What there is at a place.
    struct Here {
        Eigen::Vector3d position, ds, dt;
        Eigen::Vector3d vector;  ///< 0 where there is no tangent plane
    };

    /// Keeps a view of the field, which must outlive it.
    class Sampler {
    public:
        explicit Sampler(FieldSurface const& field);

        /// \param face     of the cage, with a limit; \param domain as in LimitSurface
        /// \param vectors  one per place; 0 where the surface has no tangent plane
        /// \throws Error   BadOption: those of RefinedFaces; less room than there are places
        void Evaluate(Index face, int domain, std::span<double const> s, std::span<double const> t,
                      std::span<Eigen::Vector3d> vectors);

        /// Makes a face of the refined cage the current one. \pre  it has a limit
        void Bind(Index face);
        bool IsBound(Index face) const { return _tree.GetFace() == face; }
        /// Whether the bound face is among regular ones, where the field is exact.
        bool IsRegular() const { return _isRegular; }

        /// On the bound face; beyond it polynomial pieces and blends go on.
        Here EvaluateHere(double s, double t);

    private:
        Eigen::Vector3d BlendCorners(Here const& here, double s, double t) const;

        FieldSurface const& _field;
        FaceTree _tree;
        std::vector<RefinedFaces::Sample> _places;
        bool _isRegular = false;
        QuadFormPatch _quad;          // one of these is of the
        TriangleFormPatch _triangle;  // bound face, if it is regular
    };

private:
    void FindVectors(Far::TopologyRefiner const& refiner, TableEvaluator* evaluator);

    far_ext::ControlMesh _cage;  // refined
    std::vector<double> _positions, _form;
    std::unique_ptr<Far::TopologyRefiner> _refiner;  // of the refined cage
    std::unique_ptr<LimitSurface> _surface;
    std::unique_ptr<RefinedFaces> _faces;
    std::vector<Eigen::Vector3d> _vectors;  // at its vertices, where they are needed
};

}  // namespace limn::eval
