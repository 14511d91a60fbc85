#include "eval/quad_form_patch.h"

#include <algorithm>

#include "far_ext/form_operators.h"

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

bool QuadFormPatch::Bind(Far::TopologyLevel const& level, Index face, std::span<double const> form) {
    Index grid[4][4];
    if (!GatherVertices(level, face, grid)) return false;
    auto const get = [&](Index from, Index to, double& value) {
        Index const edge = level.FindEdge(from, to);
        if (edge == Far::INDEX_INVALID) return false;
        value = far_ext::GetSignFrom(level, edge, from) * form[edge];
        return true;
    };
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 4; ++j) {
            if (!get(grid[i][j], grid[i + 1][j], _alongS[i][j]) || !get(grid[j][i], grid[j][i + 1], _alongT[j][i])) return false;
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
