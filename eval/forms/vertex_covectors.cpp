// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/vertex_covectors.h"

#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "far_ext/error.h"
#include "far_ext/forms/find_wheel.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

using far_ext::Wheel;

/// A left eigenvector of the vertex rules at a vertex: weights of the vertex, of the spokes' ends
/// and (quads) of the far corners.
struct TangentMask {
    double eigenvalue = 0.5, vertex = 0.0;
    std::vector<double> ends, corners;
};

/// Of the waves of one turn round a vertex [Limit 10]; half a turn over a fan is the same wave.
double FindEigenvalue(bool isLoop, double angle) {
    double const c = std::cos(angle);
    if (isLoop) return 0.375 + 0.25 * c;
    return 0.3125 + (c + std::cos(0.5 * angle) * std::sqrt(2.0 * (9.0 + c))) / 16.0;
}

TangentMask MakeEmpty(Wheel const& wheel) {
    TangentMask mask;
    mask.ends.assign(wheel.GetNumSpokes(), 0.0);
    mask.corners.assign(wheel.GetNumFaces(), 0.0);
    return mask;
}

/// The two tangents of a smooth interior vertex, a quarter turn apart: cosine and sine of one turn,
/// with the ratio of edge ends to far corners that the eigenvector has [Forms 7.2].
std::array<TangentMask, 2> MakeSmoothMasks(bool isLoop, Wheel const& wheel) {
    std::array<TangentMask, 2> masks{MakeEmpty(wheel), MakeEmpty(wheel)};
    int const k = wheel.GetNumFaces();
    double const angle = 2.0 * std::numbers::pi / k, c = std::cos(angle);
    double const edge = isLoop ? 1.0 : 1.0 + c + std::cos(0.5 * angle) * std::sqrt(2.0 * (9.0 + c));
    for (size_t a = 0; a < 2; ++a) {
        auto const wave = [&](int i) { return a == 0 ? std::cos(angle * i) : std::sin(angle * i); };
        masks[a].eigenvalue = FindEigenvalue(isLoop, angle);
        for (int i = 0; i < k; ++i) {
            masks[a].ends[i] = edge * wave(i);
            if (!isLoop) masks[a].corners[i] = wave(i) + wave(i + 1);
        }
    }
    return masks;
}

/// Along and across a boundary or crease curve: the fan of `size` faces that starts at spoke
/// `first`. OpenSubdiv's mask across is no eigenvector of its own rule for larger fans; this one is
/// [Forms 7.2].
std::array<TangentMask, 2> MakeCurveMasks(bool isLoop, Wheel const& wheel, int first, int size) {
    std::array<TangentMask, 2> masks{MakeEmpty(wheel), MakeEmpty(wheel)};
    int const k = wheel.GetNumFaces(), numSpokes = wheel.GetNumSpokes();
    auto const end = [&](TangentMask& mask, int i) -> double& {
        return mask.ends[(first + i) % numSpokes];
    };
    end(masks[0], 0) = 1.0;
    end(masks[0], size) = -1.0;
    TangentMask& across = masks[1];
    if (size == 1) {  // an ear: the wave has no inner spoke, the height of the triangle is left
        across.eigenvalue = 0.25;
        across.vertex = -1.0;
        end(across, 0) = end(across, 1) = 0.5;
        return masks;
    }
    double const angle = std::numbers::pi / size;
    double const lambda = across.eigenvalue = FindEigenvalue(isLoop, angle);
    double sum = 0.0, cornerSum = 0.0;
    for (int i = 1; i < size; ++i) sum += end(across, i) = std::sin(angle * i);
    for (int j = 0; !isLoop && j < size; ++j) {
        double const corner =
            (std::sin(angle * j) + std::sin(angle * (j + 1))) / (4.0 * (4.0 * lambda - 1.0));
        cornerSum += across.corners[(first + j) % k] = corner;
    }
    // At the ends the curve's own rule: what the eigenvalue equation leaves for them; the vertex
    // takes the rest, so that the mask is blind to translations.
    double const firstCorner = across.corners[first % k];
    double const atEnds =
        isLoop ? (std::sin(angle) / 8.0 - sum / 8.0) / (lambda - 0.25)
               : (std::sin(angle) / 16.0 + firstCorner / 4.0 - (sum + cornerSum) / 8.0) /
                     (lambda - 0.25);
    end(across, 0) = end(across, size) = atEnds;
    across.vertex = -2.0 * atEnds - sum - cornerSum;
    return masks;
}

