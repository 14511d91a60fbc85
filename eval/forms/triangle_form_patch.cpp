// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/triangle_form_patch.h"

#include <algorithm>
#include <memory>
#include <vector>

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

/// A regular lattice of triangles, so wide that nothing near its middle knows of its border.
struct Lattice {
    static constexpr Index kSide = 9;
    /// At the middle: corners (4,4), (5,4), (5,5).
    static constexpr Index kFace = 2 * ((kSide / 2) * (kSide - 1) + kSide / 2);

    far_ext::ControlMesh mesh;
    std::vector<double> positions;
};

Lattice MakeLattice() {
    constexpr Index kSide = Lattice::kSide;
    Lattice lattice;
    far_ext::ControlMesh& mesh = lattice.mesh;
    mesh.scheme = Sdc::SCHEME_LOOP;
    mesh.numVertices = kSide * kSide;
    for (Index j = 0; j < kSide; ++j) {
        for (Index i = 0; i < kSide; ++i)
            lattice.positions.insert(lattice.positions.end(),
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
    return lattice;
}

constexpr int kLevel = 2;  // its vertices on the triangle are as many as the terms

std::unique_ptr<Far::TopologyRefiner> RefineLattice(Lattice const& lattice) {
    auto refiner = far_ext::CreateRefiner(lattice.mesh);
    Far::TopologyRefiner::UniformOptions options(kLevel);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);
    return refiner;
}

/// The refined vertices on the triangle, and the polynomials through values there.
class Interpolation {
public:
    using Values = Eigen::Matrix<double, kNumTerms, 2>;

    explicit Interpolation(far_ext::Points points) {
        System system;
        for (Index vertex = 0; vertex < static_cast<Index>(points.GetCount()); ++vertex) {
            double const x = points[vertex].x() - Lattice::kSide / 2,
                         y = points[vertex].y() - Lattice::kSide / 2;
            double const s = x - y, t = y;  // (1,0) is s, (1,1) is t
            if (s < -0.01 || t < -0.01 || s + t > 1.01) continue;
            Terms const terms = MakeTerms(s, t);
            system.row(static_cast<Eigen::Index>(_nodes.size())) =
                Eigen::Map<Eigen::RowVectorXd const>(terms.data(), kNumTerms);
            _nodes.push_back(vertex);
        }
        _solver.compute(system);
    }

    std::vector<Index> const& GetNodes() const { return _nodes; }

    std::array<Terms, 2> Solve(Values const& values) const {
        Values const found = _solver.solve(values);
        std::array<Terms, 2> components;
        for (size_t c = 0; c < 2; ++c) {
            for (size_t k = 0; k < kNumTerms; ++k)
                components[c][k] =
                    found(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c));
        }
        return components;
    }

private:
    using System = Eigen::Matrix<double, kNumTerms, kNumTerms>;

    std::vector<Index> _nodes;
    Eigen::FullPivLU<System> _solver;
};

/// Polynomials of both components per edge of the neighbourhood.
struct Basis {
    struct Entry {
        size_t place;
        std::array<Terms, 2> components;
    };
    std::vector<Entry> entries;
};

/// The first place of each edge: some have two.
std::vector<size_t> FindFirstPlaces(std::array<far_ext::OrientedEdge, kNumPlaces> const& places) {
    std::vector<size_t> firsts;
    for (size_t place = 0; place < kNumPlaces; ++place) {
        auto const isSame = [&](size_t first) { return places[first].edge == places[place].edge; };
        if (std::none_of(firsts.begin(), firsts.end(), isSame)) firsts.push_back(place);
    }
    return firsts;
}

Basis MakeBasis() {
    Lattice const lattice = MakeLattice();
    auto const refiner = RefineLattice(lattice);
    auto const base = refiner->GetLevel(0);
    auto const stencils = far_ext::ComposeFormStencils(*refiner, kLevel).s1;
    std::vector<double> points = lattice.positions;
    for (int level = 1; level <= kLevel; ++level) points = RefineValues<3>(*refiner, level, points);
    Interpolation const interpolation(points);
    VertexCovectors const covectors(*refiner, kLevel);

    std::array<far_ext::OrientedEdge, kNumPlaces> places;
    GatherEdges(base, Lattice::kFace, places);
    Basis basis;
    for (size_t place : FindFirstPlaces(places)) {
        std::vector<double> form(base.GetNumEdges(), 0.0),
            refined(refiner->GetLevel(kLevel).GetNumEdges());
        form[places[place].edge] = places[place].sign;
        stencils.Apply(form.data(), refined.data(), 1);
        Interpolation::Values values;
        for (size_t k = 0; k < kNumTerms; ++k) {
            // The lattice's own metric: w(d/dx), w(d/dy).
            Eigen::Vector3d const v =
                covectors.Find(interpolation.GetNodes()[k], refined, points).GetVector();
            values.row(static_cast<Eigen::Index>(k)) << v.x(), v.x() + v.y();
        }
        basis.entries.push_back({place, interpolation.Solve(values)});
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
