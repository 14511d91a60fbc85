// SPDX-License-Identifier: Apache-2.0
#include "far_ext/stencils/refined_stencils.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/stencilTableFactory.h>

#include "far_ext/error.h"
#include "far_ext/rings/ring_weights.h"

namespace limn::far_ext {

namespace {

using Mode = RefinedStencilOptions::Mode;
using Level = Far::TopologyLevel;

Index CountPoints(Level const& level, RefinedStencilOptions const& options) {
    return options.mode == Mode::FaceVarying ? level.GetNumFVarValues(options.fvarChannel)
                                             : level.GetNumVertices();
}

Far::ConstIndexArray GetFacePoints(Level const& level, Index face,
                                   RefinedStencilOptions const& options) {
    return options.mode == Mode::FaceVarying ? level.GetFaceFVarValues(face, options.fvarChannel)
                                             : level.GetFaceVertices(face);
}

// -------- one level: rows as PrimvarRefiner blends them

/// What PrimvarRefiner writes to instead of a value: a row's controls and weights.
template <class Real>
struct RecordedRow {
    std::vector<std::pair<Index, Real>>* entries = nullptr;  // of all rows, one after another
    size_t begin = 0;
    int size = 0;

    void Clear() { size = 0; }
    void AddWithWeight(Index control, Real weight) {
        if (weight == Real(0)) return;
        if (size == 0) begin = entries->size();
        auto const own = entries->begin() + static_cast<std::ptrdiff_t>(begin);
        auto const same = std::find_if(own, entries->end(),
                                       [&](auto const& entry) { return entry.first == control; });
        if (same != entries->end()) {
            same->second += weight;
        } else {
            entries->emplace_back(control, weight);
            ++size;
        }
    }
    /// Rows blend into later ones: an edge's takes in those of its faces.
    void AddWithWeight(RecordedRow const& other, Real weight) {
        for (int k = 0; k < other.size; ++k) {
            auto const [control, own] = (*entries)[other.begin + k];
            AddWithWeight(control, weight * own);
        }
    }
};

/// Stands for the control points: point i is its own number.
struct ControlNumbers {
    Index operator[](Index control) const { return control; }
};

template <class Real>
StencilGroups RecordOneLevel(Far::TopologyRefiner const& refiner,
                             RefinedStencilOptions const& options) {
    Index const numRows = CountPoints(refiner.GetLevel(1), options);
    std::vector<std::pair<Index, Real>> entries;
    entries.reserve(size_t{8} * numRows);
    std::vector<RecordedRow<Real>> rows(numRows, RecordedRow<Real>{&entries});
    Far::PrimvarRefinerReal<Real> const primvars(refiner);
    ControlNumbers const controls;
    switch (options.mode) {
        case Mode::Vertex:
            primvars.Interpolate(1, controls, rows);
            break;
        case Mode::Varying:
            primvars.InterpolateVarying(1, controls, rows);
            break;
        case Mode::FaceVarying:
            primvars.InterpolateFaceVarying(1, controls, rows, options.fvarChannel);
            break;
    }
    StencilGroupsBuilder builder(numRows, CountPoints(refiner.GetLevel(0), options), 1);
    std::vector<Index> indices;
    std::vector<float> weights;
    for (Index row = 0; row < numRows; ++row) {
        indices.clear();
        weights.clear();
        for (int k = 0; k < rows[row].size; ++k) {
            auto const& [control, weight] = entries[rows[row].begin + k];
            indices.push_back(control);
            weights.push_back(static_cast<float>(weight));
        }
        builder.AddSingle(row, indices, weights);
    }
    return builder.Finish();
}

// -------- face-varying topology that a face's ring does not determine

/// True if the values round a vertex come in more pieces than there are values: OpenSubdiv's rule
/// for them then depends on where it starts to count the faces.
bool HasValueInSeveralPieces(Level const& level, Index vertex, int channel) {
    auto const faces = level.GetVertexFaces(vertex);
    auto const corners = level.GetVertexFaceLocalIndices(vertex);
    auto const valueAt = [&](int i, int step) {
        auto const values = level.GetFaceFVarValues(faces[i], channel);
        return values[(corners[i] + step + values.size()) % values.size()];
    };
    std::vector<Index> values;
    int numPieces = level.IsVertexBoundary(vertex) ? 1 : 0;
    for (int i = 0; i < faces.size(); ++i) {
        values.push_back(valueAt(i, 0));
        int const next = (i + 1) % faces.size();
        if (next == 0 && level.IsVertexBoundary(vertex)) break;
        numPieces += valueAt(i, 0) != valueAt(next, 0) || valueAt(i, -1) != valueAt(next, 1);
    }
    std::sort(values.begin(), values.end());
    auto const numValues = std::unique(values.begin(), values.end()) - values.begin();
    return numPieces > std::max<std::ptrdiff_t>(numValues, 1);
}

bool IsSetByRings(Level const& level, int channel) {
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (level.IsVertexNonManifold(vertex) || HasValueInSeveralPieces(level, vertex, channel))
            return false;
    }
    return true;
}

/// Far's own table, grouped afterwards.
StencilGroups GroupFarTable(Far::TopologyRefiner const& refiner,
                            RefinedStencilOptions const& options) {
    using Factory = Far::StencilTableFactoryReal<float>;
    Factory::Options farOptions;
    switch (options.mode) {
        case Mode::Vertex:
            farOptions.interpolationMode = Factory::INTERPOLATE_VERTEX;
            break;
        case Mode::Varying:
            farOptions.interpolationMode = Factory::INTERPOLATE_VARYING;
            break;
        case Mode::FaceVarying:
            farOptions.interpolationMode = Factory::INTERPOLATE_FACE_VARYING;
            break;
    }
    farOptions.generateIntermediateLevels = false;
    farOptions.generateOffsets = true;
    farOptions.fvarChannel = static_cast<unsigned>(options.fvarChannel);
    std::unique_ptr<Far::StencilTableReal<float> const> const table(
        Factory::Create(refiner, farOptions));
    return GroupRows(ViewStencils(*table));
}

// -------- more levels: by face

/// Walks the base faces and gives every refined point to the first face that has it.
class FaceWalk {
public:
    FaceWalk(Far::TopologyRefiner const& refiner, RefinedStencilOptions const& options)
        : _refiner(refiner),
          _options(options),
          _depth(refiner.GetMaxLevel()),
          _base(refiner.GetLevel(0)),
          _fine(refiner.GetLevel(_depth)),
          _lattices(refiner.GetSchemeType()),
          _weights(refiner, options.mode == Mode::Varying, _lattices),
          _gatherer(_base, refiner.GetSchemeOptions(),
                    options.mode == Mode::FaceVarying ? options.fvarChannel : -1),
          _isDone(CountPoints(_fine, options), 0),
          _builder(CountPoints(_fine, options), CountPoints(_base, options), 1) {}

