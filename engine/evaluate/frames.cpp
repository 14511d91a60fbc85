// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/frames.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "engine/evaluate/evaluate.h"
#include "engine/evaluate/place_table.h"
#include "engine/io/atomic_file.h"
#include "engine/io/mesh_reader.h"
#include "engine/scene/require_limit.h"
#include "engine/scene/same_faces.h"
#include "engine/scene/weld.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kToken = "{frame}";

/// Numbers by value, so that frame 10 follows frame 9.
bool IsNumberBefore(std::string_view a, std::string_view b) {
    auto const trim = [](std::string_view digits) {
        digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
        return digits;
    };
    std::string_view const x = trim(a), y = trim(b);
    return x.size() != y.size() ? x.size() < y.size() : x != y ? x < y : a < b;
}

bool IsMeshFile(fs::path const& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending == ".obj" || ending == ".ply" || ending == ".off";
}

/// Files of a folder in order of their names, hidden ones left out.
std::vector<fs::path> ListFiles(fs::path const& folder) {
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (entry->path().filename().string()[0] != '.' && !entry->is_directory(error))
            files.push_back(entry->path());
    }
    if (error)
        throw Error(ErrorCode::Io,
                    fmt::format("{}: cannot be listed: {}", folder.string(), error.message()));
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<Frame> FindInFolder(fs::path const& folder) {
    std::vector<Frame> frames;
    for (fs::path const& file : ListFiles(folder)) {
        if (IsMeshFile(file)) frames.push_back({file.string(), file.stem().string()});
    }
    return frames;
}

std::vector<Frame> FindByPattern(fs::path const& pattern) {
    std::string const name = pattern.filename().string();
    size_t const at = name.find(kToken);
    if (at == std::string::npos) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("`frames` {}: neither a folder nor a file name with {{frame}}",
                                pattern.string()));
    }
    std::string const before = name.substr(0, at), after = name.substr(at + kToken.size());
    std::vector<Frame> frames;
    for (fs::path const& file :
         ListFiles(pattern.has_parent_path() ? pattern.parent_path() : fs::path("."))) {
        std::string const candidate = file.filename().string();
        if (candidate.size() <= before.size() + after.size() || !candidate.starts_with(before) ||
            !candidate.ends_with(after))
            continue;
        std::string const digits =
            candidate.substr(before.size(), candidate.size() - before.size() - after.size());
        if (digits.find_first_not_of("0123456789") == std::string::npos)
            frames.push_back({file.string(), digits});
    }
    std::sort(frames.begin(), frames.end(),
              [](Frame const& a, Frame const& b) { return IsNumberBefore(a.name, b.name); });
    return frames;
}

std::string MakeOutputPath(std::string path, std::string const& frame) {
    for (size_t at = 0; (at = path.find(kToken, at)) != std::string::npos; at += frame.size()) {
        path.replace(at, kToken.size(), frame);
    }
    return path;
}

/// What a frame has that the mesh has not.
std::string Describe(Scene const& frame, FaceDifference const& difference) {
    auto const& [kind, there, here, face, corner] = difference;
    switch (kind) {
        case FaceDifference::Kind::NumVertices:
            return fmt::format("{} vertices, there {}", here, there);
        case FaceDifference::Kind::NumFaces:
            return fmt::format("{} faces, there {}", here, there);
        case FaceDifference::Kind::FaceSize:
            return fmt::format("{} has {} corners, there {}", frame.NameFace(face), here, there);
        case FaceDifference::Kind::Vertex:
            break;
    }
    return fmt::format("{} has vertex {} at corner {}, there {}", frame.NameFace(face), here,
                       corner, there);
}

/// Refuses a frame whose faces are not the mesh's.
void CheckTopology(Model const& model, Scene const& frame) {
    auto const difference = FindFaceDifference(model.GetCage(), frame.cage);
    if (!difference) return;
    throw Error(ErrorCode::BadMesh, fmt::format("{}: not the topology of '{}': {}", frame.path,
                                                model.GetPath(), Describe(frame, *difference)));
}

