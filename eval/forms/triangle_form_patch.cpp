// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/triangle_form_patch.h"

#include <algorithm>

#include <Eigen/Dense>

#include "eval/differential/refine_values.h"
#include "eval/forms/vertex_covectors.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/forms/form_stencils.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/control_mesh.h"
#include "far_ext/topology/refiner.h"

namespace limn::eval {

namespace {

using Terms = TriangleFormPatch::Terms;
constexpr size_t kNumTerms = TriangleFormPatch::kNumTerms;
constexpr size_t kNumPlaces =
    36;  // of edges: 6 spokes and 6 ring edges per corner, some of them twice

/// Monomials of degree 0 to 4 about the triangle's middle.
Terms MakeTerms(double s, double t) {
    double const x = s - 1.0 / 3.0, y = t - 1.0 / 3.0;
    Terms terms;
    size_t at = 0;
    for (int degree = 0; degree <= 4; ++degree) {
        for (int j = 0; j <= degree; ++j, ++at) {
            terms[at] = 1.0;
            for (int k = 0; k < degree - j; ++k) terms[at] *= x;
            for (int k = 0; k < j; ++k) terms[at] *= y;
        }
    }
    return terms;
}

/// The edges round a triangle: per corner its spokes outwards and its ring, counter-clockwise from
/// the triangle's side on.
bool GatherEdges(Far::TopologyLevel const& level, Index face,
                 std::array<far_ext::OrientedEdge, kNumPlaces>& places) {
    size_t at = 0;
    for (Index vertex : level.GetFaceVertices(face)) {
        auto const faces = level.GetVertexFaces(vertex);
        if (faces.size() != 6 || !far_ext::IsSmoothInterior(level, vertex)) return false;
        auto const corners = level.GetVertexFaceLocalIndices(vertex);
        int first = 0;
        while (faces[first] != face) ++first;
        for (int j = 0; j < 6; ++j) {
            int const i = (first + j) % 6;
            places[at++] = far_ext::GetFaceSide(level, faces[i], corners[i]);
            places[at++] = far_ext::GetFaceSide(level, faces[i], (corners[i] + 1) % 3);
        }
    }
    return true;
}

/// Polynomials of both components per edge of the neighbourhood.
struct Basis {
    struct Entry {
        size_t place;
        std::array<Terms, 2> components;
    };
    std::vector<Entry> entries;
};

Basis MakeBasis() {
    // A lattice wide enough that nothing near its middle knows of its border.
    constexpr Index kSide = 9;
    far_ext::ControlMesh mesh;
    mesh.scheme = Sdc::SCHEME_LOOP;
    mesh.numVertices = kSide * kSide;
    std::vector<double> positions;
    for (Index j = 0; j < kSide; ++j) {
        for (Index i = 0; i < kSide; ++i)
            positions.insert(positions.end(),
                             {static_cast<double>(i), static_cast<double>(j), 0.0});
    }
    for (Index j = 0; j + 1 < kSide; ++j) {
        for (Index i = 0; i + 1 < kSide; ++i) {
            Index const a = j * kSide + i;
            mesh.faceSizes.insert(mesh.faceSizes.end(), {3, 3});
            mesh.faceVertices.insert(mesh.faceVertices.end(),
                                     {a, a + 1, a + kSide + 1, a, a + kSide + 1, a + kSide});
        }
    }
    auto const refiner = far_ext::CreateRefiner(mesh);
    Far::TopologyRefiner::UniformOptions options(2);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);
    auto const base = refiner->GetLevel(0), fine = refiner->GetLevel(2);
    auto const stencils = far_ext::ComposeFormStencils(*refiner, 2).s1;
    std::vector<double> const points =
        RefineValues<3>(*refiner, 2, RefineValues<3>(*refiner, 1, positions));
    far_ext::Points const lattice(points);

    Index const face = 2 * ((kSide / 2) * (kSide - 1) + kSide / 2);  // corners (4,4), (5,4), (5,5)
    std::vector<std::pair<Index, Terms>> nodes;
    Eigen::Matrix<double, kNumTerms, kNumTerms> system;
    for (Index vertex = 0; vertex < fine.GetNumVertices(); ++vertex) {
        double const x = lattice[vertex].x() - kSide / 2, y = lattice[vertex].y() - kSide / 2;
        double const s = x - y, t = y;  // (1,0) is s, (1,1) is t
        if (s < -0.01 || t < -0.01 || s + t > 1.01) continue;
        Terms const terms = MakeTerms(s, t);
        system.row(static_cast<Eigen::Index>(nodes.size())) =
            Eigen::Map<Eigen::RowVectorXd const>(terms.data(), kNumTerms);
        nodes.emplace_back(vertex, terms);
    }
    Eigen::FullPivLU<Eigen::Matrix<double, kNumTerms, kNumTerms>> const solver(system);

    std::array<far_ext::OrientedEdge, kNumPlaces> places;
    GatherEdges(base, face, places);
    VertexCovectors const covectors(*refiner, 2);
    Basis basis;
    std::vector<Index> seen;
    for (size_t place = 0; place < kNumPlaces; ++place) {
        if (std::find(seen.begin(), seen.end(), places[place].edge) != seen.end()) continue;
        seen.push_back(places[place].edge);
        std::vector<double> form(base.GetNumEdges(), 0.0), refined(fine.GetNumEdges());
        form[places[place].edge] = places[place].sign;
        stencils.Apply(form.data(), refined.data(), 1);
        Eigen::Matrix<double, kNumTerms, 2> values;
        for (size_t k = 0; k < kNumTerms; ++k) {
            Eigen::Vector3d const v =
                covectors.Find(nodes[k].first, refined, points)
                    .GetVector();  // the lattice's own metric: w(d/dx), w(d/dy)
            values.row(static_cast<Eigen::Index>(k)) << v.x(), v.x() + v.y();
        }
        Eigen::Matrix<double, kNumTerms, 2> const found = solver.solve(values);
        Basis::Entry entry{place, {}};
        for (size_t c = 0; c < 2; ++c) {
            for (size_t k = 0; k < kNumTerms; ++k)
                entry.components[c][k] =
                    found(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c));
        }
        basis.entries.push_back(entry);
    }
    return basis;
}

}  // namespace

bool TriangleFormPatch::Bind(Far::TopologyLevel const& level, Index face,
                             std::span<double const> form) {
    std::array<far_ext::OrientedEdge, kNumPlaces> places;
    if (!GatherEdges(level, face, places)) return false;
    static Basis const basis = MakeBasis();
    _coefficients = {};
    for (Basis::Entry const& entry : basis.entries) {
        auto const& [edge, sign] = places[entry.place];
        double const value = sign * form[edge];
        for (size_t c = 0; c < 2; ++c) {
            for (size_t k = 0; k < kNumTerms; ++k)
                _coefficients[c][k] += value * entry.components[c][k];
        }
    }
    return true;
}

std::array<double, 2> TriangleFormPatch::Evaluate(double s, double t) const {
    Terms const terms = MakeTerms(s, t);
    std::array<double, 2> result{};
    for (size_t c = 0; c < 2; ++c) {
        for (size_t k = 0; k < kNumTerms; ++k) result[c] += _coefficients[c][k] * terms[k];
    }
    return result;
}

}  // namespace limn::eval
