// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/forms/hodge_star.h"
#include "far_ext/rows/sparse_rows.h"
#include "far_ext/topology/face_components.h"

namespace limn::eval {

class LaplaceSolver;

/// What a field does at boundaries: it runs along them, or straight into them.
enum class AtBoundary { Tangent, Normal };

/// A 1-form as the sum of three that are orthogonal in the Hodge star's inner product.
struct HodgeParts {
    std::vector<double> gradient, vortex, harmonic;
};

/// Designs 1-forms on a mesh: sources and sinks at vertices, vortices at faces, harmonic fields
/// round handles and holes; and takes given ones apart.
///
///     gradient part  d0 f,            (d0^T *1 d0) f = -sources    (flow leaves a source of
///     positive strength) vortex part    *1^-1 d1^T psi,  (d1 *1^-1 d1^T) psi = vortices
///     (counter-clockwise where positive) harmonic part  h with d1 h = 0, d0^T *1 h = 0
///
/// Boundary  Tangent: f is free there, psi is 0 outside.  Normal: f is 0 there, boundary edges
///           carry nothing.
/// Cost      each system is factorised once (nested dissection), when first needed; then a solve
///           per change of strengths.
/// Threads   one at a time.
/// Source    [Wang06] Sec. 4.2; [Forms 8], [Forms 9].
class FieldDesigner {
public:
    /// \param level      a base level that far_ext::CheckForms has passed; must outlive this
    /// \param positions  3 per vertex
    /// \throws Error     as far_ext::FindHodgeStars; BadMesh: edges or angles that differ by so
    /// many
    ///                   orders of magnitude that nothing can be solved in double
    FieldDesigner(Far::TopologyLevel const& level, std::span<double const> positions,
                  AtBoundary atBoundary);
    ~FieldDesigner();

    far_ext::HodgeStars const& GetStars() const { return _stars; }
    far_ext::FaceComponents const& GetComponents() const { return _components; }
    std::vector<int> const& GetComponentOfVertex() const {
        return _componentOfVertex;
    }  ///< -1: no faces

    /// Strengths that have nowhere to go: their sum over a component (1) on which nothing can
    /// leave.
    struct Imbalance {
        int component;
        double sum;
    };
    std::vector<Imbalance> FindSourceImbalance(std::span<double const> sources) const;
    std::vector<Imbalance> FindVortexImbalance(std::span<double const> vortices) const;

    /// \param sources  per vertex  \pre no imbalance beyond rounding, which the lowest vertex of a
    ///                 component takes
    std::vector<double> MakeGradient(std::span<double const> sources);

    /// The function f of which that is d0: 0 at the lowest vertex of each component, under Normal
    /// at boundaries.
    std::vector<double> FindPotential(std::span<double const> sources);

    /// \param vortices  per face  \pre as MakeGradient, for the lowest face
    std::vector<double> MakeVortex(std::span<double const> vortices);

    /// How many harmonic forms there are: 2 g + max(b - 1, 0) per component of genus g with b
    /// boundary loops.
    int CountHarmonics() const;

    /// A basis of them, each with period 1 round its generator; a solve for each when first asked
    /// for.
    std::vector<std::vector<double>> const& GetHarmonics();

    HodgeParts Decompose(std::vector<double> const& form);

    /// Square root of sum *1 w^2: the field's root of energy.
    double FindNorm(std::span<double const> form) const;

    /// d0^T *1 w per vertex (0 at boundary vertices under Normal): what flows in. d1 w per face:
    /// curl.
    std::vector<double> FindInflow(std::span<double const> form) const;
    std::vector<double> FindCurl(std::vector<double> const& form) const;

private:
    std::vector<Imbalance> FindImbalance(std::span<double const> strengths,
                                         std::vector<int> const& componentOf,
                                         AtBoundary freeBoundary) const;
    std::vector<double> FindGradientPart(std::span<double const> form);

    Far::TopologyLevel _level;
    AtBoundary _atBoundary;
    far_ext::FaceComponents _components;
    far_ext::HodgeStars _stars;
    far_ext::SparseRows _d1;
    std::vector<int> _componentOfVertex;  // -1: no faces
    std::vector<char> _isOpen;            // per component
    std::vector<char> _isFixedVertex;     // Normal: on a boundary
    std::vector<char> _isEmptyEdge;       // Normal: a boundary edge
    std::unique_ptr<LaplaceSolver> _vertices, _faces;
    std::vector<std::vector<double>> _harmonics;
};

}  // namespace limn::eval
