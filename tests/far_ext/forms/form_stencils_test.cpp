// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/form_stencils.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include <Eigen/SparseCore>
#include <gtest/gtest.h>

#include "far_ext/differential/subdivision_rows.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/rows/sparse_matrix.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using far_ext::AsMatrix;
using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

double Largest(Matrix const& matrix) {
    double largest = 0.0;
    for (Eigen::Index row = 0; row < matrix.outerSize(); ++row) {
        for (Matrix::InnerIterator it(matrix, row); it; ++it)
            largest = test::Worse(largest, std::abs(it.value()));
    }
    return largest;
}

/// All operators of one step.
struct Step {
    Matrix s0, s1, s2, coarseD0, coarseD1, d0, d1;

    Step(Far::TopologyRefiner const& refiner, int level) {
        auto const coarse = refiner.GetLevel(level - 1), fine = refiner.GetLevel(level);
        auto const forms = far_ext::BuildFormStencils(refiner, level);
        s0 = AsMatrix(
            far_ext::BuildSubdivisionRows(refiner, level, far_ext::SubdivisionRule::Scheme),
            coarse.GetNumVertices());
        s1 = AsMatrix(forms.s1, coarse.GetNumEdges());
        s2 = AsMatrix(forms.s2, coarse.GetNumFaces());
        coarseD0 = AsMatrix(far_ext::BuildD0(coarse), coarse.GetNumVertices());
        coarseD1 = AsMatrix(far_ext::BuildD1(coarse), coarse.GetNumEdges());
        d0 = AsMatrix(far_ext::BuildD0(fine), fine.GetNumVertices());
        d1 = AsMatrix(far_ext::BuildD1(fine), fine.GetNumEdges());
    }
};

void CheckLaws(Step const& step, std::string const& name) {
    EXPECT_EQ(Largest(step.d1 * step.d0), 0.0) << name;
    EXPECT_LT(Largest(Matrix(step.d0 * step.s0) - Matrix(step.s1 * step.coarseD0)), 1e-14) << name;
    EXPECT_LT(Largest(Matrix(step.d1 * step.s1) - Matrix(step.s2 * step.coarseD1)), 1e-14) << name;
    Eigen::VectorXd const columns = Eigen::RowVectorXd::Ones(step.s2.rows()) * step.s2;
    EXPECT_LT(test::LargestOf(columns.array() - 1.0), 1e-14) << name;
    double smallest = 0.0;
    for (Eigen::Index k = 0; k < step.s2.nonZeros(); ++k)
        smallest = std::min(smallest, step.s2.valuePtr()[k]);
    EXPECT_GE(smallest, 0.0) << name;
}

// The laws of [Forms 2]: S1 commutes with S0 and S2; nothing of a 2-form is lost; no weight is
// negative.
TEST(FormStencils, CommuteOnEveryKindOfMesh) {
    for (auto& [name, scene] : test::MakeFormMeshes()) {
        for (auto boundary :
             {Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
            scene.cage.options.SetVtxBoundaryInterpolation(boundary);
            auto const refiner = test::MakeRefiner(scene, 3);
            ASSERT_NO_THROW(far_ext::CheckForms(*refiner)) << name;
            for (int level = 1; level <= 3; ++level)
                CheckLaws(Step(*refiner, level), name + ", level " + std::to_string(level));
        }
    }
}

TEST(FormStencils, CommuteWithChaikinsCreases) {
    for (auto& [name, scene] : test::MakeFormMeshes()) {
        if (scene.cage.creaseSharpness.empty()) continue;
        scene.cage.options.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN);
        auto const refiner = test::MakeRefiner(scene, 2);
        for (int level = 1; level <= 2; ++level)
            CheckLaws(Step(*refiner, level), name + ", level " + std::to_string(level));
    }
}

class FormStencilsOf : public testing::TestWithParam<char const*> {};

TEST_P(FormStencilsOf, CommuteOnRealMeshes) {
    std::string const path = GetParam();
    engine::Scene scene = path == "spot" ? test::LoadSpot() : test::LoadAsset(path);
    bool const isTriangles = std::all_of(scene.cage.faceSizes.begin(), scene.cage.faceSizes.end(),
                                         [](int size) { return size == 3; });
    if (isTriangles) scene.cage.scheme = Sdc::SCHEME_LOOP;
    int const levels = scene.cage.GetNumFaces() < 3000 ? 3 : 1;
    auto const refiner = test::MakeRefiner(scene, levels);
    far_ext::CheckForms(*refiner);
    for (int level = 1; level <= levels; ++level) CheckLaws(Step(*refiner, level), path);
}

