// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/bake/audit/audit_input.h"
#include "eval/surface/curvature_disc.h"

namespace limn::engine {

/// Discs round the extraordinary vertices of a cage (and the centres of faces that are no quads),
/// where a sum over texels converges badly: Gaussian curvature is unbounded there from valence 5
/// on.
///
/// Weight  A disc takes a share of each texel that falls to zero smoothly at its border. A disc cut
///         out sharply would trade the error at the vertex for a larger one along its border, where
///         texels are in or out by their centre, often a whole column of them at once.
/// Size    The smallest power of two of the domain for which the weight falls over 4 texels or
///         more, so that their sum resolves it, and as much as possible is left to be audited by
///         texels; at most half of the domain, where the neighbour's disc begins. A disc of fewer
///         than 16 texels is not made: they could not even tell its weight.
class ExtraordinaryDiscs {
public:
    /// \param isWanted  per face: whether vertices of it get discs; they must be inner and without
    ///                  infinite sharpness
    ExtraordinaryDiscs(AuditInput const& input, std::vector<char> const& isWanted);

    /// The share of a place's curvature that no disc takes, in [0,1].
    double GetTexelShare(Index face, int domain, double s, double t) const;

    /// Adds each disc's integral of K dA, weighted, to the entry of its faces' component.
    void AddIntegrals(std::vector<int> const& componentOfFace,
                      std::vector<double>& integrals) const;

    size_t GetNumDiscs() const { return _discs.size(); }

private:
    struct Disc {
        std::vector<eval::DiscSector> sectors;  // counter-clockwise
        double integral = 0.0;
    };

    std::vector<eval::DiscSector> FindSectors(Index vertex) const;
    bool ChooseRadius(std::vector<eval::DiscSector>& sectors, UVRaster& raster) const;
    void Integrate();
    double& RadiusAt(eval::DiscSector const& sector) {
        return _radii[_firstOfFace[sector.face] + 4 * static_cast<size_t>(sector.domain) +
                      static_cast<size_t>(sector.corner)];
    }

    AuditInput const& _input;
    std::vector<Disc> _discs;
    std::vector<size_t> _firstOfFace;  // into _radii
    std::vector<double> _radii;        // per face, domain and corner (4 of each); 0 without a disc
};

}  // namespace limn::engine
