#pragma once

#include <string>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/scene.h"

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

/// Evaluates places in double and returns CSV text, one row per place in the order given.
///
/// \param isDouble    17 significant digits rather than 9
/// \param numWithout  counts places without a limit surface, whose rows say nan
/// \throws Error      BadMesh: a face that does not exist, a place outside its domain (row named)
std::string EvaluatePlaces(Scene const& scene, Far::TopologyRefiner const& refiner, PlaceList const& places, std::string const& path, bool isLeftHanded,
                           bool isDouble, size_t& numWithout);

}  // namespace limn::engine
