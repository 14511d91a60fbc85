// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "eval/forms/field_surface.h"

namespace limn::eval {

/// Which way a line runs: with the field, against it, or across it to the left or right, seen from
/// the side from which faces are counter-clockwise.
enum class Heading { Forward, Backward, Left, Right };

/// A tangent field as lines run along it: on faces of one domain each, which are the cage's or,
/// where these are not all quads (Loop: triangles), those of its first refinement. Places below
/// are on them, in domain 0.
///
/// Exact    in regular faces; in others a FieldSurface some levels finer.
/// Threads  immutable once built; a Sampler per thread.
class FlowSurface {
public:
    /// \param positions  3 per vertex of the cage
    /// \param form       per edge of the cage
    /// \param evaluator  as FieldSurface
    /// \throws Error     as FieldSurface
    FlowSurface(far_ext::ControlMesh const& cage, std::span<double const> positions,
                std::span<double const> form, TableEvaluator* evaluator = nullptr);

    LimitSurface const& GetSurface() const { return _faces.GetSurface(); }
    Far::TopologyLevel const& GetLevel() const { return GetSurface().GetRefiner().GetLevel(0); }

    /// A place of the cage as one of these faces, and the other way.
    ///
    /// \throws Error  as RefinedFaces
    SurfacePlace FindPlace(SurfacePlace const& onCage) const {
        return _faces.GetRefinedFaces().Find(onCage);
    }
    SurfacePlace FindOnCage(SurfacePlace const& place) const {
        return _faces.GetRefinedFaces().FindBase(place);
    }

    /// Keeps a view of the flow, which must outlive it.
    class Sampler {
    public:
        explicit Sampler(FlowSurface const& flow)
            : _faces(flow._faces), _near(flow._near), _isLoop(flow.GetSurface().IsLoop()) {}

        /// \pre a face with a limit
        void Bind(Index face);

        /// On the bound face. Beyond a regular one its polynomials go on; beyond another, whose
        /// pieces get smaller and smaller towards its corners, all is as at the nearest place.
        FieldSurface::Here Evaluate(double s, double t);

    private:
        FieldSurface::Sampler _faces, _near;
        Index _face = -1;
        bool _isLoop;
    };

    /// The length of the field's vector at each vertex; 0 at one without a limit.
    std::vector<double> FindSpeeds() const;

    /// The root of the mean of their squares.
    double FindRmsSpeed() const;

private:
    FieldSurface _faces;
    FieldSurface _near;  // the same, finer
};

/// A way onward at unit speed.
struct Velocity {
    double s, t;                ///< of the domain, per unit of length
    Eigen::Vector3d direction;  ///< of length 1
};

/// None where the field is not faster than `leastSpeed`, or the surface has no tangent plane.
std::optional<Velocity> FindVelocity(FieldSurface::Here const& here, Heading heading,
                                     double leastSpeed);

}  // namespace limn::eval
