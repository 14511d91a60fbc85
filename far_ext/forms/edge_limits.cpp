// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/edge_limits.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "far_ext/error.h"
#include "far_ext/topology/control_mesh.h"
#include "far_ext/topology/refiner.h"

namespace limn::far_ext {

namespace {

/// The dense system of a half [Forms 7.1] grows with the square of its fan: 1500 unknowns for 64
/// quads.
constexpr int kMaxFan = 64;

int FindSpoke(Far::TopologyLevel const& level, Index vertex, Index edge) {
    auto const edges = level.GetVertexEdges(vertex);
    return static_cast<int>(std::find(edges.begin(), edges.end(), edge) - edges.begin());
}

/// The edges of `numFaces` faces round a vertex from one spoke on: spokes outwards, then the other
/// sides of each face, counter-clockwise. A fan has one spoke more than faces, unless it goes all
/// round.
std::vector<OrientedEdge> ListWheel(Far::TopologyLevel const& level, Index vertex, int firstSpoke,
                                    int numFaces) {
    auto const edges = level.GetVertexEdges(vertex);
    auto const faces = level.GetVertexFaces(vertex);
    auto const corners = level.GetVertexFaceLocalIndices(vertex);
    bool const isWhole = numFaces == edges.size();
    std::vector<OrientedEdge> list;
    for (int i = 0; i < numFaces + (isWhole ? 0 : 1); ++i) {
        Index const edge = edges[(firstSpoke + i) % edges.size()];
        list.push_back({edge, GetSignFrom(level, edge, vertex)});
    }
    for (int i = 0; i < numFaces; ++i) {
        int const face = (firstSpoke + i) % faces.size(),
                  size = level.GetFaceVertices(faces[face]).size();
        for (int m = 1; m < size - 1; ++m)
            list.push_back(GetFaceSide(level, faces[face], (corners[face] + m) % size));
    }
    return list;
}

/// All round an interior vertex, from one of its edges on.
std::vector<OrientedEdge> ListWholeWheel(Far::TopologyLevel const& level, Index vertex,
                                         Index edge) {
    return ListWheel(level, vertex, FindSpoke(level, vertex, edge),
                     level.GetVertexFaces(vertex).size());
}

Index GetEnd(Far::TopologyLevel const& level, Index edge, Index from) {
    auto const ends = level.GetEdgeVertices(edge);
    return ends[0] == from ? ends[1] : ends[0];
}

/// An edge of a walk from vertex to vertex.
struct Leg {
    Index edge, from, to;
};

Leg MakeLeg(Far::TopologyLevel const& level, Index edge, Index from) {
    return {edge, from, GetEnd(level, edge, from)};
}

/// The leg behind the regular vertex that a leg leads to.
Leg GoStraightOn(Far::TopologyLevel const& level, Leg const& leg) {
    auto const edges = level.GetVertexEdges(leg.to);
    int const valence = edges.size(), back = FindSpoke(level, leg.to, leg.edge);
    return MakeLeg(level, edges[(back + valence / 2) % valence], leg.to);
}

OrientedEdge Orient(Far::TopologyLevel const& level, Leg const& leg) {
    return {leg.edge, GetSignFrom(level, leg.edge, leg.from)};
}

/// Limit of a regular edge a -> b over the wheels of a (from the spoke to b) and of b (from the
/// spoke to a): an edge of both wheels has its weight in one of them.
struct RegularStencil {
    std::vector<double> atStart, atEnd;
};

RegularStencil MakeRegularStencil(bool isLoop) {
    if (isLoop) {  // [Forms 7.1], over 120
        RegularStencil stencil{{44, 13, -6, -8, -6, 13, -13, -5, -1, 1, 5, 13},
                               {0, 0, 6, 8, 6, 0, 0, 5, 1, -1, -5, 0}};
        for (auto* part : {&stencil.atStart, &stencil.atEnd}) {
            for (double& weight : *part) weight /= 120.0;
        }
        return stencil;
    }
    // (1,4,1)/6 along times (1,4,1)/6 across; sides 1 and 2 of each face follow the four spokes.
    RegularStencil stencil{std::vector<double>(12, 0.0), std::vector<double>(12, 0.0)};
    auto const side = [](int face, int m) { return 4 + 2 * face + m - 1; };
    stencil.atStart[0] = 16.0 / 36.0;
    stencil.atStart[2] = -4.0 / 36.0;
    stencil.atStart[side(0, 2)] = -4.0 / 36.0;
    stencil.atStart[side(1, 1)] = -1.0 / 36.0;
    stencil.atStart[side(2, 2)] = 1.0 / 36.0;
    stencil.atStart[side(3, 1)] = 4.0 / 36.0;
    stencil.atEnd[2] = 4.0 / 36.0;
    stencil.atEnd[side(1, 1)] = 1.0 / 36.0;
    stencil.atEnd[side(2, 2)] = -1.0 / 36.0;
    return stencil;
}

/// The first infinitely sharp edge of a vertex's wheel; 0 if it has none.
int FindSharpSpoke(Far::TopologyLevel const& level, Index vertex) {
    auto const edges = level.GetVertexEdges(vertex);
    for (int i = 0; i < edges.size(); ++i) {
        if (level.IsEdgeInfSharp(edges[i])) return i;
    }
    return 0;
}

/// Along a boundary or an infinitely sharp crease only the curve counts: 1/6, 2/3, 1/6; at a corner
/// 5/6 and no 1/6 beyond it.
WeightRow FindCurve(Far::TopologyLevel const& level, Index edge) {
    WeightRow row;
    auto const ends = level.GetEdgeVertices(edge);
    double const sign = GetSignFrom(level, edge, ends[0]);
    double own = 2.0 / 3.0;
    for (int side : {0, 1}) {
        Index const vertex = ends[side];
        Index other = -1;
        for (Index candidate : level.GetVertexEdges(vertex)) {
            if (candidate != edge &&
                (level.IsEdgeInfSharp(candidate) || level.IsEdgeBoundary(candidate)))
                other = candidate;
        }
        if (level.GetVertexRule(vertex) != Sdc::Crease::RULE_CREASE || other < 0) own += 1.0 / 6.0;
        // The neighbour in the direction of ends[0] -> ends[1]: it comes in at the first end and
        // leaves from the second.
        else
            row.Add(other,
                    sign * (side == 0 ? -1.0 : 1.0) * GetSignFrom(level, other, vertex) / 6.0);
    }
    row.Add(edge, own);
    return row;
}

/// The edges within `rings` steps of a vertex, in an order that depends on what the neighbourhood
/// looks like alone: the same for all neighbourhoods that look alike. That a level's list and the
/// next one's agree place by place is what makes a subdivision step a square matrix [Forms 7.1].
std::vector<OrientedEdge> WalkNeighbourhood(Far::TopologyLevel const& level, Index vertex,
                                            int rings) {
    struct Stop {
        Index vertex, cameBy;
        int ring;
    };
    std::vector<Stop> stops{{vertex, -1, 0}};
    std::vector<char> isSeen(level.GetNumVertices(), 0), isListed(level.GetNumEdges(), 0);
    isSeen[vertex] = 1;
    std::vector<OrientedEdge> list;
    for (size_t at = 0; at < stops.size(); ++at) {
        auto const [here, cameBy, ring] = stops[at];
        auto const edges = level.GetVertexEdges(here);
        int const count = edges.size();
        // The middle starts at its sharp spoke, if it has one; boundary vertices at their first,
        // others at the edge they were reached by.
        int const first = cameBy < 0                     ? FindSharpSpoke(level, here)
                          : level.IsVertexBoundary(here) ? 0
                                                         : FindSpoke(level, here, cameBy);
        for (int i = 0; i < count; ++i) {
            Index const edge = edges[(first + i) % count], end = GetEnd(level, edge, here);
            if (ring == rings && !isSeen[end]) continue;
            if (!isListed[edge]) list.push_back({edge, GetSignFrom(level, edge, here)});
            isListed[edge] = 1;
            if (isSeen[end]) continue;
            isSeen[end] = 1;
            stops.push_back({end, edge, ring + 1});
        }
    }
    return list;
}

}  // namespace

/// Solves on a template, a neighbourhood that is regular but for its middle: refined until the
/// middle's four rings, all that a half reads and its image, see nothing of the template's rim.
class EdgeLimits::HalfSolver {
public:
    HalfSolver(Sdc::SchemeType scheme, Kind kind, int size, int spoke)
        : _kind(kind),
          _size(size),
          _spoke(spoke),
          _refiner(RefineTemplate(scheme, kind, size)),
          _coarse(_refiner->GetLevel(kLevel)),
          _middle(FindMiddle()),
          _firstSpoke(kind == Kind::Dart ? FindSharpSpoke(_coarse, _middle) : 0),
          _half(FindHalf()),
          _unknowns(WalkNeighbourhood(_coarse, _middle, kRings)),
          _places(_coarse.GetNumEdges(), -1) {
        for (size_t i = 0; i < _unknowns.size(); ++i)
            _places[_unknowns[i].edge] = static_cast<int>(i);
    }

