#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/evaluate.h"
#include "engine/io/file.h"

namespace limn::cli {

Verb AddEval(CLI::App& app) {
    struct Arguments {
        std::string mesh, places, output;
    };
    auto const a = std::make_shared<Arguments>();
    CLI::App* const verb = app.add_subcommand("eval", "Evaluate the limit surface at listed places, in double");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("--at", a->places, "CSV with the columns face,s,t")->required();
    verb->add_option("-o,--output", a->output, "CSV to write (default stdout)");
    verb->footer("Example:\n  printf 'face,s,t\\n0,0.5,0.5\\n' > places.csv\n  limn eval scenes/spot/spot.obj --at places.csv");
    return {verb, [a](Context& context) {
                context.KeepStdoutForData(a->output.empty());
                auto const [scene, refiner] = context.Load(a->mesh);
                auto const places = engine::ReadPlaces(a->places);
                size_t numWithout = 0;
                std::string const text =
                    engine::EvaluatePlaces(scene, *refiner, places, a->places, context.GetCommon().IsLeftHanded(),
                                           context.GetCommon().IsDouble(), numWithout);
                context.GetReport()["places"] = places.faces.size();
                context.GetReport()["places_without_limit"] = numWithout;
                if (a->output.empty()) PrintData(text);
                else engine::WriteFileAtomically(a->output, text);
                return kDone;
            }};
}

}  // namespace limn::cli
