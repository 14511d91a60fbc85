// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/least_connection.h"

#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/Dense>

#include "eval/forms/angles.h"
#include "eval/forms/field_designer.h"
#include "eval/forms/tree_cotree.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

using Complex = std::complex<double>;
constexpr double kTurn = 2.0 * std::numbers::pi;

/// A coordinate system in the plane of each face.
class FaceFrames {
public:
    FaceFrames(Far::TopologyLevel const& level, far_ext::Points points)
        : _level(level), _points(points) {
        for (Index face = 0; face < level.GetNumFaces(); ++face) {
            auto const corners = level.GetFaceVertices(face);
            Eigen::Vector3d area = Eigen::Vector3d::Zero();
            for (int j = 1; j + 1 < corners.size(); ++j)
                area += (points[corners[j]] - points[corners[0]])
                            .cross(points[corners[j + 1]] - points[corners[0]]);
            Eigen::Vector3d const normal = area.normalized();
            Eigen::Vector3d along = points[corners[1]] - points[corners[0]];
            along = (along - normal * normal.dot(along)).normalized();
            _first.push_back(along);
            _second.push_back(normal.cross(along));
        }
    }

    /// A vector, laid into the face's plane.
    Complex Find(Index face, Eigen::Vector3d const& v) const {
        return {_first[face].dot(v), _second[face].dot(v)};
    }
    Eigen::Vector3d MakeVector(Index face, Complex const& z) const {
        return z.real() * _first[face] + z.imag() * _second[face];
    }

    /// From the lower to the higher end.
    Eigen::Vector3d GetEdge(Index edge) const {
        auto const ends = _level.GetEdgeVertices(edge);
        return _points[std::max(ends[0], ends[1])] - _points[std::min(ends[0], ends[1])];
    }

    /// The angle of a face at its corner j, from 0 to 2 pi.
    double FindCornerAngle(Index face, int j) const {
        auto const corners = _level.GetFaceVertices(face);
        int const size = corners.size();
        Eigen::Vector3d const at = _points[corners[j]];
        Complex const next = Find(face, _points[corners[(j + 1) % size]] - at),
                      last = Find(face, _points[corners[(j + size - 1) % size]] - at),
                      turn = last * std::conj(next);
        double const angle = FindAngle(turn.real(), turn.imag());
        return angle < 0.0 ? angle + kTurn : angle;
    }

private:
    Far::TopologyLevel const& _level;
    far_ext::Points _points;
    std::vector<Eigen::Vector3d> _first, _second;
};

/// The two faces of an edge inside: the one that runs along it, and the other.
struct Sides {
    Index left, right;
};
bool FindSides(Far::TopologyLevel const& level, Index edge, Sides& sides) {
    auto const faces = level.GetEdgeFaces(edge);
    if (faces.size() != 2) return false;
    int const place = level.GetEdgeFaceLocalIndices(edge)[0];
    bool const isAlong = far_ext::GetFaceSide(level, faces[0], place).sign > 0.0;
    sides = isAlong ? Sides{faces[0], faces[1]} : Sides{faces[1], faces[0]};
    return true;
}

/// How much vectors are turned beyond what keeps their angle to the edge, from its left face to
/// its right one.
class Connection {
public:
    Connection(Far::TopologyLevel const& level, std::span<double const> positions,
               FaceFrames const& frames)
        : _level(level), _frames(frames), _designer(level, positions, AtBoundary::Normal) {}

    std::vector<double> Find(std::span<WantedIndex const> wanted) {
        auto const& stars = _designer.GetStars().edge;
        _turns = _designer.MakeGradient(FindSources(wanted));
        for (size_t edge = 0; edge < _turns.size(); ++edge) _turns[edge] *= stars[edge];
        MakeLoopsWhole();
        return _turns;
    }

    std::vector<char> const& GetActive() const { return _isActive; }
    std::vector<int> const& GetComponentOfFace() const { return _designer.GetComponents().ofFace; }

private:
    /// What the turns round each vertex are to add up to.
    std::vector<double> FindSources(std::span<WantedIndex const> wanted) {
        auto const& ofVertex = _designer.GetComponentOfVertex();
        _isActive.assign(_designer.GetComponents().count, 0);
        for (WantedIndex const& at : wanted) _isActive[ofVertex[at.vertex]] = 1;
        std::vector<double> sources(_level.GetNumVertices(), 0.0);
        for (Index vertex = 0; vertex < _level.GetNumVertices(); ++vertex) {
            if (ofVertex[vertex] >= 0 && _isActive[ofVertex[vertex]]) sources[vertex] = kTurn;
        }
        for (Index face = 0; face < _level.GetNumFaces(); ++face) {
            auto const corners = _level.GetFaceVertices(face);
            for (int j = 0; j < corners.size(); ++j) {
                if (_isActive[ofVertex[corners[j]]])
                    sources[corners[j]] -= _frames.FindCornerAngle(face, j);
            }
        }
        for (WantedIndex const& at : wanted) sources[at.vertex] -= kTurn * at.index;
        return sources;
    }