    HalfLimit Solve() const;

private:
    static constexpr int kLevel = 3, kRings = 4;  // of eight rings round the middle

    static ControlMesh MakeTemplate(Sdc::SchemeType scheme, Kind kind, int size);
    static std::unique_ptr<Far::TopologyRefiner> RefineTemplate(Sdc::SchemeType scheme, Kind kind,
                                                                int size);
    Index FindMiddle() const;
    Leg FindHalf() const;

    Eigen::Index GetCount() const { return static_cast<Eigen::Index>(_unknowns.size()); }
    Eigen::MatrixXd MakeStep() const;
    Eigen::RowVectorXd MakeRegularLimit() const;
    void Add(std::vector<OrientedEdge> const& edges, std::vector<double> const& weights,
             Eigen::RowVectorXd& row) const;
    std::vector<double> Take(std::vector<OrientedEdge> const& edges, Eigen::VectorXd& rest) const;

    Kind _kind;
    int _size, _spoke;
    std::unique_ptr<Far::TopologyRefiner> _refiner;
    Far::TopologyLevel _coarse;
    Index _middle;
    int _firstSpoke;
    Leg _half;  // on the coarse level, from the middle outwards
    std::vector<OrientedEdge> _unknowns;
    std::vector<int> _places;  // per edge of the coarse level: its unknown, or -1
};

ControlMesh EdgeLimits::HalfSolver::MakeTemplate(Sdc::SchemeType scheme, Kind kind, int size) {
    bool const isLoop = scheme == Sdc::SCHEME_LOOP,
               isOpen = kind == Kind::Curve || kind == Kind::Corner;
    ControlMesh mesh;
    mesh.scheme = scheme;
    mesh.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    int const numSpokes = size + (isOpen ? 1 : 0);
    mesh.numVertices = 1 + numSpokes + (isLoop ? 0 : size);
    for (int i = 0; i < size; ++i) {
        Index const a = 1 + i, b = 1 + (i + 1) % numSpokes;
        mesh.faceSizes.push_back(isLoop ? 3 : 4);
        if (isLoop)
            mesh.faceVertices.insert(mesh.faceVertices.end(), {0, a, b});
        else
            mesh.faceVertices.insert(mesh.faceVertices.end(), {0, a, 1 + numSpokes + i, b});
    }
    // Fans of a crease need no mark: a boundary has the crease's rule [Forms 5].
    if (kind == Kind::Corner) {
        mesh.cornerVertices.push_back(0);
        mesh.cornerSharpness.push_back(Sdc::Crease::SHARPNESS_INFINITE);
    }
    if (kind == Kind::Dart) {
        mesh.creaseVertexPairs = {0, 1};
        mesh.creaseSharpness.push_back(Sdc::Crease::SHARPNESS_INFINITE);
    }
    return mesh;
}

std::unique_ptr<Far::TopologyRefiner> EdgeLimits::HalfSolver::RefineTemplate(Sdc::SchemeType scheme,
                                                                             Kind kind, int size) {
    auto refiner = CreateRefiner(MakeTemplate(scheme, kind, size));
    Far::TopologyRefiner::UniformOptions options(kLevel + 1);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);
    return refiner;
}