/// At a corner the fan's two border edges themselves.
std::array<TangentMask, 2> MakeCornerMasks(Wheel const& wheel, int first, int size) {
    std::array<TangentMask, 2> masks{MakeEmpty(wheel), MakeEmpty(wheel)};
    for (size_t a = 0; a < 2; ++a) {
        masks[a].vertex = -1.0;
        masks[a].ends[(first + (a == 0 ? 0 : size)) % wheel.GetNumSpokes()] = 1.0;
    }
    return masks;
}

std::array<TangentMask, 2> MakeMasks(bool isLoop, Wheel const& wheel) {
    std::vector<int> cuts;
    int const last = wheel.GetNumSpokes() - 1;
    for (int i = 0; i <= last; ++i) {
        if (wheel.parent.isSharp[i] || (!wheel.isInterior && (i == 0 || i == last)))
            cuts.push_back(i);
    }
    // A wheel in one piece has two tangents; one that is cut shows its first fan's.
    bool const isSmooth = wheel.isInterior && cuts.size() < 2;
    if (isSmooth) return MakeSmoothMasks(isLoop, wheel);
    int const size = cuts[1] - cuts[0];
    bool const hasAcross = isLoop || size > 1;
    if (wheel.parent.isCrease && hasAcross) return MakeCurveMasks(isLoop, wheel, cuts[0], size);
    return MakeCornerMasks(wheel, cuts[0], size);
}

Far::TopologyLevel GetLevel(Far::TopologyRefiner const& refiner, int level) {
    if (level < 0 || level > refiner.GetMaxLevel()) {
        throw Error(ErrorCode::BadOption, fmt::format("level {} does not exist; levels are 0 to {}",
                                                      level, refiner.GetMaxLevel()));
    }
    return refiner.GetLevel(level);
}

}  // namespace

Eigen::Vector3d VertexCovector::GetNormal() const {
    Eigen::Vector3d const normal = tangents[0].cross(tangents[1]);
    double const length = normal.norm();
    return length > 1e-12 * tangents[0].norm() * tangents[1].norm()
               ? Eigen::Vector3d(normal / length)
               : Eigen::Vector3d::Zero();
}

/// By the inverse of the tangents' Gram matrix: whatever their length and angle, V.T_a = w(T_a).
Eigen::Vector3d VertexCovector::GetVector() const {
    double const e = tangents[0].squaredNorm(), f = tangents[0].dot(tangents[1]),
                 g = tangents[1].squaredNorm();
    double const determinant = e * g - f * f;
    if (!(determinant > 1e-20 * e * g)) return Eigen::Vector3d::Zero();
    return ((g * values[0] - f * values[1]) * tangents[0] +
            (e * values[1] - f * values[0]) * tangents[1]) /
           determinant;
}

/// [Forms 7.2]: w(T) = sum t(w_i) w(sp_i) + (quads: paths to far corners) + sum h_j (d1 w)(f_j), h
/// = r (lambda - s)^-1.
class VertexCovectors::RowMaker {
public:
    RowMaker(Sdc::SchemeType scheme, Wheel const& wheel)
        : _wheel(wheel),
          _isLoop(scheme == Sdc::SCHEME_LOOP),
          _numSides(_isLoop ? 3 : 4),
          _k(wheel.GetNumFaces()),
          _numSpokes(wheel.GetNumSpokes()),
          _local(far_ext::MakeWheelRows(scheme, wheel)) {}

    Row Make(TangentMask const& mask) const;

private:
    Eigen::Map<Eigen::VectorXd const> AsChain(std::vector<double> const& x) const {
        return {x.data(), _k};
    }
    void AddSide(Eigen::Index face, int m, double weight, Row& row) const;
    void AddSpokes(TangentMask const& mask, Row& row, Eigen::VectorXd& residue) const;
    void AddCorners(TangentMask const& mask, Row& row, Eigen::VectorXd& residue) const;
    Eigen::VectorXd FindFaces(double eigenvalue, Eigen::VectorXd const& residue) const;

    Wheel const& _wheel;
    bool _isLoop;
    int _numSides;
    Eigen::Index _k;
    size_t _numSpokes;
    far_ext::WheelRows _local;
};

/// Adds side m of a face, counter-clockwise from its first spoke on.
void VertexCovectors::RowMaker::AddSide(Eigen::Index face, int m, double weight, Row& row) const {
    if (m == 0)
        row.edges[face] += weight;
    else if (m == _numSides - 1)
        row.edges[(face + 1) % _numSpokes] -= weight;
    else
        row.edges[_numSpokes + face * (_numSides - 2) + m - 1] += weight;
}

