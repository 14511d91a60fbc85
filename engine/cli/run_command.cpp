// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/run_command.h"

#include <cstdlib>
#include <new>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "engine/cli/cli.h"
#include "engine/cli/effective_options.h"
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
                        "float or double: digits of output (default: float, of meshes far from "
                        "the origin double)"));
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
            return kUsage;
        case ErrorCode::BadMesh:
        case ErrorCode::Unsupported:
        case ErrorCode::TooLarge:
            return 3;
        case ErrorCode::Io:
            return 5;
    }
    return kInternal;
}

/// An error is one line.
std::string AsLine(std::string message) {
    for (char& c : message) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    return message;
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

constexpr char const* kInterrupted = "interrupted; nothing half-written is left";

/// Does some work and tells how it ended, whatever it throws.
template <class Work>
RunEnd Attempt(Work const& work, std::function<int()> const& getStopStatus) {
    try {
        return work();
    } catch (engine::Stopped const&) {
        return {getStopStatus(), kInterrupted};
    } catch (Error const& error) {
        return {ToExitStatus(error.GetCode()), AsLine(NameFlags(error.what()))};
    } catch (std::bad_alloc const&) {
        return {kInternal, "out of memory"};
    } catch (std::exception const& error) {
        return {kInternal, AsLine(fmt::format("internal: {}", error.what()))};
    }
}

/// Status 4 of a run that only warned of what it missed.
constexpr char const* kSeeWarnings = "what was asked for was not reached; see the warnings";

RunEnd ConcludeRun(int status, Context const& context) {
    if (status == kDone) return {};
    return {status, context.GetMiss().empty() ? kSeeWarnings : AsLine(context.GetMiss())};
}

}  // namespace

/// The command line as CLI11 understands it.
struct Parser {
    CLI::App app{"limn bakes the true limit of subdivision surfaces.", "limn"};
    CommonOptions common;
    std::vector<Verb> verbs;
    OptionDefaults defaults;

    Parser() {
        app.set_version_flag("--version", kVersionAndBuild);
        app.require_subcommand(1);
        app.get_formatter()->column_width(34);
        app.option_defaults()->always_capture_default();
        verbs = {AddInfo(app),    AddEval(app),  AddBake(app),   AddRefine(app),
                 AddMeasure(app), AddFit(app),   AddBands(app),  AddDenoise(app),
                 AddSharpen(app), AddMorph(app), AddSmooth(app), AddField(app)};
        for (auto const& verb : verbs) {
            AddCommonOptions(*verb.app, common);
            TakeDefaults(*verb.app, defaults);
        }
    }

    void Parse(std::vector<std::string> const& arguments) {
        app.parse(
            std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // last one first
    }

    Verb const& GetVerb() const {
        return *std::ranges::find_if(verbs, [](Verb const& verb) { return verb.app->parsed(); });
    }

    RunStart MakeStart(std::vector<std::string> const& arguments) const {
        CLI::App const& verb = *GetVerb().app;
        auto options = DescribeOptions(verb, defaults);
        options["threads"] = ChooseThreads(common);
        return {verb.get_name(), arguments, std::move(options)};
    }
};

namespace {

/// Help or the version, to stdout.
RunEnd PrintAnswer(CLI::App const& app, CLI::Success const& asked) {
    std::ostringstream out, err;
    RunEnd const end{app.exit(asked, out, err)};
    PrintData(out.str());
    return end;
}

}  // namespace

Command::Command(std::vector<std::string> arguments, engine::MeshSource& meshes,
                 std::function<int()> getStopStatus)
    : _arguments(std::move(arguments)), _meshes(meshes), _getStopStatus(std::move(getStopStatus)) {}

int Command::Run() {
    RunEnd const end = Attempt([&] { return ParseAndRun(); }, _getStopStatus);
    if (!end.error.empty()) Say(fmt::format("limn: error: {}\n", end.error));
    return end.status;
}

RunEnd Command::ParseAndRun() {
    Parser parser;
    try {
        parser.Parse(_arguments);
    } catch (CLI::Success const& asked) {
        return PrintAnswer(parser.app, asked);
    } catch (CLI::ParseError const& error) {
        return {kUsage, AsLine(fmt::format("{} (limn VERB --help tells more)", error.what()))};
    }
    return RunVerb(parser);
}

RunEnd Command::RunVerb(Parser const& parser) {
    Context context(parser.common, parser.MakeStart(_arguments), _meshes, _getStopStatus);
    SetContext(&context);
    RunEnd end = Attempt(
        [&] {
            int const status = RunOnThreads(ChooseThreads(parser.common),
                                            [&] { return parser.GetVerb().run(context); });
            return ConcludeRun(status, context);
        },
        _getStopStatus);
    if (end.status != kUsage) {
        RunEnd const written =
            Attempt([&] { return context.WriteReport(end), RunEnd{}; }, _getStopStatus);
        if (end.status == kDone)
            end = written;
        else if (written.status != kDone)
            Say(fmt::format("limn: warning: there is no report: {}\n", written.error));
    }
    SetContext(nullptr);
    return end;
}

void Command::SetContext(Context* context) {
    std::lock_guard const lock(_contextMutex);
    _context = context;
}

void Command::GiveUp(int status) {
    RunEnd const end{status, kInterrupted};
    _contextMutex.lock();  // for good: from here on the run can only wait
    Attempt(
        [&] {
            if (_context)
                _context->GiveUp(end);
            else
                engine::AbandonFiles(nullptr);
            return end;
        },
        _getStopStatus);
    SayWithoutWaiting(fmt::format("limn: error: {}\n", end.error));
}

}  // namespace limn::cli
