// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/types.h"

namespace limn::eval {

class RingCache;

/// How the limit surface of a cage is put together, without any values: which faces have a limit,
/// which of them are one polynomial patch, and the rings of those that are asked for. Works for
/// vertex topology and for one face-varying channel (whose values form a limit surface of their
/// own).
///
/// Domains  A quad (Loop: a triangle) has one domain, (s,t) in [0,1]^2 (Loop: s + t <= 1). Another
///          polygon has one domain per corner, its sub-quad with (0,0) at the corner and (1,1) at
///          the face's centre.
/// Threads  Immutable once built but for the cache of rings, which guards itself.
/// Memory   A byte per face, and rings up to `mostRingBytes`.
class LimitSurface {
public:
    /// A dense scan's triangles have some thousand different rings of 10 KB, one vertex of 512
    /// faces has rings of 0.2 GB.
    static constexpr size_t kMostRingBytes = size_t{1} << 26;

    /// \param refiner      unrefined base topology, kept by reference: it must outlive the surface
    /// \param fvarChannel  face-varying channel, or -1 for vertices
    /// \param mostRingBytes  memory for rings; no value depends on it
    /// \throws Error       BadOption: a channel that there is not. TooLarge: what FindExcess finds
    explicit LimitSurface(Far::TopologyRefiner const& refiner, int fvarChannel = -1,
                          size_t mostRingBytes = kMostRingBytes);
    ~LimitSurface();
    LimitSurface(LimitSurface&&) noexcept;

    /// A ring's matrices take time and memory that grow with the third power of its size: 2 s and
    /// 0.2 GB at 512 faces, 2 s and 1.4 GB at 256 corners, eight times as much at twice as many.
    static constexpr int kMaxValence = 512, kMaxCorners = 256;

    /// A vertex with more faces, or a face with more corners than that.
    struct Excess {
        bool isFace;
        Index element;
        int count;

        /// "face 3 has 300 corners; ...", where NAME is "face 3"
        std::string Describe(std::string const& name) const;
    };
    /// The first, if there is one.
    static std::optional<Excess> FindExcess(Far::TopologyRefiner const& refiner, int level = 0);
    /// \throws Error  TooLarge: there is one
    static void CheckExcess(Far::TopologyRefiner const& refiner, int level = 0);

    /// False for holes and, with boundary rule none, for faces at a boundary.
    bool HasLimit(Index face) const { return _kinds[face] != FaceKind::None; }
    int GetNumDomains(Index face) const;
    Index GetNumFaces() const { return static_cast<Index>(_kinds.size()); }

    /// Refuses an array that does not reach all control points, which are the vertices or the
    /// channel's values.
    ///
    /// \param length  numbers per control point
    /// \throws Error  BadOption
    void CheckValues(std::span<double const> values, int length) const;

    bool IsLoop() const { return _refiner.GetSchemeType() == Sdc::SCHEME_LOOP; }

    /// True if the face is a plain patch of the face's own surroundings: no ring needed.
    bool IsPlainPatch(Index face) const { return _kinds[face] == FaceKind::Plain; }

    Far::TopologyRefiner const& GetRefiner() const { return _refiner; }
    int GetFVarChannel() const { return _channel; }

private:
    friend class FaceTree;
    enum class FaceKind : char { None, Plain, Ring };

    void Classify();
    void GatherPlainPoints(Index face, Index* points) const;

    Far::TopologyRefiner const& _refiner;
    int _channel;
    std::unique_ptr<RingCache> _cache;
    std::vector<FaceKind> _kinds;
};

}  // namespace limn::eval
