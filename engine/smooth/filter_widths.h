// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "engine/scene/scene.h"
#include "engine/smooth/smooth_levels.h"

namespace limn::engine {

/// The width (sigma, in mesh units) of a geometric filter, by place. One of four kinds:
///
/// Constant     everywhere the same.
/// At vertices  of the control mesh; linear between them, and filtered along with the surface
///              ([Diewald02] Sec. 8).
/// On edges     of the control mesh: the edge's width up to a distance of one width, from there
///              down to 0 at three; 0 elsewhere. Faces further away do not move.
/// Textured     an image through the texture coordinates, black to white from 0 to a width.
///
/// The last two are evaluated anew on every level, and not filtered.
class FilterWidths {
public:
    static FilterWidths Constant(double width);

    /// \param widths  per vertex of the scene
    static FilterWidths AtVertices(std::vector<double> widths);

    /// Mean length of the edges at each vertex, times a scale. \param level  the scene's topology
    static FilterWidths LocalEdgeLengths(Scene const& scene, Far::TopologyLevel const& level,
                                         double scale);

    /// A table `vertex,width`; 0 at vertices that are not listed.
    ///
    /// \throws Error  BadMesh: a vertex that does not exist or comes twice, a width that is
    ///                negative.  Io
    static FilterWidths ReadMap(std::string const& path, Scene const& scene);

    /// A table `v0,v1,width`.
    ///
    /// \throws Error  BadMesh: an edge that does not exist or comes twice, a width that is
    ///                negative.  Io
    static FilterWidths ReadEdges(std::string const& path, Scene const& scene,
                                  Far::TopologyLevel const& level);

    /// \param path   an image, of which the first channel is taken; with <UDIM> one for each tile,
    ///               without it tile 1001 alone is painted, and the rest of the surface has no
    ///               width
    /// \param width  of the value 1
    /// \throws Error BadMesh: no texture coordinates, an image that has a value that is negative or
    ///               not finite.  Io
    static FilterWidths ReadTexture(std::string const& path, double width, Scene const& scene);

    bool IsConstant() const { return _constant >= 0.0; }
    double GetConstant() const { return _constant; }
    std::vector<double> const& GetAtVertices() const { return _atVertices; }
    double GetLargest() const { return _largest; }

    /// Per vertex of the mesh that `levels` made last; empty where the kind is not evaluated anew.
    ///
    /// \param positions  of the start surface on that level
    std::vector<double> SampleLevel(SmoothLevels& levels,
                                    std::vector<double> const& positions) const;

    /// A factor on all of it.
    FilterWidths Scaled(double factor) const;

private:
    struct Edge {
        std::array<Index, 2> ends;
        double width;
    };
    struct Image {
        int tile, width, height;
        std::vector<float> values;
        double Sample(double u, double v) const;
    };

    void ReachFaces(Scene const& scene, Far::TopologyLevel const& level);
    std::vector<double> SampleEdges(SmoothLevels const& levels,
                                    std::vector<double> const& positions) const;
    std::vector<double> SampleTexture(SmoothLevels& levels) const;

    double _constant = -1.0, _largest = 0.0, _factor = 1.0;
    std::vector<double> _atVertices;
    std::vector<Edge> _edges;
    std::vector<std::array<std::array<double, 3>, 2>> _segments;  // where the edges lie
    std::vector<std::vector<int>> _edgesNearFace;                 // per face of the scene
    std::vector<Image> _images;
    std::vector<int> _tileOfFace;
    double _textureWidth = 0.0;
};

}  // namespace limn::engine
