// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "eval/surface/surface_place.h"

namespace limn::eval {

/// Gauss points of a face, 3 x 3 per piece, on pieces that get smaller by half towards irregular
/// corners, where the surface's own polynomial pieces do: what is integrated stays smooth on each,
/// and unbounded curvature counts as far as 2^-10 of the domain.
///
/// Weights add up to each domain's area (1, on a triangle 1/2).
class GradedPoints {
public:
    /// \param surface  kept by reference
    explicit GradedPoints(LimitSurface const& surface)
        : _surface(surface), _level(surface.GetRefiner().GetLevel(0)) {}

    /// Points of one piece, side by side.
    static constexpr int kPointsPerPiece = 9;
    struct Piece {
        std::array<double, kPointsPerPiece> s, t, weights;
    };

    /// Calls visit(SurfacePlace, weight) for all points of a face with a limit.
    template <class Visit>
    void ForEach(Index face, Visit const& visit) const {
        ForEachPiece(face, [&](int domain, Piece const& piece) {
            for (size_t i = 0; i < kPointsPerPiece; ++i)
                visit(SurfacePlace{face, domain, piece.s[i], piece.t[i]}, piece.weights[i]);
        });
    }

    /// Calls visit(domain, Piece) for all pieces of a face with a limit.
    template <class Visit>
    void ForEachPiece(Index face, Visit const& visit) const {
        int const numDomains = _surface.GetNumDomains(face);
        auto const vertices = _level.GetFaceVertices(face);
        for (int domain = 0; domain < numDomains; ++domain) {
            unsigned irregular = 0;  // a bit per corner of the domain
            if (numDomains > 1) {
                irregular = (IsIrregular(vertices[domain]) ? 1u : 0u) |
                            4u;  // the middle of the face lies opposite
            } else {
                for (int corner = 0; corner < vertices.size(); ++corner) {
                    if (IsIrregular(vertices[corner])) irregular |= 1u << corner;
                }
            }
            auto const visitAt = [&](Piece const& piece) { visit(domain, piece); };
            if (_surface.IsLoop())
                VisitTriangle({0, 0}, {1, 0}, {0, 1}, irregular, 0, visitAt);
            else
                VisitSquare(0.0, 0.0, 1.0, irregular, 0, visitAt);
        }
    }

private:
    static constexpr int kMinDepth =
        1;  // 4 pieces also where all is regular: Spot's integral of K errs by 1e-3, not 8e-3
    static constexpr int kMaxDepth = 10;
    using Corner = std::array<double, 2>;

    bool IsIrregular(Index vertex) const {
        return !_level.IsVertexBoundary(vertex) &&
               _level.GetVertexEdges(vertex).size() != (_surface.IsLoop() ? 6 : 4);
    }

    template <class Visit>
    void VisitSquare(double s, double t, double size, unsigned irregular, int depth,
                     Visit const& visit) const {
        if (depth < kMinDepth || (irregular && depth < kMaxDepth)) {
            double const half = 0.5 * size;
            VisitSquare(s, t, half, irregular & 1u, depth + 1, visit);
            VisitSquare(s + half, t, half, irregular & 2u, depth + 1, visit);
            VisitSquare(s + half, t + half, half, irregular & 4u, depth + 1, visit);
            VisitSquare(s, t + half, half, irregular & 8u, depth + 1, visit);
            return;
        }
        Piece piece;
        size_t k = 0;
        for (int j = 0; j < 3; ++j) {
            for (int i = 0; i < 3; ++i, ++k) {
                piece.s[k] = s + size * kGaussNodes[i];
                piece.t[k] = t + size * kGaussNodes[j];
                piece.weights[k] = size * size * kGaussWeights[i] * kGaussWeights[j];
            }
        }
        visit(piece);
    }

    template <class Visit>
    void VisitTriangle(Corner a, Corner b, Corner c, unsigned irregular, int depth,
                       Visit const& visit) const {
        if (depth < kMinDepth || (irregular && depth < kMaxDepth)) {
            auto const middle = [](Corner const& p, Corner const& q) {
                return Corner{0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])};
            };
            Corner const ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            VisitTriangle(a, ab, ca, irregular & 1u, depth + 1, visit);
            VisitTriangle(ab, b, bc, irregular & 2u, depth + 1, visit);
            VisitTriangle(ca, bc, c, irregular & 4u, depth + 1, visit);
            VisitTriangle(ab, bc, ca, 0u, depth + 1, visit);
            return;
        }
        double const area = std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        Piece piece;
        size_t k = 0;
        for (int j = 0; j < 3; ++j) {
            double const width =
                1.0 - kGaussNodes[j];  // a triangle is the square with one side collapsed
            for (int i = 0; i < 3; ++i, ++k) {
                double const u = kGaussNodes[i] * width, v = kGaussNodes[j];
                piece.s[k] = a[0] + u * (b[0] - a[0]) + v * (c[0] - a[0]);
                piece.t[k] = a[1] + u * (b[1] - a[1]) + v * (c[1] - a[1]);
                piece.weights[k] = area * kGaussWeights[i] * kGaussWeights[j] * width;
            }
        }
        visit(piece);
    }

    LimitSurface const& _surface;
    Far::TopologyLevel _level;
};

}  // namespace limn::eval
