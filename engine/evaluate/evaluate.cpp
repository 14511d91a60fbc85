// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluate.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <opensubdiv/bfr/parameterization.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "engine/io/number_table.h"
#include "engine/scene/job.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace Bfr = OpenSubdiv::Bfr;

namespace {

class PlaceMapper {
public:
    PlaceMapper(Scene const& scene, PlaceList const& places, std::string const& path)
        : _scene(scene), _places(places), _path(path) {}

    eval::SurfacePlace Map(size_t row, int faceSize) const {
        Bfr::Parameterization const parameters(_scene.cage.scheme, faceSize);
        eval::SurfacePlace place{_places.faces[row], 0, _places.s[row], _places.t[row]};
        constexpr double kSlack = 1e-12;
        auto const isIn = [&](double x, double high) { return x >= -kSlack && x <= high + kSlack; };
        bool isInside;
        if (parameters.HasSubFaces()) {
            double const coord[2] = {place.s, place.t};
            double local[2];
            // Tiles lie in rows of as many columns as make them roughly square.
            double const numColumns = std::ceil(std::sqrt(static_cast<double>(faceSize)));
            isInside = isIn(place.s, numColumns) && isIn(place.t, numColumns) &&
                       std::floor(place.s) < numColumns;
            if (isInside) {
                place.domain = parameters.ConvertCoordToNormalizedSubFace(coord, local);
                place.s = local[0];
                place.t = local[1];
                isInside = place.domain < faceSize && isIn(place.s, 1.0) && isIn(place.t, 1.0);
            }
        } else {
            bool const isTriangle = _scene.cage.scheme == Sdc::SCHEME_LOOP;
            isInside = isIn(place.s, 1.0) && isIn(place.t, 1.0) &&
                       (!isTriangle || isIn(place.s + place.t, 1.0));
        }
        if (!isInside) {  // NaN comes here too
            throw Error(
                ErrorCode::BadMesh,
                fmt::format(
                    "{}: row {} (line {}): ({}, {}) lies outside face {}, which has {} corners",
                    _path, row, _places.lines[row], _places.s[row], _places.t[row],
                    _places.faces[row], faceSize));
        }
        return place;
    }

private:
    Scene const& _scene;
    PlaceList const& _places;
    std::string const& _path;
};

}  // namespace

PlaceList ReadPlaces(std::string const& path) {
    NumberTable table = ReadNumberTable(path, {{"face", "s", "t"}});
    PlaceList places;
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        places.faces.push_back(
            GetIndex(table, path, row, 0, std::numeric_limits<int>::max(), "face"));
        places.s.push_back(table.Get(row, 1));
        places.t.push_back(table.Get(row, 2));
    }
    places.lines = std::move(table.lines);
    return places;
}

std::vector<eval::SurfacePlace> LocatePlaces(Scene const& scene, eval::LimitSurface const& surface,
                                             PlaceList const& places, std::string const& path) {
    PlaceMapper const mapper(scene, places, path);
    std::vector<eval::SurfacePlace> located;
    for (size_t row = 0; row < places.faces.size(); ++row) {
        Index const face = places.faces[row];
        if (face < 0 || face >= surface.GetNumFaces()) {
            throw Error(
                ErrorCode::BadMesh,
                fmt::format("{}: row {} (line {}): face {} does not exist; faces are 0 to {}", path,
                            row, places.lines[row], face, surface.GetNumFaces() - 1));
        }
        located.push_back(mapper.Map(row, scene.cage.faceSizes[face]));
    }
    return located;
}

std::string FormatSamples(PlaceList const& places, eval::LimitSurface const& surface,
                          std::vector<eval::SurfaceSample> const& samples, bool isDouble) {
    std::string text = "face,s,t,px,py,pz,nx,ny,nz,mean,gaussian,k1,k2,d1x,d1y,d1z\n";
    int const digits = isDouble ? 17 : 9;
    for (size_t row = 0; row < samples.size(); ++row) {
        fmt::format_to(std::back_inserter(text), "{},{},{}", places.faces[row], places.s[row],
                       places.t[row]);
        bool const hasLimit = surface.HasLimit(places.faces[row]);
        auto const& x = samples[row];
        auto const& c = x.curvature;
        double const values[] = {x.position[0], x.position[1], x.position[2],  x.normal[0],
                                 x.normal[1],   x.normal[2],   c.mean,         c.gaussian,
                                 c.k1,          c.k2,          c.direction[0], c.direction[1],
                                 c.direction[2]};
        for (double value : values) {
            if (hasLimit)
                fmt::format_to(std::back_inserter(text), ",{:.{}g}", value, digits);
            else
                text += ",nan";
        }
        text += '\n';
    }
    return text;
}

size_t CountWithoutLimit(PlaceList const& places, eval::LimitSurface const& surface) {
    auto const count = std::count_if(places.faces.begin(), places.faces.end(),
                                     [&](Index face) { return !surface.HasLimit(face); });
    return static_cast<size_t>(count);
}

std::string EvaluatePlaces(Scene const& scene, Far::TopologyRefiner const& refiner,
                           PlaceList const& places, std::string const& path, bool isLeftHanded,
                           bool isDouble, size_t& numWithout) {
    eval::LimitSurface const surface(refiner);
    auto const located = LocatePlaces(scene, surface, places, path);
    std::vector<eval::SurfaceSample> samples(located.size());
    tbb::enumerable_thread_specific<eval::FaceTree> trees(
        [&] { return eval::FaceTree(surface, scene.positions, 3); });
    double const orientation = isLeftHanded ? -1.0 : 1.0;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, located.size(), 256), [&](auto const& range) {
        CheckInterrupted();
        eval::FaceTree& tree = trees.local();
        Index bound = -1;
        for (size_t row = range.begin(); row != range.end(); ++row) {
            auto const& place = located[row];
            if (!surface.HasLimit(place.face)) continue;
            if (place.face != bound) tree.Bind(place.face);
            bound = place.face;
            samples[row] = eval::EvaluateSample(tree, place.domain, place.s, place.t, orientation);
        }
    });
    numWithout = CountWithoutLimit(places, surface);
    return FormatSamples(places, surface, samples, isDouble);
}

}  // namespace limn::engine