INSTANTIATE_TEST_SUITE_P(Assets, FormStencilsOf,
                         testing::Values("spot", "tri/dodecahedron_poly.obj", "tri/bob_small.ply",
                                         "tri/eight.off", "tri/elephant-with-holes.off",
                                         "tri/mechpart_loop_control.obj"));

#ifdef LIMN_ASSETS
INSTANTIATE_TEST_SUITE_P(Larger, FormStencilsOf,
                         testing::Values("control/ict_head_skin.obj", "tri/cowhead.obj"));
#endif

// S2 keeps a constant density where all sums are 1/4: away from Loop's valence 3 and single
// boundary triangles.
TEST(FormStencils, KeepAConstantDensity) {
    int numKept = 0;
    for (auto& [name, scene] : test::MakeFormMeshes()) {
        if (!scene.cage.creaseSharpness.empty()) continue;
        auto const refiner = test::MakeRefiner(scene, 1);
        auto const coarse = refiner->GetLevel(0);
        auto const forms = far_ext::BuildFormStencils(*refiner, 1);
        bool const isLoop = scene.cage.scheme == Sdc::SCHEME_LOOP;
        Eigen::VectorXd density(coarse.GetNumFaces());
        std::vector<char> isExempt(static_cast<size_t>(refiner->GetLevel(1).GetNumFaces()), 0);
        for (Index face = 0; face < coarse.GetNumFaces(); ++face) {
            density[face] = isLoop ? 1.0 : coarse.GetFaceVertices(face).size() / 4.0;
            for (int j = 0; isLoop && j < 3; ++j) {
                Index const vertex = coarse.GetFaceVertices(face)[j];
                int const k = coarse.GetVertexFaces(vertex).size();
                if (k != 3 && k != 1) continue;
                for (Index child : coarse.GetFaceChildFaces(face)) isExempt[child] = 1;
            }
        }
        Eigen::VectorXd const fine = AsMatrix(forms.s2, coarse.GetNumFaces()) * density;
        for (Eigen::Index i = 0; i < fine.size(); ++i) {
            if (isExempt[static_cast<size_t>(i)]) continue;
            EXPECT_NEAR(fine[i], 0.25, 1e-14) << name << ", face " << i;
            ++numKept;
        }
    }
    EXPECT_GT(numKept, 1000);
}

// Rows worked out by hand [Forms 11].
TEST(FormStencils, MatchTheReferenceRowsOfTheTetrahedron) {
    auto const refiner = test::MakeRefiner(test::MakeTetrahedron(), 1);
    auto const coarse = refiner->GetLevel(0), fine = refiner->GetLevel(1);
    Index const edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    for (Index e = 0; e < 6; ++e) {
        auto const ends = coarse.GetEdgeVertices(e);
        EXPECT_EQ(std::min(ends[0], ends[1]), edges[e][0]);
        EXPECT_EQ(std::max(ends[0], ends[1]), edges[e][1]);
    }
    auto const forms = far_ext::BuildFormStencils(*refiner, 1);
    Eigen::MatrixXd const s1 = 96.0 * Eigen::MatrixXd(AsMatrix(forms.s1, 6)),
                          s2 = 96.0 * Eigen::MatrixXd(AsMatrix(forms.s2, 4));
    auto const children = coarse.GetFaceChildFaces(0);
    Eigen::Matrix<double, 4, 4> expected;
    expected << 4, 1, 1, 0, 4, 1, 0, 1, 4, 0, 1, 1, 60, 6, 6, 6;
    for (int i = 0; i < 4; ++i)
        EXPECT_LT(test::LargestOf(s2.row(children[i]) - expected.row(i)), 1e-12) << i;
    Eigen::RowVectorXd even(6), odd(6);
    even << 22, 2, -8, -8, 2, 0;
    odd << -27, 0, 27, 0, -3, 3;
    Index const half = coarse.GetEdgeChildEdges(0)[coarse.GetEdgeVertices(0)[0] == 0 ? 0 : 1];
    EXPECT_LT(test::LargestOf(s1.row(half) - even), 1e-12);
    Index const edge46 = fine.FindEdge(4, 6);
    ASSERT_NE(edge46, Far::INDEX_INVALID);
    EXPECT_LT(test::LargestOf(s1.row(edge46) - odd), 1e-12);
}

