// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "eval/stencils/table_evaluator.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/rows/points.h"

namespace limn::eval {

/// The limit at listed places as weights over the cage's vertices, for evaluating the same places
/// again and again while the vertices move.
///
/// Shape      One row per place and weight set: position, ds, dt, dss, dst, dtt, in double.
/// Precision  Second derivatives at depth k of a face's tree are differences of points 4^-k apart;
///            the tree keeps its digits by taking them relative to a corner, a row of weights
///            cannot. So places deeper than kRowDepth (nearer than 2^-6 to an irregular corner),
///            and places whose tangents vanish or nearly coincide in some frame, are evaluated as
///            EvaluateSample does it. What the rows make agrees with EvaluateSample to about 1e-12
///            of the mesh's size.
/// Threads    Immutable once built; Evaluate works in the caller's TBB arena.
class PlaceStencils {
public:
    static constexpr int kRowDepth = 6;

    /// \param surface  kept by reference, it must outlive this; of vertex topology
    /// \throws Error    BadOption: a face or domain that does not exist, (s,t) more than
    /// kPlaceSlack
    ///                  outside the domain; with the place's number
    PlaceStencils(LimitSurface const& surface, std::vector<SurfacePlace> places);

    size_t GetNumPlaces() const { return _places.size(); }

    /// Places that have a row of weights; the others are evaluated on their own.
    size_t GetNumRows() const { return _placeOfRow.size(); }

    /// Samples of all places for one set of positions (3 per vertex), in double. Places on faces
    /// without a limit are left as they are made.
    ///
    /// \throws Error  BadOption: positions that do not reach all vertices
    std::vector<SurfaceSample> Evaluate(std::span<double const> positions,
                                        Orientation orientation) const;

    /// The same with the rows applied in float. Positions are taken relative to their centre first.
    ///
    /// \param table   made of MakeRows()
    /// \throws Error  BadMesh: a position that float cannot hold; BadOption: as above
    std::vector<SurfaceSample> Evaluate(std::span<double const> positions, Orientation orientation,
                                        FixedTable const& table) const;

    /// The rows in float.
    far_ext::StencilRows MakeRows() const;

private:
    void AddRow(FaceTree const& tree, PatchPoint const& at);
    SurfaceDerivatives ApplyRow(size_t row, far_ext::Points points) const;
    template <class Derive>
    std::vector<SurfaceSample> EvaluateWith(std::span<double const> positions,
                                            Orientation orientation, double accuracy,
                                            Derive const& derive) const;

    Index GetNumVertices() const { return _surface.GetRefiner().GetLevel(0).GetNumVertices(); }

    LimitSurface const& _surface;
    std::vector<SurfacePlace> _places;
    std::vector<int> _rowOfPlace;  // -1: evaluated on its own
    std::vector<size_t> _placeOfRow;
    std::vector<size_t> _offsets{0};
    std::vector<Index> _indices;
    std::vector<std::array<double, far_ext::kMaxWeightSets>> _weights;
};

}  // namespace limn::eval