    /// None if so many rings differ that Far's table costs less.
    std::optional<StencilGroups> Build() {
        constexpr size_t kRowsPerRing = 256;  // of Far's table take as long as one ring
        constexpr size_t kFewRings = 1024;    // take no time to speak of
        for (Index face = 0; face < _base.GetNumFaces(); ++face) {
            AddFace(face);
            if (_parts.size() > kFewRings && _parts.size() * kRowsPerRing > _isDone.size())
                return {};
        }
        AddUnusedPoints();
        return _builder.Finish();
    }

private:
    /// Weights of some points of a ring's lattice, as a block; or of one point, as a single row.
    struct Part {
        int block = -1;
        std::vector<int> columns;    // of the ring's points
        std::vector<float> weights;  // of a single row
    };
    struct RingParts {
        Part inside;
        std::vector<Part> edges, corners;
    };

    void AddFace(Index face) {
        _gatherer.Gather(face, _ring, _points);
        RingParts const& parts = GetParts(_ring);
        FaceLattice const& lattice = _lattices.Get(_ring.GetFaceSizes()[0], _depth);
        Index first = face;
        for (int level = 0; level < _depth; ++level)
            first = _refiner.GetLevel(level).GetFaceChildFaces(first)[0];
        AddPart(parts.inside, lattice, lattice.inside, first);
        for (size_t i = 0; i < parts.edges.size(); ++i)
            AddPart(parts.edges[i], lattice, lattice.onEdge[i], first);
        for (size_t i = 0; i < parts.corners.size(); ++i)
            AddPart(parts.corners[i], lattice, {lattice.atCorner[i]}, first);
    }

    void AddPart(Part const& part, FaceLattice const& lattice, std::vector<int> const& points,
                 Index first) {
        _rows.clear();
        for (int point : points) {
            auto const [face, corner] = lattice.places[point];
            _rows.push_back(GetFacePoints(_fine, first + face, _options)[corner]);
        }
        if (_rows.empty() || _isDone[_rows[0]]) return;  // edges and corners are shared as a whole
        for (Index row : _rows) _isDone[row] = 1;
        _controls.clear();
        for (int column : part.columns) _controls.push_back(_points[column]);
        if (part.block >= 0) {
            _builder.AddGroup(part.block, _rows, _controls);
            return;
        }
        size_t const size = part.columns.size();
        for (size_t i = 0; i < _rows.size(); ++i) {
            AddSingle(_rows[i], part.weights.data() + i * size);
        }
    }