// On the regular lattice the forms dx and dy are halved (triangles and quads), wherever the stencil
// sees no boundary.
TEST(FormStencils, HalveConstantForms) {
    for (auto scheme : {Sdc::SCHEME_LOOP, Sdc::SCHEME_CATMARK}) {
        engine::Scene const scene = test::MakeLattice(8, 8, scheme);
        auto const refiner = test::MakeRefiner(scene, 1);
        auto const coarse = refiner->GetLevel(0), fine = refiner->GetLevel(1);
        auto const forms = far_ext::BuildFormStencils(*refiner, 1);
        auto const points = eval::RefineValues<3>(*refiner, 1, scene.positions);
        for (size_t axis = 0; axis < 2; ++axis) {
            auto const form = test::MakeCoordinateForm(coarse, scene.positions, axis);
            std::vector<double> result(static_cast<size_t>(fine.GetNumEdges()));
            forms.s1.Apply(form.data(), result.data(), 1);
            EXPECT_LT(test::LargestDifference(result, test::MakeCoordinateForm(fine, points, axis)),
                      1e-14);
        }
    }
}

/// The row of the fine edge between the points at two places, keyed by the places of coarse edges'
/// ends.
using Place = std::pair<double, double>;
std::map<std::pair<Place, Place>, double> RowBetween(engine::Scene const& scene, Place from,
                                                     Place to) {
    auto const refiner = test::MakeRefiner(scene, 1);
    auto const coarse = refiner->GetLevel(0), fine = refiner->GetLevel(1);
    auto const points = eval::RefineValues<3>(*refiner, 1, scene.positions);
    auto const find = [&](Place place) {
        for (Index v = 0; v < fine.GetNumVertices(); ++v) {
            if (std::abs(points[3 * static_cast<size_t>(v)] - place.first) +
                    std::abs(points[3 * static_cast<size_t>(v) + 1] - place.second) <
                1e-9)
                return v;
        }
        return Index(-1);
    };
    Index const a = find(from), b = find(to), edge = fine.FindEdge(a, b);
    auto const s1 = far_ext::BuildFormStencils(*refiner, 1).s1;
    std::map<std::pair<Place, Place>, double> row;
    for (int k = s1.offsets[edge]; k < s1.offsets[edge + 1]; ++k) {
        auto const ends = coarse.GetEdgeVertices(s1.indices[k]);
        Index const low = std::min(ends[0], ends[1]), high = std::max(ends[0], ends[1]);
        auto const place = [&](Index v) {
            return Place(scene.positions[3 * static_cast<size_t>(v)],
                         scene.positions[3 * static_cast<size_t>(v) + 1]);
        };
        double const weight = (a < b ? 1.0 : -1.0) * s1.weights[k];
        if (place(low) < place(high))
            row[{place(low), place(high)}] = weight;
        else
            row[{place(high), place(low)}] = -weight;
    }
    return row;
}

// [Forms 4]: (1,3)/8 along and (1,6,1)/8 across on mesh lines, (1,3)/8 and (1,1)/2 inside faces.
TEST(FormStencils, AreATensorProductAmongQuads) {
    auto const scene = test::MakeLattice(8, 8, Sdc::SCHEME_CATMARK);
    auto const even = RowBetween(scene, {4, 4}, {4.5, 4});
    ASSERT_EQ(even.size(), 6u);
    for (int j : {-1, 0, 1}) {
        for (int i : {0, 1}) {
            double const along = i ? 3.0 / 8.0 : 1.0 / 8.0, across = (j ? 1.0 : 6.0) / 8.0;
            EXPECT_NEAR(even.at({{3.0 + i, 4.0 + j}, {4.0 + i, 4.0 + j}}), along * across, 1e-15);
        }
    }
    auto const odd = RowBetween(scene, {4, 4.5}, {4.5, 4.5});
    ASSERT_EQ(odd.size(), 4u);
    for (int j : {0, 1}) {
        for (int i : {0, 1})
            EXPECT_NEAR(odd.at({{3.0 + i, 4.0 + j}, {4.0 + i, 4.0 + j}}), (i ? 3.0 : 1.0) / 16.0,
                        1e-15);
    }
}