void VertexCovectors::RowMaker::AddSpokes(TangentMask const& mask, Row& row,
                                          Eigen::VectorXd& residue) const {
    for (size_t i = 0; i < _numSpokes; ++i) {
        double const t = mask.ends[i];
        if (t == 0.0) continue;
        row.edges[i] += t;
        residue += t * AsChain(_local.flow[i]);
        if (_isLoop || _wheel.faceShares[i] == 0.0) continue;
        double const q = t * _wheel.faceShares[i] / 8.0;
        residue[static_cast<Eigen::Index>(i)] += q;
        residue[(static_cast<Eigen::Index>(i) + _k - 1) % _k] -= q;
    }
}

/// Paths to the far corners of quads: the mean of both ways round.
void VertexCovectors::RowMaker::AddCorners(TangentMask const& mask, Row& row,
                                           Eigen::VectorXd& residue) const {
    for (Eigen::Index j = 0; j < _k; ++j) {
        double const t = mask.corners[j];
        if (t == 0.0) continue;
        for (int m = 0; m < 4; ++m) AddSide(j, m, m < 2 ? 0.5 * t : -0.5 * t, row);
        residue += 0.5 * t * (AsChain(_local.flow[j]) + AsChain(_local.flow[(j + 1) % _numSpokes]));
    }
}

/// The faces that make the chain an eigenvector: h s + r = lambda h, since d1 S1 = S2 d1.
Eigen::VectorXd VertexCovectors::RowMaker::FindFaces(double eigenvalue,
                                                     Eigen::VectorXd const& residue) const {
    Eigen::MatrixXd shares(_k, _k);
    for (Eigen::Index j = 0; j < _k; ++j) shares.row(j) = AsChain(_local.share[j]).transpose();
    Eigen::MatrixXd const system =
        (eigenvalue * Eigen::MatrixXd::Identity(_k, _k) - shares).transpose();
    return system.partialPivLu().solve(residue);
}

VertexCovectors::Row VertexCovectors::RowMaker::Make(TangentMask const& mask) const {
    Row row{mask.vertex, mask.ends, mask.corners,
            std::vector<double>(_numSpokes + _k * (_numSides - 2), 0.0)};
    // The mask as a chain tau with boundary t, and r: what one step of S1 makes of it beside lambda
    // tau, as a 2-chain.
    Eigen::VectorXd residue = Eigen::VectorXd::Zero(_k);
    AddSpokes(mask, row, residue);
    if (!_isLoop) AddCorners(mask, row, residue);
    if (residue.isZero(0.0)) return row;
    Eigen::VectorXd const h = FindFaces(mask.eigenvalue, residue);
    for (Eigen::Index j = 0; j < _k; ++j) {
        for (int m = 0; m < _numSides; ++m) AddSide(j, m, h[j], row);
    }
    return row;
}

VertexCovectors::Rows VertexCovectors::MakeRows(Sdc::SchemeType scheme, Wheel const& wheel) {
    RowMaker const maker(scheme, wheel);
    auto const masks = MakeMasks(scheme == Sdc::SCHEME_LOOP, wheel);
    return {maker.Make(masks[0]), maker.Make(masks[1])};
}

VertexCovectors::VertexCovectors(Far::TopologyRefiner const& refiner, int level)
    : _refiner(refiner), _level(GetLevel(refiner, level)) {
    for (Index vertex = 0; vertex < _level.GetNumVertices(); ++vertex) {
        size_t const k = _level.GetVertexFaces(vertex).size();
        if (k == 0 || !far_ext::IsSmoothInterior(_level, vertex)) continue;
        if (_plainRows.size() <= k) _plainRows.resize(k + 1);
        if (!_plainRows[k])
            _plainRows[k] =
                MakeRows(refiner.GetSchemeType(),
                         far_ext::MakeSmoothWheel(refiner.GetSchemeType(), static_cast<int>(k)));
    }
}

void VertexCovectors::Check(Index vertex, std::span<double const> positions) const {
    if (vertex < 0 || vertex >= _level.GetNumVertices()) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("vertex {} does not exist; the level has {} vertices, 0 to {}",
                                vertex, _level.GetNumVertices(), _level.GetNumVertices() - 1));
    }
    far_ext::CheckPoints(positions, _level.GetNumVertices());
}

