// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/run_command.h"

#include <cstdlib>
#include <new>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "engine/cli/cli.h"
#include "engine/cli/option_names.h"
#include "engine/cli/options/number.h"
#include "engine/cli/parser.h"
#include "engine/cli/version_text.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

/// What a variable of the environment holds; empty without one.
std::string_view GetVariable(char const* name) {
    char const* const value = std::getenv(name);
    return value ? value : "";
}

/// \throws Error  BadOption: limn's own variable holds no number of threads
int ChooseThreads(CommonOptions const& options) {
    if (options.numThreads > 0) return options.numThreads;
    constexpr char const* kOwn = "LIMN_THREADS";
    if (auto const text = GetVariable(kOwn); !text.empty())
        return ParseNumber<int>(kOwn, text, kThreadCounts);
    // Those of other programs may hold what means something to them only.
    for (char const* name : {"OPENIMAGEIO_THREADS", "CUE_THREADS"}) {
        if (auto const count = FindNumber<int>(GetVariable(name), kThreadCounts)) return *count;
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
        return {ToExitStatus(error.GetCode()), NameFlags(error.what())};
    } catch (std::bad_alloc const&) {
        return {kInternal, "out of memory"};
    } catch (std::exception const& error) {
        return {kInternal, MakeOneLine(fmt::format("internal: {}", error.what()))};
    }
}

RunEnd ConcludeRun(int status, Context const& context) {
    if (status == kDone) return {};
    return {status, MakeOneLine(context.GetMiss())};
}

}  // namespace

Command::Command(std::vector<std::string> arguments, engine::MeshSource& meshes,
                 std::function<int()> getStopStatus)
    : _arguments(std::move(arguments)), _meshes(meshes), _getStopStatus(std::move(getStopStatus)) {}

int Command::Run() {
    RunEnd const end = Attempt([&] { return ParseAndRun(); }, _getStopStatus);
    if (!end.error.empty() && !_isTold.test_and_set())
        Say(fmt::format("limn: error: {}\n", end.error));
    return end.status;
}

RunEnd Command::ParseAndRun() {
    Parser parser;
    if (auto const answer = parser.Parse(_arguments)) {
        PrintData(*answer);
        return {};
    }
    return RunVerb(parser);
}

RunEnd Command::RunVerb(Parser const& parser) {
    CommonOptions const& common = parser.GetCommon();
    int const numThreads = ChooseThreads(common);
    auto options = parser.DescribeVerbsOptions();
    options["threads"] = numThreads;
    Verb const& verb = parser.GetVerb();
    Context context(common, {verb.app->get_name(), _arguments, std::move(options)}, _meshes,
                    _getStopStatus);
    context.GetJob().Note(fmt::format("{}, threads: {}", GetVersionText(), numThreads));
    SetContext(&context);
    RunEnd end = Attempt(
        [&] {
            int const status = RunOnThreads(numThreads, [&] { return verb.run(context); });
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
    RunEnd end{status, kInterrupted};
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
    if (!_isTold.test_and_set())  // the run may have ended just now
        SayWithoutWaiting(fmt::format("limn: error: {}\n", end.error));
}

}  // namespace limn::cli
