// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/place_columns.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "engine/noise/noise_scale.h"
#include "engine/scene/require_limit.h"
#include "eval/forms/field_surface.h"
#include "eval/surface/surface_sample.h"

namespace limn::engine {

namespace {

constexpr char const* kPrimvar = "primvar:";

/// Places of one domain of a face that has a limit, and which of the list they are.
struct DomainPlaces {
    Index face;
    int domain;
    std::vector<size_t> numbers;
    std::vector<double> s, t;
};

std::vector<DomainPlaces> SortByDomain(std::vector<eval::SurfacePlace> const& places,
                                       eval::LimitSurface const& surface) {
    std::vector<size_t> order(places.size());
    std::iota(order.begin(), order.end(), size_t{0});
    auto const key = [&](size_t i) { return std::pair(places[i].face, places[i].domain); };
    std::ranges::stable_sort(order, {}, key);
    std::vector<DomainPlaces> domains;
    for (size_t i : order) {
        auto const& place = places[i];
        if (!surface.HasLimit(place.face)) continue;
        if (domains.empty() || std::pair(domains.back().face, domains.back().domain) != key(i))
            domains.push_back({place.face, place.domain, {}, {}, {}});
        domains.back().numbers.push_back(i);
        domains.back().s.push_back(place.s);
        domains.back().t.push_back(place.t);
    }
    return domains;
}

/// What is evaluated, and where.
struct Surroundings {
    Model const& model;
    eval::LimitSurface const& surface;
    std::vector<DomainPlaces> const& domains;
    size_t numPlaces;
    PlaceMapOptions const& options;
    Job& job;
};

/// Calls evaluate(sampler, domain) for all domains, with a sampler per thread.
template <class MakeSampler, class Evaluate>
void ForEachDomain(Surroundings const& at, MakeSampler const& makeSampler,
                   Evaluate const& evaluate) {
    tbb::enumerable_thread_specific<decltype(makeSampler())> samplers(makeSampler);
    tbb::parallel_for(size_t{0}, at.domains.size(), [&](size_t i) {
        at.job.CheckStopped();
        evaluate(samplers.local(), at.domains[i]);
    });
}

/// Columns without values, and where the numbers of a place go.
class ColumnWriter {
public:
    ColumnWriter(std::vector<std::string> const& names, size_t numPlaces,
                 std::vector<PlaceColumn>& columns)
        : _columns(columns), _first(columns.size()) {
        for (std::string const& name : names) {
            columns.push_back(
                {name, std::vector<double>(numPlaces, std::numeric_limits<double>::quiet_NaN())});
        }
    }

