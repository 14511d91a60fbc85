// SPDX-License-Identifier: Apache-2.0
//
// The tangent field of a 1-form, as vectors in object space or as flow in texture coordinates.

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "engine/bake/maps/map_table.h"
#include "engine/field/field_levels.h"
#include "engine/scene/content_hash.h"
#include "eval/forms/field_surface.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

/// d(u,v) along a tangent vector v = a P_s + b P_t.
Eigen::Vector2d FindFlow(SampleBlock const& block, size_t i, Eigen::Vector3d const& v) {
    Eigen::Vector3d const ds = block.GetVector(eval::kTangentSX, i),
                          dt = block.GetVector(eval::kTangentTX, i);
    double const e = ds.squaredNorm(), f = ds.dot(dt), g = dt.squaredNorm(),
                 determinant = e * g - f * f;
    if (!(determinant > 1e-14 * e * g)) return Eigen::Vector2d::Zero();
    double const a = (g * ds.dot(v) - f * dt.dot(v)) / determinant,
                 b = (e * dt.dot(v) - f * ds.dot(v)) / determinant;
    auto const& [us, ut, vs, vt] = block.jacobians[i];
    return {us * a + ut * b, vs * a + vt * b};
}

class FieldMap : public Map {
public:
    FieldMap(MapTraits traits, MapOptions const& options)
        : Map(std::move(traits)), _options(options) {}

    void Prepare(BakedSurface const& baked, Job&) override {
        _field = std::make_unique<eval::FieldSurface>(
            baked.model.GetCage(), baked.model.GetPositions(), *_options.field,
            ChooseFieldLevels(baked.model, baked.width, baked.height), _options.evaluator);
    }

    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(*this);
    }

private:
    class Sampler : public MapSampler {
    public:
        explicit Sampler(FieldMap const& map)
            : _isFlow(map.GetTraits().range == RangeKind::Flow),
              _isNormalized(map._options.isNormalized),
              _field(*map._field) {}

        void Start(FaceSamples const& samples) override {
            _vectors.resize(samples.s.size());
            _field.Evaluate(samples.face, samples.domain, samples.s, samples.t, _vectors);
        }

        void Evaluate(SampleBlock const& block, float* out, size_t outStride) override {
            for (size_t i = 0; i < block.GetCount(); ++i) {
                Eigen::Vector3d vector = _vectors[block.samples[i]];
                if (_isFlow) vector << FindFlow(block, i, vector), 0.0;
                double const length = vector.norm();
                if (_isNormalized && length > 0.0) vector /= length;
                for (int c = 0; c < (_isFlow ? 2 : 3); ++c) {
                    out[static_cast<size_t>(c) * outStride + i] = static_cast<float>(vector[c]);
                }
            }
        }

    private:
        bool _isFlow, _isNormalized;
        eval::FieldSurface::Sampler _field;
        std::vector<Eigen::Vector3d> _vectors;  // per sample of the face
    };

    MapOptions const& _options;
    std::unique_ptr<eval::FieldSurface> _field;
};

}  // namespace

std::unique_ptr<Map> MakeFieldMap(std::string const& name, MapOptions const& options,
                                  Model const&) {
    if (!options.field) {
        throw Error(
            ErrorCode::BadOption,
            "`maps` field needs `field`: a value per edge; in a file, a line v0,v1,value for each");
    }
    if (options.space == VectorSpace::Tangent) {
        throw Error(ErrorCode::BadOption,
                    "`maps` field: use `space` object or uv; its vectors are tangents already");
    }
    bool const isFlow = options.space == VectorSpace::UV;
    MapTraits traits{.name = name, .channels = {"R", "G", "B"}, .units = "as the form per length"};
    traits.range = RangeKind::Vector;
    if (isFlow) {
        traits.channels = {"R", "G"};
        traits.units = "texture coordinates per unit of time";
        traits.range = RangeKind::Flow;
        traits.quantity = eval::Quantity::Tangents;
        traits.needsJacobian = true;
        traits.isComparableAtSeams = false;  // each side has coordinates of its own
    }
    if (options.isNormalized) {
        traits.units = "unit vector";
        traits.groups = {{0, traits.GetNumChannels(), Averaging::UnitVector}};
        if (!isFlow) traits.range = RangeKind::UnitVector;
    }
    traits.optionText = fmt::format("field={} flow={} normalize={}", HashNumbers(*options.field),
                                    isFlow ? "uv" : "object", options.isNormalized) +
                        options.DescribeEvaluator();
    return std::make_unique<FieldMap>(std::move(traits), options);
}

}  // namespace limn::engine
