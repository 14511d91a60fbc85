// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>

#include "far_ext/types.h"
#include "harness.h"

namespace limn::bench {

namespace Bfr = OpenSubdiv::Bfr;

/// OpenSubdiv's base-face representation in float: one surface per face, made when its samples
/// come.
class BfrSurfaces {
public:
    static constexpr int kLength = 18;  ///< floats per sample: P, Ps, Pt, Pss, Pst, Ptt

    BfrSurfaces(Far::TopologyRefiner const& refiner, std::span<double const> positions)
        : _factory(refiner), _positions(positions.begin(), positions.end()) {}

    void Bind(Index face) {
        Check(_factory.InitVertexSurface(face, &_surface), "Bfr finds no surface");
        _points.resize(static_cast<size_t>(_surface.GetNumPatchPoints()) * 3);
        _surface.PreparePatchPoints(_positions.data(), Descriptor(3), _points.data(),
                                    Descriptor(3));
    }

    void Evaluate(double s, double t, float* out) {
        float const st[2] = {static_cast<float>(s), static_cast<float>(t)};
        _surface.Evaluate(st, _points.data(), Descriptor(3), out, out + 3, out + 6, out + 9,
                          out + 12, out + 15);
    }

private:
    using Descriptor = Bfr::Surface<float>::PointDescriptor;

    Bfr::RefinerSurfaceFactory<> _factory;
    Bfr::Surface<float> _surface;
    std::vector<float> _positions, _points;
};

}  // namespace limn::bench
