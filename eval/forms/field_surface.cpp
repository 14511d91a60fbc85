// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/field_surface.h"

#include <algorithm>

#include "eval/differential/value_refiner.h"
#include "eval/forms/vertex_covectors.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/error.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/forms/form_stencils.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/refined_cage.h"
#include "far_ext/topology/refiner.h"

namespace limn::eval {

FieldSurface::FieldSurface(far_ext::ControlMesh const& cage, std::span<double const> positions,
                           std::span<double const> form, int levels, TableEvaluator* evaluator)
    : _positions(positions.begin(), positions.end()), _form(form.begin(), form.end()) {
    if (!far_ext::HasRefinedFaces(cage)) levels = std::max(levels, 1);
    double const corners = static_cast<double>(cage.faceVertices.size()) * std::pow(4.0, levels);
    if (corners > 2e9)
        throw Error(ErrorCode::TooLarge,
                    "the field's refined mesh would pass 2^31 indices; use a smaller texture");

    auto const base = far_ext::CreateRefiner(cage);
    far_ext::CheckForms(*base);
    far_ext::CheckPoints(positions, cage.numVertices);
    far_ext::CheckLength("form", form, base->GetLevel(0).GetNumEdges(), "edges", 1);
    _faces = std::make_unique<RefinedFaces>(LimitSurface(*base), levels);
    if (levels > 0) {
        Far::TopologyRefiner::UniformOptions options(levels);
        options.fullTopologyInLastLevel = true;
        base->RefineUniform(options);
    }
    ValueRefiner values(*base, evaluator);
    for (int level = 1; level <= levels; ++level) {
        _positions = values.Refine<3>(level, _positions);
        _form = ApplyRows(evaluator, far_ext::FormStencils::kS1,
                          far_ext::BuildFormStencils(*base, level).s1, _form);
    }
    FindVectors(*base, evaluator);

    // The refined cage's own edges have other numbers.
    _cage = levels > 0 ? far_ext::MakeRefinedCage(*base, cage) : cage;
    _cage.fvarChannels.clear();
    _refiner = far_ext::CreateRefiner(_cage);
    auto const from = base->GetLevel(levels), to = _refiner->GetLevel(0);
    std::vector<double> renumbered(_form.size());
    for (Index face = 0; face < to.GetNumFaces(); ++face) {
        for (int j = 0; j < to.GetFaceEdges(face).size(); ++j)
            renumbered[to.GetFaceEdges(face)[j]] = _form[from.GetFaceEdges(face)[j]];
    }
    _form = std::move(renumbered);
    _surface = std::make_unique<LimitSurface>(*_refiner);
}

/// At the corners of faces that are not regular.
void FieldSurface::FindVectors(Far::TopologyRefiner const& refiner, TableEvaluator* evaluator) {
    auto const level = refiner.GetLevel(refiner.GetMaxLevel());
    int const valence = refiner.GetSchemeType() == Sdc::SCHEME_LOOP ? 6 : 4;
    std::vector<char> isNeeded(level.GetNumVertices(), 0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const corners = level.GetFaceVertices(face);
        bool const isRegular = std::all_of(corners.begin(), corners.end(), [&](Index vertex) {
            return level.GetVertexFaces(vertex).size() == valence &&
                   far_ext::IsSmoothInterior(level, vertex);
        });
        for (Index vertex : corners) isNeeded[vertex] |= !isRegular;
    }
    _vectors.assign(isNeeded.size(), Eigen::Vector3d::Zero());
    std::vector<Index> needed;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (isNeeded[vertex]) needed.push_back(vertex);
    }
    auto const covectors = VertexCovectors(refiner, refiner.GetMaxLevel())
                               .FindAll(needed, _form, _positions, evaluator);
    for (size_t i = 0; i < needed.size(); ++i) _vectors[needed[i]] = covectors[i].GetVector();
}

FieldSurface::Sampler::Sampler(FieldSurface const& field)
    : _field(field), _tree(*field._surface, field._positions, 3) {}

void FieldSurface::Sampler::Bind(Index face) {
    _tree.Bind(face);
    auto const level = _field._refiner->GetLevel(0);
    _isRegular = _field._surface->IsLoop() ? _triangle.Bind(level, face, _field._form)
                                           : _quad.Bind(level, face, _field._form);
}

/// The exact vectors at the corners of the bound face, laid into the tangent plane.
Eigen::Vector3d FieldSurface::Sampler::BlendCorners(Here const& here, double s, double t) const {
    auto const corners = _field._refiner->GetLevel(0).GetFaceVertices(_tree.GetFace());
    auto const& vectors = _field._vectors;
    Eigen::Vector3d blend;
    if (corners.size() == 3) {
        blend =
            (1.0 - s - t) * vectors[corners[0]] + s * vectors[corners[1]] + t * vectors[corners[2]];
    } else {
        blend = (1.0 - t) * ((1.0 - s) * vectors[corners[0]] + s * vectors[corners[1]]) +
                t * ((1.0 - s) * vectors[corners[3]] + s * vectors[corners[2]]);
    }
    Eigen::Vector3d const normal = here.ds.cross(here.dt).normalized();
    return blend - normal * normal.dot(blend);
}

FieldSurface::Here FieldSurface::Sampler::EvaluateHere(double s, double t) {
    auto const derivatives =
        EvaluateDerivatives(_tree, _tree.LocateChecked(0, s, t, FaceTree::kLimitDepth));
    Here here{derivatives.position, derivatives.ds, derivatives.dt, Eigen::Vector3d::Zero()};
    if (!HasTangentPlane(derivatives)) return here;
    if (_isRegular) {
        auto const values =
            _field._surface->IsLoop() ? _triangle.Evaluate(s, t) : _quad.Evaluate(s, t);
        here.vector = VertexCovector{{here.ds, here.dt}, values}.GetVector();
    } else {
        here.vector = BlendCorners(here, s, t);
    }
    return here;
}

void FieldSurface::Sampler::Evaluate(Index face, int domain, std::span<double const> s,
                                     std::span<double const> t,
                                     std::span<Eigen::Vector3d> vectors) {
    CheckRoom(vectors.size(), s.size());
    _field._faces->FindSorted(face, domain, s, t, _places);
    Index bound = -1;
    for (auto const& place : _places) {
        if (place.at.face != bound) Bind(place.at.face);
        bound = place.at.face;
        vectors[place.index] = EvaluateHere(place.at.s, place.at.t).vector;
    }
}

}  // namespace limn::eval