// [Forms 3.5], the stencils of valence 6.
TEST(FormStencils, MatchTheRegularStencilsOfLoop) {
    auto const scene = test::MakeLattice(8, 8, Sdc::SCHEME_LOOP);
    Place const v{4, 4};
    Place const w[6] = {{5, 4}, {5, 5}, {4, 5}, {3, 4}, {3, 3}, {4, 3}};
    auto const expect = [&](std::map<std::pair<Place, Place>, double> const& row,
                            std::array<double, 6> spokes, std::array<double, 6> ring) {
        size_t count = 0;
        auto const check = [&](Place a, Place b, double weight) {
            if (weight == 0.0) return;
            ++count;
            auto const found = a < b ? row.find({a, b}) : row.find({b, a});
            ASSERT_NE(found, row.end());
            EXPECT_NEAR(found->second, (a < b ? weight : -weight) / 32.0, 1e-15);
        };
        for (size_t i = 0; i < 6; ++i) {
            check(v, w[i], spokes[i]);
            check(w[i], w[(i + 1) % 6], ring[i]);
        }
        EXPECT_EQ(row.size(), count);
    };
    expect(RowBetween(scene, {4, 4}, {4.5, 4}), {8, 2, -1, -2, -1, 2}, {-1, -1, 0, 0, 1, 1});
    expect(RowBetween(scene, {4.5, 4}, {4.5, 4.5}), {-3, 3, 3, 0, 0, -3}, {6, 1, 0, 0, 0, 1});
}

/// The same mesh with vertices and faces in other places and faces started elsewhere; or seen in a
/// mirror.
struct Renumbered {
    engine::Scene scene;
    std::vector<Index> vertices, faces;  // the new number of an old one
};

Renumbered Renumber(engine::Scene const& scene, bool isMirrored) {
    Renumbered result{scene, {}, {}};
    Index const numVertices = scene.cage.numVertices,
                numFaces = static_cast<Index>(scene.cage.faceSizes.size());
    for (Index v = 0; v < numVertices; ++v)
        result.vertices.push_back(isMirrored ? v : numVertices - 1 - v);
    for (Index f = 0; f < numFaces; ++f) result.faces.push_back(isMirrored ? f : numFaces - 1 - f);
    std::vector<std::vector<Index>> lists(static_cast<size_t>(numFaces));
    Index at = 0;
    for (Index f = 0; f < numFaces; ++f) {
        int const size = scene.cage.faceSizes[f];
        auto& list = lists[static_cast<size_t>(result.faces[static_cast<size_t>(f)])];
        for (int j = 0; j < size; ++j)
            list.push_back(
                result.vertices[static_cast<size_t>(scene.cage.faceVertices[at + (j + 1) % size])]);
        if (isMirrored) std::reverse(list.begin(), list.end());
        at += size;
    }
    std::vector<double> positions(scene.positions.size());
    for (Index v = 0; v < numVertices; ++v) {
        std::copy_n(&scene.positions[3 * static_cast<size_t>(v)], 3,
                    &positions[3 * static_cast<size_t>(result.vertices[static_cast<size_t>(v)])]);
    }
    result.scene = test::MakeScene(positions, lists, scene.cage.scheme);
    auto& cage = result.scene.cage;
    cage.creaseSharpness = scene.cage.creaseSharpness;
    cage.cornerSharpness = scene.cage.cornerSharpness;
    for (Index v : scene.cage.creaseVertexPairs)
        cage.creaseVertexPairs.push_back(result.vertices[static_cast<size_t>(v)]);
    for (Index v : scene.cage.cornerVertices)
        cage.cornerVertices.push_back(result.vertices[static_cast<size_t>(v)]);
    return result;
}