    /// Adds harmonic turns that make the holonomy of every closed way a whole number of turns, the
    /// nearest one. A closed form of whole numbers is such a way: it crosses each edge so many
    /// times, from left to right.
    void MakeLoopsWhole() {
        auto const loops = FindClosedForms(_level, true);
        if (loops.empty()) return;
        auto const& harmonics = _designer.GetHarmonics();
        auto const& stars = _designer.GetStars().edge;
        auto const count = static_cast<Eigen::Index>(loops.size());
        Eigen::MatrixXd products(count, count);
        Eigen::VectorXd missing(count);
        for (Eigen::Index i = 0; i < count; ++i) {
            double const holonomy = FindHolonomy(loops[i]);
            missing[i] = kTurn * std::nearbyint(holonomy / kTurn) - holonomy;
            for (Eigen::Index j = 0; j < count; ++j) {
                double sum = 0.0;
                for (size_t edge = 0; edge < stars.size(); ++edge)
                    sum += loops[i][edge] * stars[edge] * harmonics[j][edge];
                products(i, j) = sum;
            }
        }
        Eigen::VectorXd const factors = products.fullPivLu().solve(missing);
        for (Eigen::Index j = 0; j < count; ++j) {
            for (size_t edge = 0; edge < stars.size(); ++edge)
                _turns[edge] += factors[j] * stars[edge] * harmonics[j][edge];
        }
    }

    double FindHolonomy(std::vector<double> const& loop) const {
        double sum = 0.0;
        for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
            Sides sides{};
            if (loop[edge] == 0.0 || !FindSides(_level, edge, sides)) continue;
            Eigen::Vector3d const along = _frames.GetEdge(edge);
            Complex const turn =
                _frames.Find(sides.right, along) * std::conj(_frames.Find(sides.left, along));
            sum += loop[edge] * (FindAngle(turn.real(), turn.imag()) + _turns[edge]);
        }
        return sum;
    }

    Far::TopologyLevel const& _level;
    FaceFrames const& _frames;
    FieldDesigner _designer;
    std::vector<char> _isActive;  // per component
    std::vector<double> _turns;
};

/// Unit vectors in the frames of faces, from the lowest face of each component on, where it runs
/// along the first side; 0 where the component is not active.
std::vector<Complex> Carry(Far::TopologyLevel const& level, FaceFrames const& frames,
                           std::vector<double> const& turns, Connection const& connection) {
    std::vector<Complex> vectors(level.GetNumFaces(), 0.0);
    std::vector<Index> queue;
    for (Index root = 0; root < level.GetNumFaces(); ++root) {
        if (vectors[root] != 0.0 || !connection.GetActive()[connection.GetComponentOfFace()[root]])
            continue;
        vectors[root] = 1.0;
        queue.assign(1, root);
        for (size_t next = 0; next < queue.size(); ++next) {
            Index const face = queue[next];
            for (Index edge : level.GetFaceEdges(face)) {
                Sides sides{};
                if (!FindSides(level, edge, sides)) continue;
                bool const isFromLeft = sides.left == face;
                Index const other = isFromLeft ? sides.right : sides.left;
                if (vectors[other] != 0.0) continue;
                Eigen::Vector3d const along = frames.GetEdge(edge);
                Complex const there = frames.Find(other, along) *
                                      std::conj(frames.Find(face, along)) * vectors[face] *
                                      MakeUnit(isFromLeft ? turns[edge] : -turns[edge]);
                vectors[other] = there / std::sqrt(std::norm(there));
                queue.push_back(other);
            }
        }
    }
    return vectors;
}

}  // namespace

std::vector<double> MakeUnitField(Far::TopologyLevel const& level,
                                  std::span<double const> positions,
                                  std::span<WantedIndex const> wanted) {
    FaceFrames const frames(level, far_ext::Points(positions));
    Connection connection(level, positions, frames);
    auto const turns = connection.Find(wanted);
    auto const vectors = Carry(level, frames, turns, connection);
    std::vector<double> form(level.GetNumEdges(), 0.0);
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const faces = level.GetEdgeFaces(edge);
        for (Index face : faces)
            form[edge] +=
                frames.MakeVector(face, vectors[face]).dot(frames.GetEdge(edge)) / faces.size();
    }
    return form;
}

}  // namespace limn::eval
