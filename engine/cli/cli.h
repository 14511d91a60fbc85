// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "engine/cli/console.h"
#include "engine/cli/run_command.h"
#include "engine/io/atomic_file.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::cli {

/// Options every verb shares.
struct CommonOptions {
    std::optional<std::string> scheme, boundary, fvar, creases, triangles;
    std::string reportPath;
    std::optional<double> weld;  ///< the tolerance
    Orientation orientation = Orientation::Right;
    Precision precision = Precision::Float;
    std::optional<Console::Style> progress;  ///< none: what suits stderr
    int numThreads = 0;
    bool isQuiet = false, isVerbose = false;
};

/// What a verb runs with: its job, and the report it fills.
class Context {
public:
    Context(CommonOptions const& common, std::string command, std::vector<std::string> arguments,
            engine::MeshSource& meshes, std::function<bool()> isStopped);

    CommonOptions const& GetCommon() const { return _common; }
    engine::Job& GetJob() { return _job; }
    nlohmann::json& GetReport() { return _report; }

    enum class Defects { Warn, Keep };

    /// Reads and checks a mesh, with the subdivision options applied, and warns of what the reader
    /// saw and (unless kept) of its defects.
    engine::Model Load(std::string const& path, Defects defects = Defects::Warn);

    void Warn(std::vector<std::string> const& messages);

    /// Fills the keys all reports have and writes the report where it was asked for.
    void WriteReport();

    /// Says on stderr, as an error, that the run did not reach what was asked. Returns its exit
    /// status.
    int MissTarget(std::string const& message);

    /// \throws Error BadOption  if --report - would mix with data on stdout
    void KeepStdoutForData(bool writesToStdout) const;

private:
    CommonOptions const& _common;
    engine::MeshSource& _meshes;
    Console _console;
    engine::Job _job;
    nlohmann::json _report;
    std::unique_ptr<engine::AtomicFile> _reportFile;
    std::chrono::steady_clock::time_point _start;
};

/// The same mesh under another scheme.
///
/// \throws Error  BadMesh: faces that the scheme cannot have
engine::Model WithScheme(engine::Model const& model, Sdc::SchemeType scheme);

/// {"tolerance": ..., "joined": ..., "left_apart": ...} of a welded mesh, else null.
nlohmann::json DescribeWeld(engine::Model const& model);

/// Writes data to stdout. \throws Error Io, e.g. on a full disk
void PrintData(std::string const& text);

/// A verb: its subcommand of the command line, and what to do. Returns the exit status.
struct Verb {
    CLI::App* app;
    std::function<int(Context&)> run;
};

Verb AddInfo(CLI::App& app);
Verb AddEval(CLI::App& app);
Verb AddBake(CLI::App& app);
Verb AddBands(CLI::App& app);
Verb AddDenoise(CLI::App& app);
Verb AddField(CLI::App& app);
Verb AddFit(CLI::App& app);
Verb AddMeasure(CLI::App& app);
Verb AddMorph(CLI::App& app);
Verb AddRefine(CLI::App& app);
Verb AddSharpen(CLI::App& app);
Verb AddSmooth(CLI::App& app);

}  // namespace limn::cli