/// A 1-form and a 2-form that do not know numbers: from positions.
std::pair<std::vector<double>, std::vector<double>> MakeForms(Far::TopologyLevel const& level,
                                                              std::vector<double> const& points,
                                                              double side) {
    std::vector<double> one, two;
    auto const at = [&](Index v, size_t c) { return points[3 * static_cast<size_t>(v) + c]; };
    for (Index e = 0; e < level.GetNumEdges(); ++e) {
        auto const ends = level.GetEdgeVertices(e);
        Index const a = std::min(ends[0], ends[1]), b = std::max(ends[0], ends[1]);
        one.push_back((at(b, 0) - at(a, 0)) * (at(a, 1) + at(b, 1)) + std::sin(at(b, 2)) -
                      std::sin(at(a, 2)));
    }
    for (Index f = 0; f < level.GetNumFaces(); ++f) {
        double sum = 0.0;
        for (Index v : level.GetFaceVertices(f))
            sum += std::cos(at(v, 0) + 2 * at(v, 1) + 3 * at(v, 2));
        two.push_back(side * sum);
    }
    return {one, two};
}

/// A mesh refined once, and the forms of MakeForms on it.
struct RefinedForms {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    Far::TopologyLevel coarse, fine;
    std::vector<double> one, two;

    RefinedForms(engine::Scene const& scene, double side)
        : refiner(test::MakeRefiner(scene, 1)),
          coarse(refiner->GetLevel(0)),
          fine(refiner->GetLevel(1)) {
        auto const [coarseOne, coarseTwo] = MakeForms(coarse, scene.positions, side);
        auto const forms = far_ext::BuildFormStencils(*refiner, 1);
        one.resize(forms.s1.GetNumRows());
        two.resize(forms.s2.GetNumRows());
        forms.s1.Apply(coarseOne.data(), one.data(), 1);
        forms.s2.Apply(coarseTwo.data(), two.data(), 1);
    }
};

/// Vertices of the refined meshes, matched through their parents.
std::vector<Index> MatchVertices(RefinedForms const& a, RefinedForms const& b,
                                 Renumbered const& other) {
    std::vector<Index> matches(a.fine.GetNumVertices(), -1);
    for (Index v = 0; v < a.coarse.GetNumVertices(); ++v) {
        Index const child = a.coarse.GetVertexChildVertex(v);
        if (child >= 0) matches[child] = b.coarse.GetVertexChildVertex(other.vertices[v]);
    }
    for (Index e = 0; e < a.coarse.GetNumEdges(); ++e) {
        auto const ends = a.coarse.GetEdgeVertices(e);
        Index const same = b.coarse.FindEdge(other.vertices[ends[0]], other.vertices[ends[1]]);
        matches[a.coarse.GetEdgeChildVertex(e)] = b.coarse.GetEdgeChildVertex(same);
    }
    bool const hasFaceVertices = a.refiner->GetSchemeType() == Sdc::SCHEME_CATMARK;
    for (Index f = 0; hasFaceVertices && f < a.coarse.GetNumFaces(); ++f) {
        matches[a.coarse.GetFaceChildVertex(f)] = b.coarse.GetFaceChildVertex(other.faces[f]);
    }
    return matches;
}

void CheckSameOneForm(RefinedForms const& a, RefinedForms const& b, Renumbered const& other,
                      std::string const& name) {
    std::vector<Index> const matches = MatchVertices(a, b, other);
    for (Index e = 0; e < a.fine.GetNumEdges(); ++e) {
        auto const ends = a.fine.GetEdgeVertices(e);
        Index const low = matches[std::min(ends[0], ends[1])],
                    high = matches[std::max(ends[0], ends[1])];
        double const sign = low < high ? 1.0 : -1.0;
        EXPECT_NEAR(a.one[e], sign * b.one[b.fine.FindEdge(low, high)], 1e-13) << name;
    }
}

/// \param side  -1: seen in a mirror
void CheckSameTwoForm(RefinedForms const& a, RefinedForms const& b, Renumbered const& other,
                      double side, std::string const& name) {
    // A child face by its parent and the corner it is at (Loop: or the middle).
    for (Index f = 0; f < a.coarse.GetNumFaces(); ++f) {
        auto const corners = a.coarse.GetFaceVertices(f);
        auto const children = a.coarse.GetFaceChildFaces(f);
        Index const same = other.faces[f];
        auto const sameCorners = b.coarse.GetFaceVertices(same);
        auto const sameChildren = b.coarse.GetFaceChildFaces(same);
        for (int j = 0; j < children.size(); ++j) {
            int k = j;  // the middle keeps its place
            if (j < corners.size())
                k = static_cast<int>(
                    std::find(sameCorners.begin(), sameCorners.end(), other.vertices[corners[j]]) -
                    sameCorners.begin());
            EXPECT_NEAR(b.two[sameChildren[k]], side * a.two[children[j]], 1e-13)
                << name << ", face " << f;
        }
    }
}

