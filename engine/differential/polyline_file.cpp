// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/polyline_file.h"

#include <iterator>

#include "engine/differential/polyline_chains.h"
#include "engine/io/atomic_file.h"
#include "engine/io/file.h"
#include "engine/io/file_kind.h"
#include "engine/io/text_scanner.h"
#include "engine/scene/sha256.h"

namespace limn::engine {

namespace {

/// "7", "-1" or "7/2" to a 0-based index.
size_t ResolveIndex(TextScanner& scan, std::string_view word, size_t count) {
    long long value = 0;
    auto const [stop, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    bool const isNumber =
        code == std::errc() && (stop == word.data() + word.size() || *stop == '/');
    long long const index = value > 0 ? value - 1 : static_cast<long long>(count) + value;
    if (!isNumber || value == 0 || index < 0 || index >= static_cast<long long>(count)) {
        scan.Refuse(
            fmt::format("a polyline's vertex index is {}; 1 to {} or -{} to -1 are possible here",
                        TextScanner::Quote(word), count, count));
    }
    return static_cast<size_t>(index);
}

/// \throws Error  BadMesh: fewer than two points
Polyline ReadLine(TextScanner& scan, size_t numPoints) {
    Polyline polyline;
    polyline.line = scan.GetLineNumber();
    scan.DropComment();
    for (std::string_view word = scan.Word(); !word.empty(); word = scan.Word()) {
        polyline.vertices.push_back(ResolveIndex(scan, word, numPoints));
    }
    if (polyline.vertices.size() < 2) {
        scan.Refuse(fmt::format("a polyline has {} points; at least 2 are needed",
                                polyline.vertices.size()));
    }
    return polyline;
}

/// \throws Error  BadMesh: a closed one of fewer than three points
eval::Curve MakeCurve(TextScanner const& scan, Polyline const& polyline,
                      std::vector<eval::DoubleLanes> const& points) {
    eval::Curve curve;
    curve.isClosed = polyline.IsClosed();
    size_t const count = polyline.vertices.size() - curve.isClosed;
    if (curve.isClosed && count < 3) {
        scan.RefuseAt(polyline.line,
                      fmt::format("a closed polyline has {} points; at least 3 are needed", count));
    }
    for (size_t i = 0; i < count; ++i) curve.points.push_back(points[polyline.vertices[i]]);
    return curve;
}

}  // namespace

PolylineFile ReadPolylines(std::string const& path) {
    InputFile const file(path);
    RefuseForeignFile(file.GetBytes(), path, "OBJ");
    TextScanner scan(file.GetBytes(), path, TextScanner::Backslash::JoinsLines);
    std::vector<eval::DoubleLanes> points;
    std::vector<Polyline> polylines;
    while (scan.NextLine()) {
        std::string_view const keyword = scan.Word();
        if (keyword == "v") {
            double const x = scan.Number("x"), y = scan.Number("y"), z = scan.Number("z");
            points.push_back({x, y, z, 0.0});
        } else if (keyword == "l") {
            polylines.push_back(ReadLine(scan, points.size()));
        }
    }
    if (polylines.empty()) {
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: the file has no polylines; `curve` needs 'l' lines", path));
    }
    PolylineChains chains(std::move(polylines));
    if (auto const branch = chains.FindBranch()) {
        scan.RefuseAt(branch->line,
                      fmt::format("polylines branch at vertex {} (the first 'v' is 1); at most two "
                                  "may end there, and none on another",
                                  branch->vertex + 1));
    }
    PolylineFile found{{}, Sha256(file.GetBytes())};
    for (Polyline const& chain : chains.Join())
        found.curves.push_back(MakeCurve(scan, chain, points));
    return found;
}

std::vector<double> ListCoordinates(std::vector<eval::Curve> const& curves) {
    std::vector<double> coordinates;
    for (eval::Curve const& curve : curves) {
        for (eval::DoubleLanes const& p : curve.points)
            coordinates.insert(coordinates.end(), {p[0], p[1], p[2]});
    }
    return coordinates;
}

void WritePolylines(std::string const& path, std::vector<eval::Curve> const& curves,
                    Precision precision) {
    if (GetEnding(path) != ".obj") {
        throw Error(ErrorCode::BadOption,
                    fmt::format("`path` '{}': polylines are written as .obj", path));
    }
    fmt::memory_buffer text;
    auto const to = std::back_inserter(text);
    size_t first = 1;
    for (eval::Curve const& curve : curves) {
        for (eval::DoubleLanes const& p : curve.points) {
            if (precision == Precision::Double)
                fmt::format_to(to, "v {} {} {}\n", p[0], p[1], p[2]);
            else
                fmt::format_to(to, "v {} {} {}\n", static_cast<float>(p[0]),
                               static_cast<float>(p[1]), static_cast<float>(p[2]));
        }
    }
    for (eval::Curve const& curve : curves) {
        fmt::format_to(to, "l");
        for (size_t i = 0; i < curve.points.size(); ++i) fmt::format_to(to, " {}", first + i);
        if (curve.isClosed) fmt::format_to(to, " {}", first);
        fmt::format_to(to, "\n");
        first += curve.points.size();
    }
    WriteFileAtomically(path, fmt::to_string(text));
}

}  // namespace limn::engine