    /// A row of weights over _controls, without its zeros.
    void AddSingle(Index row, float const* weights) {
        _singleControls.clear();
        _singleWeights.clear();
        for (size_t i = 0; i < _controls.size(); ++i) {
            if (weights[i] == 0.0f) continue;
            _singleControls.push_back(_controls[i]);
            _singleWeights.push_back(weights[i]);
        }
        _builder.AddSingle(row, _singleControls, _singleWeights);
    }

    RingParts const& GetParts(FaceRing const& ring) {
        auto& node = _weights.Find(ring);
        auto const [found, isNew] = _parts.try_emplace(&node);
        RingParts& parts = found->second;
        if (!isNew) return parts;
        DenseRows const& rows = _weights.Get(node, _depth);
        FaceLattice const& lattice = _lattices.Get(ring.GetFaceSizes()[0], _depth);
        parts.inside = MakePart(rows, lattice.inside);
        for (auto const& points : lattice.onEdge) parts.edges.push_back(MakePart(rows, points));
        for (int point : lattice.atCorner) parts.corners.push_back(MakePart(rows, {point}));
        return parts;
    }

    Part MakePart(DenseRows const& rows, std::vector<int> const& points) {
        Part part;
        for (int column = 0; column < rows.numColumns; ++column) {
            auto const uses = [&](int point) {
                return static_cast<float>(rows[point][column]) != 0.0f;
            };
            if (std::any_of(points.begin(), points.end(), uses)) part.columns.push_back(column);
        }
        for (int point : points) {
            for (int column : part.columns)
                part.weights.push_back(static_cast<float>(rows[point][column]));
        }
        constexpr size_t kLeastRows = 3;  // the three of an edge refined twice
        if (points.size() >= kLeastRows && part.columns.size() <= StencilGroups::kMaxColumns) {
            part.block = _builder.AddBlock(static_cast<int>(points.size()),
                                           static_cast<int>(part.columns.size()), part.weights);
        }
        return part;
    }

    /// Vertices without faces have no rule but to stay.
    void AddUnusedPoints() {
        if (_options.mode == Mode::FaceVarying) return;
        float const one = 1.0f;
        for (Index vertex = 0; vertex < _base.GetNumVertices(); ++vertex) {
            if (_base.GetVertexFaces(vertex).size() != 0) continue;
            Index row = vertex;
            for (int level = 0; level < _depth && row >= 0; ++level)
                row = _refiner.GetLevel(level).GetVertexChildVertex(row);
            if (row < 0) continue;
            _controls = {vertex};
            AddSingle(row, &one);
        }
    }

    Far::TopologyRefiner const& _refiner;
    RefinedStencilOptions _options;
    int _depth;
    Level _base, _fine;  // views
    LatticeCache _lattices;
    RingWeights _weights;
    FaceRingGatherer _gatherer;
    std::vector<char> _isDone;
    StencilGroupsBuilder _builder;
    std::unordered_map<RingWeights::Node const*, RingParts> _parts;
    FaceRing _ring;  // scratch from here on
    std::vector<Index> _points, _rows, _controls, _singleControls;
    std::vector<float> _singleWeights;
};

}  // namespace

StencilGroups BuildRefinedStencils(Far::TopologyRefiner const& refiner,
                                   RefinedStencilOptions const& options) {
    if (!refiner.IsUniform() || refiner.GetMaxLevel() < 1) {
        throw Error(
            ErrorCode::BadOption,
            "stencils are built for a topology that is refined uniformly, to level 1 or more");
    }
    int const numChannels = refiner.GetNumFVarChannels();
    if (options.mode == Mode::FaceVarying &&
        (options.fvarChannel < 0 || options.fvarChannel >= numChannels)) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("there is no face-varying channel {}; the topology has {}",
                                options.fvarChannel, numChannels));
    }
    if (refiner.GetMaxLevel() == 1) {
        // Loop's weights come from a cosine, whose last bits depend on the CPU: rounded from double
        // they do not.
        bool const isLoop = refiner.GetSchemeType() == Sdc::SCHEME_LOOP;
        return isLoop ? RecordOneLevel<double>(refiner, options)
                      : RecordOneLevel<float>(refiner, options);
    }
    std::optional<StencilGroups> groups;
    if (options.mode != Mode::FaceVarying ||
        IsSetByRings(refiner.GetLevel(0), options.fvarChannel)) {
        groups = FaceWalk(refiner, options).Build();
    }
    return groups ? std::move(*groups) : GroupFarTable(refiner, options);
}

}  // namespace limn::far_ext
