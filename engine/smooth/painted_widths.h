// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/images/grey_image.h"
#include "engine/scene/model.h"
#include "engine/smooth/smooth_levels.h"

namespace limn::engine {

/// Filter widths from images through the texture coordinates, black to white from 0 to a width.
class PaintedWidths {
public:
    /// \param path   an image, of which the first channel is taken; with <UDIM> one for each tile,
    ///               without it tile 1001 alone is painted, and the rest of the surface has no
    ///               width
    /// \param white  the width of the value 1
    /// \throws Error BadMesh: no texture coordinates, or none in a tile that can be painted; an
    ///               image that has a value that is negative or not finite.  Io
    static PaintedWidths Read(std::string const& path, double white, Model const& model);

    double GetLargest() const { return _largest; }

    /// Per vertex of the mesh that `levels` made last.
    std::vector<double> Sample(SmoothLevels& levels) const;

private:
    struct Tile {
        int number;
        GreyImage image;
        double Sample(double u, double v) const;
    };

    PaintedWidths() = default;
    void ReadTile(std::string const& path, int number);

    double _white = 0.0, _largest = 0.0;
    std::vector<Tile> _tiles;
    std::vector<int> _tileOfFace;  // per face of the model; -1 outside of all
};

}  // namespace limn::engine
