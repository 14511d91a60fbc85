// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/cli/cli.h"
#include "engine/cli/option_names.h"
#include "engine/scene/mesh_info.h"
#include "engine/scene/subdivision_names.h"
#include "engine/scene/udim.h"
#include "engine/smooth/critical_factor.h"
#include "far_ext/topology/boundary.h"

namespace limn::cli {

namespace {

nlohmann::json ToJson(engine::MeshInfo const& info, engine::Model const& model) {
    far_ext::ControlMesh const& cage = model.GetCage();
    nlohmann::json bySize = nlohmann::json::object();
    for (auto const& [size, count] : info.facesBySize) bySize[std::to_string(size)] = count;
    nlohmann::json defects = nlohmann::json::array();
    for (auto const& defect : info.defects) {
        defects.push_back({{"kind", defect.kind},
                           {"element", defect.element},
                           {"line", defect.line},
                           {"count", defect.count},
                           {"message", NameFlags(defect.message)}});
    }
    auto const& options = cage.options;
    return {{"vertices", info.vertices},
            {"edges", info.edges},
            {"faces", info.faces},
            {"faces_by_size", bySize},
            {"components", info.components},
            {"boundary_loops", info.boundaryLoops},
            {"euler_characteristic", info.eulerCharacteristic},
            {"genus", info.genus ? nlohmann::json(*info.genus) : nlohmann::json()},
            {"valence", {{"min", info.minValence}, {"max", info.maxValence}}},
            {"creases", info.creases},
            {"corners", info.corners},
            {"holes", info.holes},
            {"groups", info.groups},
            {"uv",
             {{"present", info.uv.present},
              {"tiles", info.uv.tiles},
              {"overlap_faces", info.uv.overlapFaces},
              {"flipped_faces", info.uv.flippedFaces},
              {"zero_area_faces", info.uv.zeroAreaFaces},
              {"faces_without", info.uv.bareFaces},
              {"out_of_range_faces", info.uv.outOfRangeFaces}}},
            {"options",
             {{"scheme", engine::kSchemeWords.GetWord(cage.scheme)},
              {"boundary", engine::kBoundaryWords.GetWord(options.GetVtxBoundaryInterpolation())},
              {"fvar", engine::kFVarWords.GetWord(options.GetFVarLinearInterpolation())},
              {"creases", engine::kCreaseWords.GetWord(options.GetCreasingMethod())},
              {"triangles", engine::kTriangleWords.GetWord(options.GetTriangleSubdivision())}}},
            {"weld", DescribeWeld(model)},
            {"defects", defects}};
}

std::string ToText(engine::Model const& model, engine::MeshInfo const& info) {
    std::string text = fmt::format("{}\n", model.GetPath());
    auto const line = [&](char const* what, std::string const& value) {
        text += fmt::format("  {:<14} {}\n", what, value);
    };
    std::string sizes;
    for (auto const& [size, count] : info.facesBySize) {
        char const* const name = size == 3 ? "triangles" : size == 4 ? "quads" : nullptr;
        sizes += fmt::format("{}{} {}", sizes.empty() ? "" : ", ", count,
                             name ? name : fmt::format("{}-gons", size));
    }
    line("topology", fmt::format("{} vertices, {} edges, {} faces ({})", info.vertices, info.edges,
                                 info.faces, sizes));
    line("surface",
         fmt::format("{} component{}, {} boundary loop{}, Euler characteristic {}, genus {}",
                     info.components, info.components == 1 ? "" : "s", info.boundaryLoops,
                     info.boundaryLoops == 1 ? "" : "s", info.eulerCharacteristic,
                     info.genus ? std::to_string(*info.genus) : "undefined"));
    line("valence", fmt::format("{} to {}", info.minValence, info.maxValence));
    line("tags", fmt::format("{} crease edges, {} corners, {} holes", info.creases, info.corners,
                             info.holes));
    line("options", engine::DescribeSubdivision(model.GetCage()));
    if (!info.groups.empty()) line("groups", fmt::format("{}", fmt::join(info.groups, ", ")));
    std::string primvars;
    for (auto const& primvar : model.GetPrimvars())
        primvars += (primvars.empty() ? "" : ", ") + primvar.name;
    if (!primvars.empty()) line("primvars", primvars);
    if (!info.uv.present) {
        line("UVs", "none");
    } else {
        auto const& tiles = info.uv.tiles;
        line("UVs",
             fmt::format("{}; faces: {} over others, {} flipped, {} without area, {} out of range, "
                         "{} without UVs",
                         tiles.empty() ? "no tile" : "tiles " + engine::ListTiles(tiles),
                         info.uv.overlapFaces, info.uv.flippedFaces, info.uv.zeroAreaFaces,
                         info.uv.outOfRangeFaces, info.uv.bareFaces));
    }
    if (auto const& weld = model.GetWeld()) {
        line("weld", fmt::format("within {}: {} vertices joined to others, {} left apart",
                                 weld->tolerance, weld->numJoined, weld->numLeftApart));
    }
    for (auto const& defect : info.defects) line("defect", NameFlags(defect.message));
    return text;
}

/// What limn smooth takes for a width, and what the mesh carries.
struct WidthInfo {
    double meanEdge;
    std::optional<double> critical;

