// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/adaptive_marks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "eval/cascade/sagitta.h"
#include "far_ext/cascade/edge_numbers.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

namespace {

/// Per triangle: how far the filter moves it at most, a few of its largest widths.
std::vector<double> FindReach(far_ext::CascadeMesh const& mesh, std::span<double const> positions,
                              std::span<double const> sigmas, ScaledWidths const& widths) {
    constexpr double kWidthsMoved = 4.0;  // an edge of 90 degrees is moved by 0.7 of its width
    far_ext::Points const points(positions);
    double const resolved = widths.GetResolvedLength(), largest = widths.GetLargest();
    std::vector<double> reach(mesh.faces.size() / 3, 0.0);
    for (size_t corner = 0; corner < mesh.faces.size(); ++corner) {
        Index const vertex = mesh.faces[corner],
                    next = mesh.faces[corner % 3 == 2 ? corner - 2 : corner + 1];
        bool const isKnown = (points[next] - points[vertex]).norm() <= resolved;
        double& own = reach[corner / 3];
        own = std::max(own, kWidthsMoved * (isKnown ? sigmas[vertex] : largest));
    }
    return reach;
}

}  // namespace

bool AdaptiveMarks::IsAny() const {
    return std::find(isMarked.begin(), isMarked.end(), 1) != isMarked.end();
}

AdaptiveMarks MarkBentTriangles(far_ext::CascadeMesh const& mesh, std::span<double const> positions,
                                std::span<double const> sigmas, ScaledWidths const& widths,
                                double bound) {
    auto const reach = FindReach(mesh, positions, sigmas, widths);
    AdaptiveMarks marks;
    for (double sagitta : eval::FindSagittas({mesh.faces, positions, reach, mesh.creases})) {
        marks.isMarked.push_back(sagitta > bound);
        marks.largest = std::max(marks.largest, sagitta);
    }
    return marks;
}

double CountAfterQuarterings(far_ext::CascadeMesh const& mesh, int levels) {
    far_ext::EdgeNumbers numbers(mesh.numVertices);
    for (size_t corner = 0; corner < mesh.faces.size(); ++corner)
        numbers.Get(mesh.faces[corner], mesh.faces[corner % 3 == 2 ? corner - 2 : corner + 1]);
    double vertices = mesh.numVertices, edges = numbers.GetCount(), faces = mesh.GetNumFaces();
    for (int level = 0; level < levels; ++level) {
        vertices += edges;
        edges = 2.0 * edges + 3.0 * faces;
        faces *= 4.0;
    }
    return vertices;
}

double FindShortestEdge(far_ext::CascadeMesh const& mesh, std::span<double const> positions) {
    far_ext::Points const points(positions);
    double least = std::numeric_limits<double>::infinity();
    for (size_t corner = 0; corner < mesh.faces.size(); ++corner) {
        Index const next = mesh.faces[corner % 3 == 2 ? corner - 2 : corner + 1];
        least = std::min(least, (points[next] - points[mesh.faces[corner]]).squaredNorm());
    }
    return mesh.faces.empty() ? 0.0 : std::sqrt(least);
}

}  // namespace limn::engine
