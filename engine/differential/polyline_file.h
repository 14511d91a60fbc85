// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "eval/differential/curve.h"
#include "far_ext/types.h"

namespace limn::engine {

/// What a file of polylines holds.
struct PolylineFile {
    std::vector<eval::Curve> curves;
    std::string sha256;  ///< of its bytes
};

/// Reads the polylines ('l') of an OBJ file. Those that end at the same vertex are one curve, as
/// where a file has an 'l' per edge; one that ends where it begins is closed. Other statements but
/// 'v' are skipped.
///
/// \throws Error  Io; BadMesh: no polyline, an index out of range, a closed one of fewer than 3
///                points, a vertex at which curves branch
PolylineFile ReadPolylines(std::string const& path);

/// The coordinates of all points, 3 each.
std::vector<double> ListCoordinates(std::vector<eval::Curve> const& curves);

/// Writes curves as 'v' and 'l' of an OBJ file, complete or not at all. Numbers read back as the
/// same float or double.
///
/// \throws Error  BadOption: another ending than .obj; Io
void WritePolylines(std::string const& path, std::vector<eval::Curve> const& curves,
                    Precision precision);

}  // namespace limn::engine
