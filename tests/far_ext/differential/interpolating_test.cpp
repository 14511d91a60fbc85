// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/interpolating.h"

#include <map>

#include <gtest/gtest.h>

#include "far_ext/differential/subdivision_rows.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

/// Rows of a lattice of 7 x 7 faces, or twice as many triangles; vertex (i, j) is 8 j + i.
class InterpolatingOn {
public:
    explicit InterpolatingOn(Sdc::SchemeType scheme)
        : _refiner(test::MakeRefiner(MakeCage(scheme), 1)),
          _rows(far_ext::BuildSubdivisionRows(*_refiner, 1,
                                              far_ext::SubdivisionRule::Interpolating)) {}

    static Index At(int i, int j) { return 8 * j + i; }

    /// The weights, by how many control vertices have each.
    std::map<double, int> CountEdgeWeights(Index a, Index b) const {
        return Count(
            _refiner->GetLevel(0).GetEdgeChildVertex(_refiner->GetLevel(0).FindEdge(a, b)));
    }
    std::map<double, int> CountFaceWeights(Index face) const {
        return Count(_refiner->GetLevel(0).GetFaceChildVertex(face));
    }

private:
    static engine::Scene MakeCage(Sdc::SchemeType scheme) {
        auto scene = test::MakeLattice(7, 7, scheme);
        scene.cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
        return scene;
    }

    std::map<double, int> Count(Index row) const {
        std::map<double, int> counts;
        for (int k = _rows.offsets[row]; k < _rows.offsets[row + 1]; ++k)
            ++counts[std::round(_rows.weights[k] * 0x1p20) / 0x1p20];
        return counts;
    }

    std::unique_ptr<Far::TopologyRefiner> _refiner;
    far_ext::SparseRows _rows;
};

// Ten points, those of a Butterfly with w = -1/32 (ends 1/2, wings and beyond), times 32: 17 on the
// ends, 2 on both opposite vertices, -1 on the six other neighbours.
TEST(Interpolating, LoopsRegularEdgesHaveTenPoints) {
    using On = InterpolatingOn;
    On const rule(Sdc::SCHEME_LOOP);
    std::map<double, int> const expected{{17.0 / 32, 2}, {2.0 / 32, 2}, {-1.0 / 32, 6}};
    EXPECT_EQ(rule.CountEdgeWeights(On::At(3, 3), On::At(4, 3)), expected);
    EXPECT_EQ(rule.CountEdgeWeights(On::At(3, 3), On::At(4, 4)), expected);
}

TEST(Interpolating, CatmullClarksRegularRowsAreThePrinciples) {
    using On = InterpolatingOn;
    On const rule(Sdc::SCHEME_CATMARK);
    std::map<double, int> const edge{
        {70.0 / 128, 2}, {-6.0 / 128, 2}, {1.0 / 128, 4}, {-1.0 / 128, 4}},
        face{{79.0 / 256, 4}, {-7.0 / 256, 8}, {-1.0 / 256, 4}};
    EXPECT_EQ(rule.CountEdgeWeights(On::At(3, 3), On::At(4, 3)), edge);
    EXPECT_EQ(rule.CountFaceWeights(7 * 3 + 3), face);
}

// Boundaries are cubic B-splines, of which the principle makes four points; at a corner, which
// stays, the curve is reflected.
TEST(Interpolating, BoundariesHaveFourPoints) {
    using On = InterpolatingOn;
    for (auto scheme : {Sdc::SCHEME_LOOP, Sdc::SCHEME_CATMARK}) {
        On const rule(scheme);
        std::map<double, int> const inner{{9.0 / 16, 2}, {-1.0 / 16, 2}},
            atCorner{{7.0 / 16, 1}, {10.0 / 16, 1}, {-1.0 / 16, 1}};
        EXPECT_EQ(rule.CountEdgeWeights(On::At(3, 0), On::At(4, 0)), inner);
        EXPECT_EQ(rule.CountEdgeWeights(On::At(7, 0), On::At(7, 1)), atCorner);
    }
}

// Bilinear steps move no vertex, so that there is nothing to move back.
TEST(Interpolating, OfABilinearStepIsThatStep) {
    auto const scene = test::MakeDodecahedron();
    auto bilinear = scene;
    bilinear.cage.scheme = Sdc::SCHEME_BILINEAR;
    auto const refiner = test::MakeRefiner(bilinear, 1);
    auto const apply = [&](far_ext::SubdivisionRule rule) {
        return test::Apply(far_ext::BuildSubdivisionRows(*refiner, 1, rule), scene.positions);
    };
    EXPECT_LT(test::LargestDifference(apply(far_ext::SubdivisionRule::Interpolating),
                                      apply(far_ext::SubdivisionRule::Scheme)),
              1e-15);
}

}  // namespace
}  // namespace limn
