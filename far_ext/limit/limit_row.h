// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "far_ext/rings/face_ring.h"
#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// Generalised Catmull-Clark: the vertex rule (n-2)/n V + (1/n^2) sum [alpha V + (1-alpha) E] +
/// (1/n^2) sum F', at smooth interior vertices; 0 is Catmull-Clark.
///
/// Source  [LaiCheng11] Appendix A. The paper's matrix is that of FirstStep; Stationary has its
///         own.
struct LimitOptions {
    enum class AlphaRule {
        FirstStep,  ///< alpha in the first refinement, plain Catmull-Clark afterwards
        Stationary  ///< alpha in every refinement
    };
    double alpha = 0.0;
    AlphaRule alphaRule = AlphaRule::FirstStep;
};

/// One row of the limit matrix A: the limit point of a vertex as weights over the vertex itself,
/// its edge neighbours and the other vertices of its faces.
struct LimitRow {
    enum class Kind : unsigned char {
        Fixed,   ///< the vertex is its own limit: a sharp corner, or no face round it has a limit
                 ///< surface
        Curve,   ///< on a boundary or an infinitely sharp crease: only the curve counts
        Smooth,  ///< the closed form of a smooth interior vertex
        Other    ///< by OpenSubdiv's rules: semi-sharp, dart, non-manifold
    };

    Kind kind = Kind::Fixed;
    int numEdges = 0;    ///< so many of `indices` are edge neighbours (smooth and curve rows)
    double scale = 1.0;  ///< row of D; D A is symmetric among smooth rows
    bool isEvenCubic =
        false;  ///< smooth, valence 3, all faces with an even number of sides, alpha 0

    double centre = 1.0;             ///< weight of the vertex itself
    double edge = 0.0, other = 0.0;  ///< weights of all others, where `weights` is empty
    std::vector<Index> indices;      ///< edge neighbours first; one may come twice
    std::vector<double> weights;     ///< one per index, or empty

    bool IsUniform() const { return weights.empty(); }
    double GetWeight(size_t k) const {
        if (!IsUniform()) return weights[k];
        return static_cast<int>(k) < numEdges ? edge : other;
    }
};

/// Makes the rows of A of one level, straight from its topology.
///
/// Order    any; asking for the vertices in order reads memory in order.
/// Exact    where OpenSubdiv's Limit is not: interior vertices of valence 2, and darts (Limit takes
///          their mask for that of a smooth vertex).
/// Source   [Limit 2], [Limit 3], [Limit 4]; checked against OpenSubdiv.
class LimitRowBuilder {
public:
    /// \param refiner  kept by reference; its level with all relations (a base level has them)
    /// \throws Error   BadOption: alpha outside [0, 1], or with another scheme than Catmull-Clark
    LimitRowBuilder(Far::TopologyRefiner const& refiner, int level,
                    LimitOptions const& options = {});

    void Build(Index vertex, LimitRow& row);

    Index GetNumVertices() const { return _level.GetNumVertices(); }

private:
    struct CornerKey {
        FaceRing ring;
        int corner;
        bool operator==(CornerKey const&) const = default;
    };
    struct CornerHash {
        size_t operator()(CornerKey const& key) const { return key.ring.GetHash() + key.corner; }
    };

    LimitRow::Kind Classify(Index vertex) const;
    void BuildCatmark(Index vertex, LimitRow& row) const;
    void BuildLoop(Index vertex, LimitRow& row);
    void BuildCurve(Index vertex, LimitRow& row) const;
    void BuildOther(Index vertex, LimitRow& row);
    bool HasLimit(Index vertex) const;

    Far::TopologyRefiner const& _refiner;
    Far::TopologyLevel _level;
    LimitOptions _options;
    std::vector<double> _loopChi;  // by valence; 0 until needed
    std::unique_ptr<FaceRingGatherer> _gatherer;
    std::unordered_map<CornerKey, WeightRow, CornerHash> _corners;
};

}  // namespace limn::far_ext
