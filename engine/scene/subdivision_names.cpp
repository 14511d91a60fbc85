// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/subdivision_names.h"

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

namespace {

template <class Value>
struct Named {
    Value value;
    char const* name;
};

constexpr Named<Sdc::SchemeType> kSchemes[] = {{Sdc::SCHEME_CATMARK, "catmark"},
                                               {Sdc::SCHEME_LOOP, "loop"},
                                               {Sdc::SCHEME_BILINEAR, "bilinear"}};
constexpr Named<Sdc::Options::VtxBoundaryInterpolation> kBoundaries[] = {
    {Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER, "edge-and-corner"},
    {Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, "edge-only"},
    {Sdc::Options::VTX_BOUNDARY_NONE, "none"}};
constexpr Named<Sdc::Options::FVarLinearInterpolation> kFVars[] = {
    {Sdc::Options::FVAR_LINEAR_NONE, "none"},
    {Sdc::Options::FVAR_LINEAR_CORNERS_ONLY, "corners-only"},
    {Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1, "corners-plus1"},
    {Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2, "corners-plus2"},
    {Sdc::Options::FVAR_LINEAR_BOUNDARIES, "boundaries"},
    {Sdc::Options::FVAR_LINEAR_ALL, "all"}};
constexpr Named<Sdc::Options::CreasingMethod> kCreases[] = {
    {Sdc::Options::CREASE_UNIFORM, "uniform"}, {Sdc::Options::CREASE_CHAIKIN, "chaikin"}};
constexpr Named<Sdc::Options::TriangleSubdivision> kTriangles[] = {
    {Sdc::Options::TRI_SUB_CATMARK, "catmark"}, {Sdc::Options::TRI_SUB_SMOOTH, "smooth"}};
constexpr Named<ExrCompression> kCompressions[] = {
    {ExrCompression::Zip, "zip"}, {ExrCompression::Zips, "zips"}, {ExrCompression::Piz, "piz"},
    {ExrCompression::Rle, "rle"}, {ExrCompression::None, "none"}, {ExrCompression::Dwaa, "dwaa"}};

template <class Value, size_t N>
char const* NameOf(Value value, Named<Value> const (&table)[N]) {
    for (auto const& row : table) {
        if (row.value == value) return row.name;
    }
    return "unknown";
}

template <class Value, size_t N>
Value Parse(char const* option, std::string const& name, Named<Value> const (&table)[N]) {
    std::string known;
    for (auto const& row : table) {
        if (name == row.name) return row.value;
        known += (known.empty() ? "" : ", ") + std::string(row.name);
    }
    throw Error(ErrorCode::BadOption,
                fmt::format("`{}`: '{}' is not one of {}", option, name, known));
}

}  // namespace

char const* GetName(Sdc::SchemeType scheme) {
    return NameOf(scheme, kSchemes);
}
char const* GetName(Sdc::Options::VtxBoundaryInterpolation rule) {
    return NameOf(rule, kBoundaries);
}
char const* GetName(Sdc::Options::FVarLinearInterpolation rule) {
    return NameOf(rule, kFVars);
}
char const* GetName(Sdc::Options::CreasingMethod method) {
    return NameOf(method, kCreases);
}
char const* GetName(Sdc::Options::TriangleSubdivision rule) {
    return NameOf(rule, kTriangles);
}
char const* GetName(ExrCompression compression) {
    return NameOf(compression, kCompressions);
}

Sdc::SchemeType ParseScheme(std::string const& name) {
    return Parse("scheme", name, kSchemes);
}
Sdc::Options::VtxBoundaryInterpolation ParseBoundary(std::string const& name) {
    return Parse("boundary", name, kBoundaries);
}
Sdc::Options::FVarLinearInterpolation ParseFVar(std::string const& name) {
    return Parse("fvar", name, kFVars);
}
Sdc::Options::CreasingMethod ParseCreases(std::string const& name) {
    return Parse("creases", name, kCreases);
}
Sdc::Options::TriangleSubdivision ParseTriangles(std::string const& name) {
    return Parse("triangles", name, kTriangles);
}
ExrCompression ParseCompression(std::string const& name) {
    return Parse("compression", name, kCompressions);
}

std::string DescribeSubdivision(far_ext::ControlMesh const& cage) {
    Sdc::Options const& options = cage.options;
    return fmt::format("scheme={} boundary={} fvar={} creases={} triangles={}",
                       GetName(cage.scheme), GetName(options.GetVtxBoundaryInterpolation()),
                       GetName(options.GetFVarLinearInterpolation()),
                       GetName(options.GetCreasingMethod()),
                       GetName(options.GetTriangleSubdivision()));
}

}  // namespace limn::engine
