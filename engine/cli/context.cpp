// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "engine/cli/cli.h"
#include "engine/cli/option_names.h"
#include "engine/io/file.h"
#include "engine/scene/defects.h"
#include "engine/scene/subdivision_names.h"
#include "engine/scene/weld.h"
#include "engine/version.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

Console::Style ChooseStyle(CommonOptions const& common) {
    if (common.isQuiet) return Console::Style::None;
    if (common.progress) return *common.progress;
    return ::isatty(STDERR_FILENO) ? Console::Style::Bar : Console::Style::Lines;
}

void ApplyOptions(CommonOptions const& common, far_ext::ControlMesh& cage) {
    if (common.scheme) cage.scheme = engine::kSchemeWords.Parse(*common.scheme);
    if (common.boundary)
        cage.options.SetVtxBoundaryInterpolation(engine::kBoundaryWords.Parse(*common.boundary));
    if (common.fvar)
        cage.options.SetFVarLinearInterpolation(engine::kFVarWords.Parse(*common.fvar));
    if (common.creases) cage.options.SetCreasingMethod(engine::kCreaseWords.Parse(*common.creases));
    if (common.triangles)
        cage.options.SetTriangleSubdivision(engine::kTriangleWords.Parse(*common.triangles));
}

}  // namespace

Context::Context(CommonOptions const& common, std::string command,
                 std::vector<std::string> arguments, engine::MeshSource& meshes,
                 std::function<bool()> isStopped)
    : _common(common),
      _meshes(meshes),
      _console(ChooseStyle(common), common.isQuiet),
      _job(_console.MakeHost(std::move(isStopped))),
      _start(std::chrono::steady_clock::now()) {
    // Opened before the work, so that a report that cannot be written is known before there is
    // output.
    if (!common.reportPath.empty() && common.reportPath != "-") {
        _reportFile = std::make_unique<engine::AtomicFile>(common.reportPath);
    }
    _report["limn_version"] = kVersionAndBuild;
    _report["command"] = command;
    _report["options"] = std::move(arguments);
    _report["inputs"] = nlohmann::json::array();
}

engine::Model Context::Load(std::string const& path, Defects defects) {
    engine::Scene scene = _meshes.Read(path);
    if (_common.weld) scene = engine::Weld(std::move(scene), *_common.weld);
    ApplyOptions(_common, scene.cage);
    Warn(scene.warnings);
    auto model = engine::Model::Build(std::move(scene));
    if (defects == Defects::Warn) {
        for (auto const& defect : engine::FindDefects(model))
            _job.Warn(fmt::format("{}: {}", path, defect.message));
    }
    _report["inputs"].push_back({{"path", path},
                                 {"sha256", model.GetSha256()},
                                 {"vertices", model.GetCage().numVertices},
                                 {"faces", model.GetCage().GetNumFaces()},
                                 {"subdivision", engine::DescribeSubdivision(model.GetCage())}});
    if (model.GetWeld()) _report["inputs"].back()["weld"] = DescribeWeld(model);
    return model;
}

void Context::Warn(std::vector<std::string> const& messages) {
    for (std::string const& message : messages) _job.Warn(message);
}

int Context::MissTarget(std::string const& message) {
    fmt::print(stderr, "limn: error: {}\n", message);
    return kNotReached;
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

void PrintData(std::string const& text) {
    bool const isWritten =
        std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!isWritten) engine::ThrowIoError("stdout", "cannot be written");
}

void Context::WriteReport() {
    if (_common.reportPath.empty()) return;
    auto& warnings = _report["warnings"] = nlohmann::json::array();
    for (std::string const& warning : _job.GetWarnings()) warnings.push_back(NameFlags(warning));
    std::chrono::duration<double> const elapsed = std::chrono::steady_clock::now() - _start;
    _report["seconds"] = std::round(elapsed.count() * 1e3) / 1e3;
    std::string const text =
        _report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    if (_common.reportPath == "-") {
        PrintData(text);
    } else {
        _reportFile->Write(text);
        _reportFile->Commit();
    }
}

}  // namespace limn::cli