// A table that depends on the mesh alone: renumbering and mirroring only relabel it and turn signs.
TEST(FormStencils, DoNotDependOnNumbering) {
    for (auto& [name, scene] : test::MakeFormMeshes()) {
        for (bool isMirrored : {false, true}) {
            Renumbered const other = Renumber(scene, isMirrored);
            double const side = isMirrored ? -1.0 : 1.0;
            RefinedForms const a(scene, 1.0), b(other.scene, side);
            CheckSameOneForm(a, b, other, name);
            CheckSameTwoForm(a, b, other, side, name);
        }
    }
}

TEST(FormStencils, ComposedTablesAreTheStepsInARow) {
    for (auto const& scene :
         {test::MakeIrregularTriangles(6, 5, 1), test::MakeGridWithHole(5, 4)}) {
        auto const refiner = test::MakeRefiner(scene, 3);
        auto const all = far_ext::ComposeFormStencils(*refiner, 3);
        auto [one, two] = MakeForms(refiner->GetLevel(0), scene.positions, 1.0);
        std::vector<double> direct(static_cast<size_t>(all.s1.GetNumRows())),
            directTwo(static_cast<size_t>(all.s2.GetNumRows()));
        all.s1.Apply(one.data(), direct.data(), 1);
        all.s2.Apply(two.data(), directTwo.data(), 1);
        for (int level = 1; level <= 3; ++level) {
            auto const step = far_ext::BuildFormStencils(*refiner, level);
            std::vector<double> nextOne(static_cast<size_t>(step.s1.GetNumRows())),
                nextTwo(static_cast<size_t>(step.s2.GetNumRows()));
            step.s1.Apply(one.data(), nextOne.data(), 1);
            step.s2.Apply(two.data(), nextTwo.data(), 1);
            one = nextOne;
            two = nextTwo;
        }
        for (size_t i = 0; i < direct.size(); ++i) EXPECT_NEAR(direct[i], one[i], 1e-14);
        for (size_t i = 0; i < directTwo.size(); ++i) EXPECT_NEAR(directTwo[i], two[i], 1e-14);
    }
}

std::string Refusal(engine::Scene const& scene) {
    return test::RefusalOf([&] { far_ext::CheckForms(*test::MakeRefiner(scene, 0)); });
}

TEST(FormOperators, RefuseWhatHasNoForms) {
    std::vector<std::vector<Index>> band;  // a Moebius band of 5 quads
    std::vector<double> points;
    for (Index i = 0; i < 5; ++i) {
        points.insert(points.end(), {static_cast<double>(i), 0, 0, static_cast<double>(i), 1, 0});
        if (i < 4)
            band.push_back({2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
        else
            band.push_back({8, 1, 0, 9});
    }
    EXPECT_NE(Refusal(test::MakeScene(points, band)).find("non-orientable"), std::string::npos);

    engine::Scene reversed = test::MakeCube();
    std::reverse(reversed.cage.faceVertices.begin() + 8, reversed.cage.faceVertices.begin() + 12);
    EXPECT_NE(Refusal(reversed).find("inconsistent winding: face 2"), std::string::npos);

    engine::Scene const fin = test::MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1},
                                              {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, Sdc::SCHEME_LOOP);
    EXPECT_NE(Refusal(fin).find("has 3 faces"), std::string::npos);

    engine::Scene const bow = test::MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0},
                                              {{0, 1, 2}, {0, 3, 4}}, Sdc::SCHEME_LOOP);
    EXPECT_NE(Refusal(bow).find("vertex 0 form more than one fan"), std::string::npos);

    engine::Scene open = test::MakeLattice(2, 2, Sdc::SCHEME_CATMARK);
    open.cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_NONE);
    EXPECT_NE(Refusal(open).find("`boundary` none"), std::string::npos);

    engine::Scene bilinear = test::MakeCube();
    bilinear.cage.scheme = Sdc::SCHEME_BILINEAR;
    EXPECT_NE(Refusal(bilinear).find("`scheme` catmark or loop"), std::string::npos);
}

}  // namespace
}  // namespace limn
