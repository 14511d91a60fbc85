// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/filter_options.h"
#include "engine/io/mesh_writer.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

struct FilterArguments {
    std::string mesh, output;
    int detail = 2, first = 2, last = 4, steps = 1;
    FilterOptions filter;
};

void AddArguments(CLI::App& verb, FilterArguments& a) {
    verb.add_option("MESH", a.mesh, "OBJ, PLY or OFF")->required();
    verb.add_option("-o,--output", a.output, "mesh to write, .obj or .ply")->required();
    verb.add_option("--steps", a.steps, "how often (default 1)")->check(CLI::Range(1, 1000));
    a.filter.AddTo(verb);
}

/// Loads, filters the positions and writes, with the sizes before and after in the report.
template <class Filter>
int Run(FilterArguments const& a, Context& context, Filter const& filter) {
    engine::RequireMeshEnding(a.output);
    auto mesh = context.Load(a.mesh);
    eval::RequireFinite(mesh.scene.positions, 3);
    context.GetReport()["before"] = DescribeExtent(mesh.scene, mesh);
    filter(a.filter.Build(mesh), mesh.scene.positions);
    context.GetReport()["after"] = DescribeExtent(mesh.scene, mesh);
    std::vector<std::string> warnings;
    engine::WriteMesh(a.output, mesh.scene, context.GetCommon().IsDouble(), &warnings);
    WarnAll(context, warnings);
    return kDone;
}

}  // namespace

Verb AddDenoise(CLI::App& app) {
    auto const a = std::make_shared<FilterArguments>();
    CLI::App* const verb =
        app.add_subcommand("denoise", "Smooth a mesh: keep its lowest frequency bands");
    AddArguments(*verb, *a);
    verb->add_option("--detail", a->detail, "the last band to keep (default 2); less is smoother")
        ->check(CLI::Range(0, 1000));
    verb->footer("Example:\n  limn denoise scan.ply -o out/scan.smooth.ply --detail 2 --steps 3");
    return {verb, [a](Context& context) {
                return Run(*a, context,
                           [&](eval::LimitOperator const& A, std::vector<double>& positions) {
                               eval::Denoise(A, 3, a->detail, a->steps, positions);
                           });
            }};
}

Verb AddSharpen(CLI::App& app) {
    auto const a = std::make_shared<FilterArguments>();
    CLI::App* const verb =
        app.add_subcommand("sharpen", "Sharpen a mesh: add some of its frequency bands again");
    AddArguments(*verb, *a);
    verb->add_option("--from-band", a->first,
                     "first power of the high-pass filter added (default 2)")
        ->check(CLI::Range(1, 1000));
    verb->add_option("--to-band", a->last, "last one (default 4)")->check(CLI::Range(1, 1000));
    verb->footer("Example:\n  limn sharpen scenes/spot/spot.obj -o out/spot.sharp.obj");
    return {verb, [a](Context& context) {
                if (a->first > a->last)
                    throw Error(ErrorCode::BadOption,
                                "--from-band is above --to-band; give them in order");
                return Run(*a, context,
                           [&](eval::LimitOperator const& A, std::vector<double>& positions) {
                               eval::Sharpen(A, 3, a->first, a->last, a->steps, positions);
                           });
            }};
}

}  // namespace limn::cli
