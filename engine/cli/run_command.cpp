// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/run_command.h"

#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/option_names.h"
#include "engine/cli/word_option.h"
#include "engine/scene/subdivision_names.h"
#include "engine/version.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

void AddCommonOptions(CLI::App& app, CommonOptions& o) {
    auto const group = [&](CLI::Option* option) { option->group("Options every verb shares"); };
    group(app.add_option("--scheme", o.scheme, "catmark, loop or bilinear (default catmark)"));
    group(app.add_option("--boundary", o.boundary,
                         "edge-and-corner, edge-only or none (default: the file's tag)"));
    group(app.add_option("--fvar", o.fvar,
                         "none, corners-only, corners-plus1, corners-plus2, boundaries or all "
                         "(default: the file's tag, "
                         "else corners-plus1)"));
    group(app.add_option("--creases", o.creases, "uniform or chaikin (default: the file's tag)"));
    group(
        app.add_option("--triangles", o.triangles, "catmark or smooth (default: the file's tag)"));
    group(app.add_option("--weld", o.weld,
                         "join boundary vertices that lie within this length of each other (0: in "
                         "one place), as where an exporter has cut along texture seams"));
    group(AddWordOption(app, "--orientation", o.orientation, engine::kOrientationWords,
                        "right (default): faces are counter-clockwise from outside; left"));
    group(app.add_option("--threads", o.numThreads,
                         "default: LIMN_THREADS, OPENIMAGEIO_THREADS, CUE_THREADS, else all cores")
              ->check(CLI::Range(1, 1024)));
    group(
        app.add_option("--report", o.reportPath, "write a JSON report of the run (- for stdout)"));
    group(AddWordOption(app, "--precision", o.precision, kPrecisionWords,
                        "float (default) or double: digits of output"));
    group(app.add_flag("--quiet", o.isQuiet, "no progress, no warnings"));
    group(app.add_flag("--verbose", o.isVerbose, "say more"));
    group(AddWordOption(app, "--progress", o.progress, kProgressWords,
                        "auto (default), bar, lines or none"));
}

int ChooseThreads(CommonOptions const& options) {
    if (options.numThreads > 0) return options.numThreads;
    for (char const* name : {"LIMN_THREADS", "OPENIMAGEIO_THREADS", "CUE_THREADS"}) {
        char const* const value = std::getenv(name);
        int const threads = value ? std::atoi(value) : 0;
        if (threads > 0 && threads <= 1024) return threads;
    }
    return tbb::info::default_concurrency();
}

int ToExitStatus(ErrorCode code) {
    switch (code) {
        case ErrorCode::BadOption:
            return 2;
        case ErrorCode::BadMesh:
        case ErrorCode::Unsupported:
        case ErrorCode::TooLarge:
            return 3;
        case ErrorCode::Io:
            return 5;
    }
    return 1;
}

int Fail(int status, std::string message) {
    for (char& c : message) {
        if (c == '\n' || c == '\r') c = ' ';  // an error is one line
    }
    fmt::print(stderr, "limn: error: {}\n", message);
    return status;
}

/// Calls work() on so many threads. The arena alone sees to it up to the number of cores; the
/// process' limit is lifted only for more.
template <class Work>
int RunOnThreads(int numThreads, Work const& work) {
    std::optional<tbb::global_control> more;
    if (numThreads > tbb::info::default_concurrency()) {
        more.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(numThreads));
    }
    tbb::task_arena arena(numThreads);
    return arena.execute(work);
}

/// The command line as CLI11 understands it.
struct Parser {
    CLI::App app{"limn bakes the true limit of subdivision surfaces.", "limn"};
    CommonOptions common;
    std::vector<Verb> verbs;

    Parser() {
        app.set_version_flag("--version", kVersionAndBuild);
        app.require_subcommand(1);
        app.get_formatter()->column_width(34);
        verbs = {AddInfo(app),    AddEval(app),  AddBake(app),   AddRefine(app),
                 AddMeasure(app), AddFit(app),   AddBands(app),  AddDenoise(app),
                 AddSharpen(app), AddMorph(app), AddSmooth(app), AddField(app)};
        for (auto const& verb : verbs) AddCommonOptions(*verb.app, common);
    }

    void Parse(std::vector<std::string> const& arguments) {
        app.parse(
            std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // last one first
    }

    Verb const& GetVerb() const {
        return *std::ranges::find_if(verbs, [](Verb const& verb) { return verb.app->parsed(); });
    }
};

int RunVerb(Parser const& parser, std::vector<std::string> const& arguments,
            engine::MeshSource& meshes, std::function<bool()> const& isStopped) {
    Verb const& verb = parser.GetVerb();
    Context context(parser.common, verb.app->get_name(), arguments, meshes, isStopped);
    int const status =
        RunOnThreads(ChooseThreads(parser.common), [&] { return verb.run(context); });
    context.WriteReport();
    return status;
}

}  // namespace

int RunCommand(std::vector<std::string> const& arguments, engine::MeshSource& meshes,
               std::function<bool()> const& isStopped) {
    Parser parser;
    try {
        parser.Parse(arguments);
    } catch (CLI::Success const& asked) {  // help, version
        return parser.app.exit(asked);
    } catch (CLI::ParseError const& error) {
        return Fail(2, fmt::format("{} (limn VERB --help tells more)", error.what()));
    }
    try {
        return RunVerb(parser, arguments, meshes, isStopped);
    } catch (engine::Stopped const&) {
        return Fail(kStopped, "interrupted; nothing half-written is left");
    } catch (Error const& error) {
        return Fail(ToExitStatus(error.GetCode()), NameFlags(error.what()));
    } catch (std::bad_alloc const&) {
        return Fail(1, "out of memory");
    } catch (std::exception const& error) {
        return Fail(1, fmt::format("internal: {}", error.what()));
    }
}

}  // namespace limn::cli
