// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/place_match.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "eval/forms/form_wishes.h"
#include "eval/forms/quad_form_patch.h"
#include "eval/forms/triangle_form_patch.h"
#include "eval/surface/refined_faces.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/forms/form_stencils.h"
#include "far_ext/topology/refiner.h"

namespace limn::eval {

namespace {

/// What a field is at one place along two directions at right angles, and what it is to be.
struct PlaceWish {
    std::array<far_ext::WeightRow, 2> rows;  // over the cage's edges; empty where nothing is wished
    std::array<double, 2> right{};
};

/// The edges of all faces round a face's corners.
std::vector<Index> ListEdgesRound(Far::TopologyLevel const& level, Index face) {
    std::vector<Index> edges;
    for (Index vertex : level.GetFaceVertices(face)) {
        for (Index neighbour : level.GetVertexFaces(vertex)) {
            auto const sides = level.GetFaceEdges(neighbour);
            edges.insert(edges.end(), sides.begin(), sides.end());
        }
    }
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

/// Turns wanted vectors into wishes.
class PlaceWishMaker {
public:
    PlaceWishMaker(Far::TopologyRefiner const& refined, LimitSurface const& surface,
                   std::span<double const> positions)
        : _surface(surface),
          _positions(positions),
          _level(refined.GetLevel(refined.GetMaxLevel())),
          _faces(surface, refined.GetMaxLevel()),
          _s1(far_ext::ComposeFormStencils(refined, refined.GetMaxLevel()).s1) {}

    std::vector<PlaceWish> Make(std::span<WantedAtPlace const> wanted,
                                std::function<void()> const& onStep) const;

private:
    /// A thread's own.
    struct Worker {
        FaceTree tree;
        std::vector<double> form;  // of the refined level; 0 but while a patch is learnt
    };

    PlaceWish MakeWish(WantedAtPlace const& wanted, Worker& worker) const;
    Eigen::Matrix<double, 3, 2> FindTangents(SurfacePlace const& base, Index refinedFace,
                                             FaceTree& tree) const;
    template <class Patch>
    bool LearnRows(SurfacePlace const& at, Eigen::Matrix2d const& toFrame, Worker& worker,
                   PlaceWish& wish) const;

    LimitSurface const& _surface;
    std::span<double const> _positions;
    Far::TopologyLevel const& _level;
    RefinedFaces _faces;
    far_ext::SparseRows _s1;
};

/// The limit's tangents along s and t of a refined face.
Eigen::Matrix<double, 3, 2> PlaceWishMaker::FindTangents(SurfacePlace const& base,
                                                         Index refinedFace, FaceTree& tree) const {
    if (tree.GetFace() != base.face) tree.Bind(base.face);
    auto const derivatives = EvaluateDerivatives(tree, base.domain, base.s, base.t);
    // From one domain to the other the way is affine.
    auto const origin = _faces.FindBase({refinedFace, 0, 0.0, 0.0}),
               endS = _faces.FindBase({refinedFace, 0, 1.0, 0.0}),
               endT = _faces.FindBase({refinedFace, 0, 0.0, 1.0});
    Eigen::Matrix<double, 3, 2> tangents;
    tangents.col(0) = (endS.s - origin.s) * derivatives.ds + (endS.t - origin.t) * derivatives.dt;
    tangents.col(1) = (endT.s - origin.s) * derivatives.ds + (endT.t - origin.t) * derivatives.dt;
    return tangents;
}

/// Rows for both directions of the frame, by unit forms. False where the face is not regular.
template <class Patch>
bool PlaceWishMaker::LearnRows(SurfacePlace const& at, Eigen::Matrix2d const& toFrame,
                               Worker& worker, PlaceWish& wish) const {
    Patch patch;
    for (Index edge : ListEdgesRound(_level, at.face)) {
        worker.form[edge] = 1.0;
        bool const isRegular = patch.Bind(_level, at.face, worker.form);
        worker.form[edge] = 0.0;
        if (!isRegular) return false;
        auto const [alongS, alongT] = patch.Evaluate(at.s, at.t);
        Eigen::Vector2d const weights = toFrame * Eigen::Vector2d(alongS, alongT);
        for (int k = _s1.offsets[edge]; k < _s1.offsets[edge + 1]; ++k) {
            for (size_t row = 0; row < 2; ++row)
                wish.rows[row].Add(_s1.indices[k],
                                   weights[static_cast<Eigen::Index>(row)] * _s1.weights[k]);
        }
    }
    return true;
}

PlaceWish PlaceWishMaker::MakeWish(WantedAtPlace const& wanted, Worker& worker) const {
    constexpr double kNone = 1e-12;  // of the tangents, where they span no plane
    auto const at = _faces.Find(wanted.at);
    Eigen::Matrix<double, 3, 2> const tangents = FindTangents(wanted.at, at.face, worker.tree);
    double const lengthS = tangents.col(0).norm();
    Eigen::Vector3d const first = tangents.col(0) / lengthS;
    double const along = first.dot(tangents.col(1));
    Eigen::Vector3d const rest = tangents.col(1) - along * first;
    double const across = rest.norm(), weight = std::sqrt(wanted.area);
    if (!(lengthS > 0.0) || !(across > kNone * tangents.col(1).norm())) return {};

    // w(T_s) = |T_s| w(first), w(T_t) = along w(first) + across w(second)
    Eigen::Matrix2d toFrame;
    toFrame << 1.0 / lengthS, 0.0, -along / (lengthS * across), 1.0 / across;
    toFrame *= weight;
    PlaceWish wish;
    wish.right = {weight * first.dot(wanted.vector), weight * rest.dot(wanted.vector) / across};
    bool const isRegular = _surface.IsLoop()
                               ? LearnRows<TriangleFormPatch>(at, toFrame, worker, wish)
                               : LearnRows<QuadFormPatch>(at, toFrame, worker, wish);
    return isRegular ? wish : PlaceWish{};
}

std::vector<PlaceWish> PlaceWishMaker::Make(std::span<WantedAtPlace const> wanted,
                                            std::function<void()> const& onStep) const {
    tbb::enumerable_thread_specific<Worker> workers([&] {
        return Worker{FaceTree(_surface, _positions, 3),
                      std::vector<double>(static_cast<size_t>(_level.GetNumEdges()), 0.0)};
    });
    std::vector<PlaceWish> wishes(wanted.size());
    constexpr size_t kBlock = 4096;
    for (size_t first = 0; first < wanted.size(); first += kBlock) {
        if (onStep) onStep();
        tbb::parallel_for(first, std::min(first + kBlock, wanted.size()),
                          [&](size_t i) { wishes[i] = MakeWish(wanted[i], workers.local()); });
    }
    return wishes;
}

FormWishes Assemble(std::vector<PlaceWish> const& wishes, Index numEdges) {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right(2 * static_cast<Eigen::Index>(wishes.size()));
    int row = 0;
    for (PlaceWish const& wish : wishes) {
        for (size_t i = 0; i < 2; ++i, ++row) {
            for (auto const& [edge, weight] : wish.rows[i].GetEntries())
                entries.emplace_back(row, edge, weight);
            right[row] = wish.right[i];
        }
    }
    FormWishes assembled{{right.size(), numEdges}, right};
    assembled.rows.setFromTriplets(entries.begin(), entries.end());
    return assembled;
}

}  // namespace

std::vector<double> MatchPlaces(far_ext::ControlMesh const& cage, LimitSurface const& surface,
                                std::span<double const> positions,
                                std::span<WantedAtPlace const> wanted, int levels,
                                std::function<void()> const& onStep) {
    auto const refiner = far_ext::CreateRefiner(cage);
    far_ext::CheckForms(*refiner);
    Far::TopologyRefiner::UniformOptions options(levels);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);
    auto const base = refiner->GetLevel(0);
    far_ext::HodgeStars const stars = far_ext::FindHodgeStars(base, positions);
    auto const wishes = PlaceWishMaker(*refiner, surface, positions).Make(wanted, onStep);
    WishMatcher matcher(base, stars, Assemble(wishes, base.GetNumEdges()), onStep);
    Eigen::VectorXd const form = matcher.FindSmooth();
    return {form.data(), form.data() + form.size()};
}

}  // namespace limn::eval
