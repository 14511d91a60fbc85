// SPDX-License-Identifier: Apache-2.0
//
// How a pose stretches the surface: F maps the tangent plane of the rest mesh's limit to that of
// the mesh, at the same place of the same face. s1 >= s2 are its singular values, 1 where nothing
// has changed; R, G, B is the direction on the mesh that s1 stretches along, a line [Bake 5].

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "engine/bake/maps/map_table.h"
#include "engine/scene/same_faces.h"
#include "eval/surface/surface_sample.h"
#include "eval/surface/surface_sampler.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

struct Tangents {
    Eigen::Vector3d s, t;

    /// Bounds the sine of their angle from below, as the sampler does for what it takes as safe.
    bool SpanAPlane() const {
        double const sine = s.cross(t).squaredNorm(), one = s.squaredNorm() * t.squaredNorm();
        return sine > 1e-10 * one && std::isfinite(one);
    }
};

struct Tension {
    double s1 = 0.0, s2 = 0.0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

/// The singular values of F, with F rest.s = posed.s and F rest.t = posed.t.
///
/// \pre rest.SpanAPlane()
Tension FindTension(Tangents const& rest, Tangents const& posed) {
    // In the orthonormal frame e1, e2 of the rest plane with rest.s = p e1, rest.t = q e1 + r e2,
    // the columns of F are F e1 and F e2.
    double const p = rest.s.norm(), q = rest.s.dot(rest.t) / p, r = rest.s.cross(rest.t).norm() / p;
    Eigen::Vector3d const f1 = posed.s / p, f2 = (posed.t - (q / p) * posed.s) / r;
    // F^T F has the squares for eigenvalues, mean +- deviation, and the direction at half the angle
    // of (difference, off).
    double const mean = 0.5 * (f1.squaredNorm() + f2.squaredNorm()),
                 difference = 0.5 * (f1.squaredNorm() - f2.squaredNorm()), off = f1.dot(f2);
    double const deviation = std::sqrt(difference * difference + off * off);
    Tension tension;
    tension.s1 = std::sqrt(mean + deviation);
    if (!(tension.s1 > 0.0)) return tension;
    // det F is the product of both: no cancellation where the surface is squeezed flat.
    tension.s2 = f1.cross(f2).norm() / tension.s1;
    tension.direction = f1;
    if (deviation > 1e-5 * mean) {
        double const c = difference / deviation, s = off / deviation;
        double const large = std::sqrt(0.5 * (1.0 + std::abs(c))),
                     small = 0.5 * std::abs(s) / large;
        double const along = c >= 0.0 ? large : small, across = c >= 0.0 ? small : large;
        tension.direction = along * f1 + (s < 0.0 ? -across : across) * f2;
    }
    if (tension.direction.squaredNorm() > 0.0) tension.direction.normalize();
    return tension;
}

class TensionMap : public Map {
public:
    TensionMap(MapTraits traits, Model const& rest)
        : Map(std::move(traits)), _rest(rest), _restSurface(rest.GetRefiner()) {}

    void Prepare(BakedSurface const& baked, Job&) override {
        _posed = &baked;
        if (HaveSameFaces(baked.model.GetCage(), _rest.GetCage())) return;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: its faces differ from those of '{}'; `rest` needs the same "
                                "faces and vertices in the same order",
                                _rest.GetPath(), baked.model.GetPath()));
    }

    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(*this);
    }

private:
    class Sampler : public MapSampler {
    public:
        explicit Sampler(TensionMap const& map)
            : _restTree(map._restSurface, map._rest.GetPositions(), 3),
              _posedTree(map._posed->surface, map._posed->model.GetPositions(), 3),
              _restSampler(_restTree, eval::Quantity::Tangents, Orientation::Right) {}

        void Start(FaceSamples const& samples) override {
            _samples = samples;
            _rest.resize(samples.s.size());
            _restSampler.Bind(samples.face);
            _restSampler.Evaluate(
                samples.domain, samples.s, samples.t,
                [&](std::span<int const> block, float const* planes, size_t stride) {
                    SampleBlock const rest{block, planes, nullptr, stride, {}};
                    for (size_t i = 0; i < block.size(); ++i) {
                        _rest[block[i]] = {rest.GetVector(eval::kTangentSX, i),
                                           rest.GetVector(eval::kTangentTX, i)};
                    }
                });
        }

        void Evaluate(SampleBlock const& block, float* out, size_t outStride) override {
            for (size_t i = 0; i < block.GetCount(); ++i) {
                int const sample = block.samples[i];
                Tension const tension =
                    _rest[sample].SpanAPlane()
                        ? FindTension(_rest[sample], {block.GetVector(eval::kTangentSX, i),
                                                      block.GetVector(eval::kTangentTX, i)})
                        : FindTensionNearby(_samples.s[sample], _samples.t[sample]);
                out[i] = static_cast<float>(tension.s1);
                out[outStride + i] = static_cast<float>(tension.s2);
                for (size_t c = 0; c < 3; ++c) {
                    out[(2 + c) * outStride + i] =
                        static_cast<float>(tension.direction[static_cast<int>(c)]);
                }
            }
        }

        size_t GetNumDegenerate() const override { return _numDegenerate; }

    private:
        /// Without a tangent plane at rest: towards the domain's middle, until there is one.
        Tension FindTensionNearby(double s, double t) {
            ++_numDegenerate;
            if (_posedTree.GetFace() != _samples.face) _posedTree.Bind(_samples.face);
            double const centre = _restTree.GetCentre();
            for (double step = 0x1p-10; step <= 1.0; step *= 32.0) {
                double const nearS = s + step * (centre - s), nearT = t + step * (centre - t);
                Tangents const rest = Find(_restTree, nearS, nearT);
                if (rest.SpanAPlane()) return FindTension(rest, Find(_posedTree, nearS, nearT));
            }
            return {};  // the face has collapsed
        }

        Tangents Find(eval::FaceTree& tree, double s, double t) const {
            auto const at = eval::EvaluateDerivatives(tree, _samples.domain, s, t);
            return {at.ds, at.dt};
        }

        eval::FaceTree _restTree, _posedTree;
        eval::SurfaceSampler _restSampler;
        FaceSamples _samples{};
        std::vector<Tangents> _rest;  // per sample of the face
        size_t _numDegenerate = 0;
    };

    Model _rest;
    eval::LimitSurface _restSurface;
    BakedSurface const* _posed = nullptr;
};

}  // namespace

std::unique_ptr<Map> MakeTensionMap(std::string const& name, MapOptions const& options,
                                    Model const&) {
    if (!options.rest) throw Error(ErrorCode::BadOption, "`maps` tension needs `rest`, a mesh");
    MapTraits traits{.name = name, .channels = {"s1", "s2", "R", "G", "B"}};
    traits.units = "ratio, direction unit vector";
    traits.range = RangeKind::Positive;
    traits.groups = {{0, 2, Averaging::Plain}, {2, 3, Averaging::Line}};
    traits.quantity = eval::Quantity::Tangents;
    traits.optionText = fmt::format("rest={}", options.rest->GetSha256());
    return std::make_unique<TensionMap>(std::move(traits), *options.rest);
}

}  // namespace limn::engine
