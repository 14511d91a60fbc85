// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "engine/cli/console.h"
#include "engine/cli/options/number.h"
#include "engine/cli/report.h"
#include "engine/cli/run_command.h"
#include "engine/io/written_numbers.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::cli {

/// How many threads there may be.
inline constexpr NumberRange<int> kThreadCounts{1, 1024};

/// Options every verb shares.
struct CommonOptions {
    // Without a value as the file says.
    std::optional<Sdc::SchemeType> scheme;
    std::optional<Sdc::Options::VtxBoundaryInterpolation> boundary;
    std::optional<Sdc::Options::FVarLinearInterpolation> fvar;
    std::optional<Sdc::Options::CreasingMethod> creases;
    std::optional<Sdc::Options::TriangleSubdivision> triangles;
    std::string reportPath;
    std::optional<double> weld;  ///< the tolerance
    Orientation orientation = Orientation::Right;
    std::optional<Precision> precision;  ///< none: float, meshes in double where that is too little

    /// Of arithmetic, and of numbers that are not a mesh's coordinates.
    Precision GetPrecision() const { return precision.value_or(Precision::Float); }
    std::optional<Console::Style> progress;  ///< none: what suits stderr
    int numThreads = 0;
    bool isQuiet = false, isVerbose = false;
};

/// What is known of a run before the work.
struct RunStart {
    std::string command;
    std::vector<std::string> arguments;  ///< as typed
    nlohmann::json effectiveOptions;     ///< an object, all options
};

/// A file, and the option or argument that names it.
struct NamedFile {
    std::string option, path;
};

/// How a run ended.
struct RunEnd {
    int status = kDone;
    std::string error{};  ///< one line; empty where all is well
};

/// What a verb runs with: its job, and the report it fills.
class Context {
public:
    /// \throws Error  Io: the report's file cannot be opened
    Context(CommonOptions const& common, RunStart start, engine::MeshSource& meshes,
            std::function<int()> const& getStopStatus);

    CommonOptions const& GetCommon() const { return _common; }
    engine::Job& GetJob() { return _job; }
    Report::Access GetReport() { return _report.Open(); }

    enum class Defects { Warn, Keep };

    /// Reads and checks a mesh, with the subdivision options applied, and warns of what the reader
    /// saw and (unless kept) of its defects.
    engine::Model Load(std::string const& path, Defects defects = Defects::Warn);

    void Warn(std::vector<std::string> const& messages);

    /// A mesh file as the command line asks for it.
    engine::MeshTarget MakeTarget(std::string const& path) const {
        return {path, _common.precision};
    }

    /// As engine::ChoosePrecision, for a mesh with these positions.
    Precision ChoosePrecision(std::string const& path, std::span<double const> positions);

    /// Writes the mesh that the run is for, warns of what its format cannot hold, and reports the
    /// precision.
    void WriteMesh(std::string const& path, engine::Scene const& mesh, Precision precision);

    /// Writes the report where it was asked for, with the keys that all reports have.
    void WriteReport(RunEnd const& end) {
        if (!_report.IsWanted()) return;
        _job.Start("writing the report");
        _report.Write(Conclude(end));
    }

    /// Writes the report from another thread than the run's, which is to be given up. The process
    /// has to end then.
    void GiveUp(RunEnd const& end) { _report.WriteAndAbandonFiles(Conclude(end)); }

    /// Notes that the run did not reach what was asked, which is said on stderr as an error.
    /// Returns its exit status.
    int MissTarget(std::string message);

    /// What MissTarget was told; empty if it never was.
    std::string const& GetMiss() const { return _miss; }

    /// Refuses a run that would overwrite a file that it reads, or one of its files (the report is
    /// one of them) with another. To be called before anything is read; empty paths are none.
    /// \throws Error BadOption
    void KeepApart(std::vector<NamedFile> const& read, std::vector<NamedFile> const& written) const;

    /// \throws Error BadOption  if --report - would mix with data on stdout
    void KeepStdoutForData(bool writesToStdout) const;

private:
    void NoteInput(std::string const& path, engine::Model const& model);
    nlohmann::json Conclude(RunEnd const& end) const;

    CommonOptions const& _common;
    engine::MeshSource& _meshes;
    Console _console;
    engine::Job _job;
    Report _report;
    std::string _miss;
    std::chrono::steady_clock::time_point const _start = std::chrono::steady_clock::now();
};

/// The same mesh under another scheme.
///
/// \throws Error  BadMesh: faces that the scheme cannot have
engine::Model WithScheme(engine::Model const& model, Sdc::SchemeType scheme);

/// {"tolerance": ..., "joined": ..., "left_apart": ...} of a welded mesh, else null.
nlohmann::json DescribeWeld(engine::Model const& model);

/// A verb: its subcommand of the command line, and what to do. Returns the exit status.
struct Verb {
    CLI::App* app;
    std::function<int(Context&)> run;
};

Verb AddInfo(CLI::App& app);
Verb AddEval(CLI::App& app);
Verb AddBake(CLI::App& app);
Verb AddBands(CLI::App& app);
Verb AddCombine(CLI::App& app);
Verb AddDenoise(CLI::App& app);
Verb AddField(CLI::App& app);
Verb AddFit(CLI::App& app);
Verb AddMeasure(CLI::App& app);
Verb AddMorph(CLI::App& app);
Verb AddRefine(CLI::App& app);
Verb AddSharpen(CLI::App& app);
Verb AddSmooth(CLI::App& app);

}  // namespace limn::cli
