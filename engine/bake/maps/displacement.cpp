// SPDX-License-Identifier: Apache-2.0
//
// The way from the limit surface to that of another mesh, of the same faces or of these refined.

#include <optional>

#include <fmt/format.h>

#include "engine/bake/maps/map_table.h"
#include "engine/bake/maps/vector_frame.h"
#include "engine/scene/extent.h"
#include "engine/scene/same_faces.h"
#include "engine/scene/subdivision_names.h"
#include "eval/surface/finer_surface.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

class DisplacementMap : public Map {
public:
    DisplacementMap(MapTraits traits, MapOptions const& options)
        : Map(std::move(traits)), _other(*options.against), _frame(options) {}

    void Prepare(BakedSurface const& baked, Job&) override {
        _positions = Subtract(_other.GetPositions(), baked.floatOrigin);
        if (HaveSameFaces(baked.model.GetCage(), _other.GetCage())) return;
        _finer = eval::FinerSurface::Build(baked.surface, baked.model.GetCage(), _other.GetCage(),
                                           _positions);
        if (_finer) return;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: its faces differ from those of '{}'; `against` needs the same "
                                "faces and vertices in the same order, or these refined by the "
                                "same `scheme` ({})",
                                _other.GetPath(), baked.model.GetPath(),
                                kSchemeWords.GetWord(baked.model.GetCage().scheme)));
    }

    std::vector<eval::FaceTree::Values> GetValues() const override {
        if (_finer) return {};
        return {{_positions, 3}};
    }

    std::unique_ptr<MapSampler> MakeSampler() const override {
        return std::make_unique<Sampler>(*this);
    }

private:
    class Sampler : public MapSampler {
    public:
        explicit Sampler(DisplacementMap const& map) : _frame(map._frame) {
            if (map._finer) _finer.emplace(*map._finer);
        }

        void Start(FaceSamples const& samples) override {
            if (!_finer) return;
            _points.resize(samples.s.size());
            _finer->Evaluate(samples.face, samples.domain, samples.s, samples.t, _points);
        }

        void Evaluate(SampleBlock const& block, float* out, size_t outStride) override {
            for (size_t i = 0; i < block.GetCount(); ++i) {
                Eigen::Vector3d const there =
                    _finer ? _points[block.samples[i]] : block.GetValue(0, i);
                _frame.Put(block, i, there - block.GetVector(eval::kPositionX, i), out, outStride);
            }
        }

        TangentialPart TakeTangentialPart() override { return _frame.TakeTangentialPart(); }

    private:
        VectorFrame _frame;
        std::optional<eval::FinerSurface::Sampler> _finer;
        std::vector<Eigen::Vector3d> _points;  // on the finer surface, per sample of the face
    };

    Model _other;
    VectorFrame _frame;
    std::vector<double> _positions;  // the other mesh's, relative to the same origin as samples
    std::optional<eval::FinerSurface> _finer;  // where the other mesh's faces are refined ones
};

}  // namespace

std::unique_ptr<Map> MakeDisplacementMap(std::string const& name, MapOptions const& options,
                                         Model const&) {
    if (!options.against) {
        throw Error(ErrorCode::BadOption, "`maps` displacement needs `against`, a mesh");
    }
    MapTraits traits{.name = name, .channels = {"Y"}, .units = "length"};
    if (options.isVector) {
        traits.channels = {"R", "G", "B"};
        traits.range = RangeKind::Vector;
    }
    traits.against = options.against->GetSha256();
    VectorFrame(options).AddNeeds(traits);
    return std::make_unique<DisplacementMap>(std::move(traits), options);
}

}  // namespace limn::engine
