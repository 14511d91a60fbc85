// SPDX-License-Identifier: Apache-2.0
//
// How large the surface is where the texture maps it, against the mean over all that is baked: log2
// of (surface area per texture area) over its mean.

#include <cmath>

#include <Eigen/Geometry>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "engine/bake/maps/map_table.h"
#include "engine/bake/maps/portable_math.h"
#include "engine/bake/raster/uv_raster.h"
#include "eval/surface/surface_place.h"
#include "eval/surface/surface_sample.h"

namespace limn::engine {

namespace {

struct Areas {
    double surface = 0.0, texture = 0.0;
};

/// Both areas of one face, by cubature.
struct AreaFinder {
    explicit AreaFinder(BakedSurface const& baked)
        : surface(baked.surface),
          tree(baked.surface, baked.model.GetPositions(), 3),
          raster(baked.uvSurface, baked.model.GetUVs()) {}

    Areas Find(Index face) {
        Areas areas;
        tree.Bind(face);
        raster.Bind(face);
        eval::ForEachGaussPoint(surface, face, [&](eval::SurfacePlace const& place, double weight) {
            auto const sample = eval::EvaluateSample(tree, place.domain, place.s, place.t);
            auto const [us, ut, vs, vt] = raster.GetJacobian(place.domain, place.s, place.t);
            areas.surface += weight * sample.tangentS.cross(sample.tangentT).norm();
            areas.texture += weight * std::abs(us * vt - ut * vs);
        });
        return areas;
    }

    eval::LimitSurface const& surface;
    eval::FaceTree tree;
    UVRaster raster;
};

/// Surface area over texture area of all that is baked; 1 without any.
double FindMeanArea(BakedSurface const& baked, Job& job) {
    std::vector<Areas> areas(baked.isBaked.size());
    tbb::enumerable_thread_specific<AreaFinder> finders([&] { return AreaFinder(baked); });
    tbb::parallel_for(tbb::blocked_range<Index>(0, static_cast<Index>(areas.size()), 64),
                      [&](auto const& range) {
                          job.CheckStopped();
                          for (Index face = range.begin(); face != range.end(); ++face) {
                              if (baked.isBaked[face]) areas[face] = finders.local().Find(face);
                          }
                      });
    Areas total;
    for (Areas const& face : areas) {  // in order: the same sum for any number of threads
        total.surface += face.surface;
        total.texture += face.texture;
    }
    bool const hasArea = total.texture > 0.0 && total.surface > 0.0;
    return hasArea ? total.surface / total.texture : 1.0;
}

class StretchMap : public Map {
public:
    using Map::Map;

    void Prepare(BakedSurface const& baked, Job& job) override {
        _meanArea = FindMeanArea(baked, job);
    }

    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(_meanArea);
    }

private:
    class Sampler : public MapSampler {
    public:
        explicit Sampler(double meanArea) : _meanArea(meanArea) {}

        void Evaluate(SampleBlock const& block, float* out, size_t) override {
            for (size_t i = 0; i < block.GetCount(); ++i) {
                auto const& [us, ut, vs, vt] = block.jacobians[i];
                double const area = block.GetVector(eval::kTangentSX, i)
                                        .cross(block.GetVector(eval::kTangentTX, i))
                                        .norm();
                double const texture = std::abs(us * vt - ut * vs);
                out[i] = ToStretch(area / (texture * _meanArea));
            }
        }

    private:
        /// A point without area or without texture area has no stretch; the bounds keep it a
        /// number.
        static float ToStretch(double ratio) {
            if (!(ratio > 0x1p-60)) return -60.0f;
            return ratio < 0x1p60 ? PortableLog2(static_cast<float>(ratio)) : 60.0f;
        }

        double _meanArea;
    };

    double _meanArea = 1.0;  // surface area per texture area
};

}  // namespace

std::unique_ptr<Map> MakeStretchMap(std::string const& name, MapOptions const&, Model const&) {
    MapTraits traits{.name = name, .channels = {"Y"}, .units = "log2"};
    traits.quantity = eval::Quantity::Tangents;
    traits.needsJacobian = true;
    return std::make_unique<StretchMap>(std::move(traits));
}

}  // namespace limn::engine