Index EdgeLimits::HalfSolver::FindMiddle() const {
    Index middle = 0;
    for (int level = 0; level < kLevel; ++level)
        middle = _refiner->GetLevel(level).GetVertexChildVertex(middle);
    return middle;
}

Leg EdgeLimits::HalfSolver::FindHalf() const {
    auto const spokes = _coarse.GetVertexEdges(_middle);
    return MakeLeg(_coarse, spokes[(_firstSpoke + _spoke) % spokes.size()], _middle);
}

/// A: one step of S1 on the neighbourhood. What four refined rings read lies within four coarse
/// ones.
Eigen::MatrixXd EdgeLimits::HalfSolver::MakeStep() const {
    auto const images = WalkNeighbourhood(_refiner->GetLevel(kLevel + 1),
                                          _coarse.GetVertexChildVertex(_middle), kRings);
    SparseRows const s1 = BuildFormStencils(*_refiner, kLevel + 1).s1;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(GetCount(), GetCount());
    for (Eigen::Index row = 0; row < GetCount(); ++row) {
        auto const& image = images[row];
        for (int k = s1.offsets[image.edge]; k < s1.offsets[image.edge + 1]; ++k) {
            int const column = _places[s1.indices[k]];
            if (column >= 0) A(row, column) += image.sign * _unknowns[column].sign * s1.weights[k];
        }
    }
    return A;
}

