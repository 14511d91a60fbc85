// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/option_names.h"
#include "engine/io/distinct_files.h"
#include "engine/io/mesh_writer.h"
#include "engine/scene/defects.h"
#include "engine/scene/subdivision_names.h"
#include "engine/scene/weld.h"
#include "engine/version.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

Console::Detail ChooseDetail(CommonOptions const& common) {
    return common.isQuiet     ? Console::Detail::Quiet
           : common.isVerbose ? Console::Detail::Verbose
                              : Console::Detail::Usual;
}

void ApplyOptions(CommonOptions const& common, far_ext::ControlMesh& cage) {
    auto& options = cage.options;
    if (common.scheme) cage.scheme = *common.scheme;
    if (common.boundary) options.SetVtxBoundaryInterpolation(*common.boundary);
    if (common.fvar) options.SetFVarLinearInterpolation(*common.fvar);
    if (common.creases) options.SetCreasingMethod(*common.creases);
    if (common.triangles) options.SetTriangleSubdivision(*common.triangles);
}

}  // namespace

Context::Context(CommonOptions const& common, RunStart start, engine::MeshSource& meshes,
                 std::function<int()> const& getStopStatus)
    : _common(common),
      _meshes(meshes),
      _console(common.progress, ChooseDetail(common)),
      _job(_console.MakeHost([=] { return getStopStatus && getStopStatus() != 0; })),
      _report(common.reportPath) {
    auto const report = _report.Open();
    report["limn_version"] = kVersionAndBuild;
    report["command"] = std::move(start.command);
    report["options"] = std::move(start.arguments);
    report["effective_options"] = std::move(start.effectiveOptions);
    report["inputs"] = nlohmann::json::array();
}

engine::Model Context::Load(std::string const& path, Defects defects) {
    _job.Start("reading " + path);
    engine::Scene scene = _meshes.Read(path);
    _job.Start("topology of " + path);
    if (_common.weld) scene = engine::Weld(std::move(scene), *_common.weld);
    ApplyOptions(_common, scene.cage);
    Warn(scene.warnings);
    auto model = engine::Model::Build(std::move(scene));
    if (defects == Defects::Warn) {
        for (auto const& defect : engine::FindDefects(model))
            _job.Warn(fmt::format("{}: {}", path, defect.message));
    }
    NoteInput(path, model);
    return model;
}

/// In the report; the first input also says what the subdivision options are that it decides.
void Context::NoteInput(std::string const& path, engine::Model const& model) {
    auto const& cage = model.GetCage();
    auto const report = _report.Open();
    if (report["inputs"].empty()) {
        auto const& rules = cage.options;
        report["effective_options"].update(
            {{"scheme", engine::kSchemeWords.GetWord(cage.scheme)},
             {"boundary", engine::kBoundaryWords.GetWord(rules.GetVtxBoundaryInterpolation())},
             {"fvar", engine::kFVarWords.GetWord(rules.GetFVarLinearInterpolation())},
             {"creases", engine::kCreaseWords.GetWord(rules.GetCreasingMethod())},
             {"triangles", engine::kTriangleWords.GetWord(rules.GetTriangleSubdivision())}});
    }
    report["inputs"].push_back({{"path", path},
                                {"sha256", model.GetSha256()},
                                {"vertices", cage.numVertices},
                                {"faces", cage.GetNumFaces()},
                                {"subdivision", engine::DescribeSubdivision(cage)}});
    if (model.GetWeld()) report["inputs"].back()["weld"] = DescribeWeld(model);
}

void Context::Warn(std::vector<std::string> const& messages) {
    for (std::string const& message : messages) _job.Warn(message);
}

Precision Context::ChoosePrecision(std::string const& path, std::span<double const> positions) {
    return engine::ChoosePrecision(MakeTarget(path), engine::FindExtent(positions), _job);
}

void Context::WriteMesh(std::string const& path, engine::Scene const& mesh, Precision precision) {
    _job.Start("writing " + path);
    Warn(engine::WriteMesh(path, mesh, precision));
    GetReport()["precision_written"] = kPrecisionWords.GetWord(precision);
}

int Context::MissTarget(std::string message) {
    _miss = std::move(message);
    return kNotReached;
}

void Context::KeepApart(std::vector<NamedFile> const& read,
                        std::vector<NamedFile> const& written) const {
    engine::DistinctFiles files;
    for (auto const& [option, path] : read) {
        if (!path.empty()) files.AddRead(path, option);
    }
    for (auto const& [option, path] : written) {
        if (!path.empty()) files.AddWritten(path, option);
    }
    std::string const& report = _common.reportPath;
    if (!report.empty() && report != "-") files.AddWritten(report, "--report");
}

void Context::KeepStdoutForData(bool writesToStdout) const {
    if (writesToStdout && _common.reportPath == "-") {
        throw Error(ErrorCode::BadOption,
                    "--report -: stdout already carries the data; name a file");
    }
}

engine::Model WithScheme(engine::Model const& model, Sdc::SchemeType scheme) {
    if (scheme == model.GetCage().scheme) return model;
    engine::Scene scene = model.MakeScene();
    scene.cage.scheme = scheme;
    far_ext::Validate(scene.cage);  // here the option is wrong, not the file: no path
    return engine::Model::Build(std::move(scene));
}

nlohmann::json DescribeWeld(engine::Model const& model) {
    auto const& weld = model.GetWeld();
    if (!weld) return nullptr;
    return {{"tolerance", weld->tolerance},
            {"joined", weld->numJoined},
            {"left_apart", weld->numLeftApart}};
}

namespace {

/// The most memory that the process has held. getrusage would count what its parent held, too.
size_t FindPeakBytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
    }
    return 0;
}

}  // namespace

nlohmann::json Context::Conclude(RunEnd const& end) const {
    auto warnings = nlohmann::json::array();
    for (std::string const& warning : _job.GetWarnings()) warnings.push_back(NameFlags(warning));
    std::chrono::duration<double> const elapsed = std::chrono::steady_clock::now() - _start;
    return {{"warnings", std::move(warnings)},
            {"seconds", std::round(elapsed.count() * 1e3) / 1e3},
            {"peak_bytes", FindPeakBytes()},
            {"exit_status", end.status},
            {"error", end.error.empty() ? nlohmann::json() : nlohmann::json(end.error)}};
}

}  // namespace limn::cli
