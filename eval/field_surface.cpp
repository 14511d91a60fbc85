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

namespace {

bool IsRegularVertex(Far::TopologyLevel const& level, Index vertex) {
    auto const edges = level.GetVertexEdges(vertex);
    return edges.size() == 4 && level.GetVertexFaces(vertex).size() == 4 && level.GetVertexRule(vertex) == Sdc::Crease::RULE_SMOOTH &&
           std::all_of(edges.begin(), edges.end(), [&](Index edge) { return level.GetEdgeSharpness(edge) <= 0.0f; });
}

/// The vertices of the 3 x 3 quads round a quad whose corners are regular, at [column][row]; false if they are not.
bool GatherVertices(Far::TopologyLevel const& level, Index face, Index grid[4][4]) {
    constexpr int kColumn[4] = {1, 2, 2, 1}, kRow[4] = {1, 1, 2, 2};
    constexpr int kOut[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    auto const corners = level.GetFaceVertices(face);
    if (corners.size() != 4) return false;
    for (int c = 0; c < 4; ++c) {
        if (!IsRegularVertex(level, corners[c])) return false;
    }
    for (int c = 0; c < 4; ++c) {
        auto const faces = level.GetVertexFaces(corners[c]);
        auto const places = level.GetVertexFaceLocalIndices(corners[c]);
        int i = 0;
        while (i < 4 && faces[i] != face) ++i;
        // Across the vertex: its corner before, opposite and after the vertex.
        int const opposite = (i + 2) % 4;
        auto const others = level.GetFaceVertices(faces[opposite]);
        if (others.size() != 4) return false;
        int const column = kColumn[c], row = kRow[c], dx = kOut[c][0], dy = kOut[c][1];
        Index const first = others[(places[opposite] + 1) % 4], far = others[(places[opposite] + 2) % 4], last = others[(places[opposite] + 3) % 4];
        grid[column][row] = corners[c];
        grid[column + dx][row + dy] = far;
        // The faces round the vertex go counter-clockwise: `first` continues the side that comes in, `last` the one that leaves.
        bool const isLeavingAlongS = c % 2 == 0;
        grid[column + dx][row] = isLeavingAlongS ? first : last;
        grid[column][row + dy] = isLeavingAlongS ? last : first;
    }
    return true;
}

}  // namespace

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

bool FieldSurface::GatherEdges(Index face, double alongS[3][4], double alongT[4][3]) const {
    auto const level = _refiner->GetLevel(0);
    Index grid[4][4];
    if (_surface->IsLoop() || !GatherVertices(level, face, grid)) return false;
    auto const get = [&](Index from, Index to, double& value) {
        Index const edge = level.FindEdge(from, to);
        if (edge == Far::INDEX_INVALID) return false;
        value = far_ext::GetSignFrom(level, edge, from) * _form[edge];
        return true;
    };
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 4; ++j) {
            if (!get(grid[i][j], grid[i + 1][j], alongS[i][j]) || !get(grid[j][i], grid[j][i + 1], alongT[j][i])) return false;
        }
    }
    return true;
}

FieldSurface::Sampler::Sampler(FieldSurface const& field) : _field(field), _tree(*field._surface, field._positions, 3) {}

void FieldSurface::Sampler::Bind(Index face) {
    _tree.Bind(face);
    _isRegular = _field.GatherEdges(face, _alongS, _alongT);
}

Eigen::Vector3d FieldSurface::Sampler::EvaluateHere(RefinedFaces::Place const& place) {
    double const s = place.s, t = place.t;
    auto const derivatives = EvaluateDerivatives(_tree, place.domain, s, t);
    if (!HasTangentPlane(derivatives)) return Eigen::Vector3d::Zero();
    if (_isRegular) {
        auto const quadratic = [](double x, double b[3]) {
            b[0] = 0.5 * (1.0 - x) * (1.0 - x);
            b[1] = 0.5 + x * (1.0 - x);
            b[2] = 0.5 * x * x;
        };
        auto const cubic = [](double x, double b[4]) {
            double const y = 1.0 - x;
            b[0] = y * y * y / 6.0;
            b[1] = (4.0 - 6.0 * x * x + 3.0 * x * x * x) / 6.0;
            b[2] = (4.0 - 6.0 * y * y + 3.0 * y * y * y) / 6.0;
            b[3] = x * x * x / 6.0;
        };
        double qs[3], qt[3], cs[4], ct[4], ws = 0.0, wt = 0.0;
        quadratic(s, qs);
        quadratic(t, qt);
        cubic(s, cs);
        cubic(t, ct);
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 4; ++j) {
                ws += qs[i] * ct[j] * _alongS[i][j];
                wt += cs[j] * qt[i] * _alongT[j][i];
            }
        }
        return VertexCovector{{derivatives.ds, derivatives.dt}, {ws, wt}}.GetVector();
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