/// Where the answers of each frame go.
std::vector<std::string> MakeOutputPaths(std::string const& pattern,
                                         std::vector<Frame> const& frames) {
    if (pattern.find(kToken) == std::string::npos) {
        throw Error(
            ErrorCode::BadOption,
            fmt::format(
                "`outputPattern` {}: {{frame}} is missing; every frame goes to a file of its own",
                pattern));
    }
    std::vector<std::string> outputs;
    for (Frame const& frame : frames) {
        outputs.push_back(MakeOutputPath(pattern, frame.name));
        if (fs::path(outputs.back()).lexically_normal() ==
            fs::path(frame.path).lexically_normal()) {
            throw Error(ErrorCode::BadOption,
                        fmt::format("`outputPattern` {}: would replace the frame '{}'", pattern,
                                    frame.path));
        }
    }
    return outputs;
}

}  // namespace

std::vector<Frame> FindFrames(std::string const& folderOrPattern) {
    std::error_code ignored;
    bool const isFolder = fs::is_directory(folderOrPattern, ignored);
    auto frames = isFolder ? FindInFolder(folderOrPattern) : FindByPattern(folderOrPattern);
    if (frames.empty())
        throw Error(ErrorCode::Io, fmt::format("`frames` {}: no frames found", folderOrPattern));
    std::map<std::string, std::string> pathOfName;
    for (Frame const& frame : frames) {
        auto const [found, isNew] = pathOfName.try_emplace(frame.name, frame.path);
        if (isNew) continue;
        throw Error(ErrorCode::BadOption,
                    fmt::format("`frames` {}: '{}' and '{}' are both frame '{}'", folderOrPattern,
                                found->second, frame.path, frame.name));
    }
    return frames;
}

FramesReport EvaluateFrames(Model const& model, PlaceArrays const& places,
                            std::vector<Frame> const& frames, FrameOptions const& options,
                            Job& job) {
    FramesReport report;
    report.outputs = MakeOutputPaths(options.outputPattern, frames);
    RequireLimit(model);
    job.Start("building the table of places");
    eval::LimitSurface const surface(model.GetRefiner());
    eval::PlaceStencils const stencils(surface, LocatePlaces(model, places));
    std::optional<eval::FixedTable> table;
    if (options.evaluator)
        table.emplace(options.evaluator->Make(kPlacesTable, stencils.MakeRows()));
    auto const evaluate = [&](Scene const& frame) {
        return table ? stencils.Evaluate(frame.positions, options.orientation, *table)
                     : stencils.Evaluate(frame.positions, options.orientation);
    };

    // Reading, evaluating, formatting and writing of one frame follow each other in one filter:
    // frames are many and independent, so that the cores are kept busy by different frames at
    // different stages.
    std::vector<std::unique_ptr<AtomicFile>> files(frames.size());
    std::atomic<bool> isAnyDouble{false};
    job.Start("frames", frames.size());
    size_t next = 0;
    auto const choose = [&](tbb::flow_control& control) {
        if (next == frames.size()) control.stop();
        return next++;
    };
    auto const work = [&](size_t i) {
        job.CheckStopped();
        Scene frame = ReadMesh(frames[i].path);
        if (model.GetWeld()) frame = Weld(std::move(frame), model.GetWeld()->tolerance);
        CheckTopology(model, frame);
        auto file = std::make_unique<AtomicFile>(report.outputs[i]);
        auto const values = MakeLimitValues(surface, places.faces, evaluate(frame));
        Precision const precision =
            options.precision.value_or(FindTablePrecision(FindExtent(frame.positions)));
        if (precision == Precision::Double) isAnyDouble = true;
        file->Write(FormatValues(places, values, precision));
        file->Finish();
        files[i] = std::move(file);
        job.Note("frame " + frames[i].path);
        job.Advance();
    };
    // One frame more than there are threads, so that a core that waits for the disk finds other
    // work.
    auto const numInFlight = static_cast<size_t>(tbb::this_task_arena::max_concurrency()) + 1;
    tbb::parallel_pipeline(
        numInFlight, tbb::make_filter<void, size_t>(tbb::filter_mode::serial_in_order, choose) &
                         tbb::make_filter<size_t, void>(tbb::filter_mode::parallel, work));
    CommitTogether(files);
    job.Finish();
    report.numWithoutLimit =
        static_cast<size_t>(std::count_if(places.faces.begin(), places.faces.end(),
                                          [&](Index face) { return !surface.HasLimit(face); }));
    report.numRows = stencils.GetNumRows();
    if (isAnyDouble) report.precision = Precision::Double;
    return report;
}

}  // namespace limn::engine