    double GetDefault() const { return engine::kDefaultWidthFactor * meanEdge; }

    static WidthInfo Measure(engine::Model const& model, engine::Job& job) {
        job.Start("measuring the critical width");
        auto const scheme = engine::ChooseCascadeScheme(model.GetCage());
        return {far_ext::FindMeanEdgeLength(model.GetLevel(), model.GetPositions()),
                engine::MeasureCriticalWidth(WithScheme(model, scheme), job)};
    }

    nlohmann::json ToJson() const {
        return {{"mean_edge", meanEdge},
                {"default", GetDefault()},
                {"critical", critical ? nlohmann::json(*critical) : nlohmann::json()}};
    }

    std::string ToText() const {
        return fmt::format("  {:<14} default {:.4g} ({} of the mean edge), {}\n", "smooth width",
                           GetDefault(), engine::kDefaultWidthFactor,
                           critical ? fmt::format("critical {:.4g} ({:.3g} of it)", *critical,
                                                  *critical / meanEdge)
                                    : "no critical one: nothing is closed");
    }
};

}  // namespace

Verb AddInfo(CLI::App& app) {
    struct InfoArguments {
        std::string mesh;
        bool asJson = false, hasWidths = false;
    };
    auto const a = std::make_shared<InfoArguments>();
    CLI::App* const verb = app.add_subcommand("info", "Tell what limn understood of a mesh");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_flag("--json", a->asJson, "one JSON object instead of text");
    verb->add_flag("--widths", a->hasWidths,
                   "also measure the largest width of limn smooth that MESH carries");
    verb->footer("Example:\n  limn info scenes/spot/spot.obj --json");
    return {verb, [a](Context& context) {
                context.KeepStdoutForData(true);
                context.KeepApart({{"MESH", a->mesh}}, {});
                auto const model = context.Load(a->mesh, Context::Defects::Keep);
                context.GetJob().Start("describing");
                auto const info = engine::DescribeMesh(model);
                auto json = ToJson(info, model);
                std::string text = ToText(model, info);
                if (a->hasWidths) {
                    auto const widths = WidthInfo::Measure(model, context.GetJob());
                    json["smooth_widths"] = widths.ToJson();
                    text += widths.ToText();
                }
                PrintData(a->asJson
                              ? json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
                                    "\n"
                              : text);
                json.erase("options");  // of a report: the words as typed; "inputs" has the rules
                context.GetReport()->update(json);
                return kDone;
            }};
}

}  // namespace limn::cli
