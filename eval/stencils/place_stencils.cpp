// SPDX-License-Identifier: Apache-2.0
#include "eval/stencils/place_stencils.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <tbb/enumerable_thread_specific.h>

#include "eval/parallel/rows.h"
#include "far_ext/error.h"

namespace limn::eval {

namespace {

Eigen::AlignedBox3d GetBounds(far_ext::Points points) {
    Eigen::AlignedBox3d box;
    for (size_t vertex = 0; vertex < points.GetCount(); ++vertex) box.extend(points[vertex]);
    return box;
}

}  // namespace

PlaceStencils::PlaceStencils(LimitSurface const& surface, std::vector<SurfacePlace> places)
    : _surface(surface), _places(std::move(places)), _rowOfPlace(_places.size(), -1) {
    CheckPlaces(surface, _places);
    constexpr double kDeepest = 1 << kRowDepth;
    FaceTree tree(surface, std::vector<FaceTree::Values>{});
    Index bound = -1;
    for (size_t i = 0; i < _places.size(); ++i) {
        SurfacePlace const& place = _places[i];
        if (!surface.HasLimit(place.face)) continue;
        if (place.face != bound) tree.BindWeights(place.face);
        bound = place.face;
        PatchPoint const at = tree.Locate(place.domain, place.s, place.t, kRowDepth + 1);
        if (at.isMoved || std::abs(at.scale) > kDeepest) continue;
        _rowOfPlace[i] = static_cast<int>(_placeOfRow.size());
        _placeOfRow.push_back(i);
        AddRow(tree, at);
    }
}

void PlaceStencils::AddRow(FaceTree const& tree, PatchPoint const& at) {
    for (size_t point = 0; point < tree.GetPoints().size(); ++point) {
        auto const weights = EvaluateDerivatives(tree, at, static_cast<int>(point));
        if (std::all_of(weights.begin(), weights.end(),
                        [](double weight) { return weight == 0.0; }))
            continue;
        _indices.push_back(tree.GetPoints()[point]);
        _weights.push_back(weights);
    }
    _offsets.push_back(_indices.size());
}

/// Relative to the row's first point: that costs no digits where the mesh is far from the origin.
SurfaceDerivatives PlaceStencils::ApplyRow(size_t row, far_ext::Points points) const {
    SurfaceDerivatives d;
    Eigen::Vector3d* const sums[] = {&d.position, &d.ds, &d.dt, &d.dss, &d.dst, &d.dtt};
    for (Eigen::Vector3d* sum : sums) sum->setZero();
    auto const origin = points[_indices[_offsets[row]]];
    for (size_t k = _offsets[row]; k < _offsets[row + 1]; ++k) {
        Eigen::Vector3d const point = points[_indices[k]] - origin;
        for (int set = 0; set < far_ext::kMaxWeightSets; ++set)
            *sums[set] += _weights[k][set] * point;
    }
    d.position += origin;
    return d;
}

/// \param accuracy  tangents shorter than this, relative to the mesh, or with an angle below it are
///                  not trusted
/// \param derive    row -> SurfaceDerivatives
template <class Derive>
std::vector<SurfaceSample> PlaceStencils::EvaluateWith(std::span<double const> positions,
                                                       Orientation orientation, double accuracy,
                                                       Derive const& derive) const {
    std::vector<SurfaceSample> samples(_places.size());
    double const shortest = accuracy * GetBounds(positions).diagonal().norm();
    auto const isTrusted = [&](SurfaceDerivatives const& d) {
        return d.ds.norm() > shortest && d.dt.norm() > shortest && HasTangentPlane(d, accuracy);
    };
    tbb::enumerable_thread_specific<FaceTree> trees(
        [&] { return FaceTree(_surface, positions, 3); });
    constexpr Index kPlacesPerBlock = 256;
    ForEachBlock(static_cast<Index>(_places.size()), kPlacesPerBlock, [&](Index begin, Index end) {
        FaceTree* tree = nullptr;  // made where a place needs it
        for (Index i = begin; i < end; ++i) {
            SurfacePlace const& place = _places[i];
            if (!_surface.HasLimit(place.face)) continue;
            if (_rowOfPlace[i] >= 0) {
                SurfaceDerivatives const derivatives = derive(_rowOfPlace[i]);
                if (isTrusted(derivatives)) {
                    samples[i] = MakeSample(derivatives, orientation);
                    continue;
                }
            }
            if (!tree) tree = &trees.local();
            tree->Bind(place.face);
            samples[i] = EvaluateSample(*tree, place.domain, place.s, place.t, orientation);
        }
    });
    return samples;
}

std::vector<SurfaceSample> PlaceStencils::Evaluate(std::span<double const> positions,
                                                   Orientation orientation) const {
    far_ext::CheckPoints(positions, GetNumVertices());
    return EvaluateWith(positions, orientation, 1e-7,
                        [&](size_t row) { return ApplyRow(row, positions); });
}

std::vector<SurfaceSample> PlaceStencils::Evaluate(std::span<double const> positions,
                                                   Orientation orientation,
                                                   FixedTable const& table) const {
    far_ext::CheckPoints(positions, GetNumVertices());
    Eigen::Vector3d const centre = GetBounds(positions).center();
    size_t const size = GetNumRows() * 3;
    std::vector<double> results(size * far_ext::kMaxWeightSets);
    table.Apply(positions, 3, results, centre.data());
    return EvaluateWith(positions, orientation, 1e-4, [&](size_t row) {
        SurfaceDerivatives d;
        Eigen::Vector3d* const sums[] = {&d.position, &d.ds, &d.dt, &d.dss, &d.dst, &d.dtt};
        for (int set = 0; set < far_ext::kMaxWeightSets; ++set)
            *sums[set] = Eigen::Map<Eigen::Vector3d const>(&results[set * size + row * 3]);
        return d;
    });
}

far_ext::StencilRows PlaceStencils::MakeRows() const {
    far_ext::StencilRows rows(GetNumVertices(), far_ext::kMaxWeightSets);
    float entry[far_ext::kMaxWeightSets];
    for (size_t row = 0; row < GetNumRows(); ++row) {
        for (size_t k = _offsets[row]; k < _offsets[row + 1]; ++k) {
            for (int set = 0; set < far_ext::kMaxWeightSets; ++set)
                entry[set] = static_cast<float>(_weights[k][set]);
            rows.AddEntry(_indices[k], entry);
        }
        rows.EndRow();
    }
    return rows;
}

}  // namespace limn::eval
