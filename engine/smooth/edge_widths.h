// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/scene/model.h"
#include "engine/smooth/smooth_levels.h"

namespace limn::engine {

/// Filter widths near edges of the control mesh: the edge's width up to a distance of one width,
/// from there down to 0 at three; 0 elsewhere. Faces further away do not move.
class EdgeWidths {
public:
    struct Edge {
        std::array<Index, 2> ends;
        double sigma;
    };

    /// \throws Error  BadMesh: an edge that does not exist, a width that is no number from 0 up
    EdgeWidths(Model const& model, std::vector<Edge> edges);

    /// A table `v0,v1,width`.
    ///
    /// \throws Error  BadMesh: an edge that does not exist or comes twice, a width that is
    ///                negative.  Io
    static EdgeWidths Read(std::string const& path, Model const& model);

    double GetLargest() const;

    /// Per vertex of the mesh that `levels` made last.
    ///
    /// \param positions  of the start surface on that level
    std::vector<double> Sample(SmoothLevels const& levels,
                               std::vector<double> const& positions) const;

private:
    void ReachFaces(Model const& model);

    std::vector<Edge> _edges;                                     // of a width above 0
    std::vector<std::array<std::array<double, 3>, 2>> _segments;  // where they lie
    std::vector<std::vector<int>> _edgesNearFace;                 // per face of the model
};

}  // namespace limn::engine
