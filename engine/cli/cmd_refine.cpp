#include "engine/cli/cli.h"
#include "engine/io/mesh_writer.h"
#include "engine/refine.h"

namespace limn::cli {

Verb AddRefine(CLI::App& app) {
    struct Arguments {
        std::string mesh, output, space = "spatial";
        int levels = 1;
        bool toLimit = false;
    };
    auto const a = std::make_shared<Arguments>();
    CLI::App* const verb = app.add_subcommand("refine", "Subdivide a mesh");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("-o,--output", a->output, "mesh to write, .obj or .ply")->required();
    verb->add_option("--levels", a->levels, "how often (default 1)")->check(CLI::Range(0, 10));
    verb->add_option("--space", a->space, "spatial (default): the subdivision rules on positions")
        ->check(CLI::IsMember({"spatial"}));
    verb->add_flag("--limit", a->toLimit, "move the result's vertices to the limit surface");
    verb->footer("Example:\n  limn refine scenes/spot/spot.obj -o out/spot.2.obj --levels 2");
    return {verb, [a](Context& context) {
                auto const [scene, refiner] = context.Load(a->mesh);
                engine::Scene const fine = engine::RefineUniformly(scene, a->levels, a->toLimit);
                std::vector<std::string> warnings;
                engine::WriteMesh(a->output, fine, context.GetCommon().IsDouble(), &warnings);
                for (std::string const& warning : warnings) context.GetJob().Warn(warning);
                context.GetReport()["vertices"] = fine.cage.numVertices;
                context.GetReport()["faces"] = fine.cage.GetNumFaces();
                return kDone;
            }};
}

}  // namespace limn::cli
