// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/raster/texture_piece.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "eval/surface/patch_polynomial.h"

namespace limn::engine {

double TexturePiece::GetCentre() const {
    return isTriangle ? eval::kTriangleCentre : eval::kQuadCentre;
}

std::array<double, 3> TexturePiece::Evaluate(int coordinate, double x, double y) const {
    auto const v = isTriangle ? eval::EvaluateTrianglePolynomial(coefficients[coordinate], x, y)
                              : eval::EvaluateQuadPolynomial(coefficients[coordinate], x, y);
    return {v[0], v[1], v[2]};
}

void TexturePiece::FindBounds() {
    for (int k = 0; k < 2; ++k) bounds[k] = eval::BoundPolynomial(isTriangle, coefficients[k]);
}

bool TexturePiece::IsCollapsed() const {
    constexpr int kSteps = 4;
    for (int j = 0; j <= kSteps; ++j) {
        for (int i = 0; i <= (isTriangle ? kSteps - j : kSteps); ++i) {
            double const x = static_cast<double>(i) / kSteps - GetCentre(),
                         y = static_cast<double>(j) / kSteps - GetCentre();
            auto const u = Evaluate(0, x, y), v = Evaluate(1, x, y);
            double const det = u[1] * v[2] - u[2] * v[1];
            double const size = u[1] * u[1] + u[2] * u[2] + v[1] * v[1] + v[2] * v[2];
            if (std::abs(det) > 1e-9 * size) return false;
        }
    }
    return true;
}

namespace {

/// Newton from (x, y); true if it ends within 1e-7 texel of the target.
bool Polish(TexturePiece const& piece, double targetX, double targetY, double& x, double& y) {
    for (int step = 0; step < 10; ++step) {
        auto const u = piece.Evaluate(0, x, y), v = piece.Evaluate(1, x, y);
        double const ru = targetX - u[0], rv = targetY - v[0];
        if (ru * ru + rv * rv < 1e-14) return true;
        double const det = u[1] * v[2] - u[2] * v[1];
        if (det == 0.0) return false;
        x += (v[2] * ru - u[2] * rv) / det;
        y += (u[1] * rv - v[1] * ru) / det;
        if (!(std::abs(x) < 2.0 && std::abs(y) < 2.0)) return false;
    }
    return false;
}

struct Square {
    double x, y, half;
};

}  // namespace

SearchResult SearchPiece(TexturePiece const& piece, double targetX, double targetY,
                         double tolerance, double& s, double& t) {
    constexpr size_t kMaxSquares = 65536;
    double const centre = piece.GetCentre();
    std::vector<Square> open{{0.5 - centre, 0.5 - centre, 0.5}};
    for (size_t numSeen = 0; !open.empty(); ++numSeen) {
        if (numSeen == kMaxSquares) return SearchResult::Undecided;
        Square const square = open.back();
        open.pop_back();
        bool const isOutside =
            piece.isTriangle && square.x + square.y + 2 * centre - 2 * square.half > 1.0;
        auto const u = piece.Evaluate(0, square.x, square.y),
                   v = piece.Evaluate(1, square.x, square.y);
        double const reachX =
            (std::abs(u[1]) + std::abs(u[2])) * square.half + piece.GetStray(0, square.half);
        double const reachY =
            (std::abs(v[1]) + std::abs(v[2])) * square.half + piece.GetStray(1, square.half);
        if (isOutside || std::abs(targetX - u[0]) > reachX + tolerance ||
            std::abs(targetY - v[0]) > reachY + tolerance) {
            continue;
        }
        double x = square.x, y = square.y;
        bool const isSmall = reachX + reachY < 0.5 * tolerance;
        if (isSmall || Polish(piece, targetX, targetY, x, y)) {
            s = x + centre;
            t = y + centre;
            bool const isInside =
                s >= 0.0 && t >= 0.0 && (piece.isTriangle ? s + t <= 1.0 : s <= 1.0 && t <= 1.0);
            if (isInside) return SearchResult::Found;
            if (isSmall) continue;
        }
        double const h = square.half / 2;
        for (double const dy : {-h, h}) {
            for (double const dx : {-h, h}) open.push_back({square.x + dx, square.y + dy, h});
        }
    }
    return SearchResult::NotThere;
}

}  // namespace limn::engine
