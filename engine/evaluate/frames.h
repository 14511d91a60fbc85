// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/evaluate/places.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/stencils/table_evaluator.h"

namespace limn::engine {

/// One frame of a sequence: a mesh file, and what {frame} stands for in its output's name.
struct Frame {
    std::string path, name;
};

/// The frames of a sequence, in order.
///
/// \param folderOrPattern  a folder: all its OBJ, PLY and OFF files by name, {frame} is the name
///                         without the ending; or a path with {frame} in its last part: the files
///                         whose names have digits there, by number
/// \throws Error           Io: no such folder, no frames; BadOption: neither a folder nor a
///                         pattern, or two frames of one name
std::vector<Frame> FindFrames(std::string const& folderOrPattern);

struct FrameOptions {
    std::string outputPattern;  ///< with {frame}
    Orientation orientation = Orientation::Right;
    /// Of the tables (FormatValues); none: FindTablePrecision's for each frame.
    std::optional<Precision> precision{};
    /// What applies the table, in float; null: in double.
    eval::TableEvaluator* evaluator = nullptr;
};

struct FramesReport {
    size_t numWithoutLimit = 0;  ///< places, of each frame
    size_t numRows = 0;          ///< places evaluated by the table; the others one by one
    Precision precision = Precision::Float;  ///< the most that a frame was written with
    std::vector<std::string> outputs;
};

/// Evaluates the same places in every frame of a sequence: weights once, then per frame reading,
/// one sparse product and writing, several frames at a time and no more than that in memory.
/// Results agree with EvaluateLimit on each frame to about 1e-12 of its size (with an evaluator:
/// to float's rounding, which second derivatives and curvatures feel most).
///
/// Files    All outputs appear once the last one is written, each complete; or none does.
/// \param model    the topology and its tags; frames give positions only, and must have the same
///                 faces. Where it is welded each frame is, too
/// \throws Error   BadMesh: a frame that cannot be parsed or has other faces (file named), and as
///                 LocatePlaces; BadOption: no {frame} in the output's name; Io
/// \throws Stopped
FramesReport EvaluateFrames(Model const& model, PlaceArrays const& places,
                            std::vector<Frame> const& frames, FrameOptions const& options,
                            Job& job);

}  // namespace limn::engine
