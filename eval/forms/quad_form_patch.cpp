// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/quad_form_patch.h"

#include <algorithm>

#include "far_ext/forms/form_operators.h"

namespace limn::eval {

namespace {

void FindQuadratic(double x, double b[3]) {
    b[0] = 0.5 * (1.0 - x) * (1.0 - x);
    b[1] = 0.5 + x * (1.0 - x);
    b[2] = 0.5 * x * x;
}

void FindCubic(double x, double b[4]) {
    double const y = 1.0 - x;
    b[0] = y * y * y / 6.0;
    b[1] = (4.0 - 6.0 * x * x + 3.0 * x * x * x) / 6.0;
    b[2] = (4.0 - 6.0 * y * y + 3.0 * y * y * y) / 6.0;
    b[3] = x * x * x / 6.0;
}

}  // namespace

bool QuadFormPatch::Bind(Far::TopologyLevel const& level, Index face,
                         std::span<double const> form) {
    auto const corners = level.GetFaceVertices(face);
    for (Index vertex : corners) {
        if (corners.size() != 4 || level.GetVertexFaces(vertex).size() != 4 ||
            !far_ext::IsSmoothInterior(level, vertex))
            return false;
    }
    constexpr int kColumn[4] = {1, 2, 2, 1}, kRow[4] = {1, 1, 2, 2};  // of the corners
    constexpr int kAcross[4] = {1, 0, -1, 0},
                  kUp[4] = {0, 1, 0, -1};  // of a side that turns left at each corner
    for (int c = 0; c < 4; ++c) {
        auto const faces = level.GetVertexFaces(corners[c]);
        auto const places = level.GetVertexFaceLocalIndices(corners[c]);
        int first = 0;
        while (faces[first] != face) ++first;
        for (int j = 0; j < 4;
             ++j) {  // the quads round the corner, whose sides 0, 1 and 2 turn left twice
            int column = kColumn[c], row = kRow[c];
            for (int m = 0; m < 3; ++m) {
                int const turn = (c + j + m) % 4, dx = kAcross[turn], dy = kUp[turn];
                auto const side = far_ext::GetFaceSide(level, faces[(first + j) % 4],
                                                       (places[(first + j) % 4] + m) % 4);
                double const value = side.sign * form[side.edge];
                if (dx != 0)
                    _alongS[std::min(column, column + dx)][row] = dx * value;
                else
                    _alongT[column][std::min(row, row + dy)] = dy * value;
                column += dx;
                row += dy;
            }
        }
    }
    return true;
}

std::array<double, 2> QuadFormPatch::Evaluate(double s, double t) const {
    double qs[3], qt[3], cs[4], ct[4];
    FindQuadratic(s, qs);
    FindQuadratic(t, qt);
    FindCubic(s, cs);
    FindCubic(t, ct);
    std::array<double, 2> values{};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 4; ++j) {
            values[0] += qs[i] * ct[j] * _alongS[i][j];
            values[1] += cs[j] * qt[i] * _alongT[j][i];
        }
    }
    return values;
}

}  // namespace limn::eval