/// l: the regular limit one step out along the spoke, from its end straight on.
Eigen::RowVectorXd EdgeLimits::HalfSolver::MakeRegularLimit() const {
    Eigen::RowVectorXd regular = Eigen::RowVectorXd::Zero(GetCount());
    Leg const next = GoStraightOn(_coarse, _half);
    if (_kind == Kind::Dart && _spoke == 0) {  // along the crease: a cubic curve's
        Leg const beyond = GoStraightOn(_coarse, next);
        Add({Orient(_coarse, _half), Orient(_coarse, next), Orient(_coarse, beyond)},
            {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0}, regular);
    } else {
        RegularStencil const stencil =
            MakeRegularStencil(_refiner->GetSchemeType() == Sdc::SCHEME_LOOP);
        Add(ListWholeWheel(_coarse, next.from, next.edge), stencil.atStart, regular);
        Add(ListWholeWheel(_coarse, next.to, next.edge), stencil.atEnd, regular);
    }
    return regular;
}

void EdgeLimits::HalfSolver::Add(std::vector<OrientedEdge> const& edges,
                                 std::vector<double> const& weights,
                                 Eigen::RowVectorXd& row) const {
    for (size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] == 0.0) continue;
        int const column = _places[edges[i].edge];
        row[column] += weights[i] * edges[i].sign * _unknowns[column].sign;
    }
}

/// Moves the weights of some edges out of `rest`: an edge of two wheels counts once.
std::vector<double> EdgeLimits::HalfSolver::Take(std::vector<OrientedEdge> const& edges,
                                                 Eigen::VectorXd& rest) const {
    std::vector<double> weights;
    for (auto const& edge : edges) {
        int const column = _places[edge.edge];
        weights.push_back(column >= 0 ? rest[column] * edge.sign * _unknowns[column].sign : 0.0);
        if (column >= 0) rest[column] = 0.0;
    }
    return weights;
}

/// On the next level the regular edge one step out and the half's own are what the half is made of,
/// hence L = l A + L A.
EdgeLimits::HalfLimit EdgeLimits::HalfSolver::Solve() const {
    Eigen::MatrixXd const A = MakeStep();
    Eigen::RowVectorXd const regular = MakeRegularLimit();
    // L (I - A) = l A; S1 halves, so that 1 is no eigenvalue of A.
    Eigen::MatrixXd const system =
        (Eigen::MatrixXd::Identity(GetCount(), GetCount()) - A).transpose();
    Eigen::VectorXd rest = system.partialPivLu().solve((regular * A).transpose());
    int const firstSpoke = _kind == Kind::Interior ? _spoke : _firstSpoke;
    HalfLimit half;
    half.atVertex = Take(ListWheel(_coarse, _middle, firstSpoke, _size), rest);
    half.atMiddle = Take(ListWholeWheel(_coarse, _half.to, _half.edge), rest);
    return half;
}

EdgeLimits::EdgeLimits(Far::TopologyRefiner const& refiner, int level)
    : _refiner(refiner),
      _coarse(refiner.GetLevel(level)),
      _fine(refiner.GetLevel(level + 1)),
      _s1(BuildFormStencils(refiner, level + 1).s1) {}

