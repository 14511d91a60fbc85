// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/curvature_edit.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "engine/differential/monotone_curve.h"
#include "engine/scene/extent.h"
#include "eval/differential/dirmag.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/boundary.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;
using Vector = Eigen::Vector3d;
using far_ext::MutablePoints;

/// Of the diagonal: coordinates this short are rounding, and point anywhere.
constexpr double kFlatShare = 1e-12;

/// Coordinates as they are, and as H and u beside them, so that those which no list names keep
/// their bits.
class CoordinateEditor {
public:
    CoordinateEditor(EditedLevel const& on, std::vector<double>& deltas)
        : _on(on),
          _surfaceNormals(eval::FindAngleNormals(on.level, on.positions)),
          _deltas(deltas),
          _split(eval::SplitDirMag(on.level, on.positions, deltas,
                                   kFlatShare * FindExtent(on.positions).GetDiagonal())) {
        // u is to be outside of the surface as it is seen.
        for (double& magnitude : _split.magnitudes) magnitude *= GetSign(on.orientation);
        for (double& x : _split.directions) x *= GetSign(on.orientation);
    }

    void Apply(CurvatureEdit const& edit) {
        for (auto const& [vertex, mean] : edit.means) {
            _split.magnitudes[vertex] = mean * _on.lengthsPerMean[vertex];
            Join(vertex);
            Ask(_means, vertex, mean);
        }
        for (auto const& [vertex, factor] : edit.factors) {
            double const before = FindMean(vertex);
            _split.magnitudes[vertex] *= factor;
            GetDelta(vertex) *= factor;
            Ask(_means, vertex, before * factor);
        }
        for (auto const& [vertex, normal] : edit.normals) {
            GetDirection(vertex) = Vector(normal.data()).stableNormalized();
            Join(vertex);
            AskDirection(vertex);
        }
        for (auto const& [vertex, axis, degrees] : edit.rotations) {
            Eigen::AngleAxisd const rotation(degrees * std::acos(-1.0) / 180.0,
                                             Vector(axis.data()).normalized());
            GetDirection(vertex) = rotation * Vector(GetDirection(vertex));
            GetDelta(vertex) = rotation * Vector(GetDelta(vertex));
            AskDirection(vertex);
        }
        if (edit.isPolarised) Filter(PolariseCurvature);
        if (!edit.filterPoints.empty()) Filter(MonotoneCurve(edit.filterPoints));
    }

    std::vector<EditTarget> ListTargets() const {
        std::vector<EditTarget> targets = _means;
        targets.insert(targets.end(), _normals.begin(), _normals.end());
        return targets;
    }

private:
    Eigen::Map<Vector> GetDelta(Index vertex) { return MutablePoints(_deltas)[vertex]; }
    Eigen::Map<Vector> GetDirection(Index vertex) {
        return MutablePoints(_split.directions)[vertex];
    }

    void Join(Index vertex) { GetDelta(vertex) = _split.magnitudes[vertex] * GetDirection(vertex); }

    /// The mean curvature of a vertex so far: what was asked for, or what its coordinate has along
    /// the normal. The rest of a coordinate comes from uneven edges.
    double FindMean(Index vertex) {
        auto const known = std::ranges::find(_means, vertex, &EditTarget::vertex);
        if (known != _means.end()) return std::get<double>(known->asked);
        double const length = _on.lengthsPerMean[vertex],
                     along = GetDelta(vertex).dot(far_ext::Points(_surfaceNormals)[vertex]);
        return length > 0.0 ? GetSign(_on.orientation) * along / length : 0.0;
    }

    template <class Asked>
    static void Ask(std::vector<EditTarget>& targets, Index vertex, Asked const& asked) {
        auto const known = std::ranges::find(targets, vertex, &EditTarget::vertex);
        if (known != targets.end())
            known->asked = asked;
        else
            targets.push_back({vertex, asked});
    }

    void AskDirection(Index vertex) {
        auto const u = GetDirection(vertex);
        Ask(_normals, vertex, std::array<double, 3>{u[0], u[1], u[2]});
    }

    /// All H through a function on [0, 1], which their range is brought to and back from.
    void Filter(std::function<double(double)> const& filter) {
        auto const [low, high] =
            std::minmax_element(_split.magnitudes.begin(), _split.magnitudes.end());
        double const least = *low, range = *high - *low;
        if (!(range > 0.0)) return;  // nothing to tell apart
        for (double& magnitude : _split.magnitudes)
            magnitude = least + range * filter((magnitude - least) / range);
        _deltas = eval::JoinDirMag(_split);
    }

    EditedLevel const& _on;
    std::vector<double> const _surfaceNormals;
    std::vector<double>& _deltas;
    eval::DirMag _split;
    std::vector<EditTarget> _means, _normals;
};

/// Such coordinates would overflow in what is to come.
void RefuseEndless(std::vector<double> const& deltas, double diagonal, std::string const& path) {
    constexpr double kMost = 1e30;
    far_ext::Points const points(deltas);
    for (size_t vertex = 0; vertex < points.GetCount(); ++vertex) {
        if (points[vertex].stableNorm() <= kMost * diagonal) continue;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: the edit makes the differential coordinate of vertex {} more "
                                "than {:.0e} times as long as the mesh",
                                path, vertex, kMost));
    }
}

}  // namespace

std::vector<Index> CurvatureEdit::ListVertices() const {
    std::vector<Index> vertices;
    auto const add = [&](auto const& list) {
        for (auto const& entry : list) vertices.push_back(entry.vertex);
    };
    add(means);
    add(factors);
    add(normals);
    add(rotations);
    return vertices;
}

double PolariseCurvature(double x) {
    double const push = std::pow(std::abs(x - 0.5) / 8.0, 0.25);
    return x > 0.5 ? 0.5 + push : 0.5 - push;
}

std::vector<double> FindCombinatorialLengths(Level const& level,
                                             std::span<double const> positions) {
    far_ext::Points const points(positions);
    std::vector<double> lengths;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        auto const edges = level.GetVertexEdges(vertex);
        double sum = 0.0;
        for (Index edge : edges) {
            Index const other = far_ext::GetOtherEnd(level, edge, vertex);
            sum += (points[other] - points[vertex]).squaredNorm();
        }
        lengths.push_back(0.5 * sum / std::max(1, edges.size()));
    }
    return lengths;
}

std::vector<EditTarget> ApplyEdit(CurvatureEdit const& edit, EditedLevel const& on,
                                  std::string const& path, std::vector<double>& deltas) {
    if (edit.IsEmpty()) return {};
    CoordinateEditor editor(on, deltas);
    editor.Apply(edit);
    RefuseEndless(deltas, FindExtent(on.positions).GetDiagonal(), path);
    return editor.ListTargets();
}

}  // namespace limn::engine
