// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/evaluate/evaluate.h"
#include "engine/evaluate/place_columns.h"
#include "engine/evaluate/places.h"
#include "engine/scene/extent.h"

namespace limn::engine {

/// Places as a file lists them.
struct PlaceTable {
    std::string path;
    std::vector<Index> faces;
    std::vector<double> s, t;
    std::vector<size_t> lines;  ///< of the file

    PlaceArrays GetPlaces() const { return {faces, s, t}; }
};

/// Reads `face,s,t` lines with a header. \throws Error BadMesh, as "FILE:LINE: ..."; Io
PlaceTable ReadPlaces(std::string const& path);

/// Refuses a place by its row and line. \throws Error
[[noreturn]] void RefuseRow(PlaceTable const& table, PlaceError const& error);

/// Does what takes the table's places; one that is refused is named by its row and line.
template <class Work>
auto NamingRows(PlaceTable const& table, Work const& work) {
    try {
        return work();
    } catch (PlaceError const& error) {
        RefuseRow(table, error);
    }
}

/// The distance between coordinates of 9 digits, at the farthest of a mesh.
double GetTableStep(Extent const& mesh);

/// The digits that a mesh needs (FormatValues): 17 where 9 are more than kMostRounded of its
/// diagonal apart.
Precision FindTablePrecision(Extent const& mesh);

/// CSV text of places and their values, one row per place.
///
/// \param precision  float: 9 significant digits, double: 17
/// \param more       columns behind those of the limit
std::string FormatValues(PlaceArrays const& places, LimitValues const& values, Precision precision,
                         std::vector<PlaceColumn> const& more = {});

}  // namespace limn::engine
