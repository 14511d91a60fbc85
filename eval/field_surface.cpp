#include "eval/field_surface.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "eval/refine_values.h"
#include "eval/surface_sample.h"
#include "eval/vertex_covectors.h"
#include "far_ext/error.h"
#include "far_ext/form_operators.h"
#include "far_ext/form_stencils.h"
#include "far_ext/refined_cage.h"
#include "far_ext/refiner.h"

namespace limn::eval {

FieldSurface::FieldSurface(far_ext::ControlMesh const& cage, std::span<double const> positions, std::span<double const> form, int levels)
    : _positions(positions.begin(), positions.end()), _form(form.begin(), form.end()) {
    bool const isQuads = std::all_of(cage.faceSizes.begin(), cage.faceSizes.end(), [](int size) { return size == 4; });
    if (cage.scheme == Sdc::SCHEME_CATMARK && !isQuads) levels = std::max(levels, 1);
    double const corners = static_cast<double>(cage.faceVertices.size()) * std::pow(4.0, levels);
    if (corners > 2e9) throw Error(ErrorCode::TooLarge, "the field's refined mesh would pass 2^31 indices; use a smaller texture");

    auto const base = far_ext::CreateRefiner(cage);
    far_ext::CheckForms(*base);
    _faces = std::make_unique<RefinedFaces>(LimitSurface(*base), levels);
    if (levels > 0) {
        Far::TopologyRefiner::UniformOptions options(levels);
        options.fullTopologyInLastLevel = true;
        base->RefineUniform(options);
    }
    for (int level = 1; level <= levels; ++level) {
        _positions = RefineValues<3>(*base, level, _positions);
        auto const step = far_ext::BuildFormStencils(*base, level);
        std::vector<double> fine(static_cast<size_t>(step.s1.GetNumRows()));
        step.s1.Apply(_form.data(), fine.data(), 1);
        _form = std::move(fine);
    }
    _vectors.resize(_positions.size() / 3);
    VertexCovectors const covectors(*base, levels);
    tbb::parallel_for(Index(0), static_cast<Index>(_vectors.size()),
                      [&](Index vertex) { _vectors[vertex] = covectors.Find(vertex, _form, _positions).GetVector(); });

    // The refined cage's own edges have other numbers.
    _cage = levels > 0 ? far_ext::MakeRefinedCage(*base, cage) : cage;
    _cage.fvarChannels.clear();
    _refiner = far_ext::CreateRefiner(_cage);
    auto const from = base->GetLevel(levels), to = _refiner->GetLevel(0);
    std::vector<double> renumbered(_form.size());
    for (Index face = 0; face < to.GetNumFaces(); ++face) {
        for (int j = 0; j < to.GetFaceEdges(face).size(); ++j) renumbered[to.GetFaceEdges(face)[j]] = _form[from.GetFaceEdges(face)[j]];
    }
    _form = std::move(renumbered);
    _surface = std::make_unique<LimitSurface>(*_refiner);
}

FieldSurface::Sampler::Sampler(FieldSurface const& field) : _field(field), _tree(*field._surface, field._positions, 3) {}

void FieldSurface::Sampler::Bind(Index face) {
    _tree.Bind(face);
    auto const level = _field._refiner->GetLevel(0);
    _isRegular = _field._surface->IsLoop() ? _triangle.Bind(level, face, _field._form) : _quad.Bind(level, face, _field._form);
}

Eigen::Vector3d FieldSurface::Sampler::EvaluateHere(RefinedFaces::Place const& place) {
    double const s = place.s, t = place.t;
    auto const derivatives = EvaluateDerivatives(_tree, place.domain, s, t);
    if (!HasTangentPlane(derivatives)) return Eigen::Vector3d::Zero();
    if (_isRegular) {
        auto const values = _field._surface->IsLoop() ? _triangle.Evaluate(s, t) : _quad.Evaluate(s, t);
        return VertexCovector{{derivatives.ds, derivatives.dt}, values}.GetVector();
    }
    auto const corners = _field._refiner->GetLevel(0).GetFaceVertices(place.face);
    auto const& vectors = _field._vectors;
    Eigen::Vector3d blend;
    if (corners.size() == 3) {
        blend = (1.0 - s - t) * vectors[corners[0]] + s * vectors[corners[1]] + t * vectors[corners[2]];
    } else {
        blend = (1.0 - t) * ((1.0 - s) * vectors[corners[0]] + s * vectors[corners[1]]) + t * ((1.0 - s) * vectors[corners[3]] + s * vectors[corners[2]]);
    }
    Eigen::Vector3d const normal = derivatives.ds.cross(derivatives.dt).normalized();
    return blend - normal * normal.dot(blend);
}

void FieldSurface::Sampler::Evaluate(Index face, int domain, std::span<double const> s, std::span<double const> t, std::span<Eigen::Vector3d> vectors) {
    // Places in the order of refined faces, each of which is bound once.
    _places.clear();
    for (size_t i = 0; i < s.size(); ++i) _places.push_back({_field._faces->Find(face, domain, s[i], t[i]), i});
    std::sort(_places.begin(), _places.end(), [](Place const& a, Place const& b) {
        return a.at.face != b.at.face ? a.at.face < b.at.face : a.sample < b.sample;
    });
    Index bound = -1;
    for (Place const& place : _places) {
        if (place.at.face != bound) Bind(place.at.face);
        bound = place.at.face;
        vectors[place.sample] = EvaluateHere(place.at);
    }
}

}  // namespace limn::eval