    void Put(size_t place, std::span<double const> numbers) const {
        for (size_t c = 0; _first + c < _columns.size() && c < numbers.size(); ++c)
            _columns[_first + c].values[place] = numbers[c];
    }

private:
    std::vector<PlaceColumn>& _columns;
    size_t _first;
};

/// NAME, or NAME_r, NAME_g, ...
std::vector<std::string> NameChannels(std::string const& name, int numChannels) {
    if (numChannels == 1) return {name};
    std::vector<std::string> names;
    for (int c = 0; c < numChannels; ++c) names.push_back(name + "_" + "rgba"[c]);
    return names;
}

void AddNoise(Surroundings const& at, PlaceColumns& result) {
    auto const& options = at.options;
    SurfaceNoise const noise(at.model, options.noise, at.job);
    NoiseScale const scale(noise.GetLow(), noise.GetHigh(), options.isNormalized,
                           options.noiseRamp);
    ColumnWriter const writer(NameChannels("noise", scale.GetNumChannels()), at.numPlaces,
                              result.columns);
    ForEachDomain(
        at, [&] { return SurfaceNoise::Sampler(noise); },
        [&](SurfaceNoise::Sampler& sampler, DomainPlaces const& places) {
            std::vector<double> values(places.numbers.size());
            sampler.Evaluate(places.face, places.domain, places.s, places.t, values);
            double channels[3] = {};
            for (size_t i = 0; i < values.size(); ++i) {
                scale.Convert(values[i], channels);
                writer.Put(places.numbers[i],
                           {channels, static_cast<size_t>(scale.GetNumChannels())});
            }
        });
    result.singularLevels = noise.GetSingularLevels();
}

/// Near extraordinary vertices fields are blended within refined faces: so deep that there are some
/// hundred thousand.
int ChooseFieldLevels(far_ext::ControlMesh const& cage) {
    double numFaces = std::max(1.0, static_cast<double>(cage.GetNumFaces()));
    int levels = 0;
    for (; levels < 8 && numFaces < 6e4; numFaces *= 4.0) ++levels;
    return levels;
}

void AddField(Surroundings const& at, PlaceColumns& result) {
    if (!at.options.field)
        throw Error(ErrorCode::BadOption, "`maps` field needs `field`, a value per edge");
    auto const& cage = at.model.GetCage();
    eval::FieldSurface const field(cage, at.model.GetPositions(), *at.options.field,
                                   ChooseFieldLevels(cage));
    ColumnWriter const writer({"fx", "fy", "fz"}, at.numPlaces, result.columns);
    ForEachDomain(
        at, [&] { return eval::FieldSurface::Sampler(field); },
        [&](eval::FieldSurface::Sampler& sampler, DomainPlaces const& places) {
            std::vector<Eigen::Vector3d> vectors(places.numbers.size());
            sampler.Evaluate(places.face, places.domain, places.s, places.t, vectors);
            for (size_t i = 0; i < vectors.size(); ++i) {
                if (at.options.isNormalized) vectors[i].stableNormalize();
                writer.Put(places.numbers[i], {vectors[i].data(), 3});
            }
        });
}

void AddPrimvar(Surroundings const& at, std::string const& name, PlaceColumns& result) {
    auto const& primvars = at.model.GetPrimvars();
    auto const primvar = std::ranges::find(primvars, name, &Primvar::name);
    if (primvar == primvars.end()) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("`maps`: '{}' has no primvar '{}'", at.model.GetPath(), name));
    }
    int const numChannels = primvar->numChannels;
    std::vector<double> const values(primvar->values.begin(), primvar->values.end());
    ColumnWriter const writer(NameChannels(name, numChannels), at.numPlaces, result.columns);
    ForEachDomain(
        at, [&] { return eval::FaceTree(at.surface, values, numChannels); },
        [&](eval::FaceTree& tree, DomainPlaces const& places) {
            tree.Bind(places.face);
            std::vector<double> channels(static_cast<size_t>(numChannels));
            for (size_t i = 0; i < places.numbers.size(); ++i) {
                for (int c = 0; c < numChannels; ++c) {
                    channels[static_cast<size_t>(c)] =
                        eval::EvaluateChannel(tree, places.domain, places.s[i], places.t[i], c);
                }
                writer.Put(places.numbers[i], channels);
            }
        });
}

void CheckMaps(std::vector<std::string> const& maps) {
    for (auto map = maps.begin(); map != maps.end(); ++map) {
        if (*map != "noise" && *map != "field" && !map->starts_with(kPrimvar)) {
            throw Error(ErrorCode::BadOption,
                        fmt::format("`maps`: there is no map '{}' of places; there are: noise, "
                                    "field, {}NAME",
                                    *map, kPrimvar));
        }
        if (std::find(maps.begin(), map, *map) != map)
            throw Error(ErrorCode::BadOption, fmt::format("`maps`: '{}' is asked for twice", *map));
    }
}

}  // namespace

PlaceColumns EvaluateMaps(Model const& model, PlaceArrays const& places,
                          PlaceMapOptions const& options, Job& job) {
    CheckMaps(options.maps);
    RequireLimit(model);
    eval::LimitSurface const surface(model.GetRefiner());
    auto const domains = SortByDomain(LocatePlaces(model, places), surface);
    Surroundings const at{model, surface, domains, places.faces.size(), options, job};
    PlaceColumns result;
    for (std::string const& map : options.maps) {
        job.Start("evaluating " + map);
        if (map == "noise")
            AddNoise(at, result);
        else if (map == "field")
            AddField(at, result);
        else
            AddPrimvar(at, map.substr(std::string_view(kPrimvar).size()), result);
    }
    return result;
}

}  // namespace limn::engine
