// SPDX-License-Identifier: Apache-2.0
#include "far_ext/limit/limit_row.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "far_ext/error.h"
#include "far_ext/limit/corner_limit.h"

namespace limn::far_ext {

LimitRowBuilder::LimitRowBuilder(Far::TopologyRefiner const& refiner, int level,
                                 LimitOptions const& options)
    : _refiner(refiner), _level(refiner.GetLevel(level)), _options(options) {
    if (!(options.alpha >= 0.0 && options.alpha <= 1.0)) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("alpha {} is not from 0 to 1", options.alpha));
    }
    if (options.alpha != 0.0 && refiner.GetSchemeType() != Sdc::SCHEME_CATMARK) {
        throw Error(ErrorCode::BadOption,
                    "alpha is a parameter of the catmark scheme; the others have none");
    }
}

bool LimitRowBuilder::HasLimit(Index vertex) const {
    auto const faces = _level.GetVertexFaces(vertex);
    return std::any_of(faces.begin(), faces.end(),
                       [&](Index face) { return !_level.IsFaceHole(face); });
}

/// The kinds of [Limit 3]. Boundaries are infinitely sharp edges here: OpenSubdiv tags them so.
LimitRow::Kind LimitRowBuilder::Classify(Index vertex) const {
    using Kind = LimitRow::Kind;
    if (_refiner.GetSchemeType() == Sdc::SCHEME_BILINEAR || !HasLimit(vertex)) return Kind::Fixed;
    bool const isManifold = !_level.IsVertexNonManifold(vertex);
    if (_level.GetVertexRule(vertex) == Sdc::Crease::RULE_SMOOTH && isManifold &&
        !_level.IsVertexBoundary(vertex)) {
        // Triangles of that option have other edge points; the closed form counts on the usual
        // ones.
        bool const hasOwnTriangleRule =
            _refiner.GetSchemeType() == Sdc::SCHEME_CATMARK &&
            _refiner.GetSchemeOptions().GetTriangleSubdivision() == Sdc::Options::TRI_SUB_SMOOTH;
        auto const faces = _level.GetVertexFaces(vertex);
        bool const isClosedForm =
            !hasOwnTriangleRule || std::none_of(faces.begin(), faces.end(), [&](Index face) {
                return _level.GetFaceVertices(face).size() == 3;
            });
        return isClosedForm ? Kind::Smooth : Kind::Other;
    }
    if (_level.IsVertexInfSharp(vertex)) return Kind::Fixed;
    if (!isManifold) return Kind::Other;
    auto const edges = _level.GetVertexEdges(vertex);
    auto const numSharp = std::count_if(edges.begin(), edges.end(),
                                        [&](Index e) { return _level.IsEdgeInfSharp(e); });
    if (numSharp > 2) return Kind::Fixed;  // a corner by rule
    // While a sharpness fades the vertex obeys neither rule; its limit is found by refining.
    bool const isSemiSharp =
        _level.IsVertexSemiSharp(vertex) ||
        std::any_of(edges.begin(), edges.end(), [&](Index e) { return _level.IsEdgeSemiSharp(e); });
    return numSharp == 2 && !isSemiSharp ? Kind::Curve : Kind::Other;
}

void LimitRowBuilder::Build(Index vertex, LimitRow& row) {
    row.indices.clear();
    row.weights.clear();
    row.kind = Classify(vertex);
    row.numEdges = 0;
    row.scale = row.centre = 1.0;
    row.edge = row.other = 0.0;
    row.isEvenCubic = false;
    switch (row.kind) {
        case LimitRow::Kind::Fixed:
            return;
        case LimitRow::Kind::Curve:
            return BuildCurve(vertex, row);
        case LimitRow::Kind::Smooth:
            return _refiner.GetSchemeType() == Sdc::SCHEME_LOOP ? BuildLoop(vertex, row)
                                                                : BuildCatmark(vertex, row);
        case LimitRow::Kind::Other:
            return BuildOther(vertex, row);
    }
}

