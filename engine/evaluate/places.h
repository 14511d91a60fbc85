// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/model.h"
#include "eval/stencils/place_stencils.h"
#include "far_ext/error.h"

namespace limn::engine {

/// Places of a mesh's limit surface: base faces and (s,t) in Bfr's parameterisation of each, which
/// docs/library.md describes. Arrays of one length, read during a call.
struct PlaceArrays {
    std::span<Index const> faces;
    std::span<double const> s, t;
};

/// A place that is not on the surface: "place 12: face 7 does not exist; faces are 0 to 5".
class PlaceError : public Error {
public:
    PlaceError(size_t place, std::string reason);

    size_t GetPlace() const { return _place; }
    std::string const& GetReason() const { return _reason; }  ///< without the number

private:
    size_t _place;
    std::string _reason;
};

/// The domains that places lie in.
///
/// \throws PlaceError  BadMesh: a face that does not exist, a place outside its domain
/// \throws Error       BadOption: arrays of different lengths
std::vector<eval::SurfacePlace> LocatePlaces(Model const& model, PlaceArrays const& places);

/// The other way: (s,t) in Bfr's parameterisation of a place's face.
std::array<double, 2> FindCoordinates(Model const& model, eval::SurfacePlace const& place);

}  // namespace limn::engine
