// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/scene/scene.h"
#include "eval/stencils/place_stencils.h"

namespace limn::engine {

/// Places of a mesh's limit surface: base faces and (s,t) in Bfr's parameterisation of each (docs:
/// "The command line", eval).
struct PlaceList {
    std::vector<Index> faces;
    std::vector<double> s, t;
    std::vector<size_t> lines;  ///< of the file
};

/// Reads `face,s,t` lines with a header. \throws Error BadMesh, as "FILE:LINE: ..."; Io
PlaceList ReadPlaces(std::string const& path);

/// The domains of a surface that listed places lie in.
///
/// \param path    of the list, for messages
/// \throws Error  BadMesh: a face that does not exist, a place outside its domain (row named)
std::vector<eval::SurfacePlace> LocatePlaces(Scene const& scene, eval::LimitSurface const& surface,
                                             PlaceList const& places, std::string const& path);

/// CSV text of samples, one row per place in the order given; nan where the face has no limit
/// surface.
///
/// \param isDouble  17 significant digits rather than 9
std::string FormatSamples(PlaceList const& places, eval::LimitSurface const& surface,
                          std::vector<eval::SurfaceSample> const& samples, bool isDouble);

/// Number of places whose face has no limit surface.
size_t CountWithoutLimit(PlaceList const& places, eval::LimitSurface const& surface);

/// Evaluates places in double and returns CSV text, one row per place in the order given.
///
/// \param isDouble    17 significant digits rather than 9
/// \param numWithout  counts places without a limit surface, whose rows say nan
/// \throws Error      BadMesh: a face that does not exist, a place outside its domain (row named)
std::string EvaluatePlaces(Scene const& scene, Far::TopologyRefiner const& refiner,
                           PlaceList const& places, std::string const& path, bool isLeftHanded,
                           bool isDouble, size_t& numWithout);

}  // namespace limn::engine