/// Finds the tangents at a vertex, and calls addEdge(a, edge, weight) for the edges of which
/// w(T_a) is the weighted sum.
template <class AddEdge>
std::array<Eigen::Vector3d, 2> VertexCovectors::Walk(Index vertex,
                                                     std::span<double const> positions,
                                                     AddEdge addEdge) const {
    std::array<Eigen::Vector3d, 2> tangents{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    int const numSides = _refiner.GetSchemeType() == Sdc::SCHEME_LOOP ? 3 : 4;
    auto const faces = _level.GetVertexFaces(vertex);
    auto const corners = _level.GetVertexFaceLocalIndices(vertex);
    auto const edges = _level.GetVertexEdges(vertex);
    if (faces.size() == 0) return tangents;
    Rows own;
    bool const isPlain = far_ext::IsSmoothInterior(_level, vertex);
    if (!isPlain)
        own = MakeRows(_refiner.GetSchemeType(),
                       far_ext::FindWheel(_refiner, _level, nullptr, vertex));
    Rows const& rows = isPlain ? *_plainRows[faces.size()] : own;

    far_ext::Points const points(positions);
    for (size_t a = 0; a < 2; ++a) tangents[a] = rows[a].vertex * points[vertex];
    for (int i = 0; i < edges.size(); ++i) {
        auto const ends = _level.GetEdgeVertices(edges[i]);
        Eigen::Vector3d const end = points[ends[0] == vertex ? ends[1] : ends[0]];
        double const sign = far_ext::GetSignFrom(_level, edges[i], vertex);
        for (size_t a = 0; a < 2; ++a) {
            tangents[a] += rows[a].ends[i] * end;
            addEdge(a, edges[i], rows[a].edges[i] * sign);
        }
    }
    size_t place = edges.size();
    for (int j = 0; j < faces.size(); ++j) {
        for (int m = 1; m < numSides - 1; ++m, ++place) {
            auto const side = far_ext::GetFaceSide(_level, faces[j], (corners[j] + m) % numSides);
            for (size_t a = 0; a < 2; ++a) addEdge(a, side.edge, rows[a].edges[place] * side.sign);
        }
        if (numSides == 3) continue;
        Eigen::Vector3d const corner =
            points[_level.GetFaceVertices(faces[j])[(corners[j] + 2) % 4]];
        for (size_t a = 0; a < 2; ++a) tangents[a] += rows[a].corners[j] * corner;
    }
    return tangents;
}

VertexCovector VertexCovectors::Find(Index vertex, std::span<double const> form,
                                     std::span<double const> positions) const {
    Check(vertex, positions);
    far_ext::CheckLength("form", form, _level.GetNumEdges(), "edges", 1);
    VertexCovector result;
    result.tangents = Walk(vertex, positions, [&](size_t a, Index edge, double weight) {
        result.values[a] += weight * form[edge];
    });
    return result;
}

VertexCovectors::ValueRows VertexCovectors::FindValueRows(Index vertex,
                                                          std::span<double const> positions) const {
    Check(vertex, positions);
    ValueRows rows;
    rows.tangents = Walk(vertex, positions, [&](size_t a, Index edge, double weight) {
        rows.values[a].Add(edge, weight);
    });
    return rows;
}

std::vector<VertexCovector> VertexCovectors::FindAll(std::span<Index const> vertices,
                                                     std::span<double const> form,
                                                     std::span<double const> positions,
                                                     TableEvaluator* evaluator) const {
    std::vector<VertexCovector> covectors(vertices.size());
    if (!evaluator) {
        tbb::parallel_for(size_t(0), vertices.size(),
                          [&](size_t i) { covectors[i] = Find(vertices[i], form, positions); });
        return covectors;
    }
    far_ext::CheckLength("form", form, _level.GetNumEdges(), "edges", 1);
    std::vector<ValueRows> rows(vertices.size());
    tbb::parallel_for(size_t(0), vertices.size(),
                      [&](size_t i) { rows[i] = FindValueRows(vertices[i], positions); });
    far_ext::SparseRows table;
    for (ValueRows const& row : rows) {
        for (far_ext::WeightRow const& value : row.values) table.AddRow(value);
    }
    std::vector<double> values(2 * vertices.size());
    evaluator->Make(kTable, table, _level.GetNumEdges()).Apply(form, 1, values);
    for (size_t i = 0; i < covectors.size(); ++i)
        covectors[i] = {rows[i].tangents, {values[2 * i], values[2 * i + 1]}};
    return covectors;
}

std::array<far_ext::WeightRow, 3> VertexCovectors::FindVectorRows(
    Index vertex, std::span<double const> positions) const {
    auto const [tangents, values] = FindValueRows(vertex, positions);
    VertexCovector covector{tangents};
    std::array<far_ext::WeightRow, 3> rows;
    for (size_t a = 0; a < 2; ++a) {  // V is linear in both values
        covector.values = {};
        covector.values[a] = 1.0;
        Eigen::Vector3d const unit = covector.GetVector();
        for (size_t axis = 0; axis < 3; ++axis)
            rows[axis].AddWithWeight(values[a], unit[static_cast<Eigen::Index>(axis)]);
    }
    return rows;
}

}  // namespace limn::eval
