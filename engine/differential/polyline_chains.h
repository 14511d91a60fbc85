// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace limn::engine {

/// Vertices in the order in which a line passes them. One that ends where it begins is closed, and
/// has that vertex twice.
struct Polyline {
    std::vector<size_t> vertices;
    uint32_t line = 0;  ///< of the file; of a chain, that of the first in the file

    bool IsClosed() const { return vertices.size() > 1 && vertices.front() == vertices.back(); }
};

/// Joins polylines that end at the same vertex into chains and loops, so that one cut into edges is
/// whole again.
class PolylineChains {
public:
    explicit PolylineChains(std::vector<Polyline> polylines) : _pieces(std::move(polylines)) {}

    /// A vertex at which lines branch, and who came last to it.
    struct Branch {
        size_t vertex;
        uint32_t line;
    };

    /// The first vertex, by the order of the pieces, at which three end, or one ends on another.
    /// Lines may pass through each other.
    std::optional<Branch> FindBranch();

    /// The chains, in the order and direction of their first pieces; an open one begins at an end.
    ///
    /// \pre FindBranch has found none
    std::vector<Polyline> Join();

private:
    /// One of a piece's two ends.
    struct End {
        size_t piece;
        bool isBack;

        bool operator==(End const&) const = default;
    };
    struct Joint {
        int numEnds = 0, numPassing = 0;
        End ends[2];
    };

    size_t GetVertex(End end) const;
    std::optional<End> FindPartner(End end) const;
    End FindStart(size_t piece) const;
    Polyline WalkFrom(End start);
    void Meet(size_t piece);

    std::vector<Polyline> _pieces;
    std::vector<Joint> _joints;   // per vertex
    std::vector<char> _isJoined;  // per piece
};

}  // namespace limn::engine
