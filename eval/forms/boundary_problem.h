// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/forms/hodge_star.h"
#include "far_ext/topology/face_components.h"

namespace limn::eval {

/// What a field is to do along each edge of a boundary: flow along it or through it by an amount.
struct BoundaryData {
    std::vector<char> isCirculation;  ///< per edge; those inside do not count
    /// Per edge: circulation from its lower vertex to its higher one, or flux outwards.
    std::vector<double> values;
};

/// Boundary edges with given circulation that hang together. Along one the potential is known but
/// for a constant.
struct BoundaryArcs {
    int count = 0;               ///< by their lowest edge
    std::vector<int> ofVertex;   ///< -1: of none
    std::vector<int> component;  ///< per arc
    std::vector<char> isFirst;   ///< per arc: of its component; it takes what flows
};

/// A 1-form w from sources, vortices and what it is to be along boundaries:
///
///     d1 w = vortices;  w = given circulation;  d0^T *1 w = -(sources - half the fluxes of the two
///     boundary edges) at vertices in no arc; the same, all added up, on each arc but the first of
///     its component, less what flows out of it.
///
/// Source  [Wang06] Sec. 4.2; [Forms 13]
class BoundaryProblem {
public:
    /// \param level  a base level that far_ext::CheckForms has passed; must outlive this
    /// \throws Error as far_ext::FindHodgeStars
    BoundaryProblem(Far::TopologyLevel const& level, std::span<double const> positions,
                    BoundaryData data);

    BoundaryArcs const& GetArcs() const { return _arcs; }
    far_ext::FaceComponents const& GetComponents() const { return _components; }

    /// What a component's laws ask of its data.
    struct Balance {
        bool hasArc = false;       ///< else what sources give has to be what flows out
        bool hasFreeEdge = false;  ///< else circulations have to be what vortices give
        double sources = 0.0, fluxes = 0.0, vortices = 0.0, circulations = 0.0;
        double size = 0.0;  ///< of all of them without signs: a measure of rounding
    };
    std::vector<Balance> FindBalances(std::span<double const> sources,
                                      std::span<double const> vortices) const;

    /// \param sources    per vertex  \param vortices  per face  \param arcFluxes  per arc, outwards
    /// \pre              balances that are kept but for rounding
    std::vector<double> Solve(std::span<double const> sources, std::span<double const> vortices,
                              std::span<double const> arcFluxes) const;

    /// The largest violation of the equations, over the largest number given.
    double FindResidual(std::vector<double> const& form, std::span<double const> sources,
                        std::span<double const> vortices, std::span<double const> arcFluxes) const;

    /// What flows out at a vertex: its source and what comes along its edges.
    std::vector<double> FindOutflow(std::span<double const> form,
                                    std::span<double const> sources) const;

private:
    void FindArcs();
    bool IsBoundary(Index edge) const { return _level.GetEdgeFaces(edge).size() == 1; }
    bool IsGiven(Index edge) const { return IsBoundary(edge) && _data.isCirculation[edge]; }

    std::vector<double> FindInflow(std::span<double const> form) const;
    std::vector<double> SumUp(std::span<double const> ofVertices) const;
    std::vector<double> MakeRight(std::span<double const> sources,
                                  std::span<double const> arcFluxes) const;
    std::vector<double> MakeVortexPart(std::span<double const> vortices) const;
    std::vector<char> ChooseFixed() const;

    Far::TopologyLevel _level;  // a view
    far_ext::FaceComponents _components;
    far_ext::HodgeStars _stars;
    BoundaryData _data;
    BoundaryArcs _arcs;
    std::vector<int> _unknownOfVertex;    // arcs have one each, after the free vertices'
    std::vector<int> _componentOfVertex;  // -1: no faces
    int _numUnknowns = 0;
};

}  // namespace limn::eval
