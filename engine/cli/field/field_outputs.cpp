// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/field/field_outputs.h"

#include <iterator>

#include <fmt/format.h>

#include "engine/io/file.h"
#include "far_ext/error.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/forms/hodge_star.h"

namespace limn::cli {

FieldOutput FindFieldOutput(std::string const& path) {
    if (path.ends_with(".edges.csv")) return FieldOutput::Edges;
    if (path.ends_with(".faces.csv")) return FieldOutput::Faces;
    if (path.ends_with(".values.csv")) return FieldOutput::Values;
    if (path.ends_with(".integrals.csv")) return FieldOutput::Integrals;
    if (path.ends_with(".along.csv")) return FieldOutput::Along;
    std::string const ending = engine::GetEnding(path);
    if (ending == ".obj" || ending == ".ply") return FieldOutput::Mesh;
    throw Error(ErrorCode::BadOption,
                fmt::format("-o '{}': a field is written as .obj or .ply (and .vectors.csv beside "
                            "it), .edges.csv, .faces.csv, .values.csv, .integrals.csv or "
                            ".along.csv",
                            path));
}

std::string NameVectors(std::string const& mesh) {
    return mesh.substr(0, mesh.rfind('.')) + ".vectors.csv";
}

std::string FormatVectors(char const* element, std::vector<std::array<double, 3>> const& vectors,
                          Precision precision) {
    int const digits = precision == Precision::Double ? 17 : 9;
    std::string text = fmt::format("{},x,y,z\n", element);
    for (size_t i = 0; i < vectors.size(); ++i) {
        auto const& v = vectors[i];
        fmt::format_to(std::back_inserter(text), "{},{:.{}g},{:.{}g},{:.{}g}\n", i, v[0], digits,
                       v[1], digits, v[2], digits);
    }
    return text;
}

std::string FormatFunction(std::span<double const> values) {
    std::string text = "vertex,value\n";
    for (size_t i = 0; i < values.size(); ++i)
        fmt::format_to(std::back_inserter(text), "{},{}\n", i, values[i]);
    return text;
}

std::string FormatIntegrals(engine::Field const& field) {
    auto const level = field.refined->GetLevel(field.refined->GetMaxLevel());
    auto const areas = far_ext::FindHodgeStars(level, field.mesh.positions).area;
    std::string text = "face,value,density\n";
    for (size_t face = 0; face < areas.size(); ++face)
        fmt::format_to(std::back_inserter(text), "{},{},{}\n", face, field.integrals[face],
                       field.integrals[face] / areas[face]);
    return text;
}

std::string FormatAlong(std::span<engine::EdgeCirculation const> along) {
    std::string text = "v0,v1,value\n";
    for (auto const& edge : along)
        fmt::format_to(std::back_inserter(text), "{},{},{}\n", edge.from, edge.to, edge.value);
    return text;
}

void AddToReport(nlohmann::json& report, engine::FieldAudit const& audit) {
    report["sum_of_indices"] = audit.indices.sum;
    report["euler_characteristic"] = audit.eulerCharacteristic;
    report["max_curl_of_gradient"] = audit.maxCurlOfGradient;
    report["max_divergence_of_vortex_part"] = audit.maxDivergenceOfVortex;
    report["commutation_d0"] = audit.commutationD0;
    report["commutation_d1"] = audit.commutationD1;
    report["parts"] = {{"gradient", audit.gradientNorm},
                       {"vortex", audit.vortexNorm},
                       {"harmonic", audit.harmonicNorm}};
    report["generators"] = audit.numGenerators;
    report["solve_seconds"] = audit.solveSeconds;
    auto& list = report["singularities"] = nlohmann::json::array();
    for (auto const& singularity : audit.indices.singularities)
        list.push_back({{singularity.isFace ? "face" : "vertex", singularity.element},
                        {"index", singularity.index}});
    if (!audit.boundary) return;
    report["boundary_residual"] = audit.boundary->residual;
    auto& loops = report["boundary"] = nlohmann::json::array();
    for (auto const& loop : audit.boundary->loops)
        loops.push_back({{"vertex", loop.vertex},
                         {"kind", loop.kind},
                         {"circulation", loop.circulation},
                         {"flux", loop.flux}});
}

}  // namespace limn::cli
