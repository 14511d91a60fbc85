// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/places.h"

#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <opensubdiv/bfr/parameterization.h>

namespace limn::engine {

namespace Bfr = OpenSubdiv::Bfr;

namespace {

bool IsIn(double x, double high) {
    constexpr double kSlack = 1e-12;
    return x >= -kSlack && x <= high + kSlack;  // NaN is not
}

/// (s,t) of an n-gon, whose sub-faces are tiles in rows of as many columns as make them roughly
/// square.
std::optional<eval::SurfacePlace> LocateInTiles(Bfr::Parameterization const& parameters, Index face,
                                                double s, double t) {
    double const numColumns = std::ceil(std::sqrt(static_cast<double>(parameters.GetFaceSize())));
    if (!IsIn(s, numColumns) || !IsIn(t, numColumns) || std::floor(s) >= numColumns) return {};
    double const coord[2] = {s, t};
    double local[2];
    int const domain = parameters.ConvertCoordToNormalizedSubFace(coord, local);
    if (domain >= parameters.GetFaceSize() || !IsIn(local[0], 1.0) || !IsIn(local[1], 1.0))
        return {};
    return eval::SurfacePlace{face, domain, local[0], local[1]};
}

std::optional<eval::SurfacePlace> Locate(far_ext::ControlMesh const& cage, Index face, double s,
                                         double t) {
    Bfr::Parameterization const parameters(cage.scheme, cage.faceSizes[face]);
    if (parameters.HasSubFaces()) return LocateInTiles(parameters, face, s, t);
    bool const isTriangle = cage.scheme == Sdc::SCHEME_LOOP;
    if (!IsIn(s, 1.0) || !IsIn(t, 1.0) || (isTriangle && !IsIn(s + t, 1.0))) return {};
    return eval::SurfacePlace{face, 0, s, t};
}

}  // namespace

PlaceError::PlaceError(size_t place, std::string reason)
    : Error(ErrorCode::BadMesh, fmt::format("place {}: {}", place, reason)),
      _place(place),
      _reason(std::move(reason)) {}

std::array<double, 2> FindCoordinates(Model const& model, eval::SurfacePlace const& place) {
    auto const& cage = model.GetCage();
    Bfr::Parameterization const parameters(cage.scheme, cage.faceSizes[place.face]);
    std::array<double, 2> coordinates{place.s, place.t};
    if (parameters.HasSubFaces()) {
        std::array<double, 2> const local = coordinates;
        parameters.ConvertNormalizedSubFaceToCoord(place.domain, local.data(), coordinates.data());
    }
    return coordinates;
}

std::vector<eval::SurfacePlace> LocatePlaces(Model const& model, PlaceArrays const& places) {
    auto const& cage = model.GetCage();
    auto const& [faces, s, t] = places;
    if (s.size() != faces.size() || t.size() != faces.size()) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("places need as many faces, s and t; there are {}, {} and {}",
                                faces.size(), s.size(), t.size()));
    }
    std::vector<eval::SurfacePlace> located;
    located.reserve(faces.size());
    for (size_t i = 0; i < faces.size(); ++i) {
        if (faces[i] < 0 || faces[i] >= cage.GetNumFaces()) {
            throw PlaceError(i, fmt::format("face {} does not exist; faces are 0 to {}", faces[i],
                                            cage.GetNumFaces() - 1));
        }
        auto const place = Locate(cage, faces[i], s[i], t[i]);
        if (!place) {
            throw PlaceError(i, fmt::format("({}, {}) lies outside face {}, which has {} corners",
                                            s[i], t[i], faces[i], cage.faceSizes[faces[i]]));
        }
        located.push_back(*place);
    }
    return located;
}

}  // namespace limn::engine
