// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/place_table.h"

#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "engine/io/number_table.h"

namespace limn::engine {

namespace {

constexpr int kShortDigits = 9;

}  // namespace

PlaceTable ReadPlaces(std::string const& path) {
    NumberTable table = ReadNumberTable(path, {{"face", "s", "t"}});
    PlaceTable places;
    places.path = path;
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        places.faces.push_back(
            GetIndex(table, path, row, 0, std::numeric_limits<int>::max(), "face"));
        places.s.push_back(table.Get(row, 1));
        places.t.push_back(table.Get(row, 2));
    }
    places.lines = std::move(table.lines);
    return places;
}

void RefuseRow(PlaceTable const& table, PlaceError const& error) {
    throw Error(error.GetCode(),
                fmt::format("{}: row {} (line {}): {}", table.path, error.GetPlace(),
                            table.lines[error.GetPlace()], error.GetReason()));
}

double GetTableStep(Extent const& mesh) {
    double const farthest = mesh.GetFarthest();
    return farthest > 0.0 ? std::pow(10.0, std::floor(std::log10(farthest)) - kShortDigits + 1)
                          : 0.0;
}

Precision FindTablePrecision(Extent const& mesh) {
    return GetTableStep(mesh) <= kMostRounded * mesh.GetDiagonal() ? Precision::Float
                                                                   : Precision::Double;
}

std::string FormatValues(PlaceArrays const& places, LimitValues const& values, Precision precision,
                         std::vector<PlaceColumn> const& more) {
    std::string text = "face,s,t,px,py,pz,nx,ny,nz,mean,gaussian,k1,k2,d1x,d1y,d1z";
    for (PlaceColumn const& column : more) text += "," + column.name;
    text += '\n';
    int const digits = precision == Precision::Double ? 17 : kShortDigits;
    auto const append = [&](double value) {
        fmt::format_to(std::back_inserter(text), ",{:.{}g}", value, digits);
    };
    auto const appendVector = [&](std::span<double const> vectors, size_t i) {
        for (size_t c = 3 * i; c < 3 * i + 3; ++c) append(vectors[c]);
    };
    for (size_t i = 0; i < places.faces.size(); ++i) {
        fmt::format_to(std::back_inserter(text), "{},{},{}", places.faces[i], places.s[i],
                       places.t[i]);
        appendVector(values.positions, i);
        appendVector(values.normals, i);
        for (auto const* column : {&values.mean, &values.gaussian, &values.k1, &values.k2})
            append((*column)[i]);
        appendVector(values.directions, i);
        for (PlaceColumn const& column : more) append(column.values[i]);
        text += '\n';
    }
    return text;
}

}  // namespace limn::engine