/// D A: centre n^2 - n + p n + g sum 1/d, edge q + g (1/d + 1/d'), other vertices of a face g/d:
/// the limit mask (n^2, 4, 1) after one refinement, collected by what a face point hands to its
/// corners [Limit 2]; p, q, g and D with alpha [Limit 4].
void LimitRowBuilder::BuildCatmark(Index vertex, LimitRow& row) const {
    bool const isStationary = _options.alphaRule == LimitOptions::AlphaRule::Stationary;
    double const a = _options.alpha;
    double const p = isStationary ? 0.4 * a : a, q = isStationary ? 2.0 - 1.6 * a : 2.0 - a;
    double const g = isStationary ? 4.0 - 1.6 * a : 4.0;

    auto const faces = _level.GetVertexFaces(vertex);
    auto const corners = _level.GetVertexFaceLocalIndices(vertex);
    double const n = faces.size();
    row.scale = n * (isStationary ? n + 5.0 - 2.8 * a : n + 5.0);
    row.numEdges = faces.size();
    int const firstSize = _level.GetFaceVertices(faces[0]).size();
    bool isUniform = true, areEven = true;
    for (int i = 0; i < faces.size(); ++i) {  // each edge is the first one of one face
        auto const vertices = _level.GetFaceVertices(faces[i]);
        int const next = corners[i] + 1;
        row.indices.push_back(vertices[next < vertices.size() ? next : 0]);
        isUniform &= vertices.size() == firstSize;
        areEven &= vertices.size() % 2 == 0;
    }
    // Where all of a component is such, A loses its alternating vector [Limit 5].
    row.isEvenCubic = row.numEdges == 3 && areEven && a == 0.0;

    double faceSum = 0.0;  // sum of g/d
    if (!isUniform) row.weights.assign(row.numEdges, q);
    for (int i = 0; i < faces.size(); ++i) {
        auto const vertices = _level.GetFaceVertices(faces[i]);
        int const size = vertices.size();
        faceSum += g / size;
        for (int k = 1; k < size; ++k) {
            Index const at = vertices[(corners[i] + k) % size];
            bool const isEdge = k == 1 || k == size - 1;
            // An edge neighbour is met by both faces beside its edge, with different shares where
            // these differ in size; uniform rows know the sum beforehand.
            if (isUniform && isEdge) continue;
            if (isEdge) {
                auto const edge =
                    std::find(row.indices.begin(), row.indices.begin() + row.numEdges, at);
                row.weights[edge - row.indices.begin()] += g / size;
                continue;
            }
            row.indices.push_back(at);
            if (!isUniform) row.weights.push_back(g / size);
        }
    }
    row.centre = (n * n - n + p * n + faceSum) / row.scale;
    row.edge = (q + 2.0 * g / firstSize) / row.scale;
    row.other = g / firstSize / row.scale;
    for (double& weight : row.weights) weight /= row.scale;
}

/// chi = 1 / (n + 3/(8 beta)), beta = (5/8 - (3/8 + cos(2 pi/n)/4)^2) / n: the left eigenvector of
/// Loop's step [Limit 2].
void LimitRowBuilder::BuildLoop(Index vertex, LimitRow& row) {
    auto const faces = _level.GetVertexFaces(vertex);
    auto const corners = _level.GetVertexFaceLocalIndices(vertex);
    size_t const n = faces.size();
    if (_loopChi.size() <= n) _loopChi.resize(n + 1, 0.0);
    double& chi = _loopChi[n];
    if (chi == 0.0) {
        double const inner =
            0.375 + 0.25 * std::cos(2.0 * std::numbers::pi / static_cast<double>(n));
        double const beta = (0.625 - inner * inner) / static_cast<double>(n);
        // Which cosine glibc runs depends on the CPU: rounded, the weights are the same everywhere.
        chi = std::nearbyint(0x1p44 / (static_cast<double>(n) + 0.375 / beta)) / 0x1p44;
    }
    for (int i = 0; i < faces.size(); ++i)
        row.indices.push_back(_level.GetFaceVertices(faces[i])[(corners[i] + 1) % 3]);
    row.numEdges = faces.size();
    row.scale = 1.0 / chi;
    row.edge = chi;
    row.centre = 1.0 - static_cast<double>(n) * chi;
}

/// The limit of a cubic B-spline curve, (1, 4, 1)/6, whatever faces lie beside it [Limit 3].
void LimitRowBuilder::BuildCurve(Index vertex, LimitRow& row) const {
    for (Index edge : _level.GetVertexEdges(vertex)) {
        if (!_level.IsEdgeInfSharp(edge)) continue;
        auto const ends = _level.GetEdgeVertices(edge);
        row.indices.push_back(ends[0] == vertex ? ends[1] : ends[0]);
    }
    row.numEdges = 2;
    row.centre = 4.0 / 6.0;
    row.edge = 1.0 / 6.0;
}

/// By the ring of any face at the vertex that is no hole: they all have the same limit there. Rings
/// repeat (a semi-sharp crease has one after another), so each is refined once [Limit 3].
void LimitRowBuilder::BuildOther(Index vertex, LimitRow& row) {
    if (!_gatherer)
        _gatherer = std::make_unique<FaceRingGatherer>(_level, _refiner.GetSchemeOptions(), -1);
    auto const faces = _level.GetVertexFaces(vertex);
    auto const found = std::find_if(faces.begin(), faces.end(),
                                    [&](Index face) { return !_level.IsFaceHole(face); });
    CornerKey key{
        {}, _level.GetVertexFaceLocalIndices(vertex)[static_cast<int>(found - faces.begin())]};
    std::vector<Index> points;
    _gatherer->Gather(*found, key.ring, points);
    auto const [known, isNew] = _corners.try_emplace(std::move(key));
    if (isNew) {
        known->second = BuildCornerLimit(known->first.ring, known->first.corner,
                                         _refiner.GetSchemeType(), _refiner.GetSchemeOptions());
    }
    row.centre = 0.0;
    for (auto const& [point, weight] : known->second.GetEntries()) {
        if (points[point] == vertex) {
            row.centre = weight;
            continue;
        }
        row.indices.push_back(points[point]);
        row.weights.push_back(weight);
    }
}

}  // namespace limn::far_ext