/// What the limit along a half depends on: sharp edges shut a fan off from the rest of the wheel.
/// On a refined level, since the base may have more irregular ends than one.
EdgeLimits::Fan EdgeLimits::FindFan(Index vertex, Index edge) const {
    auto const edges = _fine.GetVertexEdges(vertex);
    auto const faces = _fine.GetVertexFaces(vertex);
    int const spoke = FindSpoke(_fine, vertex, edge), k = faces.size();
    bool const isInterior = edges.size() == k;
    auto const isSharp = [&](int i) {
        return _fine.IsEdgeInfSharp(edges[i]) || _fine.IsEdgeBoundary(edges[i]);
    };
    int numSharp = 0;
    for (int i = 0; i < edges.size(); ++i) {
        if (_fine.IsEdgeSemiSharp(edges[i])) {
            throw Error(ErrorCode::BadOption,
                        fmt::format("vertex {} of the level has a semi-sharp edge; limits need "
                                    "levels on which sharpness has faded",
                                    vertex));
        }
        numSharp += isSharp(i);
    }
    if (_fine.IsVertexSemiSharp(vertex)) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("vertex {} of the level is semi-sharp; limits need levels on which "
                                "sharpness has faded",
                                vertex));
    }
    if (isInterior && numSharp == 0)
        return {_fine.IsVertexInfSharp(vertex) ? Kind::Corner : Kind::Interior, spoke, k, 0};
    int first = spoke, last = spoke;
    while (!isSharp(first)) first = (first + edges.size() - 1) % edges.size();
    do last = (last + 1) % edges.size();
    while (!isSharp(last));
    Sdc::Crease::Rule const rule = _fine.GetVertexRule(vertex);
    Kind const kind = rule == Sdc::Crease::RULE_CREASE ? Kind::Curve
                      : rule == Sdc::Crease::RULE_DART ? Kind::Dart
                                                       : Kind::Corner;
    int const count = edges.size(), size = (last - first + count) % count;
    return {kind, first, size == 0 ? k : size, (spoke - first + count) % count};
}

EdgeLimits::HalfLimit const& EdgeLimits::FindHalf(Fan const& fan) {
    if (fan.size > kMaxFan) {
        throw Error(ErrorCode::TooLarge,
                    fmt::format("a fan of {} faces; limits along edges are found for up to {}",
                                fan.size, kMaxFan));
    }
    auto const key = std::tuple(fan.kind, fan.size, fan.kind == Kind::Interior ? 0 : fan.spoke);
    auto const found = _halves.find(key);
    if (found != _halves.end()) return found->second;
    HalfSolver const solver(_refiner.GetSchemeType(), fan.kind, fan.size, std::get<2>(key));
    return _halves.emplace(key, solver.Solve()).first->second;
}

/// Adds the value of a refined edge, as weights over the level's.
void EdgeLimits::AddRefined(Index fineEdge, double weight, WeightRow& row) const {
    for (int k = _s1.offsets[fineEdge]; weight != 0.0 && k < _s1.offsets[fineEdge + 1]; ++k)
        row.Add(_s1.indices[k], weight * _s1.weights[k]);
}

/// Adds the limit along the child at `vertex` of a coarse edge, from the vertex to the middle,
/// which is regular: refining once leaves one irregular end to a half [Forms 7.1].
void EdgeLimits::AddHalf(Index vertex, Index edge, double sign, WeightRow& row) {
    Index const v = _coarse.GetVertexChildVertex(vertex), m = _coarse.GetEdgeChildVertex(edge);
    Index const half =
        _coarse.GetEdgeChildEdges(edge)[_coarse.GetEdgeVertices(edge)[0] == vertex ? 0 : 1];
    bool const isSharp = _fine.IsEdgeBoundary(half) || _fine.IsEdgeInfSharp(half);
    if (isSharp && _fine.GetVertexRule(v) != Sdc::Crease::RULE_DART) {
        double const along = sign * GetSignFrom(_fine, half, v);
        WeightRow const curve = FindCurve(_fine, half);
        for (auto const& [index, weight] : curve.GetEntries())
            AddRefined(index, along * weight, row);
        return;
    }
    Fan const fan = FindFan(v, half);
    HalfLimit const& limit = FindHalf(fan);
    auto const add = [&](std::vector<OrientedEdge> const& edges,
                         std::vector<double> const& weights) {
        for (size_t i = 0; i < weights.size(); ++i)
            AddRefined(edges[i].edge, sign * weights[i] * edges[i].sign, row);
    };
    add(ListWheel(_fine, v, fan.first, fan.size), limit.atVertex);
    add(ListWholeWheel(_fine, m, half), limit.atMiddle);
}

WeightRow EdgeLimits::Find(Index edge) {
    auto const ends = _coarse.GetEdgeVertices(edge);
    WeightRow row;
    AddHalf(std::min(ends[0], ends[1]), edge, 1.0, row);
    AddHalf(std::max(ends[0], ends[1]), edge, -1.0, row);
    return row;
}

}  // namespace limn::far_ext
