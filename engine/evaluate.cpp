#include "engine/evaluate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <opensubdiv/bfr/parameterization.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "engine/io/file.h"
#include "engine/job.h"
#include "eval/surface_sample.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace Bfr = OpenSubdiv::Bfr;

namespace {

std::string_view Trim(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
    return text;
}

std::vector<std::string_view> SplitAtCommas(std::string_view line) {
    std::vector<std::string_view> fields;
    for (size_t start = 0; start <= line.size();) {
        size_t const comma = std::min(line.find(',', start), line.size());
        fields.push_back(Trim(line.substr(start, comma - start)));
        start = comma + 1;
    }
    return fields;
}

template <class Number>
bool ParseField(std::string_view field, Number& value) {
    auto const [stop, code] = std::from_chars(field.data(), field.data() + field.size(), value);
    return code == std::errc() && stop == field.data() + field.size();
}

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
            isInside = isIn(place.s, numColumns) && isIn(place.t, numColumns) && std::floor(place.s) < numColumns;
            if (isInside) {
                place.domain = parameters.ConvertCoordToNormalizedSubFace(coord, local);
                place.s = local[0];
                place.t = local[1];
                isInside = place.domain < faceSize && isIn(place.s, 1.0) && isIn(place.t, 1.0);
            }
        } else {
            bool const isTriangle = _scene.cage.scheme == Sdc::SCHEME_LOOP;
            isInside = isIn(place.s, 1.0) && isIn(place.t, 1.0) && (!isTriangle || isIn(place.s + place.t, 1.0));
        }
        if (!isInside) {  // NaN comes here too
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: row {} (line {}): ({}, {}) lies outside face {}, which has {} corners", _path, row,
                                    _places.lines[row], _places.s[row], _places.t[row], _places.faces[row], faceSize));
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
    InputFile const file(path);
    std::string_view rest = file.GetBytes();
    PlaceList places;
    size_t lineNumber = 0;
    constexpr char const* kColumns[3] = {"face", "s", "t"};
    int columns[3] = {-1, -1, -1};
    auto const refuse = [&](std::string const& message) {
        throw Error(ErrorCode::BadMesh, fmt::format("{}:{}: {}", path, lineNumber, message));
    };
    while (!rest.empty()) {
        size_t const end = std::min(rest.find('\n'), rest.size());
        std::string_view const line = Trim(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        ++lineNumber;
        if (line.empty()) continue;
        auto const fields = SplitAtCommas(line);
        if (columns[0] < 0) {
            for (size_t i = 0; i < fields.size(); ++i) {
                for (int k = 0; k < 3; ++k) {
                    if (fields[i] == kColumns[k]) columns[k] = static_cast<int>(i);
                }
            }
            if (columns[0] < 0 || columns[1] < 0 || columns[2] < 0) refuse("the header needs the columns face,s,t");
            continue;
        }
        auto const field = [&](int k) {
            size_t const i = static_cast<size_t>(columns[k]);
            return i < fields.size() ? fields[i] : std::string_view();
        };
        Index face = 0;
        double s = 0.0, t = 0.0;
        if (!ParseField(field(0), face) || !ParseField(field(1), s) || !ParseField(field(2), t)) {
            refuse("a row needs an integer face and two numbers s and t");
        }
        places.faces.push_back(face);
        places.s.push_back(s);
        places.t.push_back(t);
        places.lines.push_back(lineNumber);
    }
    if (columns[0] < 0) refuse("the file is empty; a header face,s,t is needed");
    return places;
}

std::vector<eval::SurfacePlace> LocatePlaces(Scene const& scene, eval::LimitSurface const& surface,
                                             PlaceList const& places, std::string const& path) {
    PlaceMapper const mapper(scene, places, path);
    std::vector<eval::SurfacePlace> located;
    for (size_t row = 0; row < places.faces.size(); ++row) {
        Index const face = places.faces[row];
        if (face < 0 || face >= surface.GetNumFaces()) {
            throw Error(ErrorCode::BadMesh, fmt::format("{}: row {} (line {}): face {} does not exist; faces are 0 to {}", path,
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
        fmt::format_to(std::back_inserter(text), "{},{},{}", places.faces[row], places.s[row], places.t[row]);
        bool const hasLimit = surface.HasLimit(places.faces[row]);
        auto const& x = samples[row];
        auto const& c = x.curvature;
        double const values[] = {x.position[0], x.position[1], x.position[2], x.normal[0],    x.normal[1],
                                 x.normal[2],   c.mean,        c.gaussian,    c.k1,           c.k2,
                                 c.direction[0], c.direction[1], c.direction[2]};
        for (double value : values) {
            if (hasLimit) fmt::format_to(std::back_inserter(text), ",{:.{}g}", value, digits);
            else text += ",nan";
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

std::string EvaluatePlaces(Scene const& scene, Far::TopologyRefiner const& refiner, PlaceList const& places, std::string const& path, bool isLeftHanded,
                           bool isDouble, size_t& numWithout) {
    eval::LimitSurface const surface(refiner);
    auto const located = LocatePlaces(scene, surface, places, path);
    std::vector<eval::SurfaceSample> samples(located.size());
    tbb::enumerable_thread_specific<eval::FaceTree> trees([&] { return eval::FaceTree(surface, scene.positions, 3); });
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
